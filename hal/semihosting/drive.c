/*
 * The image of a drive: the firmware's servo, told by takt call by call what has come over the bus
 * and what its motor does. twin/twin.h has the messages.
 *
 * The words it is started with name its files: the two ends of the talk.
 */
#include "base/assert.h"
#include "port/image.h"
#include "semihosting/files.h"
#include "twin/twin.h"

#include <string.h>

static struct node {
    int in, out;
    struct twin_order order;
    struct servo_config config;
    struct twin_setup setup;
    struct servo servo;
    char eds[TWIN_EDS_MAX];
} node;

/* The drive ends, and with it the talk. */
void takt_assert_failed(const char *file, int line, const char *text)
{
    (void)file;
    (void)line;
    (void)text;
    takt_semihosting_exit(3);
}

/* -- what the drive asks of its surroundings -- */

static struct twin_reply ask(const struct twin_ask *question)
{
    struct twin_reply reply;

    if (!takt_semihosting_write(node.out, question, sizeof *question) ||
        !takt_files_read_all(node.in, &reply, sizeof reply))
        takt_semihosting_exit(1);
    return reply;
}

static bool send(void *context, const struct can_frame *frame)
{
    struct twin_ask question = {.kind = TWIN_SEND};

    (void)context;
    classical_frame_set(&question.frame, frame);
    return ask(&question).yes != 0;
}

/* Frames come as orders. */
static bool receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static double turn(void *context, double torque_mm_s2, double step_s)
{
    (void)context;
    return ask(&(struct twin_ask){.kind = TWIN_TURN, .x = torque_mm_s2, .y = step_s}).encoder_mm;
}

static void sense(void *context, uint32_t cycle_ns, struct motor_sense *sense)
{
    (void)context;
    *sense = ask(&(struct twin_ask){.kind = TWIN_SENSE, .a = cycle_ns}).sense;
}

static bool holds_back(void *context, enum servo_frame kind)
{
    (void)context;
    return ask(&(struct twin_ask){.kind = TWIN_HOLDS_BACK, .a = (uint32_t)kind}).yes != 0;
}

static bool aborts_sdo(void *context, uint32_t object, uint32_t *code)
{
    const struct twin_reply reply = ask(&(struct twin_ask){.kind = TWIN_ABORTS_SDO, .a = object});

    (void)context;
    *code = reply.value;
    return reply.yes != 0;
}

static bool overrides(void *context, const struct object_row *row, uint32_t *value)
{
    const struct twin_reply reply =
        ask(&(struct twin_ask){.kind = TWIN_OVERRIDES, .a = row->index, .b = row->sub});

    (void)context;
    *value = reply.value;
    return reply.yes != 0;
}

/* -- start -- */

static bool open_talk(void)
{
    struct files files;

    if (!takt_files_begin(&files))
        return false;
    node.in = takt_files_open_next(&files, SEMIHOSTING_READ);
    node.out = takt_files_open_next(&files, SEMIHOSTING_WRITE);
    return node.in >= 0 && node.out >= 0;
}

static bool begin(void)
{
    const struct twin_hello hello = {TWIN_MAGIC, TWIN_CONFIG_SIZE, sizeof(struct motor_sense)};
    const struct can_port port = {.send = send, .receive = receive};
    const struct motor_port motor = {.turn = turn, .sense = sense};
    struct diagnostic damage;

    if (!takt_image_is_sound(&damage) || !takt_semihosting_write(node.out, &hello, sizeof hello) ||
        !takt_files_read_all(node.in, &node.setup, sizeof node.setup) ||
        node.setup.magic != TWIN_MAGIC ||
        !takt_files_read_all(node.in, &node.config, TWIN_CONFIG_SIZE))
        return false;
    takt_servo_init(&node.servo, &node.config,
                    node.setup.has_target != 0 ? &node.setup.target : NULL, &port, &motor);
    return true;
}

/* -- orders -- */

static void take_eds(uint32_t size)
{
    if (size > sizeof node.eds || !takt_files_read_all(node.in, node.eds, size))
        takt_semihosting_exit(1);
    takt_servo_set_eds(&node.servo, node.eds, size);
}

static void meddle(void)
{
    const struct servo_meddler meddler = {
        .holds_back = holds_back, .aborts_sdo = aborts_sdo, .overrides = overrides};

    takt_servo_meddle(&node.servo, &meddler);
}

static void carry_out_special(const struct twin_order *order)
{
    struct servo *servo = &node.servo;

    if (order->kind == TWIN_FAIL)
        takt_servo_fail(servo, (uint16_t)order->a, (uint8_t)order->b);
    else if (order->kind == TWIN_EMERGENCY)
        takt_servo_send_emergency(servo, (uint16_t)order->a, (uint8_t)order->b);
    else if (order->kind == TWIN_REBOOT)
        takt_servo_reboot(servo);
    else if (order->kind == TWIN_WRITE)
        (void)takt_servo_write_object(servo, order->a, order->b);
    else if (order->kind == TWIN_MEDDLE)
        meddle();
    else if (order->kind == TWIN_EDS)
        take_eds(order->a);
}

static void take_frame(const struct twin_order *order)
{
    struct can_frame frame;

    classical_frame_get(&order->frame, &frame);
    takt_servo_on_frame_at(&node.servo, &frame, order->time_ns);
}

static void carry_out(const struct twin_order *order)
{
    struct servo *servo = &node.servo;

    if (order->kind == TWIN_BOOT)
        takt_servo_boot(servo);
    else if (order->kind == TWIN_FRAME)
        take_frame(order);
    else if (order->kind == TWIN_STEP)
        takt_servo_step(servo, order->a);
    else if (order->kind == TWIN_TOUCH)
        takt_servo_touch(servo, order->a != 0, order->ratio);
    else if (order->kind == TWIN_LOOK)
        takt_servo_loop_look(&servo->loop);
    else
        carry_out_special(order);
}

static void run(void)
{
    const struct twin_ask done = {.kind = TWIN_DONE};

    while (takt_files_read_all(node.in, &node.order, sizeof node.order) &&
           node.order.kind != TWIN_END) {
        carry_out(&node.order);
        if (!takt_semihosting_write(node.out, &done, sizeof done))
            return;
    }
}

int main(void)
{
    if (!open_talk())
        takt_semihosting_exit(2);
    if (begin())
        run();
    takt_semihosting_exit(0);
}

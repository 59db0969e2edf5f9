#define _POSIX_C_SOURCE 200809L

#include "target/drive_image.h"

#include "target/wire.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static const char *const ask_names[TWIN_ASK_KINDS] = {
    [TWIN_DONE] = "ends the order",
    [TWIN_SEND] = "sends a frame",
    [TWIN_TURN] = "turns the motor",
    [TWIN_SENSE] = "looks at the motor",
    [TWIN_HOLDS_BACK] = "looks whether a frame is held back",
    [TWIN_ABORTS_SDO] = "looks whether an SDO request is aborted",
    [TWIN_OVERRIDES] = "looks whether an object is overridden",
};

/* The talk is over; `problem` says why. */
static bool hang_up(struct drive_image *image)
{
    image->is_talking = false;
    return false;
}

static bool say(struct drive_image *image, const char *problem)
{
    (void)snprintf(image->problem, sizeof image->problem, "%s", problem);
    return hang_up(image);
}

static bool is_gone(struct drive_image *image)
{
    return say(image, "QEMU has ended in the middle of the run");
}

bool drive_image_is_known(const char *name)
{
    const struct process_board *board = process_board(name);

    return board != NULL && board->has_drives;
}

/* -- the image does what the drive here does -- */

static bool do_differ(struct drive_image *image, enum twin_ask_kind here, uint32_t there)
{
    (void)snprintf(image->problem, sizeof image->problem, "at %.6f s the image %s where takt %s",
                   (double)image->here->now_ns * 1e-9,
                   there < TWIN_ASK_KINDS ? ask_names[there] : "does what nobody knows",
                   ask_names[here]);
    return hang_up(image);
}

/*
 * The next thing it does, which must be of this kind. False: there is none; the drive here is
 * alone.
 */
static bool next_ask(struct drive_image *image, enum twin_ask_kind kind, struct twin_ask *ask)
{
    *ask = (struct twin_ask){.kind = kind};
    if (!image->is_talking)
        return false;
    if (!image->is_in_order)
        return say(image, "the drive here does something without an order");
    if (!wire_read(image->process.from, ask, sizeof *ask))
        return is_gone(image);
    return ask->kind == (uint32_t)kind || do_differ(image, kind, ask->kind);
}

static void reply(struct drive_image *image, const struct twin_reply *reply)
{
    if (image->is_talking && !wire_write(image->process.to, reply, sizeof *reply))
        (void)is_gone(image);
}

static void compare(struct drive_image *image, bool is_same)
{
    if (!is_same && image->differences++ == 0)
        image->first_difference_ns = image->here->now_ns;
}

/* Bits, not values: -0 is not 0. */
static bool is_same_number(double a, double b)
{
    uint64_t a_bits, b_bits;

    memcpy(&a_bits, &a, sizeof a_bits);
    memcpy(&b_bits, &b, sizeof b_bits);
    return a_bits == b_bits;
}

static bool is_same_frame(const struct can_frame *a, const struct can_frame *b)
{
    return a->id == b->id && a->length == b->length && memcmp(a->data, b->data, a->length) == 0;
}

static bool send(void *context, const struct can_frame *frame)
{
    struct drive_image *image = context;
    struct can_frame sent;
    struct twin_ask ask;
    bool is_sent;

    if (next_ask(image, TWIN_SEND, &ask) && !classical_frame_is_valid(&ask.frame))
        (void)say(image, "it sends a frame that there is not");
    if (!image->is_talking)
        return image->bus.send(image->bus.context, frame);
    classical_frame_get(&ask.frame, &sent);
    compare(image, is_same_frame(frame, &sent));
    is_sent = image->bus.send(image->bus.context, &sent);
    reply(image, &(struct twin_reply){.yes = is_sent});
    return is_sent;
}

static bool receive(void *context, struct can_frame *frame)
{
    struct drive_image *image = context;

    return image->bus.receive(image->bus.context, frame);
}

static double turn(void *context, double torque_mm_s2, double step_s)
{
    struct drive_image *image = context;
    struct twin_ask ask;
    double encoder_mm;

    if (!next_ask(image, TWIN_TURN, &ask))
        return image->motor.turn(image->motor.context, torque_mm_s2, step_s);
    compare(image, is_same_number(torque_mm_s2, ask.x) && is_same_number(step_s, ask.y));
    encoder_mm = image->motor.turn(image->motor.context, ask.x, ask.y);
    reply(image, &(struct twin_reply){.encoder_mm = encoder_mm});
    return encoder_mm;
}

static void sense(void *context, uint32_t cycle_ns, struct motor_sense *seen)
{
    struct drive_image *image = context;
    struct twin_reply answer = {0};
    struct twin_ask ask;

    if (!next_ask(image, TWIN_SENSE, &ask)) {
        image->motor.sense(image->motor.context, cycle_ns, seen);
        return;
    }
    compare(image, cycle_ns == ask.a);
    image->motor.sense(image->motor.context, ask.a, seen);
    answer.sense = *seen;
    reply(image, &answer);
}

static bool holds_back(void *context, enum servo_frame kind)
{
    struct drive_image *image = context;
    const bool held = image->meddler.holds_back(image->meddler.context, kind);
    struct twin_ask ask;

    if (next_ask(image, TWIN_HOLDS_BACK, &ask)) {
        compare(image, ask.a == (uint32_t)kind);
        reply(image, &(struct twin_reply){.yes = held});
    }
    return held;
}

static bool aborts_sdo(void *context, uint32_t object, uint32_t *code)
{
    struct drive_image *image = context;
    const bool aborts = image->meddler.aborts_sdo(image->meddler.context, object, code);
    struct twin_ask ask;

    if (next_ask(image, TWIN_ABORTS_SDO, &ask)) {
        compare(image, ask.a == object);
        reply(image, &(struct twin_reply){.yes = aborts, .value = aborts ? *code : 0});
    }
    return aborts;
}

static bool overrides(void *context, const struct object_row *row, uint32_t *value)
{
    struct drive_image *image = context;
    const bool has = image->meddler.overrides(image->meddler.context, row, value);
    struct twin_ask ask;

    if (next_ask(image, TWIN_OVERRIDES, &ask)) {
        compare(image, ask.a == row->index && ask.b == row->sub);
        reply(image, &(struct twin_reply){.yes = has, .value = has ? *value : 0});
    }
    return has;
}

static struct servo_meddler meddle(void *context, const struct servo_meddler *meddler)
{
    struct drive_image *image = context;

    image->meddler = *meddler;
    return (struct servo_meddler){.holds_back = holds_back,
                                  .aborts_sdo = aborts_sdo,
                                  .overrides = overrides,
                                  .context = image};
}

/* -- orders -- */

static void begin(void *context, const struct twin_order *order, const char *bytes)
{
    struct drive_image *image = context;

    image->is_in_order = true;
    if (!image->is_talking)
        return;
    if (!wire_write(image->process.to, order, sizeof *order) ||
        (bytes != NULL && !wire_write(image->process.to, bytes, order->a)))
        (void)is_gone(image);
}

static void end(void *context)
{
    struct drive_image *image = context;
    struct twin_ask ask;

    (void)next_ask(image, TWIN_DONE, &ask);
    image->is_in_order = false;
}

/* -- start -- */

/*
 * The image says what it was built with, and is told what drive it is; then it looks at its motor.
 */
static void open(void *context, struct servo *servo, const struct servo_config *config,
                 const struct pdo *target, struct can_port *port, struct motor_port *motor)
{
    struct drive_image *image = context;
    struct twin_setup setup = {.magic = TWIN_MAGIC, .has_target = target != NULL};

    image->here = servo;
    image->bus = *port;
    image->motor = *motor;
    *port = (struct can_port){.send = send, .receive = receive, .context = image};
    *motor = (struct motor_port){.turn = turn, .sense = sense, .context = image};
    if (target != NULL)
        setup.target = *target;
    if (image->is_talking && (!wire_write(image->process.to, &setup, sizeof setup) ||
                              !wire_write(image->process.to, config, TWIN_CONFIG_SIZE)))
        (void)is_gone(image);
    image->is_in_order =
        true; /* of the start: takt_servo_init asks, and nobody says that it has ended */
}

static bool shake_hands(struct drive_image *image)
{
    struct twin_hello hello;

    if (!wire_read(image->process.from, &hello, sizeof hello))
        return say(image, "QEMU has ended before the image said anything");
    if (hello.magic != TWIN_MAGIC || hello.config_size != TWIN_CONFIG_SIZE ||
        hello.sense_size != sizeof(struct motor_sense))
        return say(image, "the image is of another version: build it anew");
    return true;
}

bool drive_image_open(struct drive_image *image, const char *name, const char *path)
{
    const struct process_board *board = process_board(name);

    memset(image, 0, sizeof *image);
    image->twin = (struct virtual_drive_twin){
        .open = open, .begin = begin, .end = end, .meddle = meddle, .context = image};
    (void)signal(SIGPIPE, SIG_IGN);
    if (!process_start(&image->process, board, path, (int[PROCESS_FILES]){PROCESS_TALK, -1})) {
        (void)snprintf(image->problem, sizeof image->problem,
                       "%s with %s cannot be started: %s (Debian: %s)", board->qemu, path,
                       strerror(errno), board->package);
        return false;
    }
    image->is_talking = shake_hands(image);
    return image->is_talking;
}

void drive_image_close(struct drive_image *image)
{
    if (image->is_talking)
        (void)wire_write(image->process.to, &(struct twin_order){.kind = TWIN_END},
                         sizeof(struct twin_order));
    image->is_talking = false;
    process_end(&image->process);
}

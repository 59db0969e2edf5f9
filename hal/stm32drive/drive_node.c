#include "stm32drive/drive_node.h"

#include "stm32/watchdog.h"

#include <string.h>

#define NS_PER_US 1000U

/* Emergencies (CiA 301, table 26). */
#define EMCY_POWER_STAGE 0x5400U
#define EMCY_SOFTWARE    0x6100U
#define EMCY_PARAMETERS  0x6310U

static bool has_torque(const struct servo *servo)
{
    const enum cia402_state state = takt_servo_get_state(servo);

    return state == CIA402_ENABLED || state == CIA402_QUICK_STOP || state == CIA402_FAULT_REACTION;
}

/* The processor stands still while a sector is erased. */
static bool keep(void *context, const struct servo *servo)
{
    struct drive_node *node = context;
    const size_t length = takt_servo_write_stored(servo, node->stored, sizeof node->stored);

    return !has_torque(servo) && length > 0 && takt_store_begin(&node->store, (uint32_t)length) &&
           takt_store_write(&node->store, node->stored, length) && takt_store_commit(&node->store);
}

/* False: what is stored is not this firmware's. Nothing stored is right. */
static bool read_stored(struct drive_node *node)
{
    const uint8_t *bytes;
    uint32_t size;

    return !takt_store_get(&node->store, &bytes, &size) ||
           takt_servo_read_stored(&node->servo, bytes, size);
}

/* After a crash somebody has to look: the fault is there until it is reset. */
static void boot(struct drive_node *node)
{
    const struct drive_keeper keeper = {.keep = keep, .context = node};
    const struct flash_port flash = takt_flash_get_port(&node->flash, node->config.mapped);

    takt_store_open(&node->store, &flash);
    const bool is_right = read_stored(node);
    takt_servo_keep(&node->servo, &keeper);
    takt_servo_boot(&node->servo);
    if (node->config.has_crashed)
        takt_servo_fail(&node->servo, EMCY_SOFTWARE, EMCY_REGISTER_GENERIC);
    if (!is_right)
        takt_servo_send_emergency(&node->servo, EMCY_PARAMETERS, EMCY_REGISTER_GENERIC);
}

bool takt_drive_node_open(struct drive_node *node, const struct drive_node_config *config)
{
    memset(node, 0, sizeof *node);
    node->config = *config;
    takt_gpio_set_output(config->enable);
    takt_servo_motor_open(&node->motor, &config->motor);
    if (!takt_can_controller_open(&node->can, &config->can))
        return false;
    node->bus = takt_can_controller_get_port(&node->can);
    const struct motor_port motor = takt_servo_motor_get_port(&node->motor);
    takt_servo_init(&node->servo, &config->servo, NULL, &node->bus, &motor);
    boot(node);
    return true;
}

static void take_frames(struct drive_node *node)
{
    struct can_frame frame;

    takt_can_controller_poll(&node->can);
    while (node->bus.receive(node->bus.context, &frame))
        takt_servo_on_frame(&node->servo, &frame);
}

/* Without torque a step may be late: sectors are erased then. */
static void watch(struct drive_node *node, bool turns)
{
    const bool is_late = takt_servo_motor_take_late(&node->motor);

    if (takt_servo_motor_has_failed(&node->motor))
        takt_servo_fail(&node->servo, EMCY_POWER_STAGE, EMCY_REGISTER_GENERIC);
    if (turns && is_late)
        takt_servo_fail(&node->servo, EMCY_SOFTWARE, EMCY_REGISTER_GENERIC);
}

void takt_drive_node_cycle(struct drive_node *node)
{
    take_frames(node);
    const bool turns = has_torque(&node->servo);
    takt_servo_motor_arm(&node->motor, turns);
    takt_gpio_write(node->config.enable, turns);
    takt_servo_step(&node->servo, node->config.servo.loop.loop_period_us * NS_PER_US);
    watch(node, turns);
    takt_watchdog_feed();
}

/* The configuration of the drives that follows from a machine. */
#include "base/maths.h"
#include "controller/controller.h"

#include <string.h>

#define START_TIMEOUT_S  5.0
#define ANSWER_TIMEOUT_S 0.02
#define STOP_TIMEOUT_S   2.0
#define BRAKE_TIMEOUT_S  3.0

static uint32_t cycles_in(const struct machine *machine, double time_s)
{
    return (uint32_t)takt_maths_ceil(1e6 * time_s / (double)machine->cycle_us);
}

static void set_homing(struct drives_homing *homing, const struct machine *machine,
                       const struct machine_axis *axis)
{
    *homing = (struct drives_homing){
        .order = axis->home_order,
        .method = axis->home_method,
        .velocity_mm_s = axis->home_velocity_mm_s,
        .zero_mm_s = axis->home_zero_velocity_mm_s,
        .acceleration_mm_s2 = axis->home_acceleration_mm_s2,
        .offset_mm = axis->home_offset_mm,
        .offset_is_position = axis->home_offset_is_position != 0,
        .timeout_cycles = cycles_in(machine, axis->home_timeout_s),
    };
}

/*
 * K = 1 / (4 T) of the position loop that is closed here (drive/drives_velocity.c). T is what a
 * setpoint takes to the report of its position, less the half of a cycle that it is held for, and
 * the drive's own delay: it has to follow setpoints whose acceleration is there after A/J, so that
 * is the most that it can be. The same for all axes, for then a straight path stays one.
 */
static double position_gain_per_s(const struct machine *machine)
{
    const double loop_s = 1e-6 * (double)machine->cycle_us * (DRIVES_LATENCY_CYCLES - 0.5);
    double slowest_s = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (machine_axis_is_on_can(axis)) {
            slowest_s = maths_max(slowest_s, axis->max_acceleration_mm_s2 / axis->max_jerk_mm_s3);
        }
    }
    return machine->position_gain_per_s > 0 ? machine->position_gain_per_s
                                            : 0.25 / (loop_s + slowest_s);
}

static void add_drive(struct drives_config *config, const struct machine *machine, unsigned i)
{
    const struct machine_axis *axis = &machine->axis[i];
    struct drives_config_axis *drive = &config->axis[config->count++];

    *drive = (struct drives_config_axis){
        .axis = (enum axis)i,
        .node = axis->drive_node,
        .bus = axis->drive_bus,
        .keeps_settings = axis->drive_is_set_up != 0,
        .increments_per_mm = axis->increments_per_mm,
        .velocity_units_per_mm_s = axis->velocity_units_per_mm_s,
        .max_acceleration_mm_s2 = axis->max_acceleration_mm_s2,
        .travel_per_turn_mm = axis->travel_per_turn_mm,
        .following_error_max_mm = axis->following_error_max_mm,
        .identity = {axis->drive_vendor, axis->drive_product, axis->drive_revision,
                     axis->drive_serial},
    };
    set_homing(&drive->homing, machine, axis);
}

/*
 * The homing method that looks on the same side of the axis with a motor that turns the other way
 * (CiA 402-2, object 6098): limit switches, 1 and 2, change places, so do home switches of either
 * end, 3 4 and 5 6, and the directions of a search about a switch between them, 7 ... 10 and 11 ...
 * 14. From 17 on the same without index pulse; 33 and 34 are index pulses alone, what comes behind
 * has no direction.
 */
static int8_t mirror_method(int8_t method)
{
    const int way = (method - 1) % 16 + 1;
    const int apart = way <= 2 ? 1 : way <= 6 ? 2 : 4;
    const int first = way <= 2 ? 1 : way <= 6 ? 3 : 7;

    if (method < 1 || method > 34 || way > 14) {
        return method;
    }
    return (int8_t)(way - first < apart ? method + apart : method - apart);
}

static uint8_t find_drive(const struct drives_config *config, unsigned axis)
{
    uint8_t i = 0;

    while (config->axis[i].axis != axis) {
        i++;
    }
    return i;
}

/* The second drive differs from the first only in what its place on the gantry asks for. */
static void add_second(struct drives_config *config, const struct machine *machine,
                       const struct machine_gantry *gantry)
{
    struct drives_config_axis *drive = &config->axis[config->count];

    config->gantry[config->gantry_count++] =
        (struct drives_gantry){.first = find_drive(config, gantry->axis),
                               .second = (uint8_t)config->count,
                               .skew_max_mm = gantry->skew_max_mm};
    add_drive(config, machine, gantry->axis);
    drive->node = gantry->drive_node;
    drive->bus = gantry->drive_bus;
    drive->identity.serial = 0;
    drive->homing.offset_mm = gantry->home_offset_mm;
    if (gantry->is_reversed != 0) {
        drive->increments_per_mm = -drive->increments_per_mm;
        drive->homing.method = mirror_method(drive->homing.method);
    }
    if (gantry->home_method != 0) {
        drive->homing.method = gantry->home_method;
    }
}

/*
 * The drive that was added last, by its configuration, if there is one: it is as if it had been set
 * up before.
 */
static void set_up_last(struct drives_config *config, const struct concise_dcf *dcf, unsigned i)
{
    struct drives_config_axis *drive = &config->axis[config->count - 1];

    if (dcf != NULL && dcf[i].bytes != NULL) {
        drive->dcf = &dcf[i];
        drive->keeps_settings = true;
    }
}

void takt_controller_drives_config(const struct machine *machine, const struct concise_dcf *dcf,
                                   struct drives_config *config)
{
    memset(config, 0, sizeof(*config));
    config->cycle_us = machine->cycle_us;
    config->rates = takt_machine_get_rates(machine);
    config->controller_node = machine->controller_node;
    config->no_error_pdo = machine->error_pdo == 0;
    config->heartbeat_ms = (uint16_t)machine->heartbeat_ms;
    config->boot_timeout_cycles = cycles_in(machine, 1e-3 * machine->boot_timeout_ms);
    config->start_timeout_cycles =
        cycles_in(machine, maths_max(START_TIMEOUT_S, 1e-3 * machine->boot_timeout_ms));
    config->answer_timeout_cycles = cycles_in(machine, ANSWER_TIMEOUT_S);
    config->sdo_timeout_cycles = cycles_in(machine, 1e-3 * machine->sdo_timeout_ms);
    config->stop_timeout_cycles = cycles_in(machine, STOP_TIMEOUT_S);
    config->brake_timeout_cycles = cycles_in(machine, BRAKE_TIMEOUT_S);
    config->io_count = takt_machine_io_count(machine);
    config->wiring = machine->io;
    config->position_gain_per_s = position_gain_per_s(machine);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i])) {
            add_drive(config, machine, i);
            set_up_last(config, dcf, i);
        }
    }
    for (unsigned i = 0; i < takt_machine_gantry_count(machine); i++) {
        add_second(config, machine, &machine->gantry[i]);
        set_up_last(config, dcf, AXIS_COUNT + i);
    }
}

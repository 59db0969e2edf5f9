#include "config/machine_setup.h"

#include "base/maths.h"
#include "classic/limiter.h"
#include "config/bus_advice.h"
#include "config/shaper.h"
#include "drive/drives.h"
#include "machine/machine_check.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#define DEGREE (MATHS_PI / 180.0)

#define SPINDLE_ANY_RPM 1e6

/* Steps a second that a virtual stepping motor follows: more than the firmware asks of one. */
#define STEPPER_RATE_HZ 500000.0

static const struct machine_axis rotary_default = {
    .rotary = true,
    .max_velocity_mm_s = 180.0 * DEGREE,
    .max_acceleration_mm_s2 = 1800.0 * DEGREE,
    .max_jerk_mm_s3 = 90000.0 * DEGREE,
    .limiter_band_percent = LIMITER_BAND_PERCENT,
    .travel_min_mm = -3600.0 * DEGREE,
    .travel_max_mm = 3600.0 * DEGREE,
    .increments_per_mm = 100000.0 * (1.0 / DEGREE), /* as a file's 100000 per degree is read */
    .following_error_max_mm = 2.0 * DEGREE,
    .steps_per_mm = 100.0 * (1.0 / DEGREE),
    .step_rate_max_hz = 200000.0,
    .home_method = 37,
    .home_velocity_mm_s = 36.0 * DEGREE,
    .home_zero_velocity_mm_s = 3.6 * DEGREE,
    .home_acceleration_mm_s2 = 900.0 * DEGREE,
    .home_timeout_s = 60.0,
};

static void set_rotary(struct machine_setup *setup, unsigned axis)
{
    setup->machine.axis[axis] = rotary_default;
    setup->machine.axis[axis].drive_node = (uint8_t)(axis + 1);
    setup->drive[axis].plant.travel_per_revolution_mm = 10.0 * DEGREE;
    setup->drive[axis].plant.quick_stop_deceleration_mm_s2 = 1800.0 * DEGREE;
    setup->drive[axis].plant.following_error_window_mm = 5.0 * DEGREE;
    setup->drive[axis].plant.pitch_error_period_mm = 10.0 * DEGREE;
    setup->drive[axis].plant.limit_switch_min_mm = -360000.0 * DEGREE;
    setup->drive[axis].plant.limit_switch_max_mm = 360000.0 * DEGREE;
    setup->drive[axis].plant.hard_stop_min_mm = -720000.0 * DEGREE;
    setup->drive[axis].plant.hard_stop_max_mm = 720000.0 * DEGREE;
}

void machine_setup_set_default(struct machine_setup *setup)
{
    *setup = (struct machine_setup){0};
    takt_machine_set_default(&setup->machine);
    virtual_spindle_set_default(&setup->spindle);
    setup->geometry.table_axis = AXIS_COUNT;
    setup->geometry.head_axis = AXIS_COUNT;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        setup->vibration.table[i].along = AXIS_COUNT;
    setup->geometry.tool_direction[AXIS_Z] = 1;
    for (unsigned i = MACHINE_SECOND_DRIVE; i < MACHINE_SETUP_DRIVES_MAX; i++)
        drive_plant_set_default(&setup->drive[i].plant);
    (void)snprintf(setup->panel.listen, sizeof setup->panel.listen, "127.0.0.1:1502");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        drive_plant_set_default(&setup->drive[i].plant);
        setup->stepper[i] =
            (struct virtual_stepper_config){.has_encoder = 1, .rate_max_hz = STEPPER_RATE_HZ};
        if (i >= AXIS_LINEAR_COUNT)
            set_rotary(setup, i);
    }
}

__attribute__((format(printf, 1, 2))) static const char *problem(const char *format, ...)
{
    static _Thread_local char text[512];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

/* What a number that is in its key's range is out of. */
static const char *bound_of(const char *field)
{
    static const struct {
        const char *field, *bound;
    } bounds[] = {
        {"hard_stop_min_mm", "; it is at most start_mm"},
        {"hard_stop_max_mm", "; it is at least start_mm"},
        {"limit_switch_max_mm", "; it is above limit_switch_min_mm"},
        {"loop_period_us", "; so slow loops do not reach velocity_bandwidth_hz"},
    };

    for (size_t i = 0; i < sizeof bounds / sizeof bounds[0]; i++) {
        if (strcmp(field, bounds[i].field) == 0)
            return bounds[i].bound;
    }
    return "";
}

static const char *check_drive(const struct machine_setup *setup, unsigned index)
{
    const char *field = drive_plant_check(&setup->drive[index].plant);
    const unsigned node = index < MACHINE_SECOND_DRIVE
                              ? setup->machine.axis[index].drive_node
                              : setup->machine.gantry[index - MACHINE_SECOND_DRIVE].drive_node;
    const unsigned bus = index < MACHINE_SECOND_DRIVE
                             ? setup->machine.axis[index].drive_bus
                             : setup->machine.gantry[index - MACHINE_SECOND_DRIVE].drive_bus;

    if (field == NULL)
        return NULL;
    if (bus > 0)
        return problem("drive %u:%u: %s is out of range%s", bus, node, field, bound_of(field));
    return problem("drive %u: %s is out of range%s", node, field, bound_of(field));
}

/* The first bus that cannot, with advice for the machine as a whole. */
static const char *check_buses(const struct machine *machine)
{
    char advice[BUS_ADVICE_MAX + 1];
    char rate[32] = "", name[16] = "";
    uint8_t node[MACHINE_NODES_MAX];
    struct drives_load load = {0};
    unsigned bus = 0;

    while (bus < takt_machine_bus_count(machine) && takt_machine_predict_load(machine, bus, &load))
        bus++;
    if (bus == takt_machine_bus_count(machine))
        return NULL;
    bus_advice_write(machine, bus, advice);
    if (machine->can_data_bitrate > 0)
        (void)snprintf(rate, sizeof rate, " (data %u)", (unsigned)machine->can_data_bitrate);
    if (takt_machine_bus_count(machine) > 1)
        (void)snprintf(name, sizeof name, " can%u", bus % 10);
    return problem("the bus%s cannot carry a cycle: %u drives take %u of %u bits at worst, load "
                   "%.1f %%, at %u "
                   "bit/s%s and %u us; %s",
                   name, takt_machine_bus_nodes(machine, bus, node), (unsigned)load.bits,
                   (unsigned)load.capacity_bits, load.percent, (unsigned)machine->can_bitrate, rate,
                   (unsigned)machine->cycle_us, advice);
}

/* What the controller itself refuses; of the bus with the figures that a machine file has. */
static const char *check_machine(const struct machine *machine)
{
    char text[DIAGNOSTIC_TEXT_MAX];
    struct diagnostic wrong;

    if (takt_machine_check(machine, &wrong))
        return NULL;
    if (wrong.code == TAKT_ERROR_BUS_OVERLOAD)
        return check_buses(machine);
    (void)takt_diagnostic_text(&wrong, text);
    return problem("%s", text);
}

/* The axis that turns the part: as the controller knows it, or as the machine really is. */
static uint32_t turn_axis(const struct machine_setup *setup)
{
    const uint32_t known = setup->machine.correction.turn_axis;

    return known < AXIS_COUNT ? known : setup->geometry.table_axis;
}

/* The turning unit is the axis that [correction] and [geometry] mean. */
static const char *check_turning(const struct machine_setup *setup, uint32_t axis)
{
    const uint32_t named[] = {setup->machine.correction.turn_axis, setup->geometry.table_axis};

    for (unsigned i = 0; i < 2; i++) {
        if (named[i] < AXIS_COUNT && named[i] != axis)
            return problem("chain: the unit beside w is to be %c, which %s says turns the part",
                           AXIS_LETTERS[named[i]],
                           i == 0 ? "correction.turn_axis" : "geometry.table_axis");
    }
    return NULL;
}

const char *machine_setup_chain(const struct machine_setup *setup, struct unit_chain *chain)
{
    const char *wrong = chain_text_read(setup->chain, turn_axis(setup), chain);
    unsigned units = 0;

    if (wrong != NULL)
        return wrong;
    for (unsigned i = 0; i < chain->units; i++)
        units |= 1U << chain->axis[i];
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (setup->machine.axis[i].present && (units & 1U << i) == 0)
            return problem("chain: axis %c is missing", AXIS_LETTERS[i]);
    }
    const uint8_t last = chain->axis[chain->units - 1];

    return check_turning(setup, last >= AXIS_LINEAR_COUNT ? last : AXIS_COUNT);
}

static bool is_direction(const double v[AXIS_LINEAR_COUNT])
{
    return v[AXIS_X] != 0 || v[AXIS_Y] != 0 || v[AXIS_Z] != 0;
}

/* What tells where a tool points: as the controller knows it, and as it really is. */
static const char *check_tool(const struct machine_setup *setup)
{
    static const char *const section[] = {"correction", "geometry"};
    const double *direction[] = {setup->machine.correction.tool_direction,
                                 setup->geometry.tool_direction};
    const uint32_t head[] = {setup->machine.correction.head_axis, setup->geometry.head_axis};

    for (unsigned i = 0; i < 2; i++) {
        if (!is_direction(direction[i]))
            return problem("%s.tool_direction: 0 0 0 is no direction", section[i]);
        if (head[i] < AXIS_COUNT && !setup->machine.axis[head[i]].present)
            return problem("%s.head_axis: the machine has no axis %c", section[i],
                           AXIS_LETTERS[head[i]]);
        if (head[i] < AXIS_COUNT && head[i] == turn_axis(setup))
            return problem("%s.head_axis: %c turns the part", section[i], AXIS_LETTERS[head[i]]);
    }
    return NULL;
}

static const char *check_shaper(const struct machine_setup *setup)
{
    const char *wrong = shaper_check(setup);

    return wrong == NULL ? NULL : problem("machine.shaper: %s", wrong);
}

static const char *check_vibration(const struct machine_setup *setup)
{
    unsigned axis = 0;
    const char *wrong = vibration_check(&setup->vibration, &axis);

    if (wrong != NULL)
        return problem("geometry.mode_%c: %s", "xyz"[axis], wrong);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const uint32_t along = setup->vibration.table[i].along;

        if (along < AXIS_LINEAR_COUNT && !setup->machine.axis[along].present)
            return problem("geometry.mode_%c_along: the machine has no axis %c", "xyz"[i],
                           AXIS_LETTERS[along]);
    }
    return NULL;
}

const char *machine_setup_check(const struct machine_setup *setup)
{
    const char *wrong = check_machine(&setup->machine);
    struct unit_chain chain;

    if (wrong == NULL)
        wrong = machine_setup_chain(setup, &chain);
    if (wrong == NULL)
        wrong = check_tool(setup);
    if (wrong == NULL)
        wrong = check_vibration(setup);
    if (wrong == NULL)
        wrong = check_shaper(setup);

    for (unsigned i = 0; i < AXIS_COUNT && wrong == NULL; i++) {
        if (setup->machine.axis[i].present)
            wrong = check_drive(setup, i);
    }
    for (unsigned i = 0; i < takt_machine_gantry_count(&setup->machine) && wrong == NULL; i++)
        wrong = check_drive(setup, MACHINE_SECOND_DRIVE + i);
    return wrong;
}

struct frame_rates machine_setup_get_rates(const struct machine *machine)
{
    return (struct frame_rates){machine->can_bitrate, machine->can_data_bitrate};
}

double machine_setup_predict_load_percent(const struct machine *machine, unsigned bus)
{
    struct drives_load load;

    (void)takt_machine_predict_load(machine, bus, &load);
    return load.percent;
}

/* A machine without a highest speed has a spindle that goes as fast as any. */
struct virtual_spindle_config machine_setup_get_spindle(const struct machine_setup *setup)
{
    struct virtual_spindle_config config = setup->spindle;

    config.ramp_rpm_s = setup->machine.spindle_ramp_rpm_s;
    config.encoder_counts_per_revolution = setup->machine.spindle_encoder_counts;
    if (setup->machine.spindle_max_rpm > 0)
        config.max_rpm = setup->machine.spindle_max_rpm;
    else
        config.max_rpm = SPINDLE_ANY_RPM;
    return config;
}

#include "takt/machine_setup.h"

#include "base/maths.h"
#include "drive/drives.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>

#define DEGREE (MATHS_PI / 180.0)

#define SPINDLE_ANY_RPM 1e6

/*
 * Setpoints are doubles: X mm from zero they are rounded, and differences over a cycle t turn that into noise of up to
 * 4.5e-16 X / t^2 in acceleration and 9e-16 X / t^3 in jerk. The limits are kept to 1e-4 and 1e-3 of themselves, so
 * they must stand that far above the noise.
 */
#define ROUNDING_ACCELERATION 5e-12
#define ROUNDING_JERK         1e-12

/* Steps a second that a virtual stepping motor follows: more than the firmware asks of one. */
#define STEPPER_RATE_HZ 500000.0

static const struct machine_axis rotary_default = {
    .rotary = true,
    .max_velocity_mm_s = 180.0 * DEGREE,
    .max_acceleration_mm_s2 = 1800.0 * DEGREE,
    .max_jerk_mm_s3 = 90000.0 * DEGREE,
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
    setup->drive[axis].travel_per_revolution_mm = 10.0 * DEGREE;
    setup->drive[axis].quick_stop_deceleration_mm_s2 = 1800.0 * DEGREE;
    setup->drive[axis].following_error_window_mm = 5.0 * DEGREE;
    setup->drive[axis].pitch_error_period_mm = 10.0 * DEGREE;
    setup->drive[axis].limit_switch_min_mm = -360000.0 * DEGREE;
    setup->drive[axis].limit_switch_max_mm = 360000.0 * DEGREE;
}

void machine_setup_set_default(struct machine_setup *setup)
{
    *setup = (struct machine_setup){0};
    machine_set_default(&setup->machine);
    virtual_spindle_set_default(&setup->spindle);
    setup->geometry.table_axis = AXIS_COUNT;
    (void)snprintf(setup->panel.listen, sizeof setup->panel.listen, "127.0.0.1:1502");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        drive_plant_set_default(&setup->drive[i]);
        setup->stepper[i] =
            (struct virtual_stepper_config){.has_encoder = 1, .rate_max_hz = STEPPER_RATE_HZ};
        if (i >= AXIS_LINEAR_COUNT)
            set_rotary(setup, i);
    }
}

__attribute__((format(printf, 1, 2))) static const char *problem(const char *format, ...)
{
    static char text[256];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

static const char *check_axis(const struct machine_axis *axis, char letter)
{
    double farthest = maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm));

    if (axis->travel_min_mm >= axis->travel_max_mm)
        return problem("axis %c: its travel ends before it begins", letter);
    if (axis->travel_min_mm > 0 || axis->travel_max_mm < 0)
        return problem("axis %c: its travel must include 0, where the drives start", letter);
    if (farthest * axis->increments_per_mm > (double)INT32_MAX)
        return problem("axis %c: at %.9g increments/%s its travel does not fit a drive's 32 bits",
                       letter,
                       axis->rotary ? axis->increments_per_mm * DEGREE : axis->increments_per_mm,
                       axis->rotary ? "deg" : "mm");
    return NULL;
}

static const char *check_limits(const struct machine_axis *axis, char letter, double cycle_s)
{
    double farthest = maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm));
    double acceleration = ROUNDING_ACCELERATION * farthest / (cycle_s * cycle_s);
    double jerk = ROUNDING_JERK * farthest / (cycle_s * cycle_s * cycle_s);

    if (axis->max_acceleration_mm_s2 < acceleration)
        return problem("axis %c: its acceleration is too low for so short a cycle: at least %.3g",
                       letter, acceleration);
    if (axis->max_jerk_mm_s3 < jerk)
        return problem("axis %c: its jerk is too low for so short a cycle: at least %.3g", letter,
                       jerk);
    return NULL;
}

static const char *check_steps(const struct machine_axis *axis, char letter)
{
    double rate_hz = axis->max_velocity_mm_s * axis->steps_per_mm;
    double farthest = maths_max(maths_abs(axis->travel_min_mm), maths_abs(axis->travel_max_mm));

    if (!machine_axis_is_stepped(axis))
        return NULL;
    if (rate_hz > axis->step_rate_max_hz * (1 + 1e-9))
        return problem("axis %c: at max_velocity its steps come at %.9g Hz, above its "
                       "step_rate_max_hz of %.9g; lower max_velocity or steps_per_%s",
                       letter, rate_hz, axis->step_rate_max_hz, axis->rotary ? "deg" : "mm");
    if (farthest * axis->steps_per_mm > (double)INT32_MAX)
        return problem("axis %c: its travel does not fit 32 bits of steps", letter);
    return NULL;
}

static const char *check_node(const struct machine *machine, unsigned axis)
{
    for (unsigned i = 0; i < axis; i++) {
        if (machine->axis[i].present &&
            machine->axis[i].drive_node == machine->axis[axis].drive_node)
            return problem("axes %c and %c have the same drive_node %u", AXIS_LETTERS[i],
                           AXIS_LETTERS[axis], (unsigned)machine->axis[axis].drive_node);
    }
    return NULL;
}

static const char *check_home(const struct machine_axis *axis, char letter)
{
    if (maths_abs(axis->home_offset_mm) * axis->increments_per_mm <= (double)INT32_MAX)
        return NULL;
    return problem("axis %c: its home_offset_%s does not fit a drive's 32 bits", letter,
                   axis->rotary ? "deg" : "mm");
}

static const char *check_controller_node(const struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine->axis[i].present && machine->axis[i].drive_node == machine->controller_node)
            return problem("controller_node %u is the drive_node of axis %c",
                           (unsigned)machine->controller_node, AXIS_LETTERS[i]);
    }
    return NULL;
}

static const char *check_drive(const struct machine_setup *setup, unsigned axis)
{
    const char *field = drive_plant_check(&setup->drive[axis]);

    if (field == NULL)
        return NULL;
    return problem("drive %u: %s is out of range", (unsigned)setup->machine.axis[axis].drive_node,
                   field);
}

static unsigned count_drives(const struct machine *machine)
{
    unsigned drives = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&machine->axis[i]))
            drives++;
    }
    return drives;
}

static const char *check_bus(const struct machine *machine)
{
    struct drives_load load;
    unsigned drives = count_drives(machine);

    if (drives_predict_load(drives, machine->can_bitrate, machine->cycle_us, &load))
        return NULL;
    return problem(
        "the bus cannot carry a cycle: %u drives take %u of %u bits at worst, load %.1f %%, at %u "
        "bit/s and %u us",
        drives, (unsigned)load.bits, (unsigned)load.capacity_bits, load.percent,
        (unsigned)machine->can_bitrate, (unsigned)machine->cycle_us);
}

const char *machine_setup_check(const struct machine_setup *setup)
{
    const char *wrong = NULL;

    if (machine_axes(&setup->machine) == 0)
        return "the machine has no axis";
    for (unsigned i = 0; i < AXIS_COUNT && wrong == NULL; i++) {
        if (!setup->machine.axis[i].present)
            continue;
        wrong = check_axis(&setup->machine.axis[i], AXIS_LETTERS[i]);
        if (wrong == NULL)
            wrong = check_limits(&setup->machine.axis[i], AXIS_LETTERS[i],
                                 1e-6 * (double)setup->machine.cycle_us);
        if (wrong == NULL)
            wrong = check_steps(&setup->machine.axis[i], AXIS_LETTERS[i]);
        if (wrong == NULL)
            wrong = check_home(&setup->machine.axis[i], AXIS_LETTERS[i]);
        if (wrong == NULL)
            wrong = check_node(&setup->machine, i);
        if (wrong == NULL)
            wrong = check_drive(setup, i);
    }
    if (wrong == NULL)
        wrong = check_controller_node(&setup->machine);
    return wrong != NULL ? wrong : check_bus(&setup->machine);
}

double machine_setup_predict_load_percent(const struct machine *machine)
{
    struct drives_load load;

    (void)drives_predict_load(count_drives(machine), machine->can_bitrate, machine->cycle_us,
                              &load);
    return load.percent;
}

/* A machine without a highest speed has a spindle that goes as fast as any. */
struct virtual_spindle_config machine_setup_get_spindle(const struct machine_setup *setup)
{
    struct virtual_spindle_config config = setup->spindle;

    if (setup->machine.spindle_max_rpm > 0)
        config.max_rpm = setup->machine.spindle_max_rpm;
    else
        config.max_rpm = SPINDLE_ANY_RPM;
    return config;
}

#include "studies/friction_test.h"

#include "base/maths.h"
#include "cli/message.h"
#include "studies/study.h"

/* So the program is called in messages. */
#define NAME "friction.ngc"

/* The highest velocity, as a part of the axis's; of its travel what is used. */
#define VELOCITY_PART 0.9
#define TRAVEL_PART   0.9

/* At a constant velocity: before torque is read, and for how long it is. */
#define SETTLES_S  0.3
#define MEASURED_S 0.5

/*
 * Line of the program on which an axis goes at the first velocity; each velocity has a line up, one
 * down, and rests.
 */
#define LINE_FIRST     3
#define LINES_VELOCITY 4
#define LINES_AXIS     (LINES_VELOCITY * FRICTION_VELOCITIES + 1)

#define OBJECT_TORQUE 0x60770010u /* thousandths of the rated torque */

struct sum {
    double torque_nm;
    uint32_t count;
};

struct run {
    struct friction_test *test;
    unsigned asked_for;                                 /* axes, bits; 0: all that can be */
    unsigned axes;                                      /* that are measured */
    struct sum sum[AXIS_COUNT][FRICTION_VELOCITIES][2]; /* up, down */
    uint32_t line;                                      /* of the last cycle */
    double steady_s;                                    /* so long at the velocity of this line */
    struct point last;                                  /* setpoint */
};

static double velocity_of(const struct friction_axis *axis, unsigned k)
{
    return (k + 1) * axis->step_mm_s;
}

/* Way of a line: what is measured, and ramps to either side, V/A + A/J each. */
static double way_at(const struct machine_axis *axis, double velocity_mm_s)
{
    const double ramp_s = velocity_mm_s / axis->max_acceleration_mm_s2 +
                          axis->max_acceleration_mm_s2 / axis->max_jerk_mm_s3;

    return velocity_mm_s * (SETTLES_S + MEASURED_S + ramp_s);
}

static double travel_of(const struct machine_axis *axis)
{
    return TRAVEL_PART * (axis->travel_max_mm - axis->travel_min_mm);
}

/* The highest velocity whose line fits into the travel, by bisection. */
static double highest_velocity(const struct machine_axis *axis)
{
    double low = 0, high = VELOCITY_PART * axis->max_velocity_mm_s;

    if (way_at(axis, high) <= travel_of(axis))
        return high;
    for (unsigned i = 0; i < 50; i++) {
        const double middle = (low + high) / 2;

        *(way_at(axis, middle) <= travel_of(axis) ? &low : &high) = middle;
    }
    return low;
}

/* -- the program -- */

static double unit_of(unsigned axis)
{
    return axis < AXIS_LINEAR_COUNT ? 1 : 180 / MATHS_PI;
}

static void write_line(FILE *stream, unsigned axis, double at_mm)
{
    (void)fprintf(stream, "G1 %c%.9f\nG4 P0.1\n", AXIS_LETTERS[axis], unit_of(axis) * at_mm);
}

static void write_axis(FILE *stream, const struct run *run, const struct machine_setup *setup,
                       unsigned i)
{
    const struct machine_axis *axis = &setup->machine.axis[i];
    const struct friction_axis *f = &run->test->axis[i];
    const double middle_mm = (axis->travel_min_mm + axis->travel_max_mm) / 2;
    const double low_mm = middle_mm - way_at(axis, velocity_of(f, FRICTION_VELOCITIES - 1)) / 2;

    (void)fprintf(stream, "G0 %c%.9f\n", AXIS_LETTERS[i], unit_of(i) * low_mm);
    for (unsigned k = 0; k < FRICTION_VELOCITIES; k++) {
        const double velocity = velocity_of(f, k);

        (void)fprintf(stream, "F%.9f ", 60 * unit_of(i) * velocity);
        write_line(stream, i, low_mm + way_at(axis, velocity));
        write_line(stream, i, low_mm);
    }
}

static void write_program(void *context, const struct machine_setup *setup, FILE *program)
{
    const struct run *run = context;

    (void)fputs("G21 G17 G40 G49 G90 G94 G61\n", program);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((run->axes & 1U << i) != 0)
            write_axis(program, run, setup, i);
    }
    (void)fputs("M2\n", program);
}

/* -- the run -- */

/*
 * The axis that is moved on a line, and at which velocity: of the measured ones in their order.
 * False: none.
 */
static bool find_line(const struct run *run, uint32_t line, unsigned *axis, unsigned *k)
{
    uint32_t first = LINE_FIRST;

    for (*axis = 0; *axis < AXIS_COUNT; (*axis)++) {
        if ((run->axes & 1U << *axis) == 0)
            continue;
        if (line >= first && line < first + LINES_AXIS - 1) {
            *k = (line - first) / LINES_VELOCITY;
            return (line - first) % 2 == 0;
        }
        first += LINES_AXIS;
    }
    return false;
}

static double torque_nm(struct run *run, struct simulation *s, unsigned axis)
{
    const struct friction_axis *f = &run->test->axis[axis];
    struct virtual_drive *drive = &s->network.drives.drive[f->drive];
    uint32_t value = 0;

    (void)virtual_drive_read_object(drive, OBJECT_TORQUE, &value);
    return 1e-3 * (int16_t)value * f->torque_rated_nm;
}

static void see(void *context, const struct machine_setup *setup, struct simulation *s,
                const struct cycle_record *record)
{
    struct run *run = context;
    const double cycle_s = machine_cycle_s(&setup->machine);
    const struct point last = run->last;
    unsigned i, k;

    run->last = record->set;
    run->steady_s = record->line == run->line ? run->steady_s : 0;
    run->line = record->line;
    if (!find_line(run, record->line, &i, &k))
        return;
    const double wanted = velocity_of(&run->test->axis[i], k);
    const double velocity = (record->set.at[i] - last.at[i]) / cycle_s;

    if (maths_abs(maths_abs(velocity) - wanted) > 1e-6 * wanted) {
        run->steady_s = 0;
        return;
    }
    run->steady_s += cycle_s;
    if (run->steady_s > SETTLES_S) {
        struct sum *sum = &run->sum[i][k][velocity < 0];

        sum->torque_nm += torque_nm(run, s, i);
        sum->count++;
    }
}

/* Friction at rest: where the line through the two lowest velocities comes to. */
static bool take(struct run *run, unsigned i)
{
    struct friction_axis *f = &run->test->axis[i];

    for (unsigned k = 0; k < FRICTION_VELOCITIES; k++) {
        const struct sum *up = &run->sum[i][k][0], *down = &run->sum[i][k][1];

        if (up->count == 0 || down->count == 0) {
            message_command_error("axis %c never goes at a constant %.6g mm/s or rad/s for %g s: "
                                  "what holds it back? (takt plan)",
                                  AXIS_LETTERS[i], velocity_of(f, k), SETTLES_S);
            return false;
        }
        const double high = up->torque_nm / up->count, low = down->torque_nm / down->count;

        f->torque_nm[k + 1] = maths_max(0, (high - low) / 2);
        f->offset_nm[k] = (high + low) / 2;
    }
    f->torque_nm[0] = maths_max(0, 2 * f->torque_nm[1] - f->torque_nm[2]);
    f->is_measured = true;
    return true;
}

static void choose_axis(struct run *run, const struct machine_setup *setup, unsigned i,
                        unsigned drive)
{
    const struct machine_axis *axis = &setup->machine.axis[i];

    run->axes |= 1U << i;
    run->test->axis[i] = (struct friction_axis){
        .bus = axis->drive_bus,
        .node = axis->drive_node,
        .drive = drive,
        .torque_rated_nm = setup->drive[i].plant.torque_rated_nm,
        .step_mm_s = highest_velocity(axis) / FRICTION_VELOCITIES,
    };
}

/* False after a message: an axis that is asked for has no drive on CAN. */
static bool choose_axes(void *context, const struct machine_setup *setup)
{
    struct run *run = context;
    const unsigned axes = run->asked_for;
    unsigned drives = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool is_on_can = machine_axis_is_on_can(&setup->machine.axis[i]);

        if (!is_on_can && (axes & 1U << i) != 0) {
            message_command_error("axis %c has no drive on CAN, which tells its torque",
                                  AXIS_LETTERS[i]);
            return false;
        }
        if (is_on_can && (axes == 0 || (axes & 1U << i) != 0))
            choose_axis(run, setup, i, drives);
        drives += is_on_can;
    }
    if (run->axes == 0)
        message_command_error("no axis has a drive on CAN, which tells its torque");
    return run->axes != 0;
}

enum command_status friction_test_run(struct friction_test *test, unsigned axes,
                                      const struct options *options)
{
    struct run run = {.test = test, .asked_for = axes};
    const struct study study = {.program = NAME,
                                .context = &run,
                                .prepare = choose_axes,
                                .write = write_program,
                                .see = see};
    enum command_status status = study_run(&study, options);

    for (unsigned i = 0; i < AXIS_COUNT && status == STATUS_DONE; i++) {
        if ((run.axes & 1U << i) != 0 && !take(&run, i))
            status = STATUS_FAILED;
    }
    return status;
}

#include "studies/resonance_test.h"

#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "studies/study.h"

#include <math.h>

/* So the program is called in messages. */
#define NAME "resonance.ngc"

/* Moves of an axis, and the longest rest behind one. */
#define MOVES      160
#define REST_MAX_S 0.25

/* Moves are longer than a millionth of the longest, which needs this part of the travel at most. */
#define TRAVEL_PART 0.3
#define RATIO       1e-3

struct run {
    struct resonance_test *test;
    unsigned asked_for; /* axes, bits; 0: all that can be */
    unsigned axes;      /* that are measured */
    uint32_t state;     /* of random numbers */
    struct resonance_record record[AXIS_LINEAR_COUNT];
    uint32_t first[AXIS_LINEAR_COUNT]; /* line of the program on which an axis begins to be moved */
    unsigned seen;                     /* cycles, of which the last two are: */
    double foot_mm[2], tool_mm[2];
    unsigned axis; /* that they are of */
};

/* 0 ... below 1: xorshift (Marsaglia 2003). */
static double draw(struct run *run)
{
    run->state ^= run->state << 13;
    run->state ^= run->state >> 17;
    run->state ^= run->state << 5;
    return run->state / 4294967296.0;
}

/* Box and Muller 1958. */
static double draw_normal(struct run *run)
{
    const double far = sqrt(-2 * log(1 - draw(run)));

    return far * cos(MATHS_TWO_PI * draw(run));
}

/* -- the program -- */

/* As far as the axis needs to come to its highest velocity, if there is so much travel. */
static double longest_mm(const struct machine_axis *axis)
{
    const double v = axis->max_velocity_mm_s, a = axis->max_acceleration_mm_s2;
    const double reach = v * (v / a + a / axis->max_jerk_mm_s3);

    return maths_min(reach, TRAVEL_PART * (axis->travel_max_mm - axis->travel_min_mm));
}

/*
 * Ways evenly over the logarithm of their length, to and fro about the middle; rests of any length.
 * Returns its lines.
 */
static uint32_t write_axis(FILE *stream, struct run *run, const struct machine_setup *setup,
                           unsigned i)
{
    const struct machine_axis *axis = &setup->machine.axis[i];
    const double middle_mm = (axis->travel_min_mm + axis->travel_max_mm) / 2;
    const double longest = longest_mm(axis);
    double at_mm = middle_mm;

    (void)fprintf(stream, "G0 %c%.6f\nG4 P0.5\n", AXIS_LETTERS[i], middle_mm);
    for (unsigned k = 0; k < MOVES; k++) {
        const double way_mm = longest * pow(RATIO, draw(run));

        at_mm += at_mm > middle_mm ? -way_mm : way_mm;
        (void)fprintf(stream, "G1 %c%.6f\nG4 P%.3f\n", AXIS_LETTERS[i], at_mm,
                      REST_MAX_S * draw(run));
    }
    return 2 + 2 * MOVES;
}

static void write_program(void *context, const struct machine_setup *setup, FILE *program)
{
    struct run *run = context;
    uint32_t line = 2;

    (void)fputs("G21 G17 G40 G49 G90 G94 G61 F999999\n", program);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        run->first[i] = line;
        if ((run->axes & 1U << i) != 0)
            line += write_axis(program, run, setup, i);
    }
    (void)fputs("M2\n", program);
}

/* -- the run -- */

/* The axis that is moved on a line; AXIS_LINEAR_COUNT: none. */
static unsigned axis_of(const struct run *run, uint32_t line)
{
    unsigned found = AXIS_LINEAR_COUNT;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((run->axes & 1U << i) != 0 && line >= run->first[i])
            found = i;
    }
    return found;
}

/*
 * The accelerometer says what the tool does about the cycle before: x[k + 1] - 2 x[k] + x[k - 1].
 */
static void see(void *context, const struct machine_setup *setup, struct simulation *s,
                const struct cycle_record *record)
{
    struct run *run = context;
    const double cycle_s = run->record[0].cycle_s;
    const struct point *tool = simulation_get_tool(s);
    const unsigned axis = axis_of(run, record->line);
    struct point at;

    if (axis == AXIS_LINEAR_COUNT)
        return;
    drive_network_get_axes(&s->network, &setup->machine, &at);
    const double foot_mm = at.at[axis];
    const double tool_mm = tool != NULL ? tool->at[axis] : foot_mm;

    run->seen = axis == run->axis ? run->seen + 1 : 1;
    run->axis = axis;
    if (run->seen > 2) {
        const double change_mm = (tool_mm - run->tool_mm[1]) - (run->tool_mm[1] - run->tool_mm[0]);
        const double noise_mm_s2 = run->test->noise_mm_s2 * draw_normal(run);

        resonance_record_add(&run->record[axis], run->foot_mm[1],
                             change_mm / (cycle_s * cycle_s) + noise_mm_s2);
    }
    run->foot_mm[0] = run->foot_mm[1];
    run->tool_mm[0] = run->tool_mm[1];
    run->foot_mm[1] = foot_mm;
    run->tool_mm[1] = tool_mm;
}

/* What Ctrl-C asks for is looked at after each: one takes some tenths of a second. */
static enum command_status fit_axes(struct run *run)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((run->axes & 1U << i) == 0)
            continue;
        run->test->is_measured[i] =
            !run->record[i].failed && resonance_fit(&run->record[i], &run->test->fit[i]);
        if (!run->test->is_measured[i]) {
            message_command_error("out of memory");
            return STATUS_ENVIRONMENT;
        }
        if (interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    return STATUS_DONE;
}

/* False after a message: an axis that is asked for cannot be measured. */
static bool choose_axes(void *context, const struct machine_setup *setup)
{
    struct run *run = context;
    const unsigned axes = run->asked_for;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool can_be =
            i < AXIS_LINEAR_COUNT && machine_axis_is_on_can(&setup->machine.axis[i]);

        if (!can_be && (axes & 1U << i) != 0) {
            message_command_error("axis %c is no linear axis with a drive on CAN", AXIS_LETTERS[i]);
            return false;
        }
        if (can_be && (axes == 0 || (axes & 1U << i) != 0))
            run->axes |= 1U << i;
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        run->record[i].cycle_s = machine_cycle_s(&setup->machine);
    if (run->axes == 0)
        message_command_error("there is no linear axis with a drive on CAN");
    return run->axes != 0;
}

enum command_status resonance_test_run(struct resonance_test *test, unsigned axes,
                                       const struct options *options)
{
    struct run run = {.test = test, .asked_for = axes, .state = test->seed != 0 ? test->seed : 1};
    const struct study study = {.program = NAME,
                                .context = &run,
                                .prepare = choose_axes,
                                .write = write_program,
                                .see = see};
    enum command_status status = study_run(&study, options);

    if (status == STATUS_DONE)
        status = fit_axes(&run);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        resonance_record_free(&run.record[i]);
    return status;
}

#define _GNU_SOURCE

#include "studies/resonance_test.h"

#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "session/session.h"
#include "simulation/simulation.h"

#include <math.h>
#include <stdlib.h>

/* Cycles between two looks at Ctrl-C. */
#define LOOK_CYCLES 4096

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
    struct session session;
    unsigned axes;  /* bits */
    uint32_t state; /* of random numbers */
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

/* Ways evenly over the logarithm of their length, to and fro about the middle; rests of any length. Returns its lines. */
static uint32_t write_axis(FILE *stream, struct run *run, unsigned i)
{
    const struct machine_axis *axis = &run->session.setup.machine.axis[i];
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

static char *write_program(struct run *run, size_t *length)
{
    char *text = NULL;
    FILE *stream = open_memstream(&text, length);
    uint32_t line = 2;

    if (stream == NULL)
        return NULL;
    (void)fputs("G21 G17 G40 G49 G90 G94 G61 F999999\n", stream);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        run->first[i] = line;
        if ((run->axes & 1U << i) != 0)
            line += write_axis(stream, run, i);
    }
    (void)fputs("M2\n", stream);
    return fclose(stream) == 0 ? text : NULL;
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

static double foot_of(const struct run *run, const struct simulation *s, unsigned axis)
{
    unsigned drive = 0;

    for (unsigned i = 0; i < axis; i++)
        drive += machine_axis_is_on_can(&run->session.setup.machine.axis[i]);
    return virtual_drive_get_position_mm(&s->field.drives.drive[drive]);
}

/* The accelerometer says what the tool does about the cycle before: x[k + 1] - 2 x[k] + x[k - 1]. */
static void add(struct run *run, const struct simulation *s, const struct cycle_record *record)
{
    const double cycle_s = run->record[0].cycle_s;
    const struct point *tool = simulation_get_tool(s);
    const unsigned axis = axis_of(run, record->line);

    if (axis == AXIS_LINEAR_COUNT)
        return;
    const double foot_mm = foot_of(run, s, axis);
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

static enum command_status follow(struct run *run, struct simulation *s)
{
    while (controller_get_state(&s->controller) < CONTROLLER_COMPLETED) {
        const struct cycle_record *record;

        if (!simulation_step(s))
            return STATUS_ENVIRONMENT;
        record = controller_get_record(&s->controller);
        if (record != NULL)
            add(run, s, record);
        if (s->cycles % LOOK_CYCLES == 0 && interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    if (controller_get_state(&s->controller) == CONTROLLER_COMPLETED)
        return STATUS_DONE;
    message_program_error(&run->session.program, controller_get_fault(&s->controller));
    return STATUS_FAILED;
}

static bool fit_axes(struct run *run)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if ((run->axes & 1U << i) == 0)
            continue;
        run->test->is_measured[i] =
            !run->record[i].failed && resonance_fit(&run->record[i], &run->test->fit[i]);
        if (!run->test->is_measured[i]) {
            message_command_error("out of memory");
            return false;
        }
    }
    return true;
}

static enum command_status run_program(struct run *run)
{
    struct session_totals totals;
    struct simulation *s = NULL;
    enum command_status status = session_check(&run->session, 1, &totals);

    if (status == STATUS_DONE)
        status = simulation_open(&run->session, &s);
    if (status == STATUS_DONE)
        status = follow(run, s);
    simulation_close(s);
    return status == STATUS_DONE && !fit_axes(run) ? STATUS_ENVIRONMENT : status;
}

/* False after a message: an axis that is asked for cannot be measured. */
static bool choose_axes(struct run *run, unsigned axes)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool can_be =
            i < AXIS_LINEAR_COUNT && machine_axis_is_on_can(&run->session.setup.machine.axis[i]);

        if (!can_be && (axes & 1U << i) != 0) {
            message_command_error("axis %c is no linear axis with a drive on CAN", AXIS_LETTERS[i]);
            return false;
        }
        if (can_be && (axes == 0 || (axes & 1U << i) != 0))
            run->axes |= 1U << i;
    }
    if (run->axes == 0)
        message_command_error("there is no linear axis with a drive on CAN");
    return run->axes != 0;
}

static enum command_status open_program(struct run *run, const struct options *options)
{
    enum command_status status;
    size_t length = 0;
    char *text = write_program(run, &length);

    if (text == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        run->record[i].cycle_s = 1e-6 * (double)run->session.setup.machine.cycle_us;
    session_close(&run->session);
    status = session_open_text(&run->session, options, NAME, text, length);
    if (status == STATUS_DONE)
        status = run_program(run);
    free(text);
    return status;
}

enum command_status resonance_test_run(struct resonance_test *test, unsigned axes,
                                       const struct options *options)
{
    struct run *run = calloc(1, sizeof *run);
    enum command_status status;

    if (run == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    run->test = test;
    run->state = test->seed != 0 ? test->seed : 1;
    status = session_open_machine(&run->session, options);
    if (status == STATUS_DONE)
        status = choose_axes(run, axes) ? open_program(run, options) : STATUS_INPUT;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        resonance_record_free(&run->record[i]);
    session_close(&run->session);
    free(run);
    return status;
}

#include "studies/circle_test.h"

#include "base/maths.h"
#include "cli/message.h"
#include "studies/study.h"

/* So the program is called in messages. */
#define NAME "circle.ngc"

/* Lines of the program with the circles. */
#define LINE_CCW 4
#define LINE_CW  6

/*
 * Turns of a circle: the feed is reached in the first, the second is measured, it ends in the
 * third.
 */
#define TURNS    3
#define MEASURED 1

struct run {
    struct circle_test *test;
    enum axis axis[2];
    uint32_t line;     /* of the last setpoint */
    double turned_rad; /* on this line, by the setpoints */
    double angle_rad;  /* of the last one */
};

/*
 * Both circles from where the first axis is farthest; rests, so that a correction has faded in and
 * the drives have settled.
 */
static void write_program(void *context, const struct machine_setup *setup, FILE *program)
{
    static const char *const planes[] = {"G17", "G18", "G19"};
    const struct run *run = context;
    const struct circle_test *t = run->test;
    const char first = AXIS_LETTERS[run->axis[0]], second = AXIS_LETTERS[run->axis[1]];
    const char centre = (char)('I' + (int)run->axis[0]);

    (void)setup;
    (void)fprintf(program, "G21 %s G40 G49 G90 G91.1 G94 G61\n", planes[t->plane]);
    (void)fprintf(program, "G0 %c%.9f %c%.9f\nG4 P3\n", first, t->centre_mm[0] + t->radius_mm,
                  second, t->centre_mm[1]);
    (void)fprintf(program, "G3 F%.9f %c%.9f P%d\nG4 P1\n", t->feed_mm_min, centre, -t->radius_mm,
                  TURNS);
    (void)fprintf(program, "G2 %c%.9f P%d\nM2\n", centre, -t->radius_mm, TURNS);
}

/* Where the tool is, or without errors of the machine what the drives move. */
static struct point true_point(const struct machine_setup *setup, const struct simulation *s)
{
    const struct point *tool = simulation_get_tool(s);
    struct point at;

    if (tool != NULL)
        return *tool;
    drive_network_get_axes(&s->network, &setup->machine, &at);
    return at;
}

/* The smaller angle from the last setpoint to this one, whichever way. */
static double turned_since(struct run *run, const double from_centre_mm[2])
{
    const double angle = takt_maths_atan2(from_centre_mm[1], from_centre_mm[0]);
    const double turned = (angle - run->angle_rad) / MATHS_TWO_PI;

    run->angle_rad = angle;
    return MATHS_TWO_PI * maths_abs(turned - takt_maths_round(turned));
}

static void see(void *context, const struct machine_setup *setup, struct simulation *s,
                const struct cycle_record *record)
{
    struct run *run = context;
    struct circle_test *t = run->test;
    const struct point at = true_point(setup, s);
    double wanted[2], there[2], turned;

    for (unsigned i = 0; i < 2; i++) {
        wanted[i] = record->cmd.at[run->axis[i]] - t->centre_mm[i];
        there[i] = at.at[run->axis[i]] - t->centre_mm[i];
    }
    turned = turned_since(run, wanted);
    run->turned_rad = record->line == run->line ? run->turned_rad + turned : 0;
    run->line = record->line;
    turned = run->turned_rad / MATHS_TWO_PI;
    if ((record->line == LINE_CCW || record->line == LINE_CW) && turned >= MEASURED &&
        turned < MEASURED + 1) {
        t->reached_mm_min = maths_max(t->reached_mm_min, 60 * record->feed_mm_s);
        circle_turn_add(&t->turn[record->line == LINE_CCW ? CIRCLE_CCW : CIRCLE_CW], there);
    }
}

/* False after a message: the machine has no such plane. */
static bool set_centre(void *context, const struct machine_setup *setup)
{
    struct run *run = context;
    struct circle_test *t = run->test;

    for (unsigned i = 0; i < 2; i++) {
        const struct machine_axis *axis = &setup->machine.axis[run->axis[i]];

        if (!axis->present) {
            message_command_error("the machine has no axis %c", AXIS_LETTERS[run->axis[i]]);
            return false;
        }
        if (!t->has_centre)
            t->centre_mm[i] = (axis->travel_min_mm + axis->travel_max_mm) / 2;
    }
    return true;
}

enum command_status circle_test_run(struct circle_test *test, const struct options *options)
{
    struct run run = {.test = test};
    const struct study study = {.program = NAME,
                                .context = &run,
                                .prepare = set_centre,
                                .write = write_program,
                                .see = see};
    enum command_status status;

    takt_plane_axes(test->plane, &run.axis[0], &run.axis[1]);
    for (unsigned way = 0; way < CIRCLE_WAYS; way++)
        test->turn[way].radius_mm = test->radius_mm;
    status = study_run(&study, options);
    if (status == STATUS_DONE && (test->turn[CIRCLE_CCW].failed || test->turn[CIRCLE_CW].failed)) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    return status;
}

/*
 * Planner and motion together, on moves of linear and rotary axes in any proportion: from nothing
 * of the one to nothing of the other. Whatever the machine and the program, setpoints keep every
 * axis's velocity, acceleration and jerk by differences, every landed end is hit, and the program
 * ends in the time that its feeds and the limits explain. So they do whatever the operator does:
 * overrides, holds, single block, stops and resets in any cycle.
 *
 *     test_rotary_moves NUMBER FIRST        NUMBER programs, from this seed on, of each test
 *
 * Machines and programs are drawn by dimensionless numbers on a log scale.
 */
#include "geometry/curve.h"
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_schedule.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define MOVES_MAX 12

/* A double is off by half of this part of it at most. */
#define EPSILON 2.220446049250313e-16

/* A rotary axis's longest way: 3600 degrees. */
#define TURNS_RAD 62.83185307179586

static unsigned programs = 400;
static unsigned first_seed = 1;

struct run {
    struct chain draw;
    struct plan_limits limits;
    struct motion_operator asked;
    bool changes;  /* of override, and holds */
    bool operated; /* by hands */
    struct hands hands;
    uint32_t look_ahead;
    unsigned moves;
    struct move move[MOVES_MAX];
    double least_s; /* by the programmed feeds */
    double most_s;  /* each move by itself, with what arcs and junctions leave of the limits */
    struct point end;
};

/* The largest ratios to the limits, but for the rounding of setpoints. */
struct seen {
    double velocity, acceleration, jerk;
    bool missed;        /* a landed end */
    struct point at[4]; /* newest first */
};

static struct path path;
static struct motion motion;
static struct run run;
static struct seen seen;

void setUp(void)
{
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    return chain_between(&run.draw, low, high);
}

static double decades(double from, double to)
{
    return chain_decades(&run.draw, from, to);
}

static bool chance(double part)
{
    return between(0.0, 1.0) < part;
}

/* -- machines -- */

/*
 * Limits of one axis: velocity, the time in which it is reached at full acceleration, and that in
 * which full acceleration is reached, at most what a ramp profile's longest box allows.
 */
static void draw_axis(unsigned axis, double unit)
{
    struct plan_limits *l = &run.limits;
    const double velocity = unit * decades(-1.0, 1.0);
    const double ramp_s = decades(-2.0, 0.0);
    const double rounding_s = decades(-2.5, 0.0);

    l->axes |= 1U << axis;
    l->velocity_mm_s[axis] = velocity;
    l->acceleration_mm_s2[axis] = velocity / ramp_s;
    l->jerk_mm_s3[axis] = velocity / ramp_s / rounding_s;
}

static void draw_machine(void)
{
    static const enum ramp_profile profiles[] = {RAMP_PROFILE_JERK, RAMP_PROFILE_JERK,
                                                 RAMP_PROFILE_JERK, RAMP_PROFILE_SMOOTH,
                                                 RAMP_PROFILE_GENTLE};
    const unsigned rotary = (unsigned)between(0.0, 4.0);
    struct plan_limits *l = &run.limits;

    memset(l, 0, sizeof(*l));
    l->cycle_s = 0.25e-3 * takt_maths_power(2.0, takt_maths_floor(between(0.0, 5.0)));
    l->chord_error_max_mm = decades(-3.0, 0.0);
    l->profile = profiles[(unsigned)between(0.0, 5.0)];
    l->landing = chance(0.2) ? LANDING_BLOCK : LANDING_SPAN;
    for (unsigned axis = 0; axis < AXIS_LINEAR_COUNT + rotary; axis++) {
        draw_axis(axis, axis < AXIS_LINEAR_COUNT ? 100.0 : MATHS_PI);
    }
}

/* One is left at least. */
static void drop_axes(void)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const unsigned others = run.limits.axes & ~(1U << i);

        run.limits.axes = others != 0 && chance(0.25) ? others : run.limits.axes;
    }
}

/* -- programs -- */

static bool turns(unsigned axis)
{
    return axis >= AXIS_LINEAR_COUNT;
}

static bool has_axis(unsigned axis)
{
    return (run.limits.axes & 1U << axis) != 0;
}

/* A line: each kind of axes from nothing to the longest way. */
static void draw_line(struct move *m, const struct point *from)
{
    const double linear_mm = chance(0.2) ? 0.0 : decades(-9.0, 2.0);
    const double rotary_rad = chance(0.2) ? 0.0 : TURNS_RAD * decades(-9.0, 0.0);

    m->end = *from;
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        if (has_axis(axis) && !chance(0.3)) {
            m->end.at[axis] += between(-1.0, 1.0) * (turns(axis) ? rotary_rad : linear_mm);
        }
    }
}

/* The way of the line before goes on, turned by little or nothing. */
static void go_on(struct move *m, const struct point *before, const struct point *from)
{
    const double factor = decades(-2.0, 0.5);
    const double turned = chance(0.5) ? 0.0 : decades(-7.0, -1.0);

    m->end = *from;
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        const double way = from->at[axis] - before->at[axis];

        m->end.at[axis] += factor * way * (1.0 + turned * between(-1.0, 1.0));
    }
}

/* An arc or helix, of the same or of two radii, while rotary axes turn. */
static void draw_arc(struct move *m, const struct point *from)
{
    const double radius = decades(-3.0, 1.7);
    const double heading = between(0.0, MATHS_TWO_PI);
    const double sweep = maths_min(6.2, decades(-2.0, 0.8));
    const double off_circle = chance(0.5) ? 1.0 : between(0.999, 1.001);
    const double way = chance(0.5) ? sweep : -sweep;

    draw_line(m, from);
    m->kind = way < 0 ? MOVE_ARC_CW : MOVE_ARC_CCW;
    m->centre_mm[0] = from->at[AXIS_X] - radius * takt_maths_cos(heading);
    m->centre_mm[1] = from->at[AXIS_Y] - radius * takt_maths_sin(heading);
    m->end.at[AXIS_X] = m->centre_mm[0] + radius * off_circle * takt_maths_cos(heading + way);
    m->end.at[AXIS_Y] = m->centre_mm[1] + radius * off_circle * takt_maths_sin(heading + way);
    if (chance(0.5)) {
        m->end.at[AXIS_Z] = from->at[AXIS_Z];
    }
}

/* What a program's test has time for. */
static double long_enough(double length, double feed)
{
    return maths_max(feed, length / 20.0);
}

/* F in mm/min or deg/min from 0.1 to a rapid's, or 1/min. */
static void draw_feed(struct move *m, const struct curve *c)
{
    const double f_min = decades(-1.0, 5.0);
    const double unit = c->rotary ? MATHS_PI / 180.0 : 1.0;

    if (m->kind == MOVE_FEED && chance(0.2)) {
        m->kind = MOVE_RAPID;
    } else if (chance(0.3)) {
        m->feed_mm_s = c->length_mm / decades(-2.0, 1.0);
    } else {
        m->feed_mm_s = long_enough(c->length_mm, unit * f_min / 60.0);
    }
}

/*
 * Least time of a move by its feed. Braking goes in whole cycles: what the axes can brake from
 * within a cycle may be come to late, by a cycle2 / 8, and the last of a move is gone in one cycle.
 */
static double least_time(const struct move *m, const struct curve *c)
{
    const struct plan_limits *l = &run.limits;
    double a = MATHS_INFINITY;
    struct curve_bounds b;

    takt_curve_bound(c, &b);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (b.first[i] > 0.0) {
            a = maths_min(a, l->acceleration_mm_s2[i] / b.first[i]);
        }
    }
    const double slack_mm = 0.25 * a * l->cycle_s * l->cycle_s;

    return m->kind == MOVE_RAPID ? 0.0 : maths_max(0.0, c->length_mm - slack_mm) / m->feed_mm_s;
}

/*
 * Time of a move from rest to rest, L/v + v/a + a/j, a by the longest box, in the parts that arcs
 * and junctions leave; twice the ramps, and some windows of cycles, for feeds kept before a change.
 */
static double most_time(const struct move *m, const struct curve *c)
{
    const struct plan_limits *l = &run.limits;
    const bool curved = c->kind == CURVE_ARC;
    double v = m->kind == MOVE_RAPID ? MATHS_INFINITY : m->feed_mm_s;
    double a = MATHS_INFINITY;
    double j = MATHS_INFINITY;
    struct curve_bounds b;

    takt_curve_bound(c, &b);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has_axis(i) && b.first[i] > 0.0) {
            v = maths_min(v, l->velocity_mm_s[i] / b.first[i]);
            a = maths_min(a, (curved ? 0.1 : 0.9) * l->acceleration_mm_s2[i] / b.first[i]);
            j = maths_min(j, (curved ? 0.1 : 0.5) * l->jerk_mm_s3[i] / b.first[i]);
        }
        if (has_axis(i) && b.second[i] > 0.0) {
            v = maths_min(v, maths_sqrt(0.1 * l->acceleration_mm_s2[i] / b.second[i]));
            v = maths_min(v, takt_maths_cbrt(0.05 * l->jerk_mm_s3[i] / b.third[i]));
        }
    }
    if (curved && b.radius_min_mm > l->chord_error_max_mm) {
        v = maths_min(v, maths_sqrt(b.radius_min_mm * l->chord_error_max_mm) / l->cycle_s);
    }
    a = maths_min(a, j * l->cycle_s * (double)takt_ramp_profile_cycles_max(l->profile));
    return c->length_mm / v + 2.0 * v / a + 2.0 * a / j + 300.0 * l->cycle_s;
}

static void draw_move(struct move *m, const struct point *before, const struct point *from)
{
    memset(m, 0, sizeof(*m));
    m->kind = MOVE_FEED;
    m->path = chance(0.1) ? PATH_EXACT_STOP : PATH_EXACT;
    m->overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m->turns = 1;
    if (chance(0.2) && has_axis(AXIS_X) && has_axis(AXIS_Y)) {
        draw_arc(m, from);
    } else if (chance(0.4)) {
        go_on(m, before, from);
    } else {
        draw_line(m, from);
    }
}

static void draw_program(void)
{
    struct point before = {{0.0}};
    struct point at = {{0.0}};
    const unsigned moves = 1 + (unsigned)(between(0.0, 1.0) * between(0.0, MOVES_MAX));

    while (run.moves < moves) {
        struct move *m = &run.move[run.moves++];
        struct curve c;

        draw_move(m, &before, &at);
        if (takt_move_curve(m, &at, &c)) {
            draw_feed(m, &c);
            run.least_s += least_time(m, &c);
            run.most_s += most_time(m, &c);
            before = at;
            at = m->end;
        } else {
            m->feed_mm_s = 1.0;
        }
    }
    run.end = at;
}

static void draw(unsigned number, bool operated)
{
    memset(&run, 0, sizeof(run));
    run.operated = operated;
    run.draw.seed = (uint64_t)number * UINT64_C(0x9e3779b97f4a7c15);
    run.asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    (void)between(0.0, 1.0);
    draw_machine();
    if (operated) {
        drop_axes();
    }
    draw_program();
    run.changes = chance(0.3);
    run.look_ahead = chance(0.3) ? 8 : 256;
    if (operated) {
        hands_begin(&run.hands, number);
        run.look_ahead = (uint32_t)decades(0.0, 2.41);
    }
}

/* -- the verifier -- */

/* What is more than so much rounding of setpoints, as a part of a limit. */
static double part_of(double difference, double rounding, double limit)
{
    return maths_max(0.0, maths_abs(difference) - rounding) / limit;
}

static void verify_axis(unsigned i)
{
    const struct plan_limits *l = &run.limits;
    const double t = l->cycle_s;
    const struct point *p = seen.at;
    const double ulp = EPSILON * (maths_abs(p[0].at[i]) + maths_abs(p[3].at[i]));
    const double v = p[0].at[i] - p[1].at[i];
    const double a = p[0].at[i] - 2.0 * p[1].at[i] + p[2].at[i];
    const double j = p[0].at[i] - 3.0 * p[1].at[i] + 3.0 * p[2].at[i] - p[3].at[i];

    seen.velocity = maths_max(seen.velocity, part_of(v, 2.0 * ulp, l->velocity_mm_s[i] * t));
    seen.acceleration =
        maths_max(seen.acceleration, part_of(a, 4.0 * ulp, l->acceleration_mm_s2[i] * t * t));
    seen.jerk = maths_max(seen.jerk, part_of(j, 8.0 * ulp, l->jerk_mm_s3[i] * t * t * t));
}

static void verifier(const struct cycle_record *record)
{
    memmove(seen.at + 1, seen.at, 3 * sizeof(seen.at[0]));
    seen.at[0] = record->cmd;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (has_axis(i)) {
            verify_axis(i);
        }
    }
    seen.missed = seen.missed || (record->landed &&
                                  !point_is_same(&run.move[record->block - 1].end, &record->cmd));
}

/* -- a run -- */

/* After a reset nothing but the end comes. */
static void push(unsigned *pushed)
{
    const struct move end = {.kind = MOVE_END};

    if (*pushed < run.moves && !run.hands.reset) {
        takt_path_push(&path, &run.move[(*pushed)++]);
        return;
    }
    takt_path_push(&path, &end);
    takt_path_finish(&path);
}

static void fill(unsigned *pushed)
{
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    while (!path.finished && !motion.ending && takt_path_has_room(&path) &&
           takt_motion_ahead(&motion) < run.look_ahead) {
        push(pushed);
    }
    takt_motion_build(&motion);
}

static void change(void)
{
    if (run.operated) {
        hands_follow(&run.hands, &motion);
        run.asked = run.hands.schedule.now;
    } else if (run.changes && chance(0.01)) {
        run.asked.feed_ratio = chance(0.5) ? 1.0 : between(0.1, 1.2);
        run.asked.rapid_ratio = maths_min(1.0, run.asked.feed_ratio);
        run.asked.hold = chance(0.2);
    }
}

static enum motion_result run_program(void)
{
    const double factor = run.operated ? 200.0 : run.changes ? 20.0 : 1.5;
    const double most_cycles =
        factor * (run.most_s / run.limits.cycle_s + (run.operated ? 1000.0 : 0.0)) + 1000.0;
    struct cycle_record record = {0};
    enum motion_result result = MOTION_CYCLE;
    unsigned pushed = 0;

    memset(&seen, 0, sizeof(seen));
    takt_path_init(&path, &run.limits, &record.cmd);
    takt_motion_init(&motion, &path, &record.cmd, false);
    while (result == MOTION_CYCLE && (double)motion.cycles <= most_cycles) {
        fill(&pushed);
        change();
        result = takt_motion_cycle(&motion, &run.asked, &record);
        if (result == MOTION_CYCLE) {
            verifier(&record);
            hands_hold_at_end(&run.hands, &motion, &record);
        }
    }
    return result;
}

/* The name of what a program breaks; NULL: nothing. */
static const char *broken(enum motion_result result)
{
    const double time_s = (double)motion.cycles * run.limits.cycle_s;

    if (result != MOTION_DONE && !(run.hands.reset && result == MOTION_EMPTY)) {
        return "does not end";
    }
    if (seen.velocity > 1.0001) {
        return "velocity";
    }
    if (seen.acceleration > 1.0001) {
        return "acceleration";
    }
    if (seen.jerk > 1.001) {
        return "jerk";
    }
    if (seen.missed || !(run.hands.reset || point_is_same(&run.end, &seen.at[0]))) {
        return "an end";
    }
    return !run.changes && !run.operated && time_s < run.least_s * (1.0 - 1e-3) ? "feed" : NULL;
}

static bool check(unsigned number, bool operated)
{
    draw(number, operated);
    const enum motion_result result = run_program();
    const char *what = broken(result);

    if (what != NULL) {
        printf(
            "program %u%s: %s: v %.6f a %.6f j %.6f of the limits; %.4f s, by feeds %.4f, at most "
            "%.4f\n",
            number, operated ? " operated" : "", what, seen.velocity, seen.acceleration, seen.jerk,
            (double)motion.cycles * run.limits.cycle_s, run.least_s, run.most_s);
    }
    return what == NULL;
}

static void check_programs(bool operated)
{
    unsigned failed = 0;

    for (unsigned i = 0; i < programs; i++) {
        failed += check(first_seed + i, operated) ? 0U : 1U;
    }
    printf("%u programs%s, %u failed\n", programs, operated ? " operated" : "", failed);
    TEST_ASSERT_EQUAL_UINT(0, failed);
}

static void test_moves_of_linear_and_rotary_axes_in_any_proportion_keep_the_limits(void)
{
    check_programs(false);
}

static void test_whatever_the_operator_does_they_keep_them(void)
{
    check_programs(true);
}

/* Found by longer runs of this test. */
static void test_rare_programs_keep_the_limits(void)
{
    TEST_ASSERT_TRUE(
        check(314501, false)); /* units that suit fast linear axes, for slow rotary ones */
    TEST_ASSERT_TRUE(check(53610, false)); /* the end of a stop was on it units before it was */
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_moves_of_linear_and_rotary_axes_in_any_proportion_keep_the_limits);
    RUN_TEST(test_whatever_the_operator_does_they_keep_them);
    RUN_TEST(test_rare_programs_keep_the_limits);
    return UNITY_END();
}

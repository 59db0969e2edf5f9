/*
 * Planner and motion on splines: whatever the order, the control points and weights, the size and
 * the feed, setpoints keep the axes' limits by differences, the end is hit, and where no limit
 * binds the feed is even.
 *
 * test_splines NUMBER runs this many seeds on each machine instead of SEEDS.
 */
#include "geometry/nurbs.h"
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define CYCLE_S    1e-3
#define SEEDS      25
#define POINTS_MAX 12

static unsigned seeds = SEEDS;
static struct path path;
static struct motion motion;
static struct chain_verifier seen;

/* What a run is about. */
struct task {
    struct plan_limits limits;
    unsigned order, points;
    double point[POINTS_MAX][2], weight[POINTS_MAX];
    enum plane plane;
    double feed_mm_s, tolerance_mm;
};

/* Pieces still to come, and where they lead. */
static struct {
    struct nurbs nurbs;
    unsigned knots;
    struct point at;
} ahead;

void setUp(void)
{
}

void tearDown(void)
{
}

/*
 * Limits that differ by decades, from axis to axis and from machine to machine, dimensions of the
 * curve beside them.
 */
static struct task random_task(uint64_t task_seed)
{
    struct chain c = {.seed = task_seed};
    const double size_mm = chain_decades(&c, -1.0, 2.5);
    const double v = size_mm * chain_decades(&c, -0.5, 1.0);
    const double a = v * chain_decades(&c, 0.5, 2.0);
    const double j = a * chain_decades(&c, 0.5, 2.0);
    struct task t = {.limits = {.axes = 7, .cycle_s = CYCLE_S}};

    for (unsigned i = 0; i < CHAIN_AXES; i++) {
        t.limits.velocity_mm_s[i] = v * chain_decades(&c, -0.3, 0.3);
        t.limits.acceleration_mm_s2[i] = a * chain_decades(&c, -0.3, 0.3);
        t.limits.jerk_mm_s3[i] = j * chain_decades(&c, -0.3, 0.3);
    }
    t.limits.chord_error_max_mm = size_mm * chain_decades(&c, -5.0, -3.0);
    t.order = 3 + (unsigned)chain_between(&c, 0, 3.99);
    t.points = t.order + (unsigned)chain_between(&c, 0, 5.99);
    for (unsigned i = 0; i < t.points; i++) {
        t.point[i][0] = chain_between(&c, -size_mm, size_mm);
        t.point[i][1] = chain_between(&c, -size_mm, size_mm);
        t.weight[i] = chain_decades(&c, -0.5, 0.5);
    }
    t.plane = (enum plane)chain_between(&c, 0, 2.99);
    t.feed_mm_s = chain_between(&c, 0, 1) < 0.3 ? 10.0 * v : v * chain_decades(&c, -1.0, 0.0);
    return t;
}

static void add_knot(const struct task *t)
{
    const unsigned i = ahead.knots++;
    const unsigned last = t->points - 1;

    if (i < t->points) {
        takt_nurbs_add_point(&ahead.nurbs, t->point[i], t->weight[i]);
    }
    takt_nurbs_add_knot(&ahead.nurbs, i < t->order ? 0.0
                                      : i <= last  ? i - t->order + 1.0
                                                   : last - t->order + 2.0);
}

static bool next_piece(const struct task *t, struct nurbs_piece *piece)
{
    enum nurbs_result result;

    while ((result = takt_nurbs_next(&ahead.nurbs, NURBS_ERROR_MM, piece)) == NURBS_NONE &&
           ahead.knots < t->points + t->order) {
        add_knot(t);
    }
    TEST_ASSERT_TRUE(result != NURBS_CUSP);
    return result == NURBS_PIECE;
}

static void push_next(const struct task *t)
{
    struct move m = {.kind = MOVE_SPLINE,
                     .path = t->tolerance_mm > 0.0 ? PATH_BLEND : PATH_EXACT,
                     .tolerance_mm = t->tolerance_mm,
                     .plane = t->plane,
                     .feed_mm_s = t->feed_mm_s,
                     .overrides = OVERRIDE_FEED | OVERRIDE_HOLD};
    struct nurbs_piece piece;
    enum axis axis[2];

    if (!next_piece(t, &piece)) {
        takt_path_push(&path, &(struct move){.kind = MOVE_END});
        takt_path_finish(&path);
        return;
    }
    takt_plane_axes(t->plane, &axis[0], &axis[1]);
    for (unsigned i = 0; i < 2; i++) {
        ahead.at.at[axis[i]] = piece.end_mm[i];
        m.heading_rad[i] = piece.course.heading_rad[i];
        m.curvature_1_mm[i] = piece.course.curvature_1_mm[i];
    }
    m.spline_mm = piece.course.length_mm;
    m.end = ahead.at;
    takt_path_push(&path, &m);
}

static void begin(const struct task *t)
{
    enum axis axis[2];

    memset(&seen, 0, sizeof(seen));
    memset(&ahead, 0, sizeof(ahead));
    takt_nurbs_open(&ahead.nurbs, t->order);
    takt_plane_axes(t->plane, &axis[0], &axis[1]);
    for (unsigned i = 0; i < 2; i++) {
        ahead.at.at[axis[i]] = t->point[0][i];
        for (unsigned k = 0; k < 4; k++) {
            seen.history[axis[i]][k] = t->point[0][i];
        }
    }
    takt_path_init(&path, &t->limits, &ahead.at);
    takt_motion_init(&motion, &path, &ahead.at, false);
}

/* Runs it with a feed override that changes all the time, or with none. */
static void run(const struct task *t, uint32_t look_ahead, bool overrides)
{
    struct motion_operator person = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    enum motion_result result;
    unsigned cycle = 0;

    begin(t);
    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            while (!path.finished && takt_path_has_room(&path) &&
                   takt_motion_ahead(&motion) < look_ahead) {
                push_next(t);
            }
            takt_motion_build(&motion);
        }
        if (overrides && ++cycle % 40 == 0) {
            person.feed_ratio = cycle % 80 == 0 ? 1.2 : 0.3;
        }
        result = takt_motion_cycle(&motion, &person, &record);
        if (result == MOTION_CYCLE) {
            chain_verifier_setpoint(&seen, &t->limits, &record.cmd);
        }
    } while (result == MOTION_CYCLE);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    TEST_ASSERT_EQUAL_MEMORY(&ahead.at, &record.cmd, sizeof(ahead.at));
}

static void check_limits(uint32_t look_ahead, bool overrides, double tolerance_ratio)
{
    double most = 0.0;

    for (unsigned s = 1; s <= seeds; s++) {
        struct task t = random_task(s);
        char where[160];

        t.tolerance_mm = tolerance_ratio * maths_abs(t.point[0][0]);
        run(&t, look_ahead, overrides);
        (void)snprintf(where, sizeof(where), "seed %u, look-ahead %u: order %u: v %g a %g j %g", s,
                       (unsigned)look_ahead, t.order, seen.velocity, seen.acceleration, seen.jerk);
        TEST_ASSERT_TRUE_MESSAGE(seen.velocity <= 1.0001, where);
        TEST_ASSERT_TRUE_MESSAGE(seen.acceleration <= 1.0001, where);
        TEST_ASSERT_TRUE_MESSAGE(seen.jerk <= 1.001, where);
        most = maths_max(most, seen.jerk);
    }
    TEST_ASSERT_TRUE(most > 0.5);
}

static void test_random_splines_keep_the_limits(void)
{
    check_limits(256, false, 0.0);
}

static void test_small_windows_keep_the_limits(void)
{
    check_limits(2, false, 0.0);
    check_limits(9, false, 0.0);
}

static void test_overrides_keep_the_limits(void)
{
    check_limits(256, true, 0.0);
}

static void test_smoothed_splines_keep_the_limits(void)
{
    check_limits(256, false, 0.02);
}

/*
 * A curve so gentle that no limit binds: in between the ramps, every step is feed times cycle, over
 * every junction.
 */
static void test_the_feed_is_even_from_piece_to_piece(void)
{
    struct task t = {.limits = {.axes = 7, .cycle_s = CYCLE_S, .chord_error_max_mm = 1.0},
                     .order = 4,
                     .points = 6,
                     .point = {{0, 0}, {30, 40}, {60, -20}, {90, 50}, {120, 0}, {150, 30}},
                     .weight = {1, 1, 2, 1, 1, 1},
                     .feed_mm_s = 20.0};
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    struct point last;
    unsigned even = 0;

    for (unsigned i = 0; i < CHAIN_AXES; i++) {
        t.limits.velocity_mm_s[i] = 100.0;
        t.limits.acceleration_mm_s2[i] = 2000.0;
        t.limits.jerk_mm_s3[i] = 100000.0;
    }
    begin(&t);
    last = ahead.at;
    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_path_go_on(&path);
            while (!path.finished && takt_path_has_room(&path) &&
                   takt_motion_ahead(&motion) < 256) {
                push_next(&t);
            }
            takt_motion_build(&motion);
        }
        if (takt_motion_cycle(&motion, &as_programmed, &record) != MOTION_CYCLE) {
            break;
        }
        const double x = record.cmd.at[AXIS_X] - last.at[AXIS_X];
        const double y = record.cmd.at[AXIS_Y] - last.at[AXIS_Y];

        if (maths_abs(record.feed_mm_s / t.feed_mm_s - 1.0) < 1e-10 && even++ > 0) {
            TEST_ASSERT_DOUBLE_WITHIN(2e-5, 1.0, maths_sqrt(x * x + y * y) / 0.02);
        }
        last = record.cmd;
    } while (true);
    TEST_ASSERT_TRUE_MESSAGE(even > 7000, "cycles at the programmed feed");
}

int main(int argc, char **argv)
{
    read_number(argc, argv, &seeds);
    UNITY_BEGIN();
    RUN_TEST(test_random_splines_keep_the_limits);
    RUN_TEST(test_small_windows_keep_the_limits);
    RUN_TEST(test_overrides_keep_the_limits);
    RUN_TEST(test_smoothed_splines_keep_the_limits);
    RUN_TEST(test_the_feed_is_even_from_piece_to_piece);
    return UNITY_END();
}

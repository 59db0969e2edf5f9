/*
 * A control cycle that is too slow for a circle: its chord error limits the feed, and is then kept
 * by the setpoints. 4 ms and 1 um on a radius of 2 mm: (2/cycle) sqrt(2 R d - d^2) = 31.6 mm/s, far
 * below what the axes could do. So it is at corners.
 */
#include "base/maths.h"
#include "motion/motion.h"
#include "plan/path.h"

#include <string.h>
#include <unity.h>

#define RADIUS_MM 2.0
#define CHORD_MM  1e-3
#define SIDES     60

static struct path path;
static struct motion motion;

void setUp(void)
{
}

void tearDown(void)
{
}

static struct plan_limits machine(double cycle_s)
{
    struct plan_limits l;

    memset(&l, 0, sizeof(l));
    l.axes = 7;
    l.cycle_s = cycle_s;
    l.chord_error_max_mm = CHORD_MM;
    for (int i = 0; i < 3; i++) {
        l.velocity_mm_s[i] = 500.0;
        l.acceleration_mm_s2[i] = 20000.0;
        l.jerk_mm_s3[i] = 1e7;
    }
    return l;
}

/* Ten turns about the origin, and the end of the program. */
static void push_circle(const struct plan_limits *limits)
{
    const struct point start = {{RADIUS_MM}};
    struct move m;

    takt_path_init(&path, limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    memset(&m, 0, sizeof(m));
    m.kind = MOVE_ARC_CCW;
    m.plane = PLANE_XY;
    m.end = start;
    m.feed_mm_s = 300.0;
    m.turns = 10;
    takt_path_push(&path, &m);
    m.kind = MOVE_END;
    takt_path_push(&path, &m);
    takt_path_finish(&path);
}

/* The largest distance of a chord between two setpoints from the circle. */
static double run_circle(void)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    struct point last = {{RADIUS_MM}};
    double most = 0.0;
    enum motion_result result;

    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_motion_build(&motion);
        }
        result = takt_motion_cycle(&motion, &as_programmed, &record);
        if (result == MOTION_CYCLE) {
            const double x = 0.5 * (record.cmd.at[AXIS_X] + last.at[AXIS_X]);
            const double y = 0.5 * (record.cmd.at[AXIS_Y] + last.at[AXIS_Y]);

            most = maths_max(most, RADIUS_MM - maths_sqrt(x * x + y * y));
            last = record.cmd;
        }
    } while (result == MOTION_CYCLE && motion.cycles < 100000);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    return most;
}

static void test_a_slow_cycle_limits_the_feed_by_the_chord_error(void)
{
    const struct plan_limits slow = machine(4e-3);

    push_circle(&slow);
    const struct block *b = path_read(&path, 0);

    TEST_ASSERT_EQUAL(GOVERNOR_CHORD, b->cap);
    TEST_ASSERT_TRUE(b->feed_cap_mm_s < b->feed_program_mm_s);
    TEST_ASSERT_DOUBLE_WITHIN(1e-5,
                              500.0 * maths_sqrt(2.0 * RADIUS_MM * CHORD_MM - CHORD_MM * CHORD_MM),
                              b->feed_max_mm_s);
}

static void test_setpoints_keep_the_chord_error_and_use_it(void)
{
    const struct plan_limits slow = machine(4e-3);

    push_circle(&slow);
    const double most = run_circle();

    TEST_ASSERT_TRUE(most <= CHORD_MM * (1.0 + 1e-9));
    TEST_ASSERT_TRUE(most >= CHORD_MM * 0.99);
}

static void test_a_cycle_that_is_fast_enough_is_not_limited_by_it(void)
{
    const struct plan_limits fast = machine(1e-4);

    push_circle(&fast);
    const struct block *b = path_read(&path, 0);

    TEST_ASSERT_TRUE(b->cap != GOVERNOR_CHORD || b->feed_cap_mm_s >= b->feed_program_mm_s);
    TEST_ASSERT_TRUE(run_circle() < 0.5 * CHORD_MM);
}

/*
 * A polygon of lines of this length, each turned by so much, and the end of the program; as many
 * corners as it has sides.
 */
static void push_polygon(const struct plan_limits *limits, double side_mm, double turn_rad,
                         struct point *corner)
{
    const struct point start = {{0.0}};
    struct move m;

    takt_path_init(&path, limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = 300.0;
    for (unsigned i = 0; i < SIDES; i++) {
        m.end.at[AXIS_X] += side_mm * takt_maths_cos(turn_rad * i);
        m.end.at[AXIS_Y] += side_mm * takt_maths_sin(turn_rad * i);
        corner[i] = m.end;
        takt_path_push(&path, &m);
    }
    m.kind = MOVE_END;
    takt_path_push(&path, &m);
    takt_path_finish(&path);
}

static double distance_from_line(const struct point *p, const struct point *a,
                                 const struct point *b)
{
    const double x = b->at[AXIS_X] - a->at[AXIS_X];
    const double y = b->at[AXIS_Y] - a->at[AXIS_Y];
    const double px = p->at[AXIS_X] - a->at[AXIS_X];
    const double py = p->at[AXIS_Y] - a->at[AXIS_Y];
    const double square = x * x + y * y;
    const double f = square > 0.0 ? maths_clamp((px * x + py * y) / square, 0.0, 1.0) : 0.0;

    return maths_sqrt((px - f * x) * (px - f * x) + (py - f * y) * (py - f * y));
}

/* The largest distance of a corner from the line through the setpoints. */
static double run_polygon(const struct point *corner)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    struct point last = {{0.0}};
    double off[SIDES];
    double most = 0.0;
    enum motion_result result;

    for (unsigned i = 0; i < SIDES; i++) {
        off[i] = MATHS_INFINITY;
    }
    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_motion_build(&motion);
        }
        result = takt_motion_cycle(&motion, &as_programmed, &record);
        for (unsigned i = 0; i < SIDES && result == MOTION_CYCLE; i++) {
            off[i] = maths_min(off[i], distance_from_line(&corner[i], &last, &record.cmd));
        }
        last = record.cmd;
    } while (result == MOTION_CYCLE && motion.cycles < 100000);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    for (unsigned i = 0; i < SIDES; i++) {
        most = maths_max(most, off[i]);
    }
    return most;
}

static void test_no_corner_is_cut_by_more_than_the_chord_error(void)
{
    static const double sides_mm[] = {2.0, 0.2, 0.02, 0.002};
    struct plan_limits slow = machine(4e-3);
    struct point corner[SIDES];

    for (unsigned i = 0; i < 3; i++) {
        slow.acceleration_mm_s2[i] *= 100.0;
        slow.jerk_mm_s3[i] *= 1000.0;
    }
    for (unsigned i = 0; i < sizeof(sides_mm) / sizeof(sides_mm[0]); i++) {
        double turn_rad = 3.0;

        for (unsigned k = 0; k < 12; k++, turn_rad *= 0.5) {
            push_polygon(&slow, sides_mm[i], turn_rad, corner);
            TEST_ASSERT_TRUE(run_polygon(corner) <= CHORD_MM * (1.0 + 1e-9));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slow_cycle_limits_the_feed_by_the_chord_error);
    RUN_TEST(test_setpoints_keep_the_chord_error_and_use_it);
    RUN_TEST(test_no_corner_is_cut_by_more_than_the_chord_error);
    RUN_TEST(test_a_cycle_that_is_fast_enough_is_not_limited_by_it);
    return UNITY_END();
}

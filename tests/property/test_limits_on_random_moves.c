/*
 * Planner and motion together, on random chains of moves: whatever the moves, the emitted setpoints keep every axis's
 * velocity, acceleration and jerk, by differences, and every landed end is hit.
 *
 * Each chain is a fixed seed of a small generator; a failure names family, seed and cycle. The families are chosen for
 * what breaks planners: corners of any angle, nearly collinear blocks, blocks shorter than a cycle, zigzags, arcs into
 * arcs, helices, arcs whose two radii differ.
 */
#include "base/maths.h"
#include "motion/motion.h"
#include "plan/path.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define CYCLE_S 1e-3
#define AXES    3
#define SEEDS   25
#define MOVES   300

/* A chain that lasts longer stands still for ever. */
#define CYCLES_MAX 3000000

enum family {
    FAMILY_CORNERS,
    FAMILY_NEARLY_COLLINEAR,
    FAMILY_POLYGON,
    FAMILY_TINY,
    FAMILY_ZIGZAG,
    FAMILY_ARCS,
    FAMILY_SPIRAL_ARCS,
    FAMILY_HELICES,
    FAMILY_MIXED
};

static const struct plan_limits machines[] = {
    {7,
     {100, 100, 100},
     {1000, 1000, 1000},
     {50000, 50000, 50000},
     CYCLE_S,
     1e-3,
     LAW_JERK,
     LANDING_SPAN},
    {7,
     {100, 60, 20},
     {1000, 400, 2000},
     {50000, 8000, 200000},
     CYCLE_S,
     1e-3,
     LAW_JERK,
     LANDING_SPAN},
    {7, {500, 500, 500}, {200, 5000, 5000}, {1e6, 1e6, 1e5}, CYCLE_S, 1e-2, LAW_JERK, LANDING_SPAN},
};

static struct path path;
static struct motion motion;
static struct point at; /* end of the moves made so far */
static double heading_rad;
static uint64_t seed;

static struct {
    double history[AXES][4];             /* newest first */
    double velocity, acceleration, jerk; /* largest ratio to the limit */
    double landing_mm;
} seen;

void setUp(void)
{
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static double random_decades(double from, double to)
{
    return maths_power(10.0, random_between(from, to));
}

static struct move line_by(double length_mm, double rise_mm)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = random_between(0, 1) < 0.1 ? MOVE_RAPID : MOVE_FEED;
    m.feed_mm_s = random_between(0, 1) < 0.5 ? 100.0 : random_between(5, 105);
    m.turns = 1;
    m.end = at;
    m.end.at[AXIS_X] += length_mm * maths_cos(heading_rad);
    m.end.at[AXIS_Y] += length_mm * maths_sin(heading_rad);
    m.end.at[AXIS_Z] += rise_mm;
    return m;
}

/* An arc that leaves along the heading; its end may lie off the circle by a factor, and it may rise. */
static struct move arc_by(double off_circle, double rise_mm)
{
    const double radius = random_decades(-1, 2);
    const double sign = random_between(0, 1) < 0.5 ? -1.0 : 1.0;
    const double sweep = sign * maths_min(6.2, random_decades(-2, 0.8));
    const double angle = heading_rad - sign * MATHS_HALF_PI + sweep;
    struct move m = line_by(0.0, rise_mm);

    m.kind = sign < 0 ? MOVE_ARC_CW : MOVE_ARC_CCW;
    m.centre_mm[0] = at.at[AXIS_X] - sign * radius * maths_sin(heading_rad);
    m.centre_mm[1] = at.at[AXIS_Y] + sign * radius * maths_cos(heading_rad);
    m.end.at[AXIS_X] = m.centre_mm[0] + radius * off_circle * maths_cos(angle);
    m.end.at[AXIS_Y] = m.centre_mm[1] + radius * off_circle * maths_sin(angle);
    heading_rad += sweep;
    return m;
}

static struct move move_of(enum family family, unsigned number)
{
    double length;

    switch (family) {
    case FAMILY_CORNERS:
        heading_rad = random_between(0, MATHS_TWO_PI);
        length = random_decades(-3, 2);
        return line_by(length, random_between(-length, length));
    case FAMILY_NEARLY_COLLINEAR:
        heading_rad += random_between(-0.5, 0.5) * random_decades(-6, -1);
        return line_by(random_decades(-3, 1), 0.0);
    case FAMILY_POLYGON:
        heading_rad += 0.001745;
        return line_by(0.035, 0.0);
    case FAMILY_TINY:
        heading_rad += random_between(-0.005, 0.005);
        return line_by(random_decades(-4, -1), 0.0);
    case FAMILY_ZIGZAG:
        heading_rad += (number % 2 == 0 ? 1.0 : -1.0) * random_decades(-5, -1);
        return line_by(random_between(0.01, 0.31), 0.0);
    case FAMILY_ARCS:
        return arc_by(1.0, 0.0);
    case FAMILY_SPIRAL_ARCS:
        return arc_by(random_between(0.999, 1.001), 0.0);
    case FAMILY_HELICES:
        return arc_by(1.0, random_between(-10, 10));
    case FAMILY_MIXED:
        break;
    }
    return move_of((enum family)(random_between(0, 1) * FAMILY_MIXED), number);
}

static void push_next(enum family family, unsigned number)
{
    struct move m;

    if (number < MOVES) {
        m = move_of(family, number);
        m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
        at = m.end;
        path_push(&path, &m);
        return;
    }
    memset(&m, 0, sizeof(m));
    m.kind = MOVE_END;
    path_push(&path, &m);
    path_finish(&path);
}

static void plan(enum family family, uint32_t look_ahead, unsigned *pushed)
{
    if (motion_wanted(&motion) == NULL) {
        return;
    }
    while (!path.finished && path_has_room(&path) && motion_ahead(&motion) < look_ahead) {
        push_next(family, (*pushed)++);
    }
    motion_build(&motion);
}

static void judge_axis(const struct plan_limits *limits, int axis, double x)
{
    double *h = seen.history[axis];

    memmove(h + 1, h, 3 * sizeof(*h));
    h[0] = x;
    const double v = (h[0] - h[1]) / CYCLE_S;
    const double a = (h[0] - 2 * h[1] + h[2]) / (CYCLE_S * CYCLE_S);
    const double j = (h[0] - 3 * h[1] + 3 * h[2] - h[3]) / (CYCLE_S * CYCLE_S * CYCLE_S);

    seen.velocity = maths_max(seen.velocity, maths_abs(v) / limits->velocity_mm_s[axis]);
    seen.acceleration =
        maths_max(seen.acceleration, maths_abs(a) / limits->acceleration_mm_s2[axis]);
    seen.jerk = maths_max(seen.jerk, maths_abs(j) / limits->jerk_mm_s3[axis]);
}

static void judge(const struct plan_limits *limits, const struct cycle_record *record)
{
    for (int axis = 0; axis < AXES; axis++) {
        judge_axis(limits, axis, record->cmd.at[axis]);
        if (record->landed) {
            const double off = record->cmd.at[axis] - motion_block(&motion)->move.end.at[axis];

            seen.landing_mm = maths_max(seen.landing_mm, maths_abs(off));
        }
    }
}

static void run_chain(enum family family, uint64_t chain_seed, const struct plan_limits *limits,
                      uint32_t look_ahead)
{
    const struct motion_operator asked = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    unsigned pushed = 0;
    enum motion_result result;

    seed = chain_seed;
    heading_rad = 0.0;
    memset(&at, 0, sizeof(at));
    memset(&seen, 0, sizeof(seen));
    path_init(&path, limits, &at);
    motion_init(&motion, &path, &at, false);
    for (;;) {
        plan(family, look_ahead, &pushed);
        result = motion_cycle(&motion, &asked, &record);
        if (result != MOTION_CYCLE || motion.cycles > CYCLES_MAX) {
            break;
        }
        judge(limits, &record);
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    TEST_ASSERT_EQUAL_MEMORY(&at, &record.cmd, sizeof(at));
}

static void check_chain(enum family family, unsigned s, unsigned m, uint32_t look_ahead)
{
    char where[80];

    run_chain(family, s, &machines[m], look_ahead);
    (void)snprintf(where, sizeof(where), "family %d, seed %u, machine %u, look-ahead %u",
                   (int)family, s, m, (unsigned)look_ahead);
    TEST_ASSERT_TRUE_MESSAGE(seen.velocity <= 1.0001, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.acceleration <= 1.0001, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.jerk <= 1.001, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.landing_mm <= 1e-9, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.jerk > 0.01, where);
}

static void check_family(enum family family, uint32_t look_ahead)
{
    for (unsigned m = 0; m < sizeof(machines) / sizeof(machines[0]); m++) {
        for (unsigned s = 1; s <= SEEDS; s++) {
            check_chain(family, s, m, look_ahead);
        }
    }
}

/* Found by longer runs of this test, each for another reason. */
static void test_rare_chains_keep_the_limits(void)
{
    check_chain(FAMILY_SPIRAL_ARCS, 163, 2, 256); /* braking took the room that a landing needed */
    check_chain(FAMILY_CORNERS, 171, 1, 256); /* rest missed a joint by the rounding of its feed */
    check_chain(FAMILY_HELICES, 153, 1, 256); /* likewise, by less */
    check_chain(FAMILY_SPIRAL_ARCS, 66, 0, 256); /* a span begins with blocks of half a window */
    check_chain(FAMILY_MIXED, 25, 2, 1);         /* a joint was the end of all that was known */
    check_chain(FAMILY_NEARLY_COLLINEAR, 34, 1,
                1); /* and its continuation came too late to land on it */
}

static void test_corners_keep_the_limits(void)
{
    check_family(FAMILY_CORNERS, 256);
}

static void test_nearly_collinear_blocks_keep_the_limits(void)
{
    check_family(FAMILY_NEARLY_COLLINEAR, 256);
}

static void test_polygons_keep_the_limits(void)
{
    check_family(FAMILY_POLYGON, 256);
}

static void test_blocks_shorter_than_a_cycle_keep_the_limits(void)
{
    check_family(FAMILY_TINY, 256);
}

static void test_zigzags_keep_the_limits(void)
{
    check_family(FAMILY_ZIGZAG, 256);
}

static void test_arcs_keep_the_limits(void)
{
    check_family(FAMILY_ARCS, 256);
}

static void test_arcs_of_two_radii_keep_the_limits(void)
{
    check_family(FAMILY_SPIRAL_ARCS, 256);
}

static void test_helices_keep_the_limits(void)
{
    check_family(FAMILY_HELICES, 256);
}

static void test_mixed_programs_keep_the_limits(void)
{
    check_family(FAMILY_MIXED, 256);
}

static void test_small_windows_keep_the_limits(void)
{
    static const uint32_t look_ahead[] = {1, 2, 3, 8};

    for (unsigned i = 0; i < sizeof(look_ahead) / sizeof(look_ahead[0]); i++) {
        check_family(FAMILY_NEARLY_COLLINEAR, look_ahead[i]);
        check_family(FAMILY_MIXED, look_ahead[i]);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_corners_keep_the_limits);
    RUN_TEST(test_nearly_collinear_blocks_keep_the_limits);
    RUN_TEST(test_polygons_keep_the_limits);
    RUN_TEST(test_blocks_shorter_than_a_cycle_keep_the_limits);
    RUN_TEST(test_zigzags_keep_the_limits);
    RUN_TEST(test_arcs_keep_the_limits);
    RUN_TEST(test_arcs_of_two_radii_keep_the_limits);
    RUN_TEST(test_helices_keep_the_limits);
    RUN_TEST(test_mixed_programs_keep_the_limits);
    RUN_TEST(test_small_windows_keep_the_limits);
    RUN_TEST(test_rare_chains_keep_the_limits);
    return UNITY_END();
}

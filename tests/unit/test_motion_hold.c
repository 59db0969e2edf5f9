/* A feed hold on a smoothed curve, and the way back to the trapezoidal reference. */
#include "base/maths.h"
#include "motion/motion.h"
#include "plan/path.h"

#include <string.h>
#include <unity.h>

/* A turn of a circle, as a polygon of these. */
#define MOVES     180
#define RADIUS_MM 30.0

/* Far below what the axes can do on it. */
#define FEED_MM_S 30.0

/* A ramp from it takes F/A + A/J, 50 cycles, where one axis moves alone. */
#define HOLD_CYCLES_MAX 58

static struct plan_limits limits;
static struct path path;
static struct motion motion;
static struct motion_operator asked;
static unsigned pushed;
static double feed_mm_s;
static double tolerance_mm;

static void set_up(double jerk_mm_s3)
{
    const struct point start = {{RADIUS_MM, 0.0}};

    limits = (struct plan_limits){
        7,    {100, 100, 100},   {1000, 1000, 1000}, {jerk_mm_s3, jerk_mm_s3, jerk_mm_s3}, 1e-3,
        1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};
    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    pushed = 0;
    feed_mm_s = FEED_MM_S;
    tolerance_mm = 0.01;
}

void setUp(void)
{
    set_up(50000.0);
}

void tearDown(void)
{
}

static void push_next(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = pushed < MOVES ? MOVE_FEED : MOVE_END;
    m.path = PATH_BLEND;
    m.tolerance_mm = tolerance_mm;
    m.feed_mm_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    pushed++;
    takt_maths_sincos(MATHS_TWO_PI * pushed / MOVES, &m.end.at[AXIS_Y], &m.end.at[AXIS_X]);
    m.end.at[AXIS_X] *= RADIUS_MM;
    m.end.at[AXIS_Y] *= RADIUS_MM;
    takt_path_push(&path, &m);
    if (m.kind == MOVE_END) {
        takt_path_finish(&path);
    }
}

static void plan(void)
{
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    takt_path_go_on(&path);
    while (!path.finished && takt_path_has_room(&path)) {
        push_next();
    }
    takt_motion_build(&motion);
}

static void run(unsigned cycles)
{
    struct cycle_record record;

    for (unsigned i = 0; i < cycles; i++) {
        plan();
        TEST_ASSERT_EQUAL(MOTION_CYCLE, takt_motion_cycle(&motion, &asked, &record));
    }
}

static unsigned cycles_to_rest(void)
{
    unsigned cycles = 0;

    asked.hold = true;
    do {
        run(1);
        cycles++;
    } while (!takt_motion_rests(&motion));
    return cycles;
}

/* Whether the setpoint has a constant rate when the hold begins to move it, or not. */
static void test_a_hold_from_any_moment_takes_hardly_longer_than_its_ramp(void)
{
    for (unsigned held = 200; held < 1000; held += 7) {
        setUp();
        run(held);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(HOLD_CYCLES_MAX, cycles_to_rest());
    }
}

static void test_after_a_hold_the_trapezoidal_reference_goes_on_by_itself(void)
{
    run(300);
    asked.hold = true;
    run(2); /* in the first cycle pieces of the curve are read */
    TEST_ASSERT_EQUAL_INT(MOTION_HELD, motion.held);
    run(HOLD_CYCLES_MAX);
    TEST_ASSERT_TRUE(takt_motion_rests(&motion));
    asked.hold = false;
    run(2 * HOLD_CYCLES_MAX);
    TEST_ASSERT_TRUE(motion.held != MOTION_HELD);
    TEST_ASSERT_FALSE(takt_motion_rests(&motion));
}

/*
 * That is one piece of another length than those of the curve, by which a hold counts. In a cycle
 * of it the setpoint's rate begins to rise.
 */
static void test_where_the_axes_stand_before_the_curve_they_are_at_rest_at_once(void)
{
    unsigned moments = 0;

    for (unsigned held = 1; held < 100; held++) {
        setUp();
        run(held);
        const bool moves = motion.feed > 0.0 || motion.reference.feed > 0.0;
        const unsigned cycles = cycles_to_rest();

        if (path.first > 0) {
            break;
        }
        moments += moves ? 1 : 0;
        TEST_ASSERT_LESS_OR_EQUAL_UINT(2, cycles);
        TEST_ASSERT_TRUE(motion.held != MOTION_HELD);
        run(10);
        TEST_ASSERT_TRUE(takt_motion_rests(&motion));
        asked.hold = false;
        run(300);
        TEST_ASSERT_FALSE(takt_motion_rests(&motion));
    }
    TEST_ASSERT_TRUE(moments > 0);
}

/*
 * Half the window of its trapezoidal reference is more pieces than are read then, with little jerk.
 */
static void test_a_hold_begins_while_the_axes_speed_up(void)
{
    for (unsigned held = 100; held < 400; held += 7) {
        set_up(5000.0);
        feed_mm_s = limits.velocity_mm_s[AXIS_X];
        tolerance_mm = 0.0005;
        run(held);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(165, cycles_to_rest());
    }
}

/*
 * Only blocks from the first on that is not known to be fast enough are asked about: none is
 * forgotten when they are many.
 */
static void test_what_is_known_to_be_fast_enough_is_always_ahead_of_a_setpoint_that_brakes(void)
{
    const struct hold *h = &motion.mover.beside.hold;
    uint32_t first;

    set_up(1000.0);
    run(1500);
    asked.hold = true;
    run(10);
    TEST_ASSERT_EQUAL_INT(MOTION_HELD, motion.held);
    first = h->here;
    while (!takt_motion_rests(&motion)) {
        run(1);
        TEST_ASSERT_GREATER_THAN_INT(0, (int32_t)(h->clear - h->here));
    }
    TEST_ASSERT_GREATER_THAN_UINT32(first + 8, h->here);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hold_from_any_moment_takes_hardly_longer_than_its_ramp);
    RUN_TEST(test_after_a_hold_the_trapezoidal_reference_goes_on_by_itself);
    RUN_TEST(test_where_the_axes_stand_before_the_curve_they_are_at_rest_at_once);
    RUN_TEST(test_a_hold_begins_while_the_axes_speed_up);
    RUN_TEST(test_what_is_known_to_be_fast_enough_is_always_ahead_of_a_setpoint_that_brakes);
    return UNITY_END();
}

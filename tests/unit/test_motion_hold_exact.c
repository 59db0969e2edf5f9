/*
 * A feed hold on an arc or a line of the exact path, and the way back to the trapezoidal reference.
 */
#include "base/maths.h"
#include "motion/motion.h"
#include "plan/path.h"

#include <string.h>
#include <unity.h>

/* A circle at the highest feed that it allows, 70 mm/s, leaves hardly anything for braking. */
#define RADIUS_MM 5.0
#define TURNS     20

/* From that feed F/A + A/J is 90 cycles; hold from any moment in so many. */
#define HOLD_CYCLES_MAX 135

static struct plan_limits limits;
static struct path path;
static struct motion motion;
static struct motion_operator asked;
static enum move_kind kind;  /* MOVE_ARC_CCW, or a line */
static double end_radius_mm; /* of the circle */
static bool pushed;
static bool bends; /* a large circle follows the line */

/* The setpoint and the two before, and the most that second differences have been of the limit. */
static struct point setpoint[3];
static double acceleration;

static void set_up(enum move_kind one, double velocity_mm_s, double jerk_mm_s3,
                   enum ramp_profile law)
{
    const struct point start = {{RADIUS_MM, 0.0}};

    kind = one;
    limits = (struct plan_limits){7,
                                  {velocity_mm_s, velocity_mm_s, velocity_mm_s},
                                  {1000, 1000, 1000},
                                  {jerk_mm_s3, jerk_mm_s3, jerk_mm_s3},
                                  1e-3,
                                  1e-3,
                                  law,
                                  LANDING_SPAN};
    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    end_radius_mm = RADIUS_MM;
    pushed = false;
    bends = false;
    acceleration = 0.0;
    for (unsigned i = 0; i < 3; i++) {
        setpoint[i] = start;
    }
}

void setUp(void)
{
    set_up(MOVE_ARC_CCW, 100.0, 50000.0, RAMP_PROFILE_JERK);
}

void tearDown(void)
{
}

static struct move move_to(enum move_kind one, double x_mm)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = one;
    m.path = PATH_EXACT;
    m.feed_mm_s = limits.velocity_mm_s[AXIS_X];
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = one == MOVE_ARC_CCW ? TURNS : 1;
    m.end.at[AXIS_X] = x_mm;
    return m;
}

static void push(struct move m)
{
    takt_path_push(&path, &m);
}

static void plan(void)
{
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    takt_path_go_on(&path);
    if (!pushed) {
        const double far_mm = 5.0 * limits.velocity_mm_s[AXIS_X];

        push(move_to(kind, kind == MOVE_ARC_CCW ? end_radius_mm : far_mm));
        if (bends) {
            struct move circle = move_to(MOVE_ARC_CCW, far_mm);

            circle.centre_mm[0] = far_mm;
            circle.centre_mm[1] = 400.0;
            push(circle);
        }
        push(move_to(MOVE_END, 0.0));
        takt_path_finish(&path);
        pushed = true;
    }
    takt_motion_build(&motion);
}

static void measure(const struct point *p)
{
    setpoint[0] = setpoint[1];
    setpoint[1] = setpoint[2];
    setpoint[2] = *p;
    for (int i = 0; i < 2; i++) {
        const double mm = setpoint[0].at[i] - 2.0 * setpoint[1].at[i] + setpoint[2].at[i];

        acceleration = maths_max(acceleration, maths_abs(mm) / (limits.acceleration_mm_s2[i] *
                                                                limits.cycle_s * limits.cycle_s));
    }
}

static enum motion_result cycle(void)
{
    struct cycle_record record;

    plan();
    const enum motion_result result = takt_motion_cycle(&motion, &asked, &record);

    if (result == MOTION_CYCLE) {
        measure(&record.cmd);
    }
    return result;
}

static void run(unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        TEST_ASSERT_EQUAL(MOTION_CYCLE, cycle());
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

static void assert_goes_on_to_the_end(void)
{
    enum motion_result result;

    asked.hold = false;
    do {
        result = cycle();
    } while (result == MOTION_CYCLE);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
}

/* With what an arc leaves for braking at that feed it was twice as long. */
static void test_a_hold_on_an_arc_from_any_moment_takes_hardly_longer_than_a_ramp(void)
{
    for (unsigned held = 20; held < 2000; held += 31) {
        setUp();
        run(held);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(HOLD_CYCLES_MAX, cycles_to_rest());
        assert_goes_on_to_the_end();
    }
}

/* Its angle does not grow evenly with its length, and a hold uses all of the acceleration. */
static void test_on_an_arc_whose_radius_changes_a_little_no_acceleration_is_exceeded(void)
{
    for (unsigned held = 20; held < 8000; held += 61) {
        setUp();
        end_radius_mm = RADIUS_MM * 0.9991;
        run(held);
        (void)cycles_to_rest();
        assert_goes_on_to_the_end();
        TEST_ASSERT_TRUE(acceleration <= 1.0001);
    }
}

/* A law of two windows brakes softer than the axes could. */
static void test_a_hold_on_a_line_does_not_take_what_the_law_of_ramps_takes(void)
{
    set_up(MOVE_FEED, 100.0, 50000.0, RAMP_PROFILE_SMOOTH);
    run(1000);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(
        128, cycles_to_rest()); /* 100/1000 + 1000/50000 s, and less than 7 % more */
    assert_goes_on_to_the_end();
}

static void test_the_trapezoidal_reference_goes_on_where_it_can_rest_before_the_end(void)
{
    run(500);
    (void)cycles_to_rest();
    TEST_ASSERT_EQUAL_INT(MOTION_HELD, motion.held);
    asked.hold = false;
    run(300);
    TEST_ASSERT_TRUE(motion.held != MOTION_HELD);
    TEST_ASSERT_FALSE(takt_motion_rests(&motion));
}

/* It need not be landed on the junction first. */
static void test_a_hold_takes_over_from_a_landing(void)
{
    set_up(MOVE_FEED, 100.0, 20000.0, RAMP_PROFILE_JERK);
    bends = true;
    do {
        run(1);
    } while (motion.reference.run.phase != LANDING_ACTIVE ||
             motion.reference.run.cycle < motion.reference.run.ramp);
    (void)cycles_to_rest();
    TEST_ASSERT_EQUAL_INT(MOTION_HELD, motion.held);
    TEST_ASSERT_EQUAL_UINT32(0, path.first);
    assert_goes_on_to_the_end();
}

/* 240 cycles of one window and 120 of another leave no memory for pieces. */
static void test_where_the_averages_leave_no_memory_the_trapezoidal_reference_brakes(void)
{
    set_up(MOVE_FEED, 1000.0, 4200.0, RAMP_PROFILE_SMOOTH);
    run(1500);
    (void)cycles_to_rest();
    TEST_ASSERT_TRUE(motion.held != MOTION_HELD);
    assert_goes_on_to_the_end();
}

/* It may have as many as fit: 16 inputs of a window leave all that is looked at. */
static void test_pieces_lie_behind_the_inputs_of_the_averages(void)
{
    run(500);
    asked.hold = true;
    run(5);
    const struct hold *h = &motion.mover.beside.hold;
    const struct average *a = &motion.mover.average;
    const char *inputs_end = (const char *)(a->input + a->box[a->boxes - 1].end);

    TEST_ASSERT_EQUAL_INT(MOTION_HELD, motion.held);
    TEST_ASSERT_EQUAL_UINT(HOLD_PIECES_MAX, h->pieces);
    TEST_ASSERT_EQUAL_PTR(inputs_end, h->store);
    TEST_ASSERT_TRUE((const char *)(h->store + h->pieces * hold_stride(h->axes)) <=
                     (const char *)h);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_hold_on_an_arc_from_any_moment_takes_hardly_longer_than_a_ramp);
    RUN_TEST(test_on_an_arc_whose_radius_changes_a_little_no_acceleration_is_exceeded);
    RUN_TEST(test_a_hold_on_a_line_does_not_take_what_the_law_of_ramps_takes);
    RUN_TEST(test_the_trapezoidal_reference_goes_on_where_it_can_rest_before_the_end);
    RUN_TEST(test_a_hold_takes_over_from_a_landing);
    RUN_TEST(test_where_the_averages_leave_no_memory_the_trapezoidal_reference_brakes);
    RUN_TEST(test_pieces_lie_behind_the_inputs_of_the_averages);
    return UNITY_END();
}

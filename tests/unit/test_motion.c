/*
 * The control cycle over a path: stops, dwell, end, hold and resume, override 0, an early end, too
 * small a window.
 */
#include "motion/motion.h"

#include "base/maths.h"
#include "plan/path.h"

#include <string.h>
#include <unity.h>

static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

static struct path path;
static struct motion motion;
static struct cycle_record record;
static struct motion_operator asked;

void setUp(void)
{
    const struct point start = {{0}};

    takt_path_init(&path, &limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
}

void tearDown(void)
{
}

static void push(enum move_kind kind, double x, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = kind;
    m.end.at[AXIS_X] = x;
    m.feed_mm_s = feed_mm_s;
    m.dwell_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    takt_path_push(&path, &m);
}

static void push_end(void)
{
    push(MOVE_END, 0.0, 0.0);
    takt_path_finish(&path);
}

static enum motion_result cycle(void)
{
    if (takt_motion_wanted(&motion) != NULL) {
        takt_path_go_on(&path);
        takt_motion_build(&motion);
    }
    return takt_motion_cycle(&motion, &asked, &record);
}

static uint64_t run_to_the_end(void)
{
    enum motion_result result;

    do {
        result = cycle();
        TEST_ASSERT_TRUE(motion.cycles < 400000);
    } while (result == MOTION_CYCLE);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    return motion.cycles;
}

/*
 * T = D/a + a/j for a ramp of D = F, else 2 sqrt(D/j), whole time 2 T + the rest at F: seven
 * segments.
 */
static double least_time(double length, double feed, double a, double j)
{
    const double top = feed;
    const double ramp = top >= a * a / j ? top / a + a / j : 2.0 * maths_sqrt(top / j);

    if (top * ramp <= length) {
        return 2.0 * ramp + (length - top * ramp) / top;
    }
    const double v = 0.5 * a * (maths_sqrt(a * a / (j * j) + 4.0 * length / a) - a / j);

    return v >= a * a / j ? 2.0 * (v / a + a / j) : 4.0 * takt_maths_cbrt(length / (2.0 * j));
}

static void test_a_single_move_takes_the_least_time_within_two_cycles(void)
{
    static const double lengths[] = {0.001, 0.01, 0.1, 0.5, 1.0, 3.0, 10.0, 33.0, 300.0};
    static const double feeds[] = {1.0, 5.0, 20.0, 50.0, 100.0};

    for (unsigned i = 0; i < sizeof(lengths) / sizeof(lengths[0]); i++) {
        for (unsigned k = 0; k < sizeof(feeds) / sizeof(feeds[0]); k++) {
            const double least_s = least_time(lengths[i], feeds[k], 1000.0, 50000.0);

            setUp();
            push(MOVE_FEED, lengths[i], feeds[k]);
            push_end();
            const double cycles = (double)run_to_the_end();

            TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == lengths[i]);
            TEST_ASSERT_DOUBLE_WITHIN(2.0, 1000.0 * least_s, cycles);
        }
    }
}

static void test_a_dwell_lasts_its_cycles_at_rest(void)
{
    push(MOVE_FEED, 1.0, 50.0);
    push_end();
    const uint64_t without = run_to_the_end();

    setUp();
    push(MOVE_FEED, 1.0, 50.0);
    push(MOVE_DWELL, 0.0, 0.25);
    push_end();
    TEST_ASSERT_EQUAL_UINT64(without + 250, run_to_the_end());
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == 1.0);
}

/*
 * Neither what stands there nor the next move is begun; a move in which the axes are is gone on
 * with.
 */
static void test_a_stop_is_not_passed_before_what_is_sent_has_come_to_it(void)
{
    push(MOVE_FEED, 1.0, 50.0);
    push(MOVE_DWELL, 0.0, 0.25);
    push_end();
    const uint64_t without = run_to_the_end();

    setUp();
    push(MOVE_FEED, 1.0, 50.0);
    push(MOVE_DWELL, 0.0, 0.25);
    push_end();
    asked.settles = true;
    while (record.cmd.at[AXIS_X] < 1.0 || motion.cycles < without) {
        TEST_ASSERT_EQUAL(MOTION_CYCLE, cycle());
    }
    TEST_ASSERT_EQUAL(1, record.block);
    asked.settles = false;
    TEST_ASSERT_EQUAL_UINT64(without + 250, run_to_the_end());
}

static void test_a_stop_is_landed_on_and_the_program_goes_on(void)
{
    unsigned landed = 0;

    push(MOVE_FEED, 10.0, 50.0);
    push(MOVE_FEED, 3.0, 50.0);
    push_end();
    while (cycle() == MOTION_CYCLE) {
        if (record.landed) {
            TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == (landed == 0 ? 10.0 : 3.0));
            landed++;
        }
    }
    TEST_ASSERT_EQUAL(2, landed);
}

/* The first cycle begins a span: it need not take the ceiling as well. */
static void test_a_ceiling_that_is_there_before_the_first_cycle_is_taken_before_it(void)
{
    push(MOVE_FEED, 100.0, 50.0);
    push_end();
    takt_motion_prepare(&motion);
    TEST_ASSERT_FALSE(motion_has_ceiling(&motion));
    TEST_ASSERT_NOT_NULL(takt_motion_wanted(&motion));
    takt_path_go_on(&path);
    takt_motion_build(&motion);
    takt_motion_prepare(&motion);
    TEST_ASSERT_TRUE(motion_has_ceiling(&motion));
    TEST_ASSERT_FALSE(reference_take(&motion.reference));
}

/* Rests within the time of one ramp, somewhere on the move; then goes on to its end. */
static void rest_and_go_on(void)
{
    double x;

    for (int i = 0; i < 300; i++) {
        (void)cycle();
    }
    x = record.cmd.at[AXIS_X];
    TEST_ASSERT_TRUE(x > 1.0 && x < 99.0);
    TEST_ASSERT_TRUE(motion.feed == 0.0);
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL(MOTION_CYCLE, cycle());
        TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == x);
    }
    asked = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    (void)run_to_the_end();
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == 100.0);
}

static void start_a_long_move(void)
{
    push(MOVE_FEED, 100.0, 50.0);
    push_end();
    for (int i = 0; i < 500; i++) {
        (void)cycle();
    }
}

static void test_a_hold_rests_on_the_path_and_resumes(void)
{
    start_a_long_move();
    asked.hold = true;
    rest_and_go_on();
}

static void test_an_override_of_0_holds(void)
{
    start_a_long_move();
    asked.feed_ratio = 0.0;
    rest_and_go_on();
}

static void test_half_the_override_is_half_the_feed(void)
{
    asked.feed_ratio = 0.5;
    start_a_long_move();
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 25.0, record.feed_mm_s);
}

static void push_smooth(double x, double y, double a)
{
    struct move m = {.kind = MOVE_FEED,
                     .path = PATH_BLEND,
                     .tolerance_mm = 0.01,
                     .feed_mm_s = 10.0,
                     .overrides = OVERRIDE_FEED | OVERRIDE_HOLD,
                     .turns = 1,
                     .end = {{x, y, 0.0, a}}};

    takt_path_push(&path, &m);
}

/* Over X, Y, Z, or over A, B, C where only those move. */
static double way(const struct point *from, const struct point *to, bool rotary)
{
    double square = 0.0;

    for (int i = rotary ? AXIS_A : AXIS_X; i < (rotary ? AXIS_COUNT : AXIS_A); i++) {
        square += (to->at[i] - from->at[i]) * (to->at[i] - from->at[i]);
    }
    return maths_sqrt(square);
}

static void expect_feed_of_setpoints(bool rotary)
{
    double most = 0.0;
    struct point before = {{0.0}};

    while (cycle() == MOTION_CYCLE) {
        const double feed_mm_s = 1000.0 * way(&before, &record.cmd, rotary);

        TEST_ASSERT_DOUBLE_WITHIN(1e-6 * feed_mm_s, feed_mm_s, record.feed_mm_s);
        most = maths_max(most, feed_mm_s);
        before = record.cmd;
    }
    TEST_ASSERT_TRUE(most > 1.0 && most < 10.1);
}

static void test_the_feed_of_a_smoothed_path_is_that_of_its_setpoints(void)
{
    push_smooth(3.0, 0.0, 0.0);
    push_smooth(3.0, 4.0, 0.2);
    push_end();
    expect_feed_of_setpoints(false);
}

static void test_the_feed_of_smoothed_rotary_motion_counts_its_angle(void)
{
    const struct point start = {{0}};
    struct plan_limits turning = limits;

    turning.axes |= 1U << AXIS_A;
    turning.velocity_mm_s[AXIS_A] = 20.0;
    turning.acceleration_mm_s2[AXIS_A] = 200.0;
    turning.jerk_mm_s3[AXIS_A] = 10000.0;
    takt_path_init(&path, &turning, &start);
    takt_motion_init(&motion, &path, &start, false);
    push_smooth(0.0, 0.0, 2.0);
    push_smooth(0.0, 0.0, 1.0);
    push_end();
    expect_feed_of_setpoints(true);
}

static void test_an_override_above_100_percent_keeps_to_the_axis(void)
{
    push(MOVE_FEED, 100.0, 95.0);
    push_end();
    asked.feed_ratio = 1.2;
    for (int i = 0; i < 500; i++) {
        (void)cycle();
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 100.0, record.feed_mm_s);
}

static void test_an_early_end_drops_the_rest_of_the_path(void)
{
    push(MOVE_FEED, 100.0, 50.0);
    push(MOVE_FEED, 200.0, 50.0);
    for (int i = 0; i < 500; i++) {
        (void)cycle();
    }
    takt_motion_end_here(&motion);
    for (int i = 0; i < 300; i++) {
        (void)cycle();
    }
    const double x = record.cmd.at[AXIS_X];

    TEST_ASSERT_TRUE(takt_motion_is_idle(&motion) && x > 1.0 && x < 50.0);
    push(MOVE_FEED, 0.0, 50.0);
    push_end();
    (void)run_to_the_end();
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == 0.0);
}

/*
 * The next move comes only when the axes have rested at the end of the last one: they wait for it,
 * and go on.
 */
static void test_a_starved_cycle_rests_and_goes_on(void)
{
    push(MOVE_FEED, 1.0, 50.0);
    push(MOVE_FEED, 2.0, 50.0);
    for (int i = 0; i < 400; i++) {
        TEST_ASSERT_TRUE(cycle() != MOTION_DONE);
    }
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == 1.0);
    push(MOVE_FEED, 3.0, 50.0);
    push_end();
    (void)run_to_the_end();
    TEST_ASSERT_TRUE(record.cmd.at[AXIS_X] == 3.0);
}

static void test_no_cycle_is_made_before_anything_is_planned(void)
{
    TEST_ASSERT_EQUAL(MOTION_NOT_YET, takt_motion_cycle(&motion, &asked, &record));
}

/*
 * Over blocks so short that the trapezoidal reference's place in a new ceiling takes more than a
 * cycle to find, both are in use until then, and nobody may make another one.
 */
static void test_no_ceiling_is_made_while_both_are_in_use(void)
{
    unsigned taking = 0;

    for (unsigned i = 1; takt_path_has_room(&path); i++) {
        struct move m = {.kind = MOVE_FEED, .feed_mm_s = 100.0, .turns = 1};

        m.end.at[AXIS_X] = 0.02 * i;
        m.overrides = i % 2 == 0 ? OVERRIDE_HOLD : OVERRIDE_FEED | OVERRIDE_HOLD;
        takt_path_push(&path, &m);
    }
    takt_path_finish(&path);
    do {
        if (motion.reference.coming.ceiling != NULL) {
            TEST_ASSERT_NULL(takt_motion_wanted(&motion));
            taking++;
        }
    } while (cycle() == MOTION_CYCLE);
    TEST_ASSERT_GREATER_THAN_UINT(0, taking);
}

/* Behind a motion to 1, and in front of an event. */
static void push_tool_change(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_TOOL;
    m.tool_change = true;
    push(MOVE_FEED, 1.0, 20.0);
    takt_path_push(&path, &m);
    push(MOVE_COOLANT, 0.0, 0.0);
    push_end();
    asked.tool_waits = true;
}

static void cycles(unsigned count)
{
    while (count-- > 0) {
        TEST_ASSERT_EQUAL(MOTION_CYCLE, cycle());
    }
}

static void test_in_a_hold_a_tool_change_that_has_begun_is_finished_and_nothing_more(void)
{
    push_tool_change();
    cycles(500);
    TEST_ASSERT_EQUAL(MOTION_CHANGES_TOOL, motion.end);
    asked.hold = MOTION_HOLD_ASKED;
    cycles(100);
    TEST_ASSERT_EQUAL(MOTION_CHANGES_TOOL, motion.end);
    asked.tool_waits = false;
    cycles(1);
    asked.tool_waits = true;
    cycles(100);
    TEST_ASSERT_NOT_EQUAL(MOTION_CHANGES_TOOL, motion.end);
    TEST_ASSERT_EQUAL_UINT32(2, path.first);
    asked.hold = MOTION_GOES;
    (void)run_to_the_end();
}

static void test_in_a_hold_no_tool_change_begins(void)
{
    push_tool_change();
    do {
        cycles(1);
    } while (motion.end != MOTION_ARRIVED);
    asked.hold = MOTION_HOLD_ASKED;
    cycles(100);
    TEST_ASSERT_NOT_EQUAL(MOTION_CHANGES_TOOL, motion.end);
    TEST_ASSERT_EQUAL_UINT32(1, path.first);
    asked.hold = MOTION_GOES;
    cycles(1);
    TEST_ASSERT_EQUAL(MOTION_CHANGES_TOOL, motion.end);
}

/* Behind an event that a hold keeps, the next motion is not read in the place of the last one. */
static void test_a_hold_at_a_stop_tells_the_motion_that_has_ended(void)
{
    push(MOVE_FEED, 1.0, 20.0);
    push(MOVE_COOLANT, 0.0, 0.0);
    push(MOVE_FEED, 2.0, 20.0);
    push_end();
    do {
        cycles(1);
    } while (motion.end != MOTION_ARRIVED);
    asked.hold = MOTION_HOLD_ASKED;
    for (unsigned i = 0; i < 100; i++) {
        cycles(1);
        TEST_ASSERT_EQUAL_UINT32(1, record.block);
        TEST_ASSERT_EQUAL_UINT32(1, motion_block(&motion)->number);
    }
    asked.hold = MOTION_GOES;
    (void)run_to_the_end();
    TEST_ASSERT_EQUAL_UINT32(2, record.block);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_single_move_takes_the_least_time_within_two_cycles);
    RUN_TEST(test_a_dwell_lasts_its_cycles_at_rest);
    RUN_TEST(test_a_stop_is_not_passed_before_what_is_sent_has_come_to_it);
    RUN_TEST(test_a_stop_is_landed_on_and_the_program_goes_on);
    RUN_TEST(test_a_ceiling_that_is_there_before_the_first_cycle_is_taken_before_it);
    RUN_TEST(test_a_hold_rests_on_the_path_and_resumes);
    RUN_TEST(test_an_override_of_0_holds);
    RUN_TEST(test_half_the_override_is_half_the_feed);
    RUN_TEST(test_an_override_above_100_percent_keeps_to_the_axis);
    RUN_TEST(test_the_feed_of_a_smoothed_path_is_that_of_its_setpoints);
    RUN_TEST(test_the_feed_of_smoothed_rotary_motion_counts_its_angle);
    RUN_TEST(test_an_early_end_drops_the_rest_of_the_path);
    RUN_TEST(test_a_starved_cycle_rests_and_goes_on);
    RUN_TEST(test_no_cycle_is_made_before_anything_is_planned);
    RUN_TEST(test_no_ceiling_is_made_while_both_are_in_use);
    RUN_TEST(test_in_a_hold_a_tool_change_that_has_begun_is_finished_and_nothing_more);
    RUN_TEST(test_in_a_hold_no_tool_change_begins);
    RUN_TEST(test_a_hold_at_a_stop_tells_the_motion_that_has_ended);
    return UNITY_END();
}

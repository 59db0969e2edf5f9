/*
 * Threads and rigid tapping against the virtual spindle: phase, limits, and what happens when it
 * goes wrong.
 */
#include "support/thread_bench.h"

#include <unity.h>

#define CYCLES_MAX 200000

/*
 * A thread keeps within this of the angle at constant speed: a count of the encoder, and the
 * filters' rest.
 */
#define STEADY_MM 0.001

static struct bench bench;

void setUp(void)
{
    bench_set_default(&bench);
}

void tearDown(void)
{
}

static void run_to_the_end(void)
{
    while (bench_cycle(&bench)) {
        TEST_ASSERT_TRUE(bench.cycles < CYCLES_MAX);
    }
    bench_check_limits(&bench);
}

static void check_completed(void)
{
    run_to_the_end();
    TEST_ASSERT_EQUAL(TAKT_OK, bench.sync.alarm.code);
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
}

static void check_alarm(enum takt_error code)
{
    run_to_the_end();
    TEST_ASSERT_EQUAL(SPINDLE_SYNC_FAILED, bench.locked);
    TEST_ASSERT_EQUAL(code, bench.sync.alarm.code);
    TEST_ASSERT_EQUAL_UINT32(2, bench.sync.alarm.line);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.command_rpm);
}

/* M3 S, then one thread of 40 mm in line 2. */
static void set_thread(double rpm, double pitch_mm)
{
    bench_turn(&bench, rpm);
    bench_go(&bench, MOVE_THREAD, 0.0, -40.0, pitch_mm);
}

static void test_a_thread_is_in_phase_with_the_index_and_ends_exactly(void)
{
    double most_mm = 0.0;
    unsigned seen = 0;

    set_thread(600, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        if (bench_is_on_thread(&bench)) {
            most_mm = maths_max(most_mm, maths_abs(bench_off_mm(&bench)));
            TEST_ASSERT_EQUAL_DOUBLE(takt_maths_round(bench.sync.at.zero_rev),
                                     bench.sync.at.zero_rev);
            seen++;
        }
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_TRUE(seen > 2000);
    TEST_ASSERT_TRUE(most_mm < STEADY_MM);
    TEST_ASSERT_EQUAL_DOUBLE(-40.0, bench.point.at[AXIS_Z]);
    bench_check_limits(&bench);
}

/* Where a groove is, as a part of a revolution: angle of the place in the middle of the thread. */
static double groove_rev(void)
{
    const double rev =
        bench.sync.sense * bench.true_rev[1] - bench.sent_mm[BENCH_AHEAD] / bench.sync.at.pitch_mm;

    return rev - takt_maths_round(rev);
}

static void test_passes_at_different_speeds_cut_the_same_groove(void)
{
    static const double rpm[] = {200, 437, 1100};
    double groove[3] = {0};
    unsigned pass = 0;

    for (unsigned i = 0; i < 3; i++) {
        bench_turn(&bench, rpm[i]);
        bench_go(&bench, MOVE_THREAD, 0.0, -30.0, 2.0);
        bench_go(&bench, MOVE_RAPID, 5.0, -30.0, 0.0);
        bench_go(&bench, MOVE_RAPID, 5.0, 0.0, 0.0);
        bench_go(&bench, MOVE_RAPID, 0.0, 0.0, 0.0);
    }
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        if (pass < 3 && bench_is_on_thread(&bench) && bench.sent_mm[BENCH_AHEAD] > 15.0) {
            groove[pass++] = groove_rev();
            while (bench.is_locked && bench_cycle(&bench)) {
            }
        }
    }
    TEST_ASSERT_EQUAL(3, pass);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.0005, groove[0], groove[i]);
    }
    bench_check_limits(&bench);
}

/* What the averages remember of the motion before the thread is no way that the axes go. */
static void test_behind_a_thread_the_feed_begins_at_0(void)
{
    bench_go(&bench, MOVE_RAPID, 5.0, 0.0, 0.0);
    bench_turn(&bench, 600);
    bench_go(&bench, MOVE_THREAD, 5.0, -30.0, 2.0);
    bench_go(&bench, MOVE_RAPID, 0.0, -30.0, 0.0);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        TEST_ASSERT_TRUE(bench.record.feed_mm_s >= 0.0);
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
}

static void test_a_spindle_that_turns_the_other_way_cuts_too(void)
{
    set_thread(-600, 1.5);
    bench_start(&bench);
    check_completed();
    TEST_ASSERT_EQUAL_DOUBLE(-40.0, bench.point.at[AXIS_Z]);
}

/* From 600 to 900 rpm in the middle of the thread. */
static void test_a_change_of_speed_changes_the_feed_and_not_the_thread(void)
{
    double most_mm = 0.0;

    set_thread(600, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        if (bench_is_on_thread(&bench)) {
            most_mm = maths_max(most_mm, maths_abs(bench_off_mm(&bench)));
            bench.command_rpm = bench.sent_mm[0] > 15.0 ? 900 : 600;
        }
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_TRUE(most_mm < 0.04);
    bench_check_limits(&bench);
}

static void test_a_thread_goes_on_over_a_tangent_junction_without_a_stop(void)
{
    unsigned stops = 0;
    double before_mm = 0.0;

    bench_turn(&bench, 600);
    bench_go(&bench, MOVE_THREAD, 0.0, -10.0, 1.5);
    bench_go(&bench, MOVE_THREAD, 0.0, -20.0, 1.5);
    bench_go(&bench, MOVE_THREAD, 0.0, -40.0, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        const double z = bench.point.at[AXIS_Z];

        stops += z < -1.0 && z > -39.0 && z == before_mm ? 1 : 0;
        before_mm = z;
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_EQUAL(0, stops);
    TEST_ASSERT_EQUAL_DOUBLE(-40.0, bench.point.at[AXIS_Z]);
    bench_check_limits(&bench);
}

/*
 * Around a corner the axes stop; the thread behind it is the continuation of the one before, some
 * revolutions later.
 */
static void test_a_thread_goes_on_in_phase_behind_a_corner(void)
{
    double first = -1.0;
    double second = -1.0;

    bench_turn(&bench, 600);
    bench_go(&bench, MOVE_THREAD, 0.0, -20.3, 1.5);
    bench_go(&bench, MOVE_THREAD, 10.0, -40.0, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        if (bench_is_on_thread(&bench) && bench.sent_mm[BENCH_AHEAD] > 15.0) {
            const double zero = bench.sync.at.zero_rev;

            *(bench.path.first == 1 ? &first : &second) = zero - takt_maths_floor(zero);
        }
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, first);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.3 / 1.5 - 13.0, second);
    bench_check_limits(&bench);
}

static void test_a_hold_waits_until_the_pass_is_finished(void)
{
    set_thread(600, 1.5);
    bench_go(&bench, MOVE_RAPID, 5.0, -40.0, 0.0);
    bench_start(&bench);
    while (bench_cycle(&bench) && bench.cycles < 10000) {
        bench.operator.hold = bench.point.at[AXIS_Z]<- 5.0;
    }
    TEST_ASSERT_EQUAL_DOUBLE(-40.0, bench.point.at[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.point.at[AXIS_X]);
    bench.operator.hold = false;
    check_completed();
    TEST_ASSERT_EQUAL_DOUBLE(5.0, bench.point.at[AXIS_X]);
}

static void test_a_hold_before_the_pass_keeps_it_from_beginning(void)
{
    set_thread(600, 1.5);
    bench_start(&bench);
    bench.operator.hold = true;
    while (bench_cycle(&bench) && bench.cycles < 2000) {
    }
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.point.at[AXIS_Z]);
    bench.operator.hold = false;
    check_completed();
    TEST_ASSERT_EQUAL_DOUBLE(-40.0, bench.point.at[AXIS_Z]);
}

static void test_a_stop_for_a_fault_is_obeyed_in_the_middle_of_a_thread(void)
{
    set_thread(600, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench) && bench.point.at[AXIS_Z] > -5.0) {
    }
    bench.operator.hold = MOTION_STOPS;
    while (bench_cycle(&bench) && !takt_motion_rests(&bench.motion)) {
    }
    TEST_ASSERT_TRUE(bench.point.at[AXIS_Z] > -5.6);
    bench_check_limits(&bench);
}

/* -- tapping -- */

static void check_tap(double rpm, double pitch_mm, double ratio)
{
    double deepest = 0.0;

    bench_go(&bench, MOVE_RAPID, 1.0, 5.0, 0.0);
    bench_turn(&bench, rpm);
    bench.move[bench.moves - 1].end.at[AXIS_X] = 1.0;
    bench.move[bench.moves - 1].end.at[AXIS_Z] = 5.0;
    bench_tap(&bench, -15.0, pitch_mm, ratio);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        TEST_ASSERT_TRUE(bench.cycles < CYCLES_MAX);
        deepest = maths_min(deepest, bench.point.at[AXIS_Z]);
        if (bench_is_on_thread(&bench)) {
            TEST_ASSERT_TRUE(maths_abs(bench_off_mm(&bench)) < 0.05);
        }
    }
    TEST_ASSERT_EQUAL(TAKT_OK, bench.sync.alarm.code);
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_TRUE(deepest >= -15.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.06 * pitch_mm, -15.0, deepest);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, bench.point.at[AXIS_Z]);
    TEST_ASSERT_EQUAL_DOUBLE(rpm, bench.command_rpm);
    bench_check_limits(&bench);
}

static void test_a_tap_goes_in_turns_back_above_the_bottom_and_returns_to_its_start(void)
{
    check_tap(600, 1.25, 1.0);
}

static void test_a_left_hand_tap_does_too(void)
{
    check_tap(-300, 1.5, 1.0);
}

static void test_a_tap_may_come_out_faster(void)
{
    check_tap(600, 1.25, 2.0);
}

static void test_the_way_out_is_in_the_groove_of_the_way_in(void)
{
    double in = 2.0;
    double out = 2.0;

    bench_turn(&bench, 500);
    bench_tap(&bench, -20.0, 1.0, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        if (bench_is_on_thread(&bench) && bench.sent_mm[BENCH_AHEAD] > 9.0 &&
            bench.sent_mm[BENCH_AHEAD] < 11.0) {
            *(bench.sync.tap.phase == TAP_OUT ? &out : &in) = groove_rev();
        }
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, in, out);
}

/* A row of holes, each with a way between. */
static void test_every_tap_of_a_row_goes_to_the_bottom_and_comes_back(void)
{
    double deepest[2] = {0.0};

    bench_turn(&bench, 600);
    bench_tap(&bench, -15.0, 1.25, 1.0);
    bench_go(&bench, MOVE_RAPID, 10.0, 0.0, 0.0);
    bench_tap(&bench, -12.0, 1.25, 1.0);
    bench_go(&bench, MOVE_RAPID, 20.0, 0.0, 0.0);
    bench_start(&bench);
    while (bench_cycle(&bench)) {
        double *z = &deepest[bench.point.at[AXIS_X] > 5.0 ? 1 : 0];

        TEST_ASSERT_TRUE(bench.cycles < CYCLES_MAX);
        *z = maths_min(*z, bench.point.at[AXIS_Z]);
    }
    TEST_ASSERT_EQUAL(MOTION_DONE, bench.result);
    TEST_ASSERT_DOUBLE_WITHIN(0.06 * 1.25, -15.0, deepest[0]);
    TEST_ASSERT_DOUBLE_WITHIN(0.06 * 1.25, -12.0, deepest[1]);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, bench.point.at[AXIS_X]);
    bench_check_limits(&bench);
}

/* -- alarms -- */

static void test_a_spindle_that_never_gets_to_its_speed_is_an_alarm(void)
{
    bench.spindle_config.max_rpm = 500;
    set_thread(600, 1.5);
    bench_start(&bench);
    check_alarm(TAKT_ERROR_THREAD_WAITS);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.point.at[AXIS_Z]);
}

static void test_a_pitch_and_speed_that_an_axis_cannot_do_are_an_alarm_before_anything_moves(void)
{
    bench.limits.velocity_mm_s[AXIS_Z] = 14.0;
    set_thread(600, 1.5);
    bench_start(&bench);
    check_alarm(TAKT_ERROR_THREAD_FAST);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 15.0, bench.sync.alarm.value);
    TEST_ASSERT_DOUBLE_WITHIN(0.02, 14.0, bench.sync.alarm.limit);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.point.at[AXIS_Z]);
}

static void test_a_thread_shorter_than_catching_up_is_an_alarm_before_anything_moves(void)
{
    bench.limits.acceleration_mm_s2[AXIS_Z] = 5.0;
    set_thread(600, 1.5);
    bench_start(&bench);
    check_alarm(TAKT_ERROR_THREAD_SHORT);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench.point.at[AXIS_Z]);
}

/* The thread is in its middle; then something happens. */
static void come_to_the_middle(void)
{
    set_thread(600, 1.5);
    bench_start(&bench);
    while (bench_cycle(&bench) && bench.point.at[AXIS_Z] > -20.0) {
    }
}

static void test_a_spindle_that_stops_in_a_thread_is_an_alarm_and_the_axes_rest_on_the_thread(void)
{
    come_to_the_middle();
    bench.command_rpm = 0.0;
    check_alarm(TAKT_ERROR_THREAD_STOPPED);
    TEST_ASSERT_TRUE(bench.point.at[AXIS_Z] > -21.0);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 0.0, bench_off_mm(&bench));
}

static void test_a_spindle_that_gets_too_fast_in_a_thread_is_an_alarm(void)
{
    bench.limits.velocity_mm_s[AXIS_Z] = 16.0;
    come_to_the_middle();
    bench.command_rpm = 900.0;
    check_alarm(TAKT_ERROR_THREAD_FAST);
}

/* It is blocked: from 10 revolutions a second to none at once. */
static void test_a_spindle_that_jerks_away_from_the_axes_is_an_alarm(void)
{
    come_to_the_middle();
    bench.spindle.locked = true;
    check_alarm(TAKT_ERROR_THREAD_LAG);
    TEST_ASSERT_TRUE(bench.sync.alarm.value > bench.sync.alarm.limit);
    TEST_ASSERT_TRUE(bench.point.at[AXIS_Z] > -21.0);
}

static void test_a_trip_of_the_spindle_is_an_alarm(void)
{
    come_to_the_middle();
    virtual_spindle_set_trip(&bench.spindle, VIRTUAL_SPINDLE_OVERCURRENT);
    check_alarm(TAKT_ERROR_SPINDLE_TRIPPED);
}

static void test_a_silent_spindle_is_an_alarm(void)
{
    come_to_the_middle();
    bench.is_silent = true;
    check_alarm(TAKT_ERROR_SPINDLE_SILENT);
}

/* Its motor is weaker than the ramp that has been promised. */
static void test_a_tap_whose_spindle_does_not_turn_back_stops_just_below_the_bottom(void)
{
    bench.spindle_config.inertia_kg_m2 = 0.03;
    bench_turn(&bench, 600);
    bench_tap(&bench, -20.0, 1.25, 1.0);
    bench_start(&bench);
    check_alarm(TAKT_ERROR_TAP_DEEP);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, -20.0 - bench.spindle_sync_config.tolerance_mm,
                              bench.point.at[AXIS_Z]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_thread_is_in_phase_with_the_index_and_ends_exactly);
    RUN_TEST(test_passes_at_different_speeds_cut_the_same_groove);
    RUN_TEST(test_behind_a_thread_the_feed_begins_at_0);
    RUN_TEST(test_a_spindle_that_turns_the_other_way_cuts_too);
    RUN_TEST(test_a_change_of_speed_changes_the_feed_and_not_the_thread);
    RUN_TEST(test_a_thread_goes_on_over_a_tangent_junction_without_a_stop);
    RUN_TEST(test_a_thread_goes_on_in_phase_behind_a_corner);
    RUN_TEST(test_a_hold_waits_until_the_pass_is_finished);
    RUN_TEST(test_a_hold_before_the_pass_keeps_it_from_beginning);
    RUN_TEST(test_a_stop_for_a_fault_is_obeyed_in_the_middle_of_a_thread);
    RUN_TEST(test_a_tap_goes_in_turns_back_above_the_bottom_and_returns_to_its_start);
    RUN_TEST(test_a_left_hand_tap_does_too);
    RUN_TEST(test_a_tap_may_come_out_faster);
    RUN_TEST(test_the_way_out_is_in_the_groove_of_the_way_in);
    RUN_TEST(test_every_tap_of_a_row_goes_to_the_bottom_and_comes_back);
    RUN_TEST(test_a_spindle_that_never_gets_to_its_speed_is_an_alarm);
    RUN_TEST(test_a_pitch_and_speed_that_an_axis_cannot_do_are_an_alarm_before_anything_moves);
    RUN_TEST(test_a_thread_shorter_than_catching_up_is_an_alarm_before_anything_moves);
    RUN_TEST(test_a_spindle_that_stops_in_a_thread_is_an_alarm_and_the_axes_rest_on_the_thread);
    RUN_TEST(test_a_spindle_that_gets_too_fast_in_a_thread_is_an_alarm);
    RUN_TEST(test_a_spindle_that_jerks_away_from_the_axes_is_an_alarm);
    RUN_TEST(test_a_trip_of_the_spindle_is_an_alarm);
    RUN_TEST(test_a_silent_spindle_is_an_alarm);
    RUN_TEST(test_a_tap_whose_spindle_does_not_turn_back_stops_just_below_the_bottom);
    return UNITY_END();
}

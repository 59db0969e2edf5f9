/*
 * firmware/controller/approach.h: the way from where the drives stand to where the program starts.
 */
#include "controller/approach.h"

#include "unity.h"

#include <math.h>

#define CYCLES_MAX 100000U

static struct machine machine;
static struct approach approach;
static struct point actual, setpoint;
static const struct point start = {{1, 2, 3}};

void setUp(void)
{
    takt_machine_set_default(&machine);
    takt_approach_init(&approach, &start);
    actual = start;
}

void tearDown(void)
{
}

/* Largest values of the setpoints' differences, by axis. */
struct peaks {
    double velocity_mm_s[3], acceleration_mm_s2[3], jerk_mm_s3[3];
    unsigned cycles;
};

static struct peaks run(void)
{
    struct peaks peaks = {.cycles = 0};
    double x[3][4];

    for (unsigned i = 0; i < 3; i++) {
        for (unsigned k = 0; k < 4; k++) {
            x[i][k] = actual.at[i];
        }
    }
    while (!takt_approach_cycle(&approach, &machine, &actual, &setpoint) &&
           peaks.cycles < CYCLES_MAX) {
        peaks.cycles++;
        for (unsigned i = 0; i < 3; i++) {
            x[i][0] = x[i][1], x[i][1] = x[i][2], x[i][2] = x[i][3], x[i][3] = setpoint.at[i];
            peaks.velocity_mm_s[i] = fmax(peaks.velocity_mm_s[i], fabs(x[i][3] - x[i][2]) / 1e-3);
            peaks.acceleration_mm_s2[i] =
                fmax(peaks.acceleration_mm_s2[i], fabs(x[i][3] - 2 * x[i][2] + x[i][1]) / 1e-6);
            peaks.jerk_mm_s3[i] = fmax(peaks.jerk_mm_s3[i],
                                       fabs(x[i][3] - 3 * x[i][2] + 3 * x[i][1] - x[i][0]) / 1e-9);
        }
    }
    return peaks;
}

static void assert_at_start(void)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        TEST_ASSERT_TRUE(setpoint.at[i] == start.at[i]);
    }
}

static void test_axes_that_stand_at_the_start_do_not_move(void)
{
    TEST_ASSERT_EQUAL_UINT(0, run().cycles);
    assert_at_start();
}

static void test_less_than_the_resolution_is_there(void)
{
    actual.at[AXIS_Y] += 0.9 / machine.resolution_per_mm;
    TEST_ASSERT_EQUAL_UINT(0, run().cycles);
    assert_at_start();
}

static void test_axes_come_to_the_start_exactly_and_within_their_limits(void)
{
    static const double ways_mm[] = {0.01, 0.5, 3, 40, 400};

    for (unsigned i = 0; i < sizeof(ways_mm) / sizeof(ways_mm[0]); i++) {
        struct peaks peaks;

        setUp();
        actual.at[AXIS_X] -= ways_mm[i];
        actual.at[AXIS_Z] += ways_mm[i] / 3;
        peaks = run();
        assert_at_start();
        for (unsigned axis = 0; axis < 3; axis += 2) {
            TEST_ASSERT_TRUE(peaks.velocity_mm_s[axis] <= 0.1 * 100 * 1.0001);
            TEST_ASSERT_TRUE(peaks.acceleration_mm_s2[axis] <= 1000 * 1.0001);
            TEST_ASSERT_TRUE(peaks.jerk_mm_s3[axis] <= 50000 * 1.001);
        }
        TEST_ASSERT_TRUE(peaks.velocity_mm_s[AXIS_Y] == 0);
    }
}

static void test_a_long_way_is_made_at_a_tenth_of_the_velocity_and_no_slower(void)
{
    actual.at[AXIS_X] += 100;
    TEST_ASSERT_TRUE(run().velocity_mm_s[AXIS_X] > 0.099 * 100);
}

static void test_axes_move_in_the_order_they_are_homed_in_and_the_others_last(void)
{
    unsigned moved[3] = {0};
    unsigned cycle = 0;

    machine.axis[AXIS_Z].home_order = 1;
    machine.axis[AXIS_X].home_order = 7;
    actual = (struct point){{2, 3, 4}};
    while (!takt_approach_cycle(&approach, &machine, &actual, &setpoint) && cycle++ < CYCLES_MAX) {
        for (unsigned i = 0; i < 3; i++) {
            if (moved[i] == 0 && setpoint.at[i] != actual.at[i]) {
                moved[i] = cycle;
            }
        }
        if (setpoint.at[AXIS_Z] != start.at[AXIS_Z]) {
            TEST_ASSERT_TRUE(setpoint.at[AXIS_X] == actual.at[AXIS_X]);
        }
    }
    TEST_ASSERT_TRUE(moved[AXIS_Z] < moved[AXIS_X]);
    TEST_ASSERT_TRUE(moved[AXIS_X] < moved[AXIS_Y]);
    assert_at_start();
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_axes_that_stand_at_the_start_do_not_move);
    RUN_TEST(test_less_than_the_resolution_is_there);
    RUN_TEST(test_axes_come_to_the_start_exactly_and_within_their_limits);
    RUN_TEST(test_a_long_way_is_made_at_a_tenth_of_the_velocity_and_no_slower);
    RUN_TEST(test_axes_move_in_the_order_they_are_homed_in_and_the_others_last);
    return UNITY_END();
}

/*
 * The flat curve of a machine with modes: what follows from it is what the machine does, and its
 * changes are as the optimiser has them.
 */
#include "ahead/modes.h"
#include "ahead/trail.h"
#include "convex/vector.h"

#include <string.h>
#include <unity.h>

#define INTERVALS ((size_t)200)
#define STEP_S    0.002
#define FINE      ((size_t)40) /* parts of a step in which the machine is followed */

static const struct vibration_config one = {.mode = {{25, 0.03, 1}, {60, 0.1, 0.7}, {10, 0.02, 1}}};
static const struct vibration_config two = {
    .mode = {{25, 0.03, 0.8, 55, 0.05, 0.2}, {31, 0.03, 1}}};

void setUp(void)
{
}

void tearDown(void)
{
}

/* From rest to rest in a third of the time and back, each axis by another way. */
static void make_trail(struct trail *t, const struct ahead_modes *modes)
{
    TEST_ASSERT_TRUE(trail_allocate(t, INTERVALS, modes->count));
    for (size_t k = 0; k < INTERVALS + trail_ends(modes->count); k++) {
        const double x = maths_clamp(((double)k - 20) / (INTERVALS - 40), 0, 1);
        const double b = x * (1 - x);

        for (int i = 0; i < 3; i++)
            t->control[k][i] = (1 + i) * 64 * b * b * b * (1 + x);
    }
    trail_follow(t, modes);
}

static void at_part(double (*control)[3], double f, double point[3])
{
    double weight[4];

    trail_weights(f, weight);
    trail_sum(control, weight, point);
}

/*
 * The curve of a tool against the machine that follows the motors; how far it is off them at most.
 */
static double away_of(const struct trail *t, double (*curve)[3],
                      const struct vibration_config *config)
{
    struct vibration v;
    double most_mm = 0;

    vibration_init(&v, config, STEP_S / FINE);
    for (size_t n = 0; n < INTERVALS * FINE; n++) {
        const double f = (double)(n % FINE) / FINE;
        double motor[3];
        double tool[3];
        struct point real = {{0}};

        at_part(t->motor + n / FINE, f, motor);
        at_part(curve + n / FINE, f, tool);
        vector_copy(motor, real.at);
        vibration_follow(&v, &real);
        for (int i = 0; i < 3; i++) {
            most_mm = maths_max(most_mm, maths_abs(tool[i] - motor[i]));
            TEST_ASSERT_DOUBLE_WITHIN(1e-4, real.at[i], tool[i]);
        }
    }
    return most_mm;
}

static void check_tool(const struct vibration_config *config)
{
    struct ahead_modes modes;
    struct trail t;

    modes_init(&modes, config, STEP_S, STEP_S / FINE);
    make_trail(&t, &modes);
    TEST_ASSERT_TRUE(away_of(&t, t.tool, config) > 0.01);
    trail_free(&t);
}

static void test_the_tool_goes_where_the_machine_has_it(void)
{
    check_tool(&one);
}

/* Where its frequencies are others, what swings is another machine's. */
static void test_a_stray_tool_goes_where_a_machine_of_other_modes_has_it(void)
{
    for (int s = 0; s < MODES_STRAYS; s++) {
        struct vibration_config config = one;
        struct ahead_modes modes;
        struct trail t;

        for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
            config.uncertain_percent[i] = 10;
        modes_init(&modes, &config, STEP_S, STEP_S / FINE);
        TEST_ASSERT_EQUAL_UINT(MODES_STRAYS, modes.strays);
        vibration_shift(&config, s == 0 ? -1 : 1);
        make_trail(&t, &modes);
        TEST_ASSERT_TRUE(away_of(&t, t.stray[s], &config) > 0.01);
        trail_free(&t);
    }
}

/* A piece of a trail swings as the whole of it. */
static void test_a_piece_swings_on(void)
{
    const size_t first = 70;
    struct vibration_config config = one;
    struct ahead_modes modes;
    struct trail t;
    struct trail piece;

    config.uncertain_percent[0] = 10;
    modes_init(&modes, &config, STEP_S, STEP_S);
    make_trail(&t, &modes);
    TEST_ASSERT_TRUE(trail_allocate(&piece, INTERVALS - first, modes.count));
    memcpy(piece.control, t.control + first,
           (piece.intervals + trail_ends(modes.count)) * sizeof *t.control);
    trail_continue(&piece, &t, first, piece.intervals);
    trail_follow(&piece, &modes);
    for (size_t k = 0; k < piece.intervals + TRAIL_ENDS; k++)
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, t.stray[0][first + k][0], piece.stray[0][k][0]);
    trail_free(&piece);
    trail_free(&t);
}

static void test_so_it_does_with_two_modes(void)
{
    check_tool(&two);
}

static void test_where_the_curve_rests_motors_and_tool_do(void)
{
    struct ahead_modes modes;
    struct trail t;

    modes_init(&modes, &two, STEP_S, STEP_S);
    make_trail(&t, &modes);
    for (size_t k = 0; k < TRAIL_ENDS; k++) {
        const size_t last = INTERVALS + TRAIL_ENDS - 1 - k;

        TEST_ASSERT_EQUAL_MEMORY(t.control[0], t.motor[k], sizeof t.motor[k]);
        TEST_ASSERT_EQUAL_MEMORY(t.control[0], t.tool[k], sizeof t.tool[k]);
        TEST_ASSERT_EQUAL_MEMORY(t.control[INTERVALS + 3], t.motor[last], sizeof t.motor[last]);
        TEST_ASSERT_EQUAL_MEMORY(t.control[INTERVALS + 3], t.tool[last], sizeof t.tool[last]);
    }
    trail_free(&t);
}

/*
 * Points of a parabola around x = 0, passed at the rate r: x is r x + s x^2 / 2 then, with s the
 * change of r. What differences of points are off derivatives, s by s, is left.
 */
static void test_a_change_of_time_is_known_to_first_order(void)
{
    static const double e[3] = {1e-4, 3e-4, -2e-4};
    struct ahead_modes modes;
    double now[3][3];
    double then[3][3];
    struct modes_point motor, tool, motor_then, tool_then;
    double change = 0;
    double change_of_tool = 0;

    modes_init(&modes, &one, STEP_S, STEP_S);
    for (int k = 0; k < 3; k++) {
        const double x = k - 1;
        const double slope = 0.5 * (e[2] - e[0]) / 2; /* of the rate */
        const double later = x * (1 + e[1] / 2) + slope * x * x / 2;

        now[k][0] = 2 + 3 * x + 5 * x * x;
        then[k][0] = 2 + 3 * later + 5 * later * later;
    }
    modes_at(&modes, 0, now, &motor, &tool);
    modes_at(&modes, 0, then, &motor_then, &tool_then);
    for (int k = 0; k < 3; k++) {
        change += motor.by_time[k] * e[k];
        change_of_tool += tool.by_time[k] * e[k];
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, motor_then.at_mm - motor.at_mm, change);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, tool_then.at_mm - tool.at_mm, change_of_tool);
    TEST_ASSERT_TRUE(change > 1e-2 || change < -1e-2);
}

static void test_a_change_of_the_curve_is_linear(void)
{
    struct ahead_modes modes;
    double w[5][3] = {{1}, {4}, {2}, {3}, {7}};
    struct modes_point motor, tool, moved, tool_moved;

    modes_init(&modes, &two, STEP_S, STEP_S);
    modes_at(&modes, 0, w, &motor, &tool);
    for (int k = 0; k < 5; k++) {
        w[k][0] += 0.5;
        modes_at(&modes, 0, w, &moved, &tool_moved);
        w[k][0] -= 0.5;
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, motor.at_mm + 0.5 * motor.by_curve[k], moved.at_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, tool.at_mm + 0.5 * tool.by_curve[k], tool_moved.at_mm);
    }
}

static void test_weights_of_any_degree_have_the_sum_1_and_meet_at_knots(void)
{
    for (unsigned modes = 0; modes <= MODES_MAX; modes++) {
        double end[TRAIL_ENDS + 1 + 2 * MODES_MAX];
        double begin[TRAIL_ENDS + 1 + 2 * MODES_MAX];
        const size_t last = TRAIL_ENDS + 2 * modes;
        double sum = 0;

        trail_curve_weights(modes, 1, end);
        trail_curve_weights(modes, 0, begin);
        for (size_t i = 0; i <= last; i++) {
            sum += begin[i];
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, i > 0 ? begin[i - 1] : 0, end[i]);
            TEST_ASSERT_DOUBLE_WITHIN(1e-12, begin[last - i], end[i]);
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, sum);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_tool_goes_where_the_machine_has_it);
    RUN_TEST(test_a_stray_tool_goes_where_a_machine_of_other_modes_has_it);
    RUN_TEST(test_a_piece_swings_on);
    RUN_TEST(test_so_it_does_with_two_modes);
    RUN_TEST(test_where_the_curve_rests_motors_and_tool_do);
    RUN_TEST(test_a_change_of_time_is_known_to_first_order);
    RUN_TEST(test_a_change_of_the_curve_is_linear);
    RUN_TEST(test_weights_of_any_degree_have_the_sum_1_and_meet_at_knots);
    return UNITY_END();
}

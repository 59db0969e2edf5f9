/*
 * Setpoints to pulses: where the axes are and when, whatever the form.
 */
#include "base/maths.h"
#include "step/steps.h"
#include "stepper/virtual_steppers.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

#define CYCLE_US 1000
#define CYCLE_NS 1000000
#define CYCLE_S  1e-3
#define PULSES   200000 /* that are remembered */

static struct virtual_steppers steppers;
static struct step_port port;
static struct steps steps;
static struct steps_config config;

static struct {
    unsigned count;
    uint64_t time_ns[PULSES];
    uint8_t axes[PULSES];
} pulses;

static void note_pulse(void *context, uint64_t time_ns, const struct step_pulse *pulse)
{
    (void)context;
    if (pulses.count == PULSES)
        return;
    pulses.time_ns[pulses.count] = time_ns;
    pulses.axes[pulses.count++] = pulse->axes;
}

static void begin(enum steps_form form)
{
    const struct point start = {{0}};
    struct virtual_stepper_config drives[AXIS_COUNT];

    config = (struct steps_config){.form = form, .cycle_us = CYCLE_US, .axes = 63};
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        config.axis[i] = (struct steps_config_axis){1000.0, 200000.0, 0.05, 1000.0};
        drives[i] = (struct virtual_stepper_config){true, 1, 1e6};
    }
    virtual_steppers_init(&steppers, drives, CYCLE_NS);
    virtual_steppers_listen(&steppers, &(struct virtual_steppers_listener){note_pulse, NULL});
    port = virtual_steppers_get_port(&steppers);
    takt_steps_init(&steps, &config, &start);
    pulses.count = 0;
}

void setUp(void)
{
    begin(STEPS_EVEN);
}

void tearDown(void)
{
}

static bool cycle(const struct point *setpoint, const struct curve *curve, uint32_t number)
{
    bool good = takt_steps_cycle(&steps, &port, setpoint, curve, number);

    virtual_steppers_end_cycle(&steppers);
    return good;
}

static struct point at_x(double x_mm)
{
    return (struct point){{x_mm}};
}

static void test_a_setpoint_is_reported_three_cycles_later(void)
{
    struct point actual = {{0}};
    struct point to = at_x(0.1);

    for (unsigned k = 0; k < STEPS_LATENCY_CYCLES; k++) {
        takt_steps_get_actual(&steps, &actual);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, actual.at[AXIS_X]);
        TEST_ASSERT_TRUE(cycle(&to, NULL, 0));
    }
    takt_steps_get_actual(&steps, &actual);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.1, actual.at[AXIS_X]);
}

static void test_an_axis_of_constant_velocity_steps_evenly_over_all_cycles(void)
{
    /* 37.3 steps a cycle: no whole number of them fits into one. */
    for (unsigned k = 0; k < 200; k++) {
        struct point to = at_x(0.0373 * (double)k);

        TEST_ASSERT_TRUE(cycle(&to, NULL, 0));
    }
    for (unsigned i = 1; i < pulses.count; i++)
        TEST_ASSERT_INT_WITHIN(2, (int)(1e6 / 37.3),
                               (int)(pulses.time_ns[i] - pulses.time_ns[i - 1]));
    TEST_ASSERT_TRUE(pulses.count > 7000);
}

static void test_a_slow_axis_steps_evenly_too(void)
{
    /* 0.3 steps a cycle */
    for (unsigned k = 0; k < 2000; k++) {
        struct point to = at_x(0.0003 * (double)k);

        TEST_ASSERT_TRUE(cycle(&to, NULL, 0));
    }
    for (unsigned i = 1; i < pulses.count; i++)
        TEST_ASSERT_INT_WITHIN(2, (int)(1e6 / 0.3),
                               (int)(pulses.time_ns[i] - pulses.time_ns[i - 1]));
    TEST_ASSERT_EQUAL_UINT(600, pulses.count + 1);
}

/*
 * A curve at constant feed, the given one or the little less that ends on a cycle: which is
 * returned.
 */
static double run_curve(const struct curve *curve, double feed_mm_s, uint32_t number)
{
    unsigned cycles = (unsigned)takt_maths_ceil(curve->length_mm / (feed_mm_s * CYCLE_S));
    struct point to;

    for (unsigned k = 1; k < cycles; k++) {
        takt_curve_point(curve, curve->length_mm * (double)k / (double)cycles, &to);
        TEST_ASSERT_TRUE(cycle(&to, curve, number));
    }
    to = curve->end;
    for (unsigned k = 0; k < 2; k++)
        TEST_ASSERT_TRUE(cycle(&to, curve, number));
    return curve->length_mm / ((double)cycles * CYCLE_S);
}

/* The same without a stay at its end. */
static void pass_curve(const struct curve *curve, double feed_mm_s, uint32_t number)
{
    unsigned cycles = (unsigned)takt_maths_ceil(curve->length_mm / (feed_mm_s * CYCLE_S));
    struct point to;

    for (unsigned k = 1; k <= cycles; k++) {
        takt_curve_point(curve, curve->length_mm * ((double)k - 0.5) / (double)cycles, &to);
        TEST_ASSERT_TRUE(cycle(&to, curve, number));
    }
}

static void expect_at(const struct point *end)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        TEST_ASSERT_EQUAL_INT32((int32_t)takt_maths_round(end->at[i] * 1000.0),
                                steppers.axis[i].position_steps);
}

/* As if all had stood there at power-on. */
static void start_at(const struct point *start)
{
    takt_steps_init(&steps, &config, start);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        steppers.axis[i].position_steps = (int32_t)steps.at[i];
}

static struct curve circle(double radius_mm, double rise_mm)
{
    const double centre[2] = {0, 0};
    struct point start = {{radius_mm, 0, 0}}, end = {{radius_mm, 0, rise_mm}};
    struct curve curve;

    TEST_ASSERT_TRUE(takt_curve_set_arc(&curve, &start, &end, PLANE_XY, centre, false, 1));
    return curve;
}

/*
 * One tick of a circle is h / max(|cos|, |sin|) of path: that over the time to the next is the path
 * speed. The very first and last ticks, and the two beside each change of the leading axis, have no
 * such place.
 */
static double worst_speed(double radius_mm, double feed_mm_s)
{
    double worst = 0;
    double begin_ns = (double)pulses.time_ns[0];
    double angle_ns = feed_mm_s / radius_mm * 1e-9;
    double start = takt_maths_asin(0.5e-3 / radius_mm);

    for (unsigned i = 1; i < pulses.count; i++) {
        double dt_ns = (double)(pulses.time_ns[i] - pulses.time_ns[i - 1]);
        double angle = start + angle_ns * ((double)pulses.time_ns[i] - begin_ns - 0.5 * dt_ns);
        double leading =
            maths_max(maths_abs(takt_maths_sin(angle)), maths_abs(takt_maths_cos(angle)));

        worst = maths_max(worst, maths_abs(1e-3 / leading / (dt_ns * 1e-9) / feed_mm_s - 1.0));
    }
    return worst;
}

static void test_path_speed_along_a_circle_is_constant_within_1_percent(void)
{
    static const double radii[] = {0.5, 3.0, 10.0, 25.0};

    for (unsigned i = 0; i < sizeof radii / sizeof radii[0]; i++) {
        double feed = maths_min(30.0, maths_sqrt(1000.0 * radii[i]));
        struct curve curve = circle(radii[i], 0);
        double worst;

        begin(STEPS_IMPROVED);
        start_at(&curve.start);
        feed = run_curve(&curve, feed, 1);
        expect_at(&curve.end);
        worst = worst_speed(radii[i], feed);
        (void)printf("circle of %g mm: path speed off by at most %.2f %%\n", radii[i], 100 * worst);
        TEST_ASSERT_TRUE(worst < 0.01);
    }
}

static void test_at_a_constant_rate_path_speed_would_swing_by_root_2(void)
{
    struct evaluate_arc_config arc = {.start = {1000, 0}, .end = {-1000, 0}};
    struct evaluate_arc on;
    struct evaluate_tick tick;
    double lowest = 2, highest = 0;

    takt_evaluate_arc_begin(&on, &arc);
    do {
        lowest = maths_min(lowest, takt_evaluate_arc_rate(&on));
        highest = maths_max(highest, takt_evaluate_arc_rate(&on));
    } while (takt_evaluate_arc_next(&on, &tick));
    TEST_ASSERT_DOUBLE_WITHIN(0.002, maths_sqrt(2.0), highest / lowest);
}

/*
 * Distance of the stepped position from the setpoints' straight way, each time it changes: in
 * steps, per axis.
 */
static double worst_off(const struct point *from, const struct point *to, const int64_t at[],
                        double part)
{
    double worst = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double way = from->at[i] + (to->at[i] - from->at[i]) * part;

        worst = maths_max(worst, maths_abs((double)at[i] - 1000.0 * way));
    }
    return worst;
}

static uint64_t seed = 20;

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static void test_the_even_form_is_off_by_half_a_step_at_most(void)
{
    struct point from = {{0}}, to = {{0}}, next;
    int64_t before[AXIS_COUNT];

    for (unsigned k = 0; k < 3000; k++) {
        for (unsigned i = 0; i < AXIS_COUNT; i++)
            next.at[i] = to.at[i] + random_between(-0.02, 0.02);
        memcpy(before, steps.at, sizeof before);
        TEST_ASSERT_TRUE(cycle(&next, NULL, 0));
        TEST_ASSERT_TRUE(worst_off(&from, &to, before, 0.0) <= 0.5 + 1e-9);
        TEST_ASSERT_TRUE(worst_off(&from, &to, steps.at, 1.0) <= 0.5 + 1e-9);
        from = to;
        to = next;
    }
    TEST_ASSERT_EQUAL_UINT64(0, steppers.disordered);
}

static void run_line(struct point *at, uint32_t number, double feed_mm_s)
{
    struct point end = *at;
    struct curve line;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        end.at[i] += random_between(-3, 3);
    TEST_ASSERT_TRUE(takt_curve_set_line(&line, at, &end));
    (void)run_curve(&line, feed_mm_s, number);
    *at = end;
}

static void test_lines_by_evaluation_functions_end_exactly_and_miss_no_step(void)
{
    static const enum steps_form forms[] = {STEPS_IMPROVED, STEPS_PLAIN};

    for (unsigned f = 0; f < 2; f++) {
        struct point at = {{0}};

        begin(forms[f]);
        for (uint32_t n = 1; n <= 60; n++) {
            run_line(&at, n, random_between(1, 60));
            expect_at(&at);
        }
        for (unsigned i = 0; i < AXIS_COUNT; i++)
            TEST_ASSERT_EQUAL_UINT64(0, steppers.axis[i].missed);
        TEST_ASSERT_EQUAL_UINT64(0, steppers.disordered);
    }
}

/*
 * A chain of arcs and lines, passed at full feed: at their junctions a form has a step or two left
 * over.
 */
static void test_no_junction_asks_a_drive_for_more_than_its_rate(void)
{
    static const enum steps_form forms[] = {STEPS_EVEN, STEPS_IMPROVED, STEPS_PLAIN};

    for (unsigned f = 0; f < 3; f++) {
        struct point at = {{5, 0, 0}};

        begin(forms[f]);
        start_at(&at);
        for (uint32_t n = 1; n <= 200; n++) {
            const double centre[2] = {0, 0};
            struct point end = {{5, 0, 0.01 * n}};
            struct curve curve;

            takt_maths_sincos(0.3 * n, &end.at[AXIS_Y], &end.at[AXIS_X]);
            end.at[AXIS_X] *= 5;
            end.at[AXIS_Y] *= 5;
            TEST_ASSERT_TRUE(
                n % 3 == 0 ? takt_curve_set_line(&curve, &at, &end)
                           : takt_curve_set_arc(&curve, &at, &end, PLANE_XY, centre, false, 1));
            pass_curve(&curve, 60, n);
            at = end;
        }
        (void)cycle(&at, NULL, 0);
        (void)cycle(&at, NULL, 0);
        (void)cycle(&at, NULL, 0);
        expect_at(&at);
        for (unsigned i = 0; i < 3; i++) {
            TEST_ASSERT_EQUAL_UINT64(0, steppers.axis[i].missed);
            TEST_ASSERT_TRUE(steppers.axis[i].rate_peak_hz <= 200000.0);
        }
        TEST_ASSERT_EQUAL_UINT64(0, steppers.disordered);
    }
}

static void test_an_improved_line_takes_as_many_ticks_as_its_leading_axis_has_steps(void)
{
    struct point start = {{0}}, end = {{2.0, 1.3, -0.7}};
    struct curve line;

    begin(STEPS_IMPROVED);
    TEST_ASSERT_TRUE(takt_curve_set_line(&line, &start, &end));
    (void)run_curve(&line, 20, 1);
    TEST_ASSERT_EQUAL_UINT(2000, pulses.count);
    begin(STEPS_PLAIN);
    (void)run_curve(&line, 20, 1);
    TEST_ASSERT_EQUAL_UINT(4000, pulses.count);
}

static void test_helices_by_evaluation_functions_end_exactly(void)
{
    static const double rises[] = {0.1, 0.3, 1, 3, 9, 11, 12, 13, 14, 30};

    for (unsigned n = 0; n < sizeof rises / sizeof rises[0]; n++) {
        struct curve curve = circle(2.0, rises[n]);

        begin(STEPS_IMPROVED);
        start_at(&curve.start);
        (void)run_curve(&curve, 30, 1);
        expect_at(&curve.end);
    }
}

static void test_a_setpoint_beside_its_curve_is_followed_all_the_same(void)
{
    struct curve curve = circle(2.0, 0);
    struct point to = {{0}};

    begin(STEPS_IMPROVED);
    start_at(&curve.start);
    for (unsigned n = 0; n < 100; n++) {
        const double s = 0.03 * n;

        takt_curve_point(&curve, s, &to);
        to.at[AXIS_Z] += 0.1 * s; /* a correction */
        TEST_ASSERT_TRUE(cycle(&to, &curve, 1));
    }
    for (unsigned k = 0; k < 2; k++)
        TEST_ASSERT_TRUE(cycle(&to, &curve, 1));
    expect_at(&to);
}

static void test_a_setpoint_too_far_for_the_drive_is_an_error_that_names_axis_and_rate(void)
{
    struct point to = at_x(0.3); /* 300 steps in 1 ms; the drive takes 200,000 a second */

    TEST_ASSERT_TRUE(cycle(&to, NULL, 0));
    TEST_ASSERT_FALSE(cycle(&to, NULL, 0));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_STEP_RATE, takt_steps_get_fault(&steps)->code);
    TEST_ASSERT_EQUAL_STRING("X", takt_steps_get_fault(&steps)->word);
    TEST_ASSERT_DOUBLE_WITHIN(1, 300000, takt_steps_get_fault(&steps)->value);
    TEST_ASSERT_EQUAL_UINT(0, pulses.count);
}

static void test_what_is_no_position_is_an_error(void)
{
    struct point to = at_x(maths_sqrt(-1.0));

    (void)cycle(&to, NULL, 0);
    TEST_ASSERT_FALSE(cycle(&to, NULL, 0));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_RANGE, takt_steps_get_fault(&steps)->code);
}

static bool refuse(void *context, const struct step_pulse *pulse)
{
    (void)context;
    (void)pulse;
    return false;
}

static void test_an_output_without_room_is_an_error(void)
{
    struct step_port full = {refuse, NULL, NULL};
    struct point to = at_x(0.01);

    TEST_ASSERT_TRUE(takt_steps_cycle(&steps, &full, &to, NULL, 0));
    TEST_ASSERT_FALSE(takt_steps_cycle(&steps, &full, &to, NULL, 0));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_STEP_PORT, takt_steps_get_fault(&steps)->code);
}

static void test_missed_steps_are_seen_by_the_encoder(void)
{
    bool good = true;
    unsigned k = 0;

    steppers.axis[AXIS_X].config.rate_max_hz = 50000;
    for (; k < 200 && good; k++) {
        struct point to = at_x(0.06 * (double)k); /* 60,000 steps a second */

        good = cycle(&to, NULL, 0);
    }
    TEST_ASSERT_FALSE(good);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_DRIVE_FOLLOWING, takt_steps_get_fault(&steps)->code);
    TEST_ASSERT_TRUE(steppers.axis[AXIS_X].missed > 50);
    TEST_ASSERT_DOUBLE_WITHIN(100, 60000, steppers.axis[AXIS_X].rate_peak_hz);
}

static void test_after_a_fault_the_axes_brake_with_their_deceleration(void)
{
    uint64_t before;
    struct point to;

    for (unsigned k = 0; k <= 100; k++) {
        to = at_x(0.05 * (double)k); /* 50 mm/s */
        TEST_ASSERT_TRUE(cycle(&to, NULL, 0));
    }
    before = steppers.axis[AXIS_X].steps;
    for (unsigned k = 0; k < 100; k++) {
        takt_steps_brake(&steps, &port);
        virtual_steppers_end_cycle(&steppers);
    }
    /* v^2 / (2 a) = 1.25 mm, less half a cycle's way */
    TEST_ASSERT_INT_WITHIN(2, 1225, (int)(steppers.axis[AXIS_X].steps - before));
    TEST_ASSERT_EQUAL_UINT64(0, steppers.axis[AXIS_X].missed);
}

static void test_after_a_restart_the_axes_are_where_their_encoders_say(void)
{
    struct point actual = {{0}};

    steppers.axis[AXIS_Y].position_steps = 123;
    takt_steps_brake(&steps, &port);
    takt_steps_restart(&steps);
    takt_steps_get_actual(&steps, &actual);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.123, actual.at[AXIS_Y]);
    TEST_ASSERT_TRUE(cycle(&actual, NULL, 0));
    TEST_ASSERT_TRUE(cycle(&actual, NULL, 0));
    TEST_ASSERT_EQUAL_UINT(0, pulses.count);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_setpoint_is_reported_three_cycles_later);
    RUN_TEST(test_an_axis_of_constant_velocity_steps_evenly_over_all_cycles);
    RUN_TEST(test_a_slow_axis_steps_evenly_too);
    RUN_TEST(test_path_speed_along_a_circle_is_constant_within_1_percent);
    RUN_TEST(test_at_a_constant_rate_path_speed_would_swing_by_root_2);
    RUN_TEST(test_the_even_form_is_off_by_half_a_step_at_most);
    RUN_TEST(test_lines_by_evaluation_functions_end_exactly_and_miss_no_step);
    RUN_TEST(test_no_junction_asks_a_drive_for_more_than_its_rate);
    RUN_TEST(test_an_improved_line_takes_as_many_ticks_as_its_leading_axis_has_steps);
    RUN_TEST(test_helices_by_evaluation_functions_end_exactly);
    RUN_TEST(test_a_setpoint_beside_its_curve_is_followed_all_the_same);
    RUN_TEST(test_a_setpoint_too_far_for_the_drive_is_an_error_that_names_axis_and_rate);
    RUN_TEST(test_what_is_no_position_is_an_error);
    RUN_TEST(test_an_output_without_room_is_an_error);
    RUN_TEST(test_missed_steps_are_seen_by_the_encoder);
    RUN_TEST(test_after_a_fault_the_axes_brake_with_their_deceleration);
    RUN_TEST(test_after_a_restart_the_axes_are_where_their_encoders_say);
    return UNITY_END();
}

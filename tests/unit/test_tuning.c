/* What a motor moves, from a record that a closed form makes; and gains for it. */
#include "base/maths.h"
#include "tuning/gains.h"
#include "tuning/loop_model.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define CYCLE_S 1e-3
#define LEAD    (10 / MATHS_TWO_PI) /* mm per radian */
#define CYCLES  1200
#define HALF    12 /* cycles until the torque turns round */

static struct tuning_record record;
static struct tuning_plant plant;

void setUp(void)
{
    record = (struct tuning_record){.cycle_s = CYCLE_S};
}

void tearDown(void)
{
    tuning_record_free(&record);
}

static double torque_at(double t)
{
    const long half = (long)floor(t / (HALF * CYCLE_S) + 0.5);

    return t < 0 ? 0 : half % 2 == 0 ? 0.5 : -0.5;
}

/*
 * x'' = h/J (M(t - D) - g - c sign x') - b/J x' in steps so fine that they do not show: v goes by
 * exp over each, which has one torque.
 */
static void make(double inertia, double viscous, double dry, double weight, double delay_s)
{
    const unsigned fine = 200;
    const double dt = CYCLE_S / fine, f = viscous / inertia;
    double x = 3, v = 0;

    for (unsigned k = 0; k < CYCLES; k++) {
        tuning_record_add(&record, torque_at(k * CYCLE_S), x);
        for (unsigned i = 0; i < fine; i++) {
            const double t = (k + (i + 0.5) / fine) * CYCLE_S - delay_s;
            const double held = floor(t / CYCLE_S) * CYCLE_S + CYCLE_S / 2;
            const double torque =
                (t < 0 ? 0 : torque_at(held - CYCLE_S / 2)) - weight - copysign(dry, v);
            const double a = LEAD * torque / inertia;
            const double e = exp(-f * dt), w = f > 0 ? (1 - e) / f : dt;

            x += v * w + (f > 0 ? a * (dt - w) / f : a * dt * dt / 2);
            v = v * e + a * w;
        }
    }
    TEST_ASSERT_FALSE(record.failed);
}

static void expect(double inertia, double viscous, double dry, double weight, double delay_s)
{
    TEST_ASSERT_TRUE(tuning_identify(&record, LEAD, &plant));
    TEST_ASSERT_DOUBLE_WITHIN(5e-3 * inertia, inertia, plant.inertia_kg_m2);
    TEST_ASSERT_DOUBLE_WITHIN(2e-5, delay_s, plant.delay_s);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, dry, plant.dry_nm);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, weight, plant.weight_nm);
    TEST_ASSERT_DOUBLE_WITHIN(0.1 * viscous + 2e-4, viscous, plant.viscous_nm_s_per_rad);
}

static void test_a_bare_inertia_is_found_with_its_delay(void)
{
    make(3e-4, 0, 0, 0, 0);
    expect(3e-4, 0, 0, 0, 0);
    tearDown();
    make(6e-3, 0, 0, 0, 3.3e-3);
    expect(6e-3, 0, 0, 0, 3.3e-3);
}

static void test_friction_and_weight_are_told_apart(void)
{
    make(1e-3, 5e-3, 0.06, 0.02, 1.7e-3);
    expect(1e-3, 5e-3, 0.06, 0.02, 1.7e-3);
}

/*
 * Readings in steps of a thirtieth of the way: the deviation that is told is not smaller than what
 * it is off by, times three.
 */
static void test_readings_in_steps_are_less_sure_and_say_so(void)
{
    make(1e-3, 0, 0, 0, 1e-3);
    record.step = 5e-4;
    for (size_t k = 0; k < record.count; k++)
        record.position[k] = record.step * round(record.position[k] / record.step);
    TEST_ASSERT_TRUE(tuning_identify(&record, LEAD, &plant));
    TEST_ASSERT_TRUE(plant.inertia_deviation_kg_m2 > 0);
    TEST_ASSERT_DOUBLE_WITHIN(3 * plant.inertia_deviation_kg_m2, 1e-3, plant.inertia_kg_m2);
}

static void test_what_is_no_answer_to_the_torque_is_refused(void)
{
    make(1e-3, 0, 0, 0, 0);
    for (size_t k = 0; k < record.count; k++)
        record.position[k] = -record.position[k]; /* it goes the other way */
    TEST_ASSERT_FALSE(tuning_identify(&record, LEAD, &plant));
    for (size_t k = 0; k < record.count; k++)
        record.position[k] = 5; /* jammed */
    TEST_ASSERT_FALSE(tuning_identify(&record, LEAD, &plant));
    record.count = 10;
    TEST_ASSERT_FALSE(tuning_identify(&record, LEAD, &plant));
}

static const struct tuning_drive drive = {
    .step_s = 250e-6, .torque_rated_nm = 1.27, .bandwidth_max_hz = 1e6};

/*
 * P alone on an inertia: L = Kp e^(-sT)/s has the margin 90 degrees - Kp T; Kv << Kp leaves 90
 * degrees of it, but for Kv (1/Kp + T).
 */
static void test_margins_are_those_of_the_closed_form(void)
{
    const struct tuning_plant bare = {
        .travel_per_rad = LEAD, .inertia_kg_m2 = 1e-3, .delay_s = 750e-6};
    const struct tuning_gains gains = {.told_inertia_kg_m2 = 2e-3,
                                       .velocity_bandwidth_hz = 100 / MATHS_TWO_PI,
                                       .position_gain_per_s = 1};
    struct tuning_margins margins;

    tuning_margins_of(&bare, &drive, &gains, &margins);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 90 - 200 * 1e-3 * 180 / MATHS_PI, margins.velocity_phase_deg);
    TEST_ASSERT_DOUBLE_WITHIN(0.5, 90 - (1 / 200.0) * 180 / MATHS_PI, margins.position_phase_deg);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, margins.overshoot);
}

/*
 * Fast loops and P alone: x'' = Kp (Kv (1 - x) - x'), damping d = sqrt(Kp / Kv) / 2: it overshoots
 * by exp(-pi d / sqrt(1 - d^2)).
 */
static void test_the_model_overshoots_as_an_oscillator_of_second_order(void)
{
    const struct tuning_plant bare = {
        .travel_per_rad = LEAD, .inertia_kg_m2 = 1e-3, .delay_s = -5e-6};
    const struct tuning_drive fast = {.step_s = 1e-5};
    const double kp = 20, kv = 20, d = sqrt(kp / kv) / 2;
    const struct tuning_gains gains = {.told_inertia_kg_m2 = 1e-3,
                                       .velocity_bandwidth_hz = kp / MATHS_TWO_PI,
                                       .position_gain_per_s = kv};

    TEST_ASSERT_DOUBLE_WITHIN(1e-3, exp(-MATHS_PI * d / sqrt(1 - d * d)),
                              loop_model_overshoot(&bare, &fast, &gains));
}

static void test_gains_that_are_unstable_are_seen(void)
{
    const struct tuning_plant late = {
        .travel_per_rad = LEAD, .inertia_kg_m2 = 1e-3, .delay_s = 3e-3};
    const struct tuning_gains gains = {.told_inertia_kg_m2 = 1e-3,
                                       .velocity_bandwidth_hz = 120,
                                       .velocity_integral_s = 0.02,
                                       .position_gain_per_s = 20};
    struct tuning_margins margins;

    tuning_margins_of(&late, &drive, &gains, &margins);
    TEST_ASSERT_TRUE(margins.velocity_phase_deg < 0);
    TEST_ASSERT_TRUE(isinf(margins.overshoot));
    TEST_ASSERT_FALSE(tuning_margins_are_good(&margins));
}

/*
 * Over inertias, delays and frictions: what is found keeps what is promised, and is the faster the
 * less late the torque is.
 */
static void test_gains_that_are_found_keep_the_promise(void)
{
    static const double delays_s[] = {1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3};
    static const double viscous[] = {0, 1e-4, 1e-3, 1e-2, 0.1};
    const size_t delays = sizeof delays_s / sizeof delays_s[0];
    double before = MATHS_INFINITY;

    for (size_t i = 0; i < delays * sizeof viscous / sizeof viscous[0]; i++) {
        const struct tuning_plant any = {.travel_per_rad = LEAD,
                                         .inertia_kg_m2 = 5e-4,
                                         .viscous_nm_s_per_rad = viscous[i / delays],
                                         .delay_s = delays_s[i % delays]};
        struct tuning_gains gains;
        struct tuning_margins margins;

        TEST_ASSERT_TRUE(tuning_find_gains(&any, &drive, &gains));
        tuning_margins_of(&any, &drive, &gains, &margins);
        TEST_ASSERT_TRUE(tuning_margins_are_good(&margins));
        TEST_ASSERT_TRUE(i >= delays || gains.position_gain_per_s < before);
        before = gains.position_gain_per_s;
    }
}

/* One step of the encoder between two readings asks for the rated torque and no more. */
static void test_a_coarse_encoder_bounds_the_gain(void)
{
    const struct tuning_plant bare = {
        .travel_per_rad = LEAD, .inertia_kg_m2 = 1e-3, .delay_s = 1e-4};
    struct tuning_drive coarse = drive;
    struct tuning_gains gains;

    coarse.position_step = 0.005;
    TEST_ASSERT_TRUE(tuning_find_gains(&bare, &coarse, &gains));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, LEAD * 1.27 / 1e-3,
                              MATHS_TWO_PI * gains.velocity_bandwidth_hz * 0.005 / 250e-6);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_bare_inertia_is_found_with_its_delay);
    RUN_TEST(test_friction_and_weight_are_told_apart);
    RUN_TEST(test_readings_in_steps_are_less_sure_and_say_so);
    RUN_TEST(test_what_is_no_answer_to_the_torque_is_refused);
    RUN_TEST(test_margins_are_those_of_the_closed_form);
    RUN_TEST(test_the_model_overshoots_as_an_oscillator_of_second_order);
    RUN_TEST(test_gains_that_are_unstable_are_seen);
    RUN_TEST(test_gains_that_are_found_keep_the_promise);
    RUN_TEST(test_a_coarse_encoder_bounds_the_gain);
    return UNITY_END();
}

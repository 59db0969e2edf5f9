/* Which arcs are stepped by evaluation functions, and which evenly. */
#include "base/maths.h"
#include "step/steps.h"
#include "stepper/virtual_steppers.h"
#include "unity.h"

#define CYCLE_US 1000
#define CYCLE_NS 1000000
#define CYCLES   200

static struct virtual_steppers steppers;
static struct step_port port;
static struct steps steps;
static struct steps_config config;

void setUp(void)
{
    config = (struct steps_config){.form = STEPS_IMPROVED, .cycle_us = CYCLE_US, .axes = 3};
    for (unsigned i = 0; i < 2; i++)
        config.axis[i] = (struct steps_config_axis){1000.0, 200000.0, 0.0, 1000.0};
}

void tearDown(void)
{
}

static void start_at(const struct point *start)
{
    struct virtual_stepper_config drives[AXIS_COUNT];

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        drives[i] = (struct virtual_stepper_config){true, 1, 1e6};
    virtual_steppers_init(&steppers, drives, CYCLE_NS);
    port = virtual_steppers_get_port(&steppers);
    takt_steps_init(&steps, &config, start);
}

/* The farthest that an axis is from its setpoint at the end of a cycle, in steps. */
static double farthest_off(const struct point *set)
{
    double farthest = 0.0;

    for (unsigned i = 0; i < 2; i++) {
        const double off = set->at[i] * config.axis[i].steps_per_mm - (double)steps.at[i];

        farthest = maths_max(farthest, maths_abs(off));
    }
    return farthest;
}

/* Along a quarter of a turn around 0. Steps are those of the setpoint before. */
static double run_quarter(void)
{
    const double centre_mm[2] = {0.0, 0.0};
    const struct point start = {{2.0, 0.0}};
    const struct point end = {{0.0, 2.0}};
    struct point before = start;
    struct curve curve;
    double farthest = 0.0;

    TEST_ASSERT_TRUE(takt_curve_set_arc(&curve, &start, &end, PLANE_XY, centre_mm, false, 1));
    start_at(&start);
    for (unsigned k = 1; k <= CYCLES; k++) {
        struct point to;

        takt_curve_point(&curve, curve.length_mm * k / CYCLES, &to);
        TEST_ASSERT_TRUE(takt_steps_cycle(&steps, &port, &to, &curve, 1));
        virtual_steppers_end_cycle(&steppers);
        farthest = maths_max(farthest, farthest_off(&before));
        before = to;
    }
    return farthest;
}

/*
 * By an evaluation function an axis is off by a step and what is rounded; evenly stepped, by half a
 * step.
 */
static void test_a_circle_is_stepped_by_its_evaluation_function(void)
{
    const double off = run_quarter();

    TEST_ASSERT_TRUE(off > 0.51 && off < 2.0);
}

static void test_an_arc_in_axes_of_different_steps_is_stepped_evenly(void)
{
    config.axis[AXIS_Y].steps_per_mm = 800.0;
    TEST_ASSERT_TRUE(run_quarter() < 0.51);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_circle_is_stepped_by_its_evaluation_function);
    RUN_TEST(test_an_arc_in_axes_of_different_steps_is_stepped_evenly);
    return UNITY_END();
}

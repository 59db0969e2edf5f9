/*
 * The figures of the page (seed 001) to the digits it gives, and the laws behind them.
 */
#include "base/maths.h"
#include "bore/job.h"

#include <string.h>
#include <unity.h>

static struct bore_job job;
static struct bore_spiral spiral;
static struct bore_form form;

/* The page's hole: diameter 200, cutter 40, largest radial step 4, allowance 1. */
void setUp(void)
{
    job = (struct bore_job){
        .pass = BORE_ROUGHING,
        .hole_mm = 200,
        .cutter_mm = 40,
        .step_mm = 4,
        .allowance_mm = 1,
        .turns = 1,
        .height_mm = 2,
        .feed_mm_min = 1000,
        .plunge_mm_min = 300,
        .tolerance_mm = 0.01,
    };
}

void tearDown(void)
{
}

static void set_finishing(void)
{
    job.pass = BORE_FINISHING;
    job.allowance_mm = 0;
    job.turns = 2;
    job.start_mm[0] = -40;
    job.start_mm[1] = 40;
    bore_set_spiral(&job, BORE_FINISHING, &spiral);
    bore_spiral_form(&spiral, &form);
}

static void test_roughing_has_the_figures_of_the_page(void)
{
    bore_set_spiral(&job, BORE_ROUGHING, &spiral);
    TEST_ASSERT_EQUAL_DOUBLE(79.0, spiral.radius_mm);
    TEST_ASSERT_EQUAL_DOUBLE(20.0, spiral.turns);
    TEST_ASSERT_EQUAL_DOUBLE(3.95, spiral.radius_mm / spiral.turns);
    TEST_ASSERT_DOUBLE_WITHIN(5e-10, 0.628662025, spiral.base_mm);
    TEST_ASSERT_DOUBLE_WITHIN(5e-6, 4963.71639, bore_spiral_length(&spiral));
    TEST_ASSERT_DOUBLE_WITHIN(5e-7, 496.371639, MATHS_TWO_PI * spiral.radius_mm);
}

/* The page's 9.04482 is 5e-6 from the angle that its own length, 242.24973, belongs to. */
static void test_finishing_has_the_figures_of_the_page(void)
{
    double junction[2];

    set_finishing();
    TEST_ASSERT_EQUAL_DOUBLE(80.0, spiral.radius_mm);
    TEST_ASSERT_DOUBLE_WITHIN(5e-10, 6.366197724, spiral.base_mm);
    TEST_ASSERT_DOUBLE_WITHIN(6e-6, 9.04482, spiral.start_rad);
    TEST_ASSERT_DOUBLE_WITHIN(5e-6, 242.24973, form.length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(6e-6, 502.65483, MATHS_TWO_PI * spiral.radius_mm);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, 57.5811, form.radius_start_mm);
    TEST_ASSERT_EQUAL_DOUBLE(80.0, form.radius_end_mm);
    TEST_ASSERT_DOUBLE_WITHIN(5e-6, 0.94657, spiral.turned_rad);
    bore_spiral_point(&spiral, MATHS_TWO_PI * spiral.turns, junction);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, 64.9131, junction[0]);
    TEST_ASSERT_DOUBLE_WITHIN(5e-5, -46.7577, junction[1]);
}

static void test_the_spiral_begins_at_the_point_asked_for(void)
{
    set_finishing();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, -40.0, form.start_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 40.0, form.start_mm[1]);
}

static void test_six_numbers_tell_the_base_circle_and_the_start(void)
{
    set_finishing();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, spiral.base_mm, bore_form_base(&form));
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, spiral.start_rad, bore_form_unrolled(&form));
}

static void test_a_start_radius_and_a_length_give_the_same_spiral_as_the_point(void)
{
    struct bore_spiral other;

    set_finishing();
    other = spiral;
    bore_spiral_begin_radius(&other, form.radius_start_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, spiral.start_rad, other.start_rad);
    bore_spiral_begin_length(&other, form.length_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, spiral.start_rad, other.start_rad);
}

static void test_the_start_may_be_in_any_direction(void)
{
    set_finishing();
    for (int i = 0; i < 24; i++) {
        const double angle = i * MATHS_PI / 12.0;
        double p[2];

        job.start_mm[0] = 33.0 * takt_maths_cos(angle);
        job.start_mm[1] = 33.0 * takt_maths_sin(angle);
        bore_set_spiral(&job, BORE_FINISHING, &spiral);
        bore_spiral_point(&spiral, spiral.start_rad, p);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, job.start_mm[0], p[0]);
        TEST_ASSERT_DOUBLE_WITHIN(1e-12, job.start_mm[1], p[1]);
    }
}

static void test_at_the_centre_the_spiral_is_whole(void)
{
    set_finishing();
    job.start_mm[0] = job.start_mm[1] = 0;
    bore_set_spiral(&job, BORE_FINISHING, &spiral);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, spiral.start_rad);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, spiral.turned_rad);
}

static void test_roughing_begins_where_it_is_told(void)
{
    double p[2];

    job.start_mm[0] = 30.0;
    job.start_mm[1] = 40.0;
    bore_set_spiral(&job, BORE_ROUGHING, &spiral);
    bore_spiral_point(&spiral, spiral.start_rad, p);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 30.0, p[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 40.0, p[1]);
    job.pass = BORE_BOTH; /* the start is that of finishing then */
    job.turns = 1;
    bore_set_spiral(&job, BORE_ROUGHING, &spiral);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, spiral.start_rad);
}

static void test_the_direction_turns_the_whole_spiral(void)
{
    double p[2];

    job.direction_rad = MATHS_HALF_PI;
    bore_set_spiral(&job, BORE_ROUGHING, &spiral);
    bore_spiral_point(&spiral, MATHS_TWO_PI * spiral.turns, p);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, spiral.radius_mm, p[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.0, p[1]);
}

static void expect_problem(const char *said)
{
    const char *problem = bore_check(&job);

    TEST_ASSERT_NOT_NULL_MESSAGE(problem, said);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(problem, said), problem);
    setUp();
}

static void test_bad_jobs_are_refused_with_the_value_that_is_wrong(void)
{
    TEST_ASSERT_NULL(bore_check(&job));
    job.hole_mm = 0;
    expect_problem("the hole's diameter is 0 mm");
    job.cutter_mm = -3;
    expect_problem("the cutter's diameter is -3 mm");
    job.cutter_mm = 200;
    expect_problem("the cutter of 200 mm is not smaller than the hole of 200 mm");
    job.step_mm = 0;
    expect_problem("the radial step is 0 mm");
    job.step_mm = 1e-6;
    expect_problem("turns: more than");
    job.allowance_mm = -1;
    expect_problem("the allowance is -1 mm");
    job.allowance_mm = 80;
    expect_problem("the allowance of 80 mm leaves nothing");
    job.pass = BORE_FINISHING;
    job.start_mm[0] = 79;
    expect_problem("the start 79,0 is 79 mm from the hole's centre");
    job.pass = BORE_FINISHING;
    job.turns = 0;
    expect_problem("the approach makes 0 turns");
    job.pass = BORE_FINISHING;
    job.begin = BORE_AT_RADIUS;
    job.start_radius_mm = 79;
    expect_problem("the spiral begins with a radius of 79 mm");
    job.pass = BORE_FINISHING;
    job.begin = BORE_AT_LENGTH;
    job.start_length_mm = 300;
    expect_problem("the spiral is 300 mm long");
    job.depth_mm = -1;
    expect_problem("the depth is -1 mm");
    job.depth_mm = 1;
    job.depth_step_mm = 1e-9;
    expect_problem("the depth step of 1e-09 mm makes more than");
    job.feed_mm_min = 0;
    expect_problem("the feed is 0 mm/min");
    job.plunge_mm_min = -5;
    expect_problem("the feed down is -5 mm/min");
    job.spindle_rpm = -5;
    expect_problem("the spindle's speed is -5 rpm");
    job.as = BORE_AS_ARCS;
    job.tolerance_mm = 0;
    expect_problem("the tolerance is 0 mm");
}

static void test_with_both_passes_the_allowance_is_only_roughings(void)
{
    struct bore_spiral rough;

    job.pass = BORE_BOTH;
    bore_set_spiral(&job, BORE_ROUGHING, &rough);
    bore_set_spiral(&job, BORE_FINISHING, &spiral);
    TEST_ASSERT_EQUAL_DOUBLE(79.0, rough.radius_mm);
    TEST_ASSERT_EQUAL_DOUBLE(80.0, spiral.radius_mm);
}

static void test_the_depth_is_reached_in_equal_steps(void)
{
    job.depth_mm = 20;
    TEST_ASSERT_EQUAL_UINT(1, bore_depth_steps(&job));
    job.depth_step_mm = 5;
    TEST_ASSERT_EQUAL_UINT(4, bore_depth_steps(&job));
    job.depth_step_mm = 6;
    TEST_ASSERT_EQUAL_UINT(4, bore_depth_steps(&job));
    job.depth_mm = 0.3; /* 3 x 0.1 but for rounding */
    job.depth_step_mm = 0.1;
    TEST_ASSERT_EQUAL_UINT(3, bore_depth_steps(&job));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_roughing_has_the_figures_of_the_page);
    RUN_TEST(test_finishing_has_the_figures_of_the_page);
    RUN_TEST(test_the_spiral_begins_at_the_point_asked_for);
    RUN_TEST(test_six_numbers_tell_the_base_circle_and_the_start);
    RUN_TEST(test_a_start_radius_and_a_length_give_the_same_spiral_as_the_point);
    RUN_TEST(test_the_start_may_be_in_any_direction);
    RUN_TEST(test_at_the_centre_the_spiral_is_whole);
    RUN_TEST(test_roughing_begins_where_it_is_told);
    RUN_TEST(test_the_direction_turns_the_whole_spiral);
    RUN_TEST(test_bad_jobs_are_refused_with_the_value_that_is_wrong);
    RUN_TEST(test_with_both_passes_the_allowance_is_only_roughings);
    RUN_TEST(test_the_depth_is_reached_in_equal_steps);
    return UNITY_END();
}

/* The averaging window of a span. */
#include "plan/span.h"

#include "plan_along_x.h"

#include <string.h>
#include <unity.h>

static struct ceiling ceiling;
static struct ceiling_request request;

void setUp(void)
{
    begin_path();
    request = (struct ceiling_request){.reference = path.position,
                                       .span = path.position - 1,
                                       .feed_ratio = 1.0,
                                       .rapid_ratio = 1.0};
}

void tearDown(void)
{
}

static void push_dwell(void)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_DWELL;
    takt_path_push(&path, &m);
}

static bool known;

static uint32_t cycles_of_first(void)
{
    return takt_span_window(&path, &request, 0, &known);
}

static void test_a_long_fast_span_has_the_window_of_full_acceleration(void)
{
    push(100.0, 100.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(20, cycles_of_first());
}

/* A ramp to F needs no more than sqrt(F / J) = sqrt(5 / 50,000) = 10 ms. */
static void test_a_slow_span_has_the_window_of_its_ramp(void)
{
    push(100.0, 5.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(10, cycles_of_first());
}

static uint32_t cycles_by(enum ramp_profile profile, double length_mm, double feed_mm_s)
{
    const struct point start = {{0}};
    struct plan_limits other = limits;

    x_mm = 0.0;
    other.profile = profile;
    takt_path_init(&path, &other, &start);
    push(length_mm, feed_mm_s);
    takt_path_finish(&path);
    return cycles_of_first();
}

/*
 * Boxes that take 1.5 or twice as long as their first: sqrt(F / wJ) to a feed F, cbrt(L / 2Jw^2)
 * from rest to rest over L.
 */
static void test_by_a_profile_of_more_boxes_the_first_is_shorter(void)
{
    TEST_ASSERT_EQUAL(9, cycles_by(RAMP_PROFILE_SMOOTH, 100.0, 5.0));
    TEST_ASSERT_EQUAL(8, cycles_by(RAMP_PROFILE_GENTLE, 100.0, 5.0));
    TEST_ASSERT_EQUAL(16, cycles_by(RAMP_PROFILE_JERK, 0.4, 100.0));
    TEST_ASSERT_EQUAL(13, cycles_by(RAMP_PROFILE_SMOOTH, 0.4, 100.0));
    TEST_ASSERT_EQUAL(10, cycles_by(RAMP_PROFILE_GENTLE, 0.4, 100.0));
}

/*
 * A slow end is come to earlier by half a window at its feed: here 0.7 of the longest window is the
 * fastest.
 */
static void test_a_slow_block_at_the_end_asks_for_a_shorter_window(void)
{
    push(0.5, 50.0);
    push(2.0, 10.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(14, cycles_of_first());
}

/*
 * From rest up through ever faster parts: with the end in sight, a stop, a shorter window would do.
 */
static void test_a_span_whose_end_is_out_of_sight_has_the_longest_window(void)
{
    for (int i = 0; i < 60; i++) {
        push(0.1, 5.0 + i);
    }
    TEST_ASSERT_EQUAL(20, cycles_of_first());
}

static void test_the_override_does_not_change_the_window(void)
{
    push(2.0, 60.0);
    push(1.0, 5.0);
    takt_path_finish(&path);
    const uint32_t cycles = cycles_of_first();

    request.feed_ratio = 0.3;
    TEST_ASSERT_EQUAL(cycles, cycles_of_first());
}

static void test_a_window_is_known_when_the_end_of_the_span_is(void)
{
    push(100.0, 100.0);
    push(100.0, 100.0);
    (void)cycles_of_first();
    TEST_ASSERT_FALSE(known);
    push_dwell();
    (void)cycles_of_first();
    TEST_ASSERT_TRUE(known);
}

/*
 * The window that a ceiling was made with is kept when more of the span is seen, by a trapezoidal
 * reference close to it.
 */
static void test_a_window_once_promised_is_kept_close_by(void)
{
    push(0.5, 50.0);
    push(1.0, 10.0);
    push(1.0, 10.0);
    takt_ceiling_build(&ceiling, &path, &request);
    const uint32_t cycles = path_at(&path, 0)->cycles;

    takt_path_finish(&path);
    TEST_ASSERT_TRUE(cycles_of_first() != cycles);
    takt_ceiling_build(&ceiling, &path, &request);
    TEST_ASSERT_EQUAL(cycles, path_at(&path, 0)->cycles);
}

/* Each part another feed, more of them than are looked at: no part is written beyond the last. */
static void test_a_span_of_many_parts_has_a_window(void)
{
    for (int i = 0; i < 200; i++) {
        push(0.5 + 0.001 * i, 10.0 + i % 60);
    }
    takt_path_finish(&path);
    TEST_ASSERT_TRUE(cycles_of_first() >= 5 && cycles_of_first() <= 20);
}

/*
 * To a stop at 0.02 mm 6 cycles are the longest of use. The trapezoidal reference is half a window
 * ahead: to leave at 50 mm/s it goes 0.02 mm + 0.05 (N - 1)/2 from rest by J N, which takes 31.1,
 * 30.8, 30.6 and 30 cycles for N = 6, 4, 3 and 2.
 */
static void test_a_short_block_that_is_left_in_motion_has_a_shorter_window_than_to_a_stop(void)
{
    const struct point start = {{0}};
    struct plan_limits landing = limits;

    landing.landing = LANDING_BLOCK;
    takt_path_init(&path, &landing, &start);
    push(0.02, 50.0);
    push(5.0, 50.0);
    takt_path_finish(&path);
    TEST_ASSERT_TRUE(takt_span_lands(&path, 0));
    TEST_ASSERT_EQUAL(2, cycles_of_first());
    begin_path();
    push(0.02, 50.0);
    takt_path_finish(&path);
    TEST_ASSERT_EQUAL(6, cycles_of_first());
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_long_fast_span_has_the_window_of_full_acceleration);
    RUN_TEST(test_a_slow_span_has_the_window_of_its_ramp);
    RUN_TEST(test_by_a_profile_of_more_boxes_the_first_is_shorter);
    RUN_TEST(test_a_slow_block_at_the_end_asks_for_a_shorter_window);
    RUN_TEST(test_a_span_whose_end_is_out_of_sight_has_the_longest_window);
    RUN_TEST(test_the_override_does_not_change_the_window);
    RUN_TEST(test_a_window_is_known_when_the_end_of_the_span_is);
    RUN_TEST(test_a_window_once_promised_is_kept_close_by);
    RUN_TEST(test_a_span_of_many_parts_has_a_window);
    RUN_TEST(test_a_short_block_that_is_left_in_motion_has_a_shorter_window_than_to_a_stop);
    return UNITY_END();
}

/* Samples of a window at another pace: the curve stays where it was, in every axis. */
#include "smooth/timing.h"

#include <string.h>
#include <unity.h>

#define COUNT      30
#define INTERVAL_S 4e-3

static struct route route;
static struct window window;
static struct timing timing;

/* Six axes of equal limits: more than one operation works at. */
void setUp(void)
{
    struct smooth_limits limits = {.axes = 63, .chord_error_max_mm = 1e-3, .cycle_s = 1e-3};

    for (int i = 0; i < AXIS_COUNT; i++) {
        limits.velocity_mm_s[i] = 100.0;
        limits.acceleration_mm_s2[i] = 1000.0;
        limits.jerk_mm_s3[i] = 50000.0;
    }
    takt_route_init(&route, &limits, 0.01);
    takt_window_init(&window, &route, INTERVAL_S);
}

void tearDown(void)
{
}

static void put_sample(const int32_t at[], unsigned count)
{
    struct window_spot spot;

    memset(&spot, 0, sizeof(spot));
    memcpy(spot.at, at, count * sizeof(at[0]));
    takt_window_set(&window, &route, window.count, &spot);
    window.element[window.count] = 0;
    window.at_mm[window.count++] = 0.0;
}

static void test_axes_that_move_alike_are_sampled_alike(void)
{
    for (int32_t i = 0; i < COUNT; i++) {
        const int32_t straight = 1000 * i;
        const int32_t curved = 100 * i * i;

        put_sample((const int32_t[]){straight, curved, 0, straight, curved, 0}, 6);
    }
    takt_timing_slow(&timing, &window, &route, COUNT / 2);
    TEST_ASSERT_GREATER_THAN_UINT(COUNT / 2, window.count);
    for (unsigned i = 0; i < window.count; i++) {
        for (unsigned slot = 0; slot < 3; slot++) {
            TEST_ASSERT_EQUAL_INT32(window_x(&window, slot, i), window_x(&window, slot + 3, i));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_axes_that_move_alike_are_sampled_alike);
    return UNITY_END();
}

#include "report/thin.h"

#include "unity.h"

#include <math.h>
#include <stdlib.h>

static struct thin thin;
static struct thin_point point[THIN_POINTS_MAX];

void setUp(void)
{
    TEST_ASSERT_TRUE(thin_open(&thin, 2));
}

void tearDown(void)
{
    thin_close(&thin);
}

/* xorshift32: the same numbers everywhere. */
static uint32_t next_random(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static float *random_series(uint32_t count, uint32_t seed)
{
    float *value = malloc(count * sizeof *value);
    TEST_ASSERT_NOT_NULL(value);
    for (uint32_t k = 0; k < count; k++)
        value[k] = (float)(next_random(&seed) % 20001u) - 10000.0F;
    return value;
}

static void add_all(const float *value, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++)
        thin_add(&thin, k, (const float[]){value[k], -value[k]});
}

static void test_a_short_run_is_kept_whole(void)
{
    const uint32_t count = THIN_BUCKETS_MAX - 1;
    float *value = random_series(count, 1);
    add_all(value, count);
    TEST_ASSERT_EQUAL_UINT(count, thin_get_points(&thin, 0, point));
    for (uint32_t k = 0; k < count; k++) {
        TEST_ASSERT_EQUAL_UINT32(k, point[k].cycle);
        TEST_ASSERT_EQUAL_FLOAT(value[k], point[k].value);
    }
    free(value);
}

static void test_points_are_values_of_the_run_in_order_of_time(void)
{
    const uint32_t count = 1000003;
    float *value = random_series(count, 2);
    add_all(value, count);
    const unsigned points = thin_get_points(&thin, 0, point);
    for (unsigned i = 0; i < points; i++) {
        TEST_ASSERT_TRUE(i == 0 || point[i].cycle > point[i - 1].cycle);
        TEST_ASSERT_EQUAL_FLOAT(value[point[i].cycle], point[i].value);
    }
    free(value);
}

/* Extremes of the kept points whose cycles lie in one bucket. */
static void find_kept(unsigned points, uint32_t first, uint32_t after, float *low, float *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (unsigned i = 0; i < points; i++) {
        if (point[i].cycle < first || point[i].cycle >= after)
            continue;
        *low = fminf(*low, point[i].value);
        *high = fmaxf(*high, point[i].value);
    }
}

static void test_every_bucket_keeps_its_smallest_and_its_largest_value(void)
{
    const uint32_t count = 70001;
    float *value = random_series(count, 3);
    add_all(value, count);
    const unsigned points = thin_get_points(&thin, 0, point);
    for (uint32_t first = 0; first < count; first += thin.width_cycles) {
        float low, high;
        find_kept(points, first, first + thin.width_cycles, &low, &high);
        for (uint32_t k = first; k < count && k < first + thin.width_cycles; k++) {
            TEST_ASSERT_TRUE(value[k] >= low);
            TEST_ASSERT_TRUE(value[k] <= high);
        }
    }
    free(value);
}

static void test_a_single_spike_survives_ten_million_cycles(void)
{
    const uint32_t spike = 7654321;
    for (uint32_t k = 0; k < 10000000; k++)
        thin_add(&thin, k, (const float[]){k == spike ? 9.0F : 1.0F, k == spike ? -9.0F : 1.0F});
    unsigned seen = 0;
    for (unsigned series = 0; series < 2; series++) {
        const unsigned points = thin_get_points(&thin, series, point);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(THIN_POINTS_MAX, points);
        for (unsigned i = 0; i < points; i++)
            seen += point[i].cycle == spike && fabsf(point[i].value) == 9.0F;
    }
    TEST_ASSERT_EQUAL_UINT(2, seen);
}

static void test_the_number_of_points_stays_bounded(void)
{
    float *value = random_series(3 * THIN_BUCKETS_MAX, 4);
    for (uint32_t k = 0; k < 3 * THIN_BUCKETS_MAX; k++) {
        thin_add(&thin, k, (const float[]){value[k], 0.0F});
        TEST_ASSERT_LESS_THAN_UINT32(THIN_BUCKETS_MAX, thin.buckets);
    }
    TEST_ASSERT_EQUAL_UINT32(4, thin.width_cycles);
    free(value);
}

static void test_a_value_that_is_missing_leaves_no_point(void)
{
    thin_add(&thin, 0, (const float[]){NAN, 1.0F});
    thin_add(&thin, 1, (const float[]){2.0F, NAN});
    TEST_ASSERT_EQUAL_UINT(1, thin_get_points(&thin, 0, point));
    TEST_ASSERT_EQUAL_UINT32(1, point[0].cycle);
    TEST_ASSERT_EQUAL_UINT(1, thin_get_points(&thin, 1, point));
    TEST_ASSERT_EQUAL_UINT32(0, point[0].cycle);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_short_run_is_kept_whole);
    RUN_TEST(test_points_are_values_of_the_run_in_order_of_time);
    RUN_TEST(test_every_bucket_keeps_its_smallest_and_its_largest_value);
    RUN_TEST(test_a_single_spike_survives_ten_million_cycles);
    RUN_TEST(test_the_number_of_points_stays_bounded);
    RUN_TEST(test_a_value_that_is_missing_leaves_no_point);
    return UNITY_END();
}

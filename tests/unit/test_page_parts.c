#include "page/page_access.h"
#include "page/page_link.h"
#include "page/page_path.h"
#include "page/page_peaks.h"
#include "page/page_text.h"
#include "unity.h"

#include <stdlib.h>

static struct page_link *link;
static struct page_text text;

void setUp(void)
{
    link = calloc(1, sizeof *link);
    TEST_ASSERT_NOT_NULL(link);
    text = (struct page_text){0};
}

void tearDown(void)
{
    free(link);
    page_text_free(&text);
}

static void test_names_of_this_computer_are_taken_with_a_port_or_without(void)
{
    static const char *const good[] = {
        "localhost",  "localhost:8080", "LOCALHOST:1", "127.0.0.1",  "10.0.0.7:80",      "[::1]",
        "[::1]:8080", "mill",           "Mill:8080",   "mill.local", "mill.shop.example"};

    for (unsigned i = 0; i < sizeof good / sizeof good[0]; i++)
        TEST_ASSERT_TRUE_MESSAGE(page_access_is_host(good[i], "mill.shop.example"), good[i]);
}

static void test_all_other_names_are_refused(void)
{
    static const char *const bad[] = {
        "",          ":8080",       "evil.example", "localhost.evil.example",
        "mill.evil", "mill2",       "127.0.0.1.x",  "127.0.0.1:80:evil",
        "[::1]evil", "[::1",        "localhost:x",  "localhost:",
        "[]",        "millx.local", "1.2.3.256"};

    for (unsigned i = 0; i < sizeof bad / sizeof bad[0]; i++)
        TEST_ASSERT_FALSE_MESSAGE(page_access_is_host(bad[i], "mill.shop.example"), bad[i]);
    TEST_ASSERT_FALSE(page_access_is_host("", ""));
    TEST_ASSERT_FALSE(page_access_is_host(".local", ""));
}

static void test_an_origin_is_our_own_or_none(void)
{
    TEST_ASSERT_TRUE(page_access_is_origin("http://mill:8080", "mill:8080"));
    TEST_ASSERT_TRUE(page_access_is_origin("https://mill:8080", "mill:8080"));
    TEST_ASSERT_FALSE(page_access_is_origin("http://mill:8081", "mill:8080"));
    TEST_ASSERT_FALSE(page_access_is_origin("http://evil", "mill"));
    TEST_ASSERT_FALSE(page_access_is_origin("null", "mill"));
    TEST_ASSERT_FALSE(page_access_is_origin("", ""));
}

/* x = k^3: v 3k^2, a 6k, j 6, in units of the cycle. */
static void test_peaks_are_differences_of_the_setpoints(void)
{
    struct page_peaks peaks;

    page_peaks_init(&peaks, 1000000, 0);
    for (uint32_t k = 0; k <= 5; k++) {
        const struct page_cycle cycle = {.number = 100 + k, .set.at[0] = (double)k * k * k};

        page_peaks_add(&peaks, &cycle);
    }
    TEST_ASSERT_EQUAL_DOUBLE(61, peaks.peak[PAGE_VELOCITY].at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(24, peaks.peak[PAGE_ACCELERATION].at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(6, peaks.peak[PAGE_JERK].at[0]);
}

static void test_no_difference_is_taken_over_a_gap(void)
{
    struct page_peaks peaks;
    struct page_cycle cycle = {.number = 7, .set.at[0] = 5};

    page_peaks_init(&peaks, 1000, 0);
    page_peaks_add(&peaks, &cycle);
    cycle = (struct page_cycle){.number = 9, .set.at[0] = 105};
    page_peaks_add(&peaks, &cycle);
    TEST_ASSERT_EQUAL_DOUBLE(0, peaks.peak[PAGE_VELOCITY].at[0]);
    cycle = (struct page_cycle){.number = 10, .set.at[0] = 105.001};
    page_peaks_add(&peaks, &cycle);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, peaks.peak[PAGE_VELOCITY].at[0]);
    TEST_ASSERT_EQUAL_DOUBLE(0, peaks.peak[PAGE_ACCELERATION].at[0]);
}

static void test_cycles_come_in_order_and_those_without_room_are_left_out(void)
{
    struct page_cycle cycle = {0};

    for (uint32_t k = 0; k < PAGE_LINK_CYCLES + 5; k++) {
        cycle.number = k;
        page_link_put(link, &cycle);
    }
    for (uint32_t k = 0; k < PAGE_LINK_CYCLES; k++) {
        TEST_ASSERT_TRUE(page_link_take(link, &cycle));
        TEST_ASSERT_EQUAL_UINT32(k, cycle.number);
    }
    TEST_ASSERT_FALSE(page_link_take(link, &cycle));
}

static void test_one_job_is_under_way_at_a_time(void)
{
    struct page_job *job = page_link_next_job(link);

    TEST_ASSERT_NULL(page_link_get_job(link));
    TEST_ASSERT_NOT_NULL(job);
    page_link_ask(link);
    TEST_ASSERT_NULL(page_link_next_job(link));
    TEST_ASSERT_NULL(page_link_answer(link));
    TEST_ASSERT_EQUAL_PTR(job, page_link_get_job(link));
    page_link_finish(link);
    TEST_ASSERT_EQUAL_PTR(job, page_link_answer(link));
    TEST_ASSERT_NULL(page_link_answer(link));
    TEST_ASSERT_EQUAL_PTR(job, page_link_next_job(link));
}

static void test_strings_are_json_whatever_they_hold(void)
{
    page_text_add_string(&text, "a\"b\\c\n\xC3\xA4\xFF\xE2\x82");
    TEST_ASSERT_EQUAL_STRING("\"a\\u0022b\\u005cc\\u000a\xC3\xA4???\"", page_text_get(&text));
}

static void test_numbers_that_json_has_not_are_null(void)
{
    page_text_add_number(&text, 1.0 / 3.0);
    page_text_add_number(&text, 1e308 * 10);
    TEST_ASSERT_EQUAL_STRING("0.333333333null", page_text_get(&text));
}

static void test_a_path_of_any_length_fits_and_keeps_its_ends(void)
{
    struct page_path path;
    struct point at = {{0}};

    TEST_ASSERT_TRUE(page_path_open(&path));
    for (uint32_t k = 0; k < 3 * PAGE_PATH_MAX; k++) {
        at.at[0] = k;
        TEST_ASSERT_TRUE(page_path_add(&path, &at, k, false));
    }
    page_path_finish(&path);
    TEST_ASSERT_TRUE(path.count <= PAGE_PATH_MAX && path.count > PAGE_PATH_MAX / 2);
    TEST_ASSERT_EQUAL_UINT32(0, path.point[0].line);
    TEST_ASSERT_EQUAL_UINT32(3 * PAGE_PATH_MAX - 1, path.point[path.count - 1].line);
    for (size_t i = 1; i < path.count; i++)
        TEST_ASSERT_TRUE(path.point[i].line > path.point[i - 1].line);
    page_path_close(&path);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_names_of_this_computer_are_taken_with_a_port_or_without);
    RUN_TEST(test_all_other_names_are_refused);
    RUN_TEST(test_an_origin_is_our_own_or_none);
    RUN_TEST(test_peaks_are_differences_of_the_setpoints);
    RUN_TEST(test_no_difference_is_taken_over_a_gap);
    RUN_TEST(test_cycles_come_in_order_and_those_without_room_are_left_out);
    RUN_TEST(test_one_job_is_under_way_at_a_time);
    RUN_TEST(test_strings_are_json_whatever_they_hold);
    RUN_TEST(test_numbers_that_json_has_not_are_null);
    RUN_TEST(test_a_path_of_any_length_fits_and_keeps_its_ends);
    return UNITY_END();
}

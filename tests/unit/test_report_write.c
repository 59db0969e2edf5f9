#include "report/report.h"

#include "unity.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const struct plan_limits limits = {
    .axes = 0x3f,
    .velocity_mm_s = {500.0, 500.0, 500.0, 5.0, 5.0, 5.0},
    .acceleration_mm_s2 = {5000.0, 5000.0, 5000.0, 50.0, 50.0, 50.0},
    .jerk_mm_s3 = {50000.0, 50000.0, 50000.0, 500.0, 500.0, 500.0},
    .cycle_s = 0.001,
};

static struct report *report;

void setUp(void)
{
    report = report_open(&limits);
    TEST_ASSERT_NOT_NULL(report);
}

void tearDown(void)
{
    report_close(report);
}

/* Six axes that never stand, on a path that never repeats: as many points as a report can hold. */
static void add_restless_cycles(struct report *r, uint32_t cycles)
{
    uint32_t state = 12345;
    struct cycle_record record = {.override_percent = 100.0, .limiter = 1.0};
    for (uint32_t k = 0; k < cycles; k++) {
        record.cycle = k;
        record.line = k;
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            state = state * 1664525u + 1013904223u;
            record.cmd.at[i] = record.set.at[i] = (double)state / 4294967296.0 * 100.0;
        }
        record.feed_mm_s = (double)(state % 1000u);
        record.override_percent = (double)(state % 101u);
        record.limiter = (double)(state % 11u) / 10.0;
        report_add(r, &record, k % 2 == 0);
    }
}

/* The page as text, zero-terminated; the caller frees it. */
static char *write_page(struct report *r, const char *summary_json, size_t *length)
{
    FILE *file = tmpfile();
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_INT(0, report_write(r, file, summary_json));
    *length = (size_t)ftell(file);
    char *text = malloc(*length + 1);
    TEST_ASSERT_NOT_NULL(text);
    rewind(file);
    TEST_ASSERT_EQUAL_UINT64(*length, fread(text, 1, *length, file));
    text[*length] = '\0';
    (void)fclose(file);
    return text;
}

static void test_the_largest_report_is_under_ten_megabytes(void)
{
    size_t length;
    add_restless_cycles(report, 1000000);
    free(write_page(report, "{}", &length));
    TEST_ASSERT_TRUE(length > 100000);
    TEST_ASSERT_TRUE(length <= 10000000);
}

static void test_equal_runs_make_equal_bytes(void)
{
    size_t length[2];
    char *text[2];
    for (int i = 0; i < 2; i++) {
        struct report *r = report_open(&limits);
        add_restless_cycles(r, 20000);
        text[i] = write_page(r, "{\"outcome\":\"completed\"}", &length[i]);
        report_close(r);
    }
    TEST_ASSERT_EQUAL_UINT64(length[0], length[1]);
    TEST_ASSERT_TRUE(memcmp(text[0], text[1], length[0]) == 0);
    free(text[0]);
    free(text[1]);
}

/* What is there between the quotes of a column of the page, in bytes; the caller frees it. */
static uint8_t *decode_column(const char *text, const char *name, size_t *count)
{
    static const char alphabet[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *column = strstr(text, name) + strlen(name);
    const size_t characters = strspn(column, alphabet);
    uint8_t *byte = calloc(characters, 1);
    TEST_ASSERT_NOT_NULL(byte);
    TEST_ASSERT_EQUAL_UINT64((4 - characters % 4) % 4, strspn(column + characters, "="));
    *count = characters * 6 / 8;
    for (size_t bit = 0; bit < *count * 8; bit++) {
        const long value = strchr(alphabet, column[bit / 6]) - alphabet;
        byte[bit / 8] |= (uint8_t)((value >> (5 - bit % 6) & 1) << (7 - bit % 8));
    }
    return byte;
}

static void test_columns_are_base64_of_their_numbers_however_many(void)
{
    const uint32_t cycles[] = {1, 2, 3, 767, 768, 769, 3071, 3072, 3073, 5000};
    for (unsigned n = 0; n < sizeof cycles / sizeof cycles[0]; n++) {
        struct report *r = report_open(&limits);
        size_t length, count;
        add_restless_cycles(r, cycles[n]);
        char *text = write_page(r, "{}", &length);
        uint8_t *line = decode_column(text, "\"line\":\"", &count);
        TEST_ASSERT_EQUAL_UINT64((size_t)4 * cycles[n], count);
        for (size_t k = 0; k < cycles[n]; k++)
            TEST_ASSERT_EQUAL_UINT32(k, line[4 * k] | (uint32_t)line[4 * k + 1] << 8);
        uint8_t *rapid = decode_column(text, "\"rapid\":\"", &count);
        TEST_ASSERT_EQUAL_UINT64(cycles[n], count);
        for (size_t k = 0; k < cycles[n]; k++)
            TEST_ASSERT_EQUAL_UINT8(k % 2 == 0, rapid[k]);
        free(rapid);
        free(line);
        free(text);
        report_close(r);
    }
}

static void test_no_text_of_the_summary_can_end_its_script(void)
{
    size_t length;
    char *text = write_page(report, "{\"program\":\"</script><b>\"}", &length);
    TEST_ASSERT_NOT_NULL(strstr(text, "{\"program\":\"\\u003c/script>\\u003cb>\"}"));
    free(text);
}

static void test_every_place_of_the_template_is_filled(void)
{
    size_t length;
    char *text = write_page(report, "{}", &length);
    TEST_ASSERT_NOT_NULL(
        strstr(text, "<script type=\"application/json\" id=\"run-summary\">{}</script>"));
    TEST_ASSERT_NULL(strstr(text, "{{START}}"));
    TEST_ASSERT_EQUAL_STRING("</body>\n</html>\n", text + length - strlen("</body>\n</html>\n"));
    free(text);
}

static void test_the_plotting_library_is_there_unless_the_report_says_why_not(void)
{
    size_t length;
    char *text = write_page(report, "{}", &length);
    const bool has_library = strstr(text, "window.Plotly = Plotly") != NULL;
    TEST_ASSERT_EQUAL_INT(has_library, report_get_plots_missing() == NULL);
    free(text);
}

static void test_a_full_device_is_an_error(void)
{
    FILE *full = fopen("/dev/full", "wb");
    TEST_ASSERT_NOT_NULL(full);
    TEST_ASSERT_EQUAL_INT(ENOSPC, report_write(report, full, "{}"));
    (void)fclose(full);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_largest_report_is_under_ten_megabytes);
    RUN_TEST(test_equal_runs_make_equal_bytes);
    RUN_TEST(test_columns_are_base64_of_their_numbers_however_many);
    RUN_TEST(test_no_text_of_the_summary_can_end_its_script);
    RUN_TEST(test_every_place_of_the_template_is_filled);
    RUN_TEST(test_the_plotting_library_is_there_unless_the_report_says_why_not);
    RUN_TEST(test_a_full_device_is_an_error);
    return UNITY_END();
}

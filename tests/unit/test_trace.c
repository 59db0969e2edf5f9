#define _XOPEN_SOURCE 700 /* mkstemp, mkdtemp */

#include "results/trace_writer.h"
#include "trace/trace_check.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct trace_writer writer;
static char path[2][32];

static void make_file(char name[32])
{
    int descriptor;

    (void)snprintf(name, 32, "/tmp/takt-trace-XXXXXX");
    descriptor = mkstemp(name);
    TEST_ASSERT_GREATER_OR_EQUAL(0, descriptor);
    (void)close(descriptor);
}

void setUp(void)
{
    make_file(path[0]);
    make_file(path[1]);
}

void tearDown(void)
{
    (void)unlink(path[0]);
    (void)unlink(path[1]);
}

/* Rows whose X goes as given, in mm. */
static void write_trace(const char *name, const double x[], unsigned count)
{
    FILE *stream = fopen(name, "wb");

    TEST_ASSERT_NOT_NULL(stream);
    trace_writer_init(&writer, stream, 1, 0.001, false);
    for (unsigned i = 0; i < count; i++) {
        struct cycle_record record = {
            .cycle = i, .block = 1, .line = 7, .override_percent = 100, .limiter = 1};

        record.set.at[AXIS_X] = x[i];
        trace_writer_add(&writer, &record, NULL);
    }
    TEST_ASSERT_TRUE(trace_writer_flush(&writer));
    (void)fclose(stream);
}

static void test_rows_have_the_columns_and_places_of_the_format(void)
{
    struct cycle_record record = {.cycle = 12,
                                  .block = 3,
                                  .line = 40,
                                  .feed_mm_s = 10,
                                  .override_percent = 100,
                                  .limiter = 1};
    FILE *stream = fopen(path[0], "w+b");
    char text[512];
    size_t length;

    TEST_ASSERT_NOT_NULL(stream);
    trace_writer_init(&writer, stream, 1u << AXIS_Y | 1u << AXIS_A, 0.001, false);
    record.cmd.at[AXIS_Y] = -1.5;
    record.set.at[AXIS_Y] = 1e-9;
    record.act.at[AXIS_A] = 3.14159265358979323846 / 2;
    record.spindle_rev = -12.25;
    trace_writer_add(&writer, &record, NULL);
    TEST_ASSERT_TRUE(trace_writer_flush(&writer));
    rewind(stream);
    length = fread(text, 1, sizeof text - 1, stream);
    text[length] = '\0';
    (void)fclose(stream);
    TEST_ASSERT_EQUAL_STRING("cycle,time_s,block,line,feed_mm_min,override_percent,limiter,cmd_Y_"
                             "mm,set_Y_mm,act_Y_mm,cmd_A_deg,set_A_deg,act_A_deg,spindle_rev\n"
                             "12,0.012000,3,40,600.000000,100.000000,1.000000,-1.500000000,0."
                             "000000001,0.000000000,0.000000000,0.000000000,"
                             "90.000000000,-12.250000000\n",
                             text);
}

static void test_what_is_written_is_read_again(void)
{
    const double x[] = {0, -0.125, 499.999999999};
    struct trace_reader reader;
    int column;

    write_trace(path[0], x, 3);
    TEST_ASSERT_TRUE(trace_reader_open(&reader, path[0]));
    column = trace_reader_find(&reader, "set_X_mm");
    TEST_ASSERT_EQUAL_INT(8, column);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_INT(TRACE_ROW, trace_reader_next(&reader));
        TEST_ASSERT_EQUAL_DOUBLE(x[i], reader.value[column]);
    }
    TEST_ASSERT_EQUAL_INT(TRACE_END, trace_reader_next(&reader));
    trace_reader_close(&reader);
}

static void test_a_buffer_that_fills_up_loses_nothing(void)
{
    enum { ROWS = 20000 };
    double *x = calloc(ROWS, sizeof *x);
    struct trace_reader reader;
    unsigned rows = 0;

    TEST_ASSERT_NOT_NULL(x);
    for (unsigned i = 0; i < ROWS; i++)
        x[i] = (double)i / 1024;
    write_trace(path[0], x, ROWS);
    TEST_ASSERT_TRUE(trace_reader_open(&reader, path[0]));
    while (trace_reader_next(&reader) == TRACE_ROW) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, x[rows], reader.value[8]);
        rows++;
    }
    TEST_ASSERT_EQUAL_UINT(ROWS, rows);
    trace_reader_close(&reader);
    free(x);
}

static enum command_status limits_of(const double x[], unsigned count)
{
    struct trace_reader reader;
    struct machine machine;
    enum command_status status;

    takt_machine_set_default(&machine);
    write_trace(path[0], x, count);
    TEST_ASSERT_TRUE(trace_reader_open(&reader, path[0]));
    status = trace_check_limits(&reader, &machine);
    trace_reader_close(&reader);
    return status;
}

static void test_limits_are_verified_by_differences(void)
{
    const double slow[] = {100, 100.1, 100.2,
                           100.3}; /* 100 mm/s: at the limit, whatever came before */
    const double fast[] = {100, 100.1, 100.21, 100.32};       /* 110 mm/s */
    const double hard[] = {0, 0, 0.0011, 0.0022 + 0.0000001}; /* 1.1 mm/s in a cycle: 1100 mm/s2 */
    const double jerky[] = {0, 0, 0, 0.00006};                /* 60,000 mm/s3 */

    TEST_ASSERT_EQUAL_INT(STATUS_DONE, limits_of(slow, 4));
    TEST_ASSERT_EQUAL_INT(STATUS_FAILED, limits_of(fast, 4));
    TEST_ASSERT_EQUAL_INT(STATUS_FAILED, limits_of(hard, 4));
    TEST_ASSERT_EQUAL_INT(STATUS_FAILED, limits_of(jerky, 4));
}

static enum command_status compare(const double a[], unsigned rows_a, const double b[],
                                   unsigned rows_b, double tolerance)
{
    struct trace_reader first, second;
    enum command_status status;

    write_trace(path[0], a, rows_a);
    write_trace(path[1], b, rows_b);
    TEST_ASSERT_TRUE(trace_reader_open(&first, path[0]));
    TEST_ASSERT_TRUE(trace_reader_open(&second, path[1]));
    status = trace_check_equal(&first, &second, tolerance);
    trace_reader_close(&first);
    trace_reader_close(&second);
    return status;
}

static void test_traces_are_equal_within_the_tolerance_alone(void)
{
    const double a[] = {1, 2, 3}, b[] = {1, 2.000001, 3};

    TEST_ASSERT_EQUAL_INT(STATUS_DONE, compare(a, 3, a, 3, 0));
    TEST_ASSERT_EQUAL_INT(STATUS_FAILED, compare(a, 3, b, 3, 0));
    TEST_ASSERT_EQUAL_INT(STATUS_DONE, compare(a, 3, b, 3, 2e-6));
    TEST_ASSERT_EQUAL_INT(STATUS_FAILED, compare(a, 3, a, 2, 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rows_have_the_columns_and_places_of_the_format);
    RUN_TEST(test_what_is_written_is_read_again);
    RUN_TEST(test_a_buffer_that_fills_up_loses_nothing);
    RUN_TEST(test_limits_are_verified_by_differences);
    RUN_TEST(test_traces_are_equal_within_the_tolerance_alone);
    return UNITY_END();
}

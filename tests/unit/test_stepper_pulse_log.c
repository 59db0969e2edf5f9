/*
 * The log of pulses: its exact text, edge by edge.
 */
#define _POSIX_C_SOURCE 200809L

#include "stepper/pulse_log.h"
#include "unity.h"

#include <stdlib.h>

static char *text;
static size_t size;
static FILE *stream;
static struct pulse_log pulses;

void setUp(void)
{
    stream = open_memstream(&text, &size);
    TEST_ASSERT_NOT_NULL(stream);
}

void tearDown(void)
{
    (void)fclose(stream);
    free(text);
}

/* X takes a step each 100 ns, Z one each 20 ns. */
static void begin(enum pulse_log_form form)
{
    const struct pulse_log_config config = {
        .form = form, .axes = 1u << AXIS_X | 1u << AXIS_Z, .rate_max_hz = {1e7, 1.0, 5e7}};

    pulse_log_begin(&pulses, stream, &config);
}

static void take(uint64_t time_ns, unsigned axes, unsigned direction)
{
    const struct step_pulse pulse = {0, (uint8_t)axes, (uint8_t)direction};

    pulse_log_take(&pulses, time_ns, &pulse);
}

static void expect(const char *expected)
{
    TEST_ASSERT_TRUE(pulse_log_end(&pulses));
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

#define VCD_HEAD                                                                                   \
    "$timescale 1 ns $end\n$scope module takt $end\n$var wire 1 ! X_step $end\n"                   \
    "$var wire 1 \" X_dir $end\n$var wire 1 % Z_step $end\n$var wire 1 & Z_dir $end\n"             \
    "$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n0!\n1\"\n0%\n1&\n$end\n"

static void test_step_lines_are_high_for_half_of_the_shortest_time_between_two_steps(void)
{
    begin(PULSE_LOG_VCD);
    take(1000, 1, 0);
    take(1020, 4, 4);
    take(1100, 5, 0);
    expect(VCD_HEAD "#1000\n1!\n#1020\n0&\n1%\n#1030\n0%\n#1050\n0!\n"
                    "#1100\n1!\n1&\n1%\n#1110\n0%\n#1150\n0!\n");
}

static void test_edges_of_one_time_stand_below_it(void)
{
    begin(PULSE_LOG_VCD);
    take(0, 1, 1);
    take(40, 4, 0);
    take(50, 2, 0); /* Y has no step drive */
    expect(VCD_HEAD "0\"\n1!\n#40\n1%\n#50\n0!\n0%\n");
}

static void test_a_row_has_a_step_of_each_axis(void)
{
    begin(PULSE_LOG_CSV);
    take(0, 1, 1);
    take(1000000001, 5, 4);
    take(UINT64_C(123456789012345), 4, 0);
    expect("time_s,X,Z\n0.000000000,-1,0\n1.000000001,1,-1\n123456.789012345,0,1\n");
}

static void test_no_pulses_are_a_whole_log(void)
{
    begin(PULSE_LOG_VCD);
    expect(VCD_HEAD);
}

static void test_the_form_is_told_by_the_name(void)
{
    enum pulse_log_form form;

    TEST_ASSERT_TRUE(pulse_log_form_of("a.b/run.vcd", &form));
    TEST_ASSERT_EQUAL(PULSE_LOG_VCD, form);
    TEST_ASSERT_TRUE(pulse_log_form_of("run.vcd.csv", &form));
    TEST_ASSERT_EQUAL(PULSE_LOG_CSV, form);
    TEST_ASSERT_TRUE(pulse_log_form_of("-", &form));
    TEST_ASSERT_EQUAL(PULSE_LOG_CSV, form);
    TEST_ASSERT_FALSE(pulse_log_form_of(".vcd", &form));
    TEST_ASSERT_FALSE(pulse_log_form_of("run.txt", &form));
    TEST_ASSERT_FALSE(pulse_log_form_of("", &form));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_step_lines_are_high_for_half_of_the_shortest_time_between_two_steps);
    RUN_TEST(test_edges_of_one_time_stand_below_it);
    RUN_TEST(test_a_row_has_a_step_of_each_axis);
    RUN_TEST(test_no_pulses_are_a_whole_log);
    RUN_TEST(test_the_form_is_told_by_the_name);
    return UNITY_END();
}

/* The main part of every image: programs brought and streamed, machines that must not run. */
#include "embedded_bench.h"

#include <stdio.h>
#include <string.h>

#define PROGRAM_MAX    ((size_t)3 * TEXT_QUEUE_MAX)
#define CYCLES_STARVED 500

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

/* A square, again and again, until the text is so long. */
static size_t long_program(char *text, size_t length)
{
    static const char talk[] =
        "(so that there is more text than there is motion, as in real programs)";
    size_t at = (size_t)sprintf(text, "G21 G90 G61 F6000\n");

    while (at + 400 < length)
        at += (size_t)sprintf(text + at, "G1 X4 Y0 %s\nG1 X4 Y3 %s\nG1 X0 Y3 %s\nG1 X0 Y0 %s\n",
                              talk, talk, talk, talk);
    return at + (size_t)sprintf(text + at, "M2\n");
}

static char program[PROGRAM_MAX];

/* Cycles until the program has ended, bringing what there is room for. */
static void run_stream(size_t size)
{
    for (unsigned i = 0; i < CYCLES_MAX && get(REGISTER_OUTCOME) == PANEL_OUTCOME_NONE; i++) {
        if (get(REGISTER_UPLOAD_RECEIVED) < size)
            (void)bring(program, size);
        cycle();
    }
}

/* What the same text gives that is there from the beginning: the digest of the setpoints. */
static uint64_t digest_of_whole(size_t size)
{
    static struct source_text whole;
    struct controller_config config = {
        .machine = &machine,
        .can = {.port = {{.send = send, .receive = receive}}},
        .parameters = &embedded_core.parameters,
    };
    const struct point start = {{0}};

    wait_for(PANEL_IDLE);
    takt_source_open_text(&config.source, &whole, program, size);
    takt_controller_start_program(&embedded.service.controller, &config, &start);
    embedded.service.job = SERVICE_PROGRAM;
    wait_for(PANEL_IDLE);
    return embedded.service.digest;
}

/* ---- claims ---- */

static void test_a_program_that_fits_is_kept_and_runs_as_often_as_wanted(void)
{
    const char *text = "G1 X2 F3000\nG1 X0\nM2\n";

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(text, strlen(text), PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL_UINT(0, bring(text, strlen(text)));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
    for (unsigned runs = 1; runs <= 2; runs++) {
        TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
        wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
        TEST_ASSERT_EQUAL_UINT32(runs, get(REGISTER_RUNS));
    }
    TEST_ASSERT_NOT_NULL(strstr(log_text, "state: running\ncompleted, setpoints "));
}

static void test_a_program_longer_than_the_memory_is_no_upload(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(MODBUS_VALUE, begin(program, size, PANEL_UPLOAD_BEGIN));
}

static void test_a_stream_that_keeps_up_gives_the_setpoints_of_the_whole_text(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    const uint64_t whole = digest_of_whole(size);

    setUp();
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_NONE, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_HEX64(whole, embedded.service.digest);
}

static void test_a_chunk_without_room_is_refused_and_can_come_again(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    unsigned exception = 0;

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    while (exception == 0)
        exception = bring(program, size);
    TEST_ASSERT_EQUAL_UINT(MODBUS_BUSY, exception);
    TEST_ASSERT_LESS_THAN_UINT32(PANEL_CHUNK_MAX, get(REGISTER_UPLOAD_ROOM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
}

static void test_a_starved_stream_brakes_within_limits_raises_an_alarm_and_goes_on(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);
    struct point at;

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    while (get(REGISTER_UPLOAD_RECEIVED) < size / 2) {
        (void)bring(program, size);
        cycle();
    }
    for (unsigned i = 0; i < CYCLES_MAX && embedded.service.alarm == PANEL_ALARM_NONE; i++)
        cycle();
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_STARVED, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PROGRAM_STARVED, embedded.service.alarm_text.code);
    TEST_ASSERT_EQUAL_UINT32(PANEL_RUNNING, get(REGISTER_STATE));
    at = embedded.service.at;
    for (unsigned i = 0; i < CYCLES_STARVED; i++)
        cycle();
    TEST_ASSERT_TRUE(point_is_same(&at, &embedded.service.at));
    run_stream(size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    check_limits();
}

static void test_a_stream_that_is_given_up_or_wrong_ends_the_program_in_an_error(void)
{
    const size_t size = long_program(program, PROGRAM_MAX);

    for (unsigned wrong = 0; wrong < 2; wrong++) {
        setUp();
        wait_for(PANEL_IDLE);
        TEST_ASSERT_EQUAL_UINT(0, begin(program, size, PANEL_UPLOAD_STREAM));
        TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
        for (unsigned i = 0; i < 20; i++)
            (void)bring(program, size);
        if (wrong != 0)
            embedded_core.panel.upload.crc++;
        else
            TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_ABANDON));
        for (unsigned i = 0; i < CYCLES_MAX && embedded.service.alarm == PANEL_ALARM_NONE; i++) {
            if (wrong != 0 && get(REGISTER_UPLOAD_RECEIVED) < size)
                (void)bring(program, size);
            cycle();
        }
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_PROGRAM, get(REGISTER_ALARM));
        TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_FAILED, get(REGISTER_OUTCOME));
    }
}

static void test_a_running_program_is_not_overwritten(void)
{
    const char *text = "G1 X20 F600\nM2\n";

    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, begin(text, strlen(text), PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL_UINT(0, bring(text, strlen(text)));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    cycle();
    TEST_ASSERT_NOT_EQUAL(0, begin("M2\n", 3, PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_NOT_EQUAL(0, begin("M2\n", 3, PANEL_UPLOAD_STREAM));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
}

static void test_a_machine_that_must_not_run_says_why_and_sends_nothing(void)
{
    const enum takt_error reasons[] = {TAKT_ERROR_IMAGE_DAMAGED, TAKT_ERROR_CAN_ABSENT};

    for (unsigned i = 0; i < sizeof reasons / sizeof reasons[0]; i++) {
        const struct diagnostic why = {.code = reasons[i], .value = 0x1234};
        char text[DIAGNOSTIC_TEXT_MAX];

        setUp();
        takt_embedded_refuse(&embedded, &why);
        for (unsigned k = 0; k < CYCLES_STARVED; k++)
            cycle();
        (void)takt_diagnostic_text(&why, text);
        TEST_ASSERT_NOT_NULL(strstr(log_text, text));
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM, get(REGISTER_STATE));
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_INTERNAL, get(REGISTER_ALARM));
        TEST_ASSERT_EQUAL_UINT(MODBUS_STATE, set(REGISTER_RESET, 1));
        TEST_ASSERT_EQUAL_UINT32(0, embedded.cycles);
        TEST_ASSERT_EQUAL_UINT(0, frames_sent);
    }
}

/* As a clock read in several interrupts does: no request is lost by it. */
static void test_a_clock_that_steps_back_breaks_no_request(void)
{
    uint8_t frame[8] = {UNIT, 4, 0, 1, 0, 1};
    const uint16_t crc = takt_crc16(frame, 6);

    frame[6] = (uint8_t)crc;
    frame[7] = (uint8_t)(crc >> 8);
    now_ns = 50 * (uint64_t)CYCLE_NS;
    replied_length = 0;
    for (unsigned i = 0; i < sizeof frame; i++) {
        takt_embedded_take_byte(&embedded, frame[i], (uint32_t)(now_ns / 1000) + (i % 2) * 900);
        takt_embedded_background(&embedded);
    }
    TEST_ASSERT_EQUAL_UINT(7, replied_length);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_program_that_fits_is_kept_and_runs_as_often_as_wanted);
    RUN_TEST(test_a_program_longer_than_the_memory_is_no_upload);
    RUN_TEST(test_a_stream_that_keeps_up_gives_the_setpoints_of_the_whole_text);
    RUN_TEST(test_a_chunk_without_room_is_refused_and_can_come_again);
    RUN_TEST(test_a_starved_stream_brakes_within_limits_raises_an_alarm_and_goes_on);
    RUN_TEST(test_a_stream_that_is_given_up_or_wrong_ends_the_program_in_an_error);
    RUN_TEST(test_a_running_program_is_not_overwritten);
    RUN_TEST(test_a_machine_that_must_not_run_says_why_and_sends_nothing);
    RUN_TEST(test_a_clock_that_steps_back_breaks_no_request);
    return UNITY_END();
}

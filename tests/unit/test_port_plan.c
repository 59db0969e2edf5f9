/* Programs planned ahead, brought through the panel's mailbox while they run. */
#include "ahead/compile.h"
#include "cutter_compensation/cutter_compensation.h"
#include "embedded_bench.h"

#include <stdio.h>
#include <stdlib.h>

#define SQUARES       14
#define TEXT_MAX      4096
#define PLAN_MAX      65536
#define CYCLES_LATE   3000
#define PLANNED_BYTES 12000 /* this many at least: more than what is kept of it anywhere */

static char text[TEXT_MAX];
static size_t text_size;
static char plan[PLAN_MAX];
static size_t plan_size;

void setUp(void)
{
    bench_set_up();
}

void tearDown(void)
{
}

/* Squares, one in another. */
static void write_text(unsigned squares)
{
    text_size = (size_t)sprintf(text, "G21 G90 G64 P0.01 F6000\n");
    for (unsigned i = 1; i <= squares; i++) {
        const int a = (int)i;

        text_size += (size_t)sprintf(text + text_size, "G1 X%d Y%d\nG1 X%d Y%d\nG1 X%d Y%d\n", a,
                                     -a, a, a, -a, a);
        text_size += (size_t)sprintf(text + text_size, "G1 X%d Y%d\n", -a, -a - 1);
    }
    text_size += (size_t)sprintf(text + text_size, "G4 P0.1\nG0 X0 Y0\nM2\n");
}

/* The machine's limits as the controller has them. */
static struct compile_config compile_config(void)
{
    struct compile_config config = {.cycle_us = machine.cycle_us,
                                    .ceiling_percent = 100,
                                    .text_size = (uint32_t)text_size,
                                    .text_crc = takt_crc32_add(CRC32_START, text, text_size),
                                    .tolerance_part = 1,
                                    .tolerance_mm = 0.01,
                                    .workers = 1};

    takt_controller_plan_limits(&machine, &config.limits);
    return config;
}

static void add_moves(struct compile *compile)
{
    static struct program program;
    static struct cutter_compensation offset;
    static struct parameters parameters;
    const struct controller_config controller = {.machine = &machine, .parameters = &parameters};
    struct program_config config;
    struct source_text whole;
    struct source source;
    struct diagnostic error;
    struct move move;

    takt_parameters_clear(&parameters);
    takt_controller_program_config(&controller, &config);
    takt_source_open_text(&source, &whole, text, text_size);
    takt_program_open(&program, &config, &source);
    takt_cutter_compensation_open(&offset, &config);
    while (takt_cutter_compensation_next(&offset, &program, &move, &error) == PROGRAM_MOVE)
        TEST_ASSERT_EQUAL_INT(COMPILE_DONE, compile_add(compile, &move));
}

static void compile_text(void)
{
    static struct compile compile;
    const struct compile_config config = compile_config();
    const struct point start = {{0}};
    FILE *file = tmpfile();

    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL_INT(COMPILE_DONE, compile_begin(&compile, &config, &start, file));
    add_moves(&compile);
    TEST_ASSERT_EQUAL_INT(COMPILE_DONE, compile_end(&compile));
    compile_free(&compile);
    rewind(file);
    plan_size = fread(plan, 1, PLAN_MAX, file);
    (void)fclose(file);
    TEST_ASSERT_LESS_THAN(PLAN_MAX, (int)plan_size);
}

/* The long text and its plan, which is made once. */
static void write_long_plan(void)
{
    static char made[PLAN_MAX];
    static size_t made_size;

    write_text(SQUARES);
    if (made_size == 0) {
        compile_text();
        made_size = plan_size;
        memcpy(made, plan, made_size);
    }
    plan_size = made_size;
    memcpy(plan, made, made_size);
}

static void upload_text(void)
{
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PROGRAM));
    TEST_ASSERT_EQUAL_UINT(0, begin(text, text_size, PANEL_UPLOAD_BEGIN));
    while (get(REGISTER_UPLOAD_RECEIVED) < text_size)
        TEST_ASSERT_EQUAL_UINT(0, bring(text, text_size));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT));
}

static unsigned announce(void)
{
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PLAN));
    return begin(plan, plan_size, PANEL_UPLOAD_STREAM);
}

/* The text is there and of the plan as much as there is room for. */
static void begin_plan(void)
{
    unsigned exception = 0;

    upload_text();
    TEST_ASSERT_EQUAL_UINT(0, announce());
    while (exception == 0 && get(REGISTER_UPLOAD_RECEIVED) < plan_size)
        exception = bring(plan, plan_size);
    TEST_ASSERT_TRUE(exception == 0 || exception == MODBUS_BUSY);
}

static void run_plan(size_t up_to)
{
    for (unsigned i = 0; i < CYCLES_MAX && get(REGISTER_OUTCOME) == PANEL_OUTCOME_NONE; i++) {
        if (get(REGISTER_UPLOAD_RECEIVED) < up_to)
            (void)bring(plan, plan_size);
        else if (up_to < plan_size)
            return;
        cycle();
    }
}

/* What the same plan gives that is there from the beginning. */
static size_t read_whole(void *context, uint8_t *bytes, size_t size)
{
    size_t *at = context;
    const size_t count = size < plan_size - *at ? size : plan_size - *at;

    memcpy(bytes, plan + *at, count);
    *at += count;
    return count;
}

static uint64_t digest_of_whole(void)
{
    static struct source_text whole;
    static size_t at;
    const struct replay_source compiled = {.context = &at, .read = read_whole};
    const struct controller_config config = {
        .machine = &machine,
        .can = {.port = {{.send = send, .receive = receive}}},
        .parameters = &embedded_core.parameters,
        .compiled = &compiled,
    };
    struct controller_config with_text = config;
    const struct point start = {{0}};

    at = 0;
    wait_for(PANEL_IDLE);
    takt_source_open_text(&with_text.source, &whole, text, text_size);
    takt_controller_start_program(&embedded.service.controller, &with_text, &start);
    embedded.service.job = SERVICE_PROGRAM;
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_INT(PANEL_ALARM_NONE, embedded.service.alarm);
    return embedded.service.digest;
}

static void refusal_text(char *into)
{
    memcpy(into, embedded_core.panel.upload_text, strlen(embedded_core.panel.upload_text) + 1);
}

/* ---- claims ---- */

static void test_a_streamed_plan_gives_the_setpoints_of_the_file(void)
{
    write_long_plan();
    TEST_ASSERT_GREATER_THAN(PLANNED_BYTES, (int)plan_size);
    const uint64_t whole = digest_of_whole();

    setUp();
    begin_plan();
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_plan(plan_size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_NONE, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_HEX64(whole, embedded.service.digest);
    check_limits();
}

static void test_without_a_new_plan_the_program_is_planned_as_it_runs(void)
{
    write_text(2);
    compile_text();
    begin_plan();
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_plan(plan_size);
    const uint64_t planned = embedded.service.digest;

    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    TEST_ASSERT_TRUE(planned != embedded.service.digest);
}

static void test_a_late_plan_brakes_within_limits_raises_an_alarm_and_goes_on(void)
{
    struct point at;

    write_long_plan();
    begin_plan();
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    run_plan(plan_size * 2 / 3);
    for (unsigned i = 0; i < CYCLES_LATE && embedded.service.alarm == PANEL_ALARM_NONE; i++)
        cycle();
    TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_STARVED, get(REGISTER_ALARM));
    TEST_ASSERT_EQUAL_UINT32(PANEL_RUNNING, get(REGISTER_STATE));
    at = embedded.service.at;
    for (unsigned i = 0; i < CYCLES_LATE; i++)
        cycle();
    TEST_ASSERT_TRUE(point_is_same(&at, &embedded.service.at));
    run_plan(plan_size);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    check_limits();
}

/* Its header is looked at as soon as it is there, before anything moves. */
static void check_refused(unsigned exception, const char *why)
{
    char told[PANEL_ALARM_TEXT_MAX];

    TEST_ASSERT_EQUAL_UINT(0, announce());
    TEST_ASSERT_EQUAL_UINT(exception, bring(plan, plan_size));
    refusal_text(told);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(told, why), told);
    TEST_ASSERT_EQUAL_UINT(MODBUS_STATE, set(REGISTER_CYCLE_START, 1));
}

static void text_of(enum takt_error code, char *why)
{
    const struct diagnostic d = {.code = code};

    (void)takt_diagnostic_text(&d, why);
}

static void test_a_plan_for_something_else_is_refused_with_the_reason(void)
{
    struct diagnostic machine_why;
    char why[DIAGNOSTIC_TEXT_MAX];

    write_text(2);
    compile_text();
    text[text_size - 2] = '3'; /* M3 in the place of M2: another program */
    upload_text();
    text_of(TAKT_ERROR_PLAN_PROGRAM, why);
    check_refused(MODBUS_VALUE, why);
    plan[8]++;
    text_of(TAKT_ERROR_PLAN_VERSION, why);
    check_refused(MODBUS_VALUE, why);
    plan[0]++;
    text_of(TAKT_ERROR_PLAN_FOREIGN, why);
    check_refused(MODBUS_VALUE, why);

    machine.axis[AXIS_Y].max_jerk_mm_s3 = 40000;
    write_text(2);
    compile_text();
    upload_text();
    takt_diagnostic_set(&machine_why, TAKT_ERROR_PLAN_MACHINE, 0, 0, "Y jerk", 6, 40000.0);
    takt_diagnostic_set_limit(&machine_why, 50000.0);
    (void)takt_diagnostic_text(&machine_why, why);
    check_refused(MODBUS_VALUE, why);
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_RESET, 1));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
}

static void test_a_plan_that_is_given_up_or_wrong_ends_the_program_in_an_error(void)
{
    for (unsigned wrong = 0; wrong < 2; wrong++) {
        setUp();
        write_long_plan();
        begin_plan();
        if (wrong != 0)
            embedded_core.panel.upload.crc++;
        TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
        run_plan(wrong != 0 ? plan_size : plan_size / 2);
        if (wrong == 0)
            TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_ABANDON));
        for (unsigned i = 0; i < CYCLES_MAX && embedded.service.alarm == PANEL_ALARM_NONE; i++)
            cycle();
        TEST_ASSERT_EQUAL_UINT32(PANEL_ALARM_PROGRAM, get(REGISTER_ALARM));
        TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_FAILED, get(REGISTER_OUTCOME));
        TEST_ASSERT_EQUAL_INT(TAKT_ERROR_PLAN_DAMAGED, embedded.service.alarm_text.code);
        check_limits();
    }
}

static void test_a_plan_whose_memory_is_lent_is_given_up(void)
{
    write_text(2);
    compile_text();
    begin_plan();
    TEST_ASSERT_EQUAL_UINT(0, (uintptr_t)takt_plan_queue_lend(&embedded_core.plan) % 8);
    memset(takt_plan_queue_lend(&embedded_core.plan), 0xAA, PLAN_QUEUE_MAX);
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
    const uint64_t planned_here = embedded.service.digest;

    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_HEX64(planned_here, embedded.service.digest);
}

static void test_a_plan_needs_a_program_and_rest(void)
{
    write_text(2);
    compile_text();
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT(MODBUS_STATE, announce());
    upload_text();
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PLAN));
    TEST_ASSERT_EQUAL_UINT(MODBUS_VALUE, begin(plan, plan_size, PANEL_UPLOAD_BEGIN));
    TEST_ASSERT_EQUAL_UINT(0, set(REGISTER_CYCLE_START, 1));
    cycle();
    TEST_ASSERT_EQUAL_UINT(MODBUS_STATE, announce());
    wait_for(PANEL_IDLE);
    TEST_ASSERT_EQUAL_UINT32(PANEL_OUTCOME_COMPLETED, get(REGISTER_OUTCOME));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_streamed_plan_gives_the_setpoints_of_the_file);
    RUN_TEST(test_without_a_new_plan_the_program_is_planned_as_it_runs);
    RUN_TEST(test_a_late_plan_brakes_within_limits_raises_an_alarm_and_goes_on);
    RUN_TEST(test_a_plan_for_something_else_is_refused_with_the_reason);
    RUN_TEST(test_a_plan_that_is_given_up_or_wrong_ends_the_program_in_an_error);
    RUN_TEST(test_a_plan_whose_memory_is_lent_is_given_up);
    RUN_TEST(test_a_plan_needs_a_program_and_rest);
    return UNITY_END();
}

/*
 * A sender on the serial line of an image: what it is told it may send, and what becomes of bytes
 * that find no room.
 */
#include "embedded_bench.h"
#include "port/embedded_console.h"

#define SAID_MAX 65536

static struct embedded_console console;
static struct service_lines console_lines;
static char said[SAID_MAX]; /* since the last forget */

static void hear(void *context, const char *text, size_t length)
{
    (void)context;
    TEST_ASSERT_LESS_THAN(SAID_MAX, strlen(said) + length);
    strncat(said, text, length);
}

void setUp(void)
{
    const struct embedded_console_config config = {
        .embedded = &embedded, .version = "1", .write = hear};

    said[0] = '\0';
    console_lines = takt_embedded_console_get_lines(&console);
    bench_set_up_with(&console_lines);
    takt_embedded_console_init(&console, &config);
    wait_for(PANEL_IDLE);
}

void tearDown(void)
{
}

static void type(const char *text)
{
    for (; *text != '\0'; text++)
        takt_embedded_console_take_byte(&console, (uint8_t)*text);
}

static void run_cycles(unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        takt_embedded_console_background(&console);
        cycle();
    }
}

static unsigned count_said(const char *word)
{
    unsigned count = 0;

    for (const char *at = said; (at = strstr(at, word)) != NULL; at++)
        count++;
    return count;
}

static void test_all_that_a_sender_is_told_finds_room_before_anybody_looks(void)
{
    unsigned told;

    type("$I\n");
    run_cycles(10);
    const char *options = strstr(said, "[OPT:");
    TEST_ASSERT_NOT_NULL(options);
    TEST_ASSERT_EQUAL_INT(1, sscanf(options, "[OPT:%*[^,],%*u,%u", &told));
    said[0] = '\0';
    for (unsigned i = 0; i < told; i++)
        type("\n");
    run_cycles(2000);
    TEST_ASSERT_EQUAL_UINT(told, count_said("ok"));
}

static void test_a_line_that_has_lost_bytes_is_an_error_and_moves_nothing(void)
{
    const struct point *set = &embedded.service.controller.record.set;
    char text[LINE_RING_MAX + 64];
    size_t length = 0;

    while (length < LINE_RING_MAX - 4)
        length += (size_t)sprintf(text + length, "\n");
    (void)sprintf(text + length, "G1 F6000 X12345\nX3\n");
    type(text); /* the ring ends in "G1 F" */
    run_cycles(2000);
    TEST_ASSERT_EQUAL_UINT(LINE_RING_MAX - 4, count_said("ok"));
    TEST_ASSERT_EQUAL_UINT(0, count_said("error"));
    type("000 X7\n");
    run_cycles(2000);
    TEST_ASSERT_EQUAL_UINT_MESSAGE(1, count_said("error:11"), said);
    TEST_ASSERT_EQUAL_DOUBLE(0, set->at[0]);
    type("G0 X2\n");
    run_cycles(2000);
    TEST_ASSERT_EQUAL_UINT(LINE_RING_MAX - 3, count_said("ok"));
    TEST_ASSERT_EQUAL_DOUBLE(2, set->at[0]);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_that_a_sender_is_told_finds_room_before_anybody_looks);
    RUN_TEST(test_a_line_that_has_lost_bytes_is_an_error_and_moves_nothing);
    return UNITY_END();
}

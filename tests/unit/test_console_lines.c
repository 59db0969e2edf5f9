/* The ring of lines between console and program. */
#include "console/lines.h"
#include "unity.h"

#include <string.h>

#define SIZE 64

static struct lines lines;
static uint8_t ring[SIZE];
static struct source source;
static char text[LINES_LENGTH_MAX + 1];

void setUp(void)
{
    takt_lines_init(&lines, ring, SIZE);
}

void tearDown(void)
{
}

static void put(const char *bytes)
{
    for (; *bytes != '\0'; bytes++)
        TEST_ASSERT_TRUE(takt_lines_put(&lines, (uint8_t)*bytes));
}

static const char *read_one(void)
{
    static char buffer[LINES_LENGTH_MAX];
    const long count = source.read(source.context, buffer, sizeof buffer);

    if (count < 0)
        return count == SOURCE_LATER ? "later" : "end";
    buffer[count] = '\0';
    return buffer;
}

static void test_a_line_is_read_when_it_is_released_and_answered_when_the_next_is_asked_for(void)
{
    uint8_t answer;

    put("G0\nG1\n");
    takt_lines_open(&lines, &source);
    TEST_ASSERT_EQUAL_STRING("later", read_one());
    takt_lines_release(&lines);
    TEST_ASSERT_EQUAL_STRING("G0\n", read_one());
    TEST_ASSERT_FALSE(takt_lines_collect(&lines, text, &answer));
    TEST_ASSERT_EQUAL_STRING("later", read_one());
    TEST_ASSERT_TRUE(takt_lines_collect(&lines, text, &answer));
    TEST_ASSERT_EQUAL_STRING("G0", text);
    TEST_ASSERT_EQUAL_UINT8(0, answer);
}

static void test_the_ring_goes_round_and_lines_keep_their_order_and_answers(void)
{
    const struct diagnostic why = {.code = TAKT_ERROR_WORD_UNKNOWN};
    struct diagnostic told;
    uint8_t answer;

    takt_lines_open(&lines, &source);
    for (unsigned i = 0; i < 50; i++) {
        char line[] = "N00 X1\n";

        line[1] = (char)('0' + i / 10);
        line[2] = (char)('0' + i % 10);
        put(line);
        takt_lines_release(&lines);
        TEST_ASSERT_EQUAL_STRING(line, read_one());
        if (i % 3 == 0)
            takt_lines_refuse(&lines, 20, &why);
        (void)read_one();
        TEST_ASSERT_TRUE(takt_lines_collect(&lines, text, &answer));
        TEST_ASSERT_EQUAL_UINT8(i % 3 == 0 ? 20 : 0, answer);
        takt_lines_take_why(&lines, &told);
        TEST_ASSERT_EQUAL_INT(i % 3 == 0 ? TAKT_ERROR_WORD_UNKNOWN : TAKT_OK, told.code);
        TEST_ASSERT_EQUAL_UINT32(takt_lines_capacity(&lines), takt_lines_room(&lines));
    }
}

static void test_what_the_console_has_answered_is_passed_over(void)
{
    uint8_t answer;

    put("G0\n$$\nG1\n");
    takt_lines_open(&lines, &source);
    takt_lines_release(&lines);
    TEST_ASSERT_EQUAL_STRING("G0\n", read_one());
    TEST_ASSERT_EQUAL_UINT8(LINES_NEW, takt_lines_look(&lines, text));
    TEST_ASSERT_EQUAL_STRING("$$", text);
    takt_lines_skip(&lines);
    takt_lines_release(&lines);
    TEST_ASSERT_EQUAL_STRING("G1\n", read_one());
    takt_lines_end(&lines, 9, TAKT_ERROR_ENDED);
    TEST_ASSERT_TRUE(takt_lines_collect(&lines, text, &answer));
    TEST_ASSERT_EQUAL_UINT8(0, answer);
    TEST_ASSERT_TRUE(takt_lines_collect(&lines, text, &answer));
    TEST_ASSERT_EQUAL_STRING("G1", text);
    TEST_ASSERT_EQUAL_UINT8(9, answer);
    TEST_ASSERT_FALSE(takt_lines_collect(&lines, text, &answer));
}

static void test_lines_that_the_program_has_not_read_come_back(void)
{
    put("M2\nG0\n");
    takt_lines_open(&lines, &source);
    takt_lines_release(&lines);
    takt_lines_release(&lines);
    TEST_ASSERT_EQUAL_STRING("M2\n", read_one());
    takt_lines_end(&lines, 0, TAKT_OK);
    TEST_ASSERT_EQUAL_UINT8(0, takt_lines_look(&lines, text));
    takt_lines_take_back(&lines);
    TEST_ASSERT_EQUAL_UINT8(LINES_NEW, takt_lines_look(&lines, text));
    TEST_ASSERT_EQUAL_STRING("G0", text);
}

static void test_there_is_always_room_for_the_end_of_a_line(void)
{
    unsigned taken = 0;

    while (takt_lines_put(&lines, 'X'))
        taken++;
    TEST_ASSERT_TRUE(taken >= SIZE - 4);
    TEST_ASSERT_TRUE(takt_lines_put(&lines, '\n'));
    TEST_ASSERT_EQUAL_UINT8(LINES_LONG, takt_lines_look(&lines, text));
    TEST_ASSERT_TRUE(takt_lines_room(&lines) > 0);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_line_is_read_when_it_is_released_and_answered_when_the_next_is_asked_for);
    RUN_TEST(test_the_ring_goes_round_and_lines_keep_their_order_and_answers);
    RUN_TEST(test_what_the_console_has_answered_is_passed_over);
    RUN_TEST(test_lines_that_the_program_has_not_read_come_back);
    RUN_TEST(test_there_is_always_room_for_the_end_of_a_line);
    return UNITY_END();
}

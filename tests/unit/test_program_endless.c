/*
 * Programs that read the same lines again and again, and texts in which no line can be read twice.
 */
#include "program_flow_bench.h"

/*
 * A jump of a translator (O<place> GOTO line blocks), and a line that goes on: what lies behind is
 * as new, and read again, as elsewhere.
 */
static void test_a_circle_behind_a_jump_forward_is_stopped(void)
{
    expect_refused("o23 goto [3] [0]\nG0 X1\no1 while [1]\n#1=2\no1 endwhile\n", TAKT_ERROR_CIRCLE,
                   4);
    expect_refused("F100\n\x1fG1 X1\no1 while [1]\n#1=2\no1 endwhile\n", TAKT_ERROR_CIRCLE, 3);
}

static void test_a_program_that_runs_in_a_circle_without_a_move_is_stopped(void)
{
    expect_refused("o1 while [1]\n#1=[#1+1]\no1 endwhile\n", TAKT_ERROR_CIRCLE, 2);
    expect_refused("M99\n", TAKT_ERROR_CIRCLE, 1);
    expect_refused("o1 while [1]\nG0 X0\no1 endwhile\n", TAKT_ERROR_CIRCLE, 2);
    expect_refused("F100 G1 X5\no1 while [1]\nG1 X5\nM8\nM9\no1 endwhile\n", TAKT_ERROR_CIRCLE, 2);
    expect_refused("o1 while [1]\nG4 P0\no1 endwhile\n", TAKT_ERROR_CIRCLE, 2);
    TEST_ASSERT_EQUAL_INT(
        PROGRAM_END, takt_program_next(&reader.program, &(struct move){0}, &reader.diagnostic));
}

/* A stream: the same text without a way back. */
static void open_stream(const char *text)
{
    struct source source;

    reader_prepare(&reader);
    takt_source_open_text(&source, &reader.text, text, strlen(text));
    source.seek = NULL;
    takt_program_open(&reader.program, &reader.config, &source);
}

static void expect_no_way_back(const char *text, const char *word)
{
    open_stream(text);
    reader_expect_error(&reader, TAKT_ERROR_JUMP_BACK);
    TEST_ASSERT_EQUAL_STRING(word, reader.diagnostic.word);
}

static void test_a_stream_passes_over_text_but_never_goes_back(void)
{
    open_stream("o1 if [0]\nG0 X9\no1 else\nG0 X1\no1 endif\no2 while [0]\nG0 X9\no2 endwhile\n"
                "o3 repeat [1]\nG0 X2\no3 endrepeat\no4 do\nG0 X3\no4 while [0]\no5 sub\no5 "
                "endsub\nG0 X4\n");
    for (unsigned i = 1; i <= 4; i++) {
        expect_x(i);
    }
    reader_expect_end(&reader);
    expect_no_way_back("o2 while [1]\n", "O2 WHILE");
    expect_no_way_back("o2 repeat [2]\n", "O2 REPEAT");
    expect_no_way_back("o2 do\no2 while [1]\n", "O2 WHILE");
    expect_no_way_back("o5 sub\no5 endsub\no5 call\n", "O5 CALL");
    expect_no_way_back("o5 call\no5 sub\no5 endsub\n", "O5 CALL");
    expect_no_way_back("M98 P5\n", "M98 P5");
    expect_no_way_back("M99\n", "M99");
}

/* Errors that come after the first, in the order of their lines. */
static unsigned count_errors(const char *text)
{
    unsigned errors = 0;
    struct move move;
    enum program_result result;

    reader_open(&reader, text);
    do {
        result = takt_program_next(&reader.program, &move, &reader.diagnostic);
        errors += result == PROGRAM_ERROR ? 1U : 0U;
    } while (result != PROGRAM_END);
    return errors;
}

static void test_after_an_error_each_line_is_read_once_more_at_most(void)
{
    TEST_ASSERT_EQUAL_UINT(2, count_errors("o1 while [1]\nG77\nG78\no1 endwhile\n"));
    TEST_ASSERT_EQUAL_UINT(1, count_errors("o1 repeat [1000]\nG77\no1 endrepeat\nM99\n"));
    TEST_ASSERT_EQUAL_UINT(2, count_errors("o1 call\no1 call\nG77\nM2\no1 sub\nG78\no1 endsub\n"));
    TEST_ASSERT_EQUAL_UINT(3,
                           count_errors("G77\no1 if [\nG78\no1 elseif [1]\nG79\no1 endif\nG77\n"));
}

static void test_after_an_error_a_subroutine_is_gone_through_once_more(void)
{
    reader_open(&reader, "o1 sub\nG91 G0 X1\no1 endsub\nQ\no1 call\no1 call\nG90 G0 X5\n");
    reader_expect_error(&reader, TAKT_ERROR_NUMBER_EXPECTED);
    expect_x(1.0);
    expect_x(5.0);
    reader_expect_end(&reader);
}

static void test_a_search_in_vain_goes_on_behind_its_call(void)
{
    reader_open(&reader, "o1 call\nG0 X1\no2 call\nG0 X2\n");
    reader_expect_error(&reader, TAKT_ERROR_SUB_UNKNOWN);
    expect_x(1.0);
    reader_expect_error(&reader, TAKT_ERROR_SUB_UNKNOWN);
    expect_x(2.0);
    reader_expect_end(&reader);
}

/* A move each round, so that it is no endless loop of lines without one. */
static void test_lines_are_not_read_again_more_often_than_the_host_lets_them(void)
{
    struct move move;
    enum program_result result = PROGRAM_MOVE;

    reader_prepare(&reader);
    reader.config.repeats_max = 100;
    reader_text(&reader, "o1 while [1]\nG0 X1\nG0 X0\no1 endwhile\n");
    for (unsigned i = 0; i < 100 && result == PROGRAM_MOVE; i++) {
        result = takt_program_next(&reader.program, &move, &reader.diagnostic);
    }
    TEST_ASSERT_EQUAL_INT(PROGRAM_ERROR, result);
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_ENDLESS, reader.diagnostic.code);
}

/* One that means to run for ever is no mistake. */
static void test_a_program_that_goes_back_to_its_beginning_is_read_for_long_enough(void)
{
    struct move move = {.kind = MOVE_RAPID};

    reader_prepare(&reader);
    reader.config.repeats_max = 100;
    reader_text(&reader, "G0 X1\nG0 X0\nM99\n");
    for (unsigned i = 0; i < 100 && move.kind != MOVE_END; i++) {
        TEST_ASSERT_EQUAL_INT(PROGRAM_MOVE,
                              takt_program_next(&reader.program, &move, &reader.diagnostic));
    }
    TEST_ASSERT_EQUAL_INT(PROGRAM_END,
                          takt_program_next(&reader.program, &move, &reader.diagnostic));
    TEST_ASSERT_TRUE(takt_program_warning(&reader.program, &reader.diagnostic));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_REPEATS, reader.diagnostic.code);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_circle_behind_a_jump_forward_is_stopped);
    RUN_TEST(test_a_program_that_runs_in_a_circle_without_a_move_is_stopped);
    RUN_TEST(test_a_stream_passes_over_text_but_never_goes_back);
    RUN_TEST(test_after_an_error_each_line_is_read_once_more_at_most);
    RUN_TEST(test_after_an_error_a_subroutine_is_gone_through_once_more);
    RUN_TEST(test_a_search_in_vain_goes_on_behind_its_call);
    RUN_TEST(test_a_program_that_goes_back_to_its_beginning_is_read_for_long_enough);
    RUN_TEST(test_lines_are_not_read_again_more_often_than_the_host_lets_them);
    return UNITY_END();
}

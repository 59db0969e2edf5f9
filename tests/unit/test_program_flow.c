/*
 * O-words: branches, loops, subroutines, numbered programs, and the errors of all of them.
 */
#include "program_flow_bench.h"

static void test_the_first_branch_whose_condition_holds_is_executed_and_no_other(void)
{
    static const char text[] =
        "o1 if [#1 eq 0]\nG0 X1\no1 elseif [#1 eq 0]\nG0 X2\no1 else\nG0 X3\no1 endif\n"
        "#1=1\n"
        "o1 if [#1 eq 0]\nG0 X4\no1 elseif [#1 eq 1]\nG0 X5\no1 else\nG0 X6\no1 endif\n"
        "#1=2\n"
        "o1 if [#1 eq 0]\nG0 X7\no1 elseif [#1 eq 1]\nG0 X8\no1 else\nG0 X9\no1 endif\n";

    reader_open(&reader, text);
    expect_x(1.0);
    expect_x(5.0);
    expect_x(9.0);
    reader_expect_end(&reader);
}

static void test_any_condition_but_zero_holds(void)
{
    reader_open(&reader, "o1 if [-0.001]\nG0 X1\no1 endif\no2 if [0]\nG0 X2\no2 endif\n");
    expect_x(1.0);
    reader_expect_end(&reader);
}

static void test_what_stands_in_a_branch_not_taken_need_not_be_right(void)
{
    reader_open(&reader, "o1 if [0]\nG77 ?!\no2 frobnicate\no1 endif\nG0 X1\n");
    expect_x(1.0);
    reader_expect_end(&reader);
}

static void test_while_tests_before_each_round_and_do_behind_it(void)
{
    reader_open(&reader, "o1 while [#1 lt 2]\n#1=[#1+1]\nG0 X#1\no1 endwhile\n"
                         "o2 do\n#1=[#1+1]\nG0 X#1\no2 while [#1 lt 3]\n"
                         "o3 while [0]\nG0 X99\no3 endwhile\n");
    expect_x(1.0);
    expect_x(2.0);
    expect_x(3.0);
    reader_expect_end(&reader);
}

static void test_repeat_makes_its_rounds_rounded_and_works_its_count_out_once(void)
{
    reader_open(&reader, "#2=1.6\no1 repeat [#2]\n#2=9\n#1=[#1+1]\nG0 X#1\no1 endrepeat\n"
                         "o2 repeat [-3]\nG0 X99\no2 endrepeat\n");
    expect_x(1.0);
    expect_x(2.0);
    reader_expect_end(&reader);
}

static void test_break_leaves_its_loop_and_continue_its_round(void)
{
    static const char text[] =
        "o1 while [1]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\n"
        "o3 if [#1 gt 3]\no1 break\no3 endif\nG0 X#1\no1 endwhile\n"
        "#1=10\no4 do\n#1=[#1+1]\no5 if [#1 eq 11]\no4 continue\no5 endif\nG0 X#1\no4 break\no4 "
        "while [1]\n"
        "o6 repeat [3]\n#1=[#1+1]\no7 if [#1 eq 14]\no6 continue\no7 endif\nG0 X#1\no6 endrepeat\n";

    reader_open(&reader, text);
    expect_x(1.0);
    expect_x(3.0);
    expect_x(12.0);
    expect_x(13.0);
    expect_x(15.0);
    reader_expect_end(&reader);
}

static void test_a_loop_in_a_loop_begins_anew_in_each_round(void)
{
    reader_open(&reader,
                "o1 repeat [2]\no2 repeat [2]\n#1=[#1+1]\nG0 X#1\no2 endrepeat\no1 endrepeat\n");
    for (unsigned i = 1; i <= 4; i++) {
        expect_x(i);
    }
    reader_expect_end(&reader);
}

static void test_moves_of_a_loop_name_the_line_they_are_on(void)
{
    reader_open(&reader, "o1 repeat [2]\n\nG0 X1\no1 endrepeat\nG0 X2\n");
    TEST_ASSERT_EQUAL_UINT(3, reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0).line);
    TEST_ASSERT_EQUAL_UINT(3, reader_expect(&reader, MOVE_RAPID, 1.0, 0.0, 0.0).line);
    TEST_ASSERT_EQUAL_UINT(5, reader_expect(&reader, MOVE_RAPID, 2.0, 0.0, 0.0).line);
}

static void test_a_subroutine_has_its_own_parameters_and_gives_the_callers_back(void)
{
    reader_open(&reader, "o<Go There> sub\nG0 X#1 Y#2 Z#3\n#1=99\no<go there> endsub\n"
                         "#1=7 #3=8\no<GoThere> call [1] [#1+1]\nG0 X#1 Y#2 Z#3\n");
    (void)reader_expect(&reader, MOVE_RAPID, 1.0, 8.0, 0.0);
    (void)reader_expect(&reader, MOVE_RAPID, 7.0, 0.0, 8.0);
    reader_expect_end(&reader);
}

static void test_a_subroutine_may_stand_behind_its_call_and_behind_m2(void)
{
    reader_open(
        &reader,
        "o2 call\no1 call\no2 call\nM2\no1 sub\nG0 X1\no1 endsub\no2 sub\nG0 X2\no2 endsub\n");
    expect_x(2.0);
    expect_x(1.0);
    expect_x(2.0);
    reader_expect_end(&reader);
}

static void test_one_between_a_call_and_what_it_calls_is_found_from_there(void)
{
    reader_open(&reader, "o2 call\nM2\no1 sub\nG0 X1\no1 endsub\no2 sub\no1 call\no2 endsub\n");
    expect_x(1.0);
    reader_expect_end(&reader);
}

static void test_a_subroutine_may_call_itself(void)
{
    reader_open(&reader, "o1 sub\nG0 X#1\no2 if [#1 lt 3]\no1 call [#1+1]\no2 endif\nG0 "
                         "X[10+#1]\no1 endsub\no1 call [1]\n");
    expect_x(1.0);
    expect_x(2.0);
    expect_x(3.0);
    expect_x(13.0);
    expect_x(12.0);
    expect_x(11.0);
    reader_expect_end(&reader);
}

static void test_return_leaves_open_blocks_behind_and_may_bring_a_value(void)
{
    reader_open(
        &reader,
        "o1 sub\no2 while [1]\no3 if [1]\no1 return [#1*2]\no3 endif\no2 endwhile\no1 endsub\n"
        "o1 call [4]\nG0 X#<_value>\nG0 X#<_value_returned>\n"
        "o4 sub\no4 endsub\no4 call\nG0 X[5+#<_value>+#<_value_returned>]\n");
    expect_x(8.0);
    expect_x(1.0);
    expect_x(5.0);
    reader_expect_end(&reader);
}

static void test_local_names_belong_to_one_call_and_global_ones_to_all(void)
{
    reader_open(
        &reader,
        "#<x>=1 #<_depth>=2\no1 sub\nG0 X[EXISTS[#<x>]+10]\n#<x>=5 #<_depth>=6 #<z>=7\no1 endsub\n"
        "o1 call\nG0 X#<x>\nG0 X#<_depth>\nG0 X[EXISTS[#<z>]]\no1 call\n");
    expect_x(10.0);
    expect_x(1.0);
    expect_x(6.0);
    expect_x(0.0);
    expect_x(10.0);
    reader_expect_end(&reader);
}

static void test_labels_can_be_worked_out_and_are_numbers_or_names(void)
{
    reader_open(&reader, "o100 sub\nG0 X1\no100 endsub\n#1=99\nO[#1+1] call\nN10 o<100> call\no#1 "
                         "if [1]\nG0 X2\no99 endif\n");
    expect_x(1.0);
    expect_x(1.0);
    expect_x(2.0);
    reader_expect_end(&reader);
    reader_open(&reader, "o7 if [1]\no<007> if [1]\no<7> if [1]\n");
    reader_expect_error(&reader, TAKT_ERROR_OWORD_LABEL_USED);
    TEST_ASSERT_EQUAL_STRING("O7 IF", reader.diagnostic.word);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, reader.diagnostic.value);
}

static void test_m98_shares_the_callers_parameters_and_counts_its_runs(void)
{
    reader_open(
        &reader,
        "o1 (title)\n#1=1\nM98 P100 L2\nG0 X#1\nM98 P100 L0\nM98 P200\nM30\no100\n#1=[#1+10]\nM99\n"
        "o200\nM98 P100\nG0 X#1\nM99\n");
    expect_x(21.0);
    expect_x(31.0);
    reader_expect_end(&reader);
}

static void test_a_move_beside_m98_comes_before_it(void)
{
    reader_open(&reader, "G0 X1 M98 P5\nM2\no5\nG0 X2\nM99\n");
    expect_x(1.0);
    expect_x(2.0);
    reader_expect_end(&reader);
}

static void test_m99_in_the_main_program_begins_again(void)
{
    reader_open(&reader, "%\n#1=[#1+1]\nG0 X#1\nM99\n");
    for (unsigned i = 1; i <= 5; i++) {
        expect_x(i);
    }
}

static void test_every_o_word_that_fits_nowhere_is_refused(void)
{
    expect_refused("o1 endif\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 else\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 elseif [1]\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 endwhile\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 endrepeat\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 break\n", TAKT_ERROR_OWORD_UNMATCHED, 1);
    expect_refused("o1 if [1]\no1 continue\n", TAKT_ERROR_OWORD_UNMATCHED, 2);
    expect_refused("o1 if [1]\no1 endwhile\n", TAKT_ERROR_OWORD_UNMATCHED, 2);
    expect_refused("o1 repeat [1]\no2 if [1]\no1 endrepeat\n", TAKT_ERROR_OWORD_CROSSED, 3);
    expect_refused("o1 repeat [1]\no1 if [1]\n", TAKT_ERROR_OWORD_LABEL_USED, 2);
    expect_refused("o1 if [0]\no1 if [1]\n", TAKT_ERROR_OWORD_LABEL_USED, 2);
    expect_refused("o1 endsub\n", TAKT_ERROR_SUB_NOT_INSIDE, 1);
    expect_refused("M98 P1\nM2\no1\no2 sub\n", TAKT_ERROR_SUB_NESTED, 4);
    expect_refused("o1 sub\no1 endsub\no1 sub\n", TAKT_ERROR_SUB_DEFINED_TWICE, 3);
    expect_refused("o1 call\n", TAKT_ERROR_SUB_UNKNOWN, 1);
    expect_refused("M98 P7\n", TAKT_ERROR_SUB_UNKNOWN, 1);
}

static void test_the_two_styles_of_subroutines_do_not_mix(void)
{
    expect_refused("o1 sub\no1 endsub\nM98 P1\n", TAKT_ERROR_SUB_STYLE, 3);
    expect_refused("o1 call\nM2\no1\nM99\n", TAKT_ERROR_SUB_STYLE, 1);
    expect_refused("o1 sub\nM99\no1 endsub\no1 call\n", TAKT_ERROR_SUB_STYLE, 2);
    expect_refused("M98 P1\nM2\no1\no1 endsub\n", TAKT_ERROR_SUB_STYLE, 4);
}

static void test_what_is_open_at_the_end_is_named_where_it_was_opened(void)
{
    expect_refused("\no1 if [1]\nG0 X1\n", TAKT_ERROR_OWORD_UNCLOSED, 2);
    TEST_ASSERT_EQUAL_STRING("O1 IF", reader.diagnostic.word);
    expect_refused("o1 if [0]\no<later> while [1]\n%\n", TAKT_ERROR_OWORD_UNCLOSED, 1);
    expect_refused("o<long> sub\nG0 X1\n", TAKT_ERROR_OWORD_UNCLOSED, 1);
    TEST_ASSERT_EQUAL_STRING("O<LONG> SUB", reader.diagnostic.word);
    expect_refused("o1 call\nM2\no1 sub\nG0 X1\n", TAKT_ERROR_OWORD_UNCLOSED, 3);
    expect_refused("M98 P1\nM2\no1\nG0 X1\n", TAKT_ERROR_OWORD_UNCLOSED, 3);
}

static void test_words_that_cannot_be_read_are_refused(void)
{
    expect_refused("o1 frob\n", TAKT_ERROR_OWORD_UNKNOWN, 1);
    TEST_ASSERT_EQUAL_STRING("FROB", reader.diagnostic.word);
    expect_refused("o1.5 if [1]\n", TAKT_ERROR_OWORD_LABEL, 1);
    expect_refused("o-1 if [1]\n", TAKT_ERROR_OWORD_LABEL, 1);
    expect_refused("o<> call\n", TAKT_ERROR_OWORD_LABEL, 1);
    expect_refused("o<a call\n", TAKT_ERROR_OWORD_LABEL, 1);
    expect_refused("o<a234567890123456789012345678901> call\n", TAKT_ERROR_SUB_UNKNOWN, 1);
    expect_refused("o<a234567890123456789012345678901234567890123456789012345678901234> call\n",
                   TAKT_ERROR_OWORD_LABEL, 1);
    expect_refused("o call\n", TAKT_ERROR_NUMBER_EXPECTED, 1);
    expect_refused("o1 if 1\n", TAKT_ERROR_BRACKET_EXPECTED, 1);
    expect_refused("o1 if [1] G0 X1\n", TAKT_ERROR_OWORD_ALONE, 1);
    expect_refused("o1 do X1\n", TAKT_ERROR_OWORD_ALONE, 1);
    expect_refused("o1 call 5\n", TAKT_ERROR_OWORD_ALONE, 1);
    expect_refused("G0 X1 o1 if [1]\n", TAKT_ERROR_WORD_UNKNOWN, 1);
    expect_refused("M98 L2\n", TAKT_ERROR_CALL_P_MISSING, 1);
    expect_refused("M98 P1.5\n", TAKT_ERROR_WORD_NOT_WHOLE, 1);
    expect_refused("M98 P-1\n", TAKT_ERROR_WORD_OUT_OF_RANGE, 1);
}

/* Writes more behind the text, this many times; there is room. */
static void append(char *text, const char *more, unsigned times)
{
    size_t length = strlen(text);

    while (times-- > 0) {
        memcpy(text + length, more, strlen(more) + 1);
        length += strlen(more);
    }
}

static void test_a_call_takes_thirty_arguments(void)
{
    static char text[512];

    text[0] = '\0';
    append(text, "o1 sub\nG0 X#30\no1 endsub\no1 call ", 1);
    append(text, "[7]", 30);
    reader_open(&reader, text);
    expect_x(7.0);
    append(text, "[7]", 1);
    expect_refused(text, TAKT_ERROR_CALL_ARGUMENTS, 4);
}

/* PROGRAM_BLOCKS_MAX blocks, each with its own label, and one more. */
static void test_blocks_and_calls_have_a_stated_depth(void)
{
    static char text[4096];
    unsigned line = 0;

    text[0] = '\0';
    for (line = 0; line <= PROGRAM_BLOCKS_MAX; line++) {
        const char label[] = {'o', '<', (char)('a' + line), '>', '\0'};

        append(text, label, 1);
        append(text, "if [1]\n", 1);
    }
    expect_refused(text, TAKT_ERROR_OWORD_TOO_DEEP, PROGRAM_BLOCKS_MAX + 1);
    reader_open(
        &reader,
        "o1 sub\nG0 X#1\no2 if [#1 lt 10]\no1 call [#1+1]\no2 endif\no1 endsub\no1 call [1]\n");
    for (unsigned i = 1; i <= PROGRAM_CALLS_MAX; i++) {
        expect_x(i);
    }
    reader_expect_end(&reader);
    expect_refused("o1 sub\no1 call\no1 endsub\no1 call\n", TAKT_ERROR_CALL_TOO_DEEP, 2);
}

static void test_a_text_has_a_stated_number_of_subroutines(void)
{
    static char text[8192];

    text[0] = '\0';
    for (unsigned i = 0; i <= PROGRAM_SUBS_MAX; i++) {
        const char label[] = {'o', (char)('1' + i / 10), (char)('0' + i % 10), '\0'};

        append(text, label, 1);
        append(text, " sub\n", 1);
        append(text, label, 1);
        append(text, " endsub\n", 1);
    }
    expect_refused(text, TAKT_ERROR_SUBS_TOO_MANY, 2 * PROGRAM_SUBS_MAX + 1);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_first_branch_whose_condition_holds_is_executed_and_no_other);
    RUN_TEST(test_any_condition_but_zero_holds);
    RUN_TEST(test_what_stands_in_a_branch_not_taken_need_not_be_right);
    RUN_TEST(test_while_tests_before_each_round_and_do_behind_it);
    RUN_TEST(test_repeat_makes_its_rounds_rounded_and_works_its_count_out_once);
    RUN_TEST(test_break_leaves_its_loop_and_continue_its_round);
    RUN_TEST(test_a_loop_in_a_loop_begins_anew_in_each_round);
    RUN_TEST(test_moves_of_a_loop_name_the_line_they_are_on);
    RUN_TEST(test_a_subroutine_has_its_own_parameters_and_gives_the_callers_back);
    RUN_TEST(test_a_subroutine_may_stand_behind_its_call_and_behind_m2);
    RUN_TEST(test_one_between_a_call_and_what_it_calls_is_found_from_there);
    RUN_TEST(test_a_subroutine_may_call_itself);
    RUN_TEST(test_return_leaves_open_blocks_behind_and_may_bring_a_value);
    RUN_TEST(test_local_names_belong_to_one_call_and_global_ones_to_all);
    RUN_TEST(test_labels_can_be_worked_out_and_are_numbers_or_names);
    RUN_TEST(test_m98_shares_the_callers_parameters_and_counts_its_runs);
    RUN_TEST(test_a_move_beside_m98_comes_before_it);
    RUN_TEST(test_m99_in_the_main_program_begins_again);
    RUN_TEST(test_every_o_word_that_fits_nowhere_is_refused);
    RUN_TEST(test_the_two_styles_of_subroutines_do_not_mix);
    RUN_TEST(test_what_is_open_at_the_end_is_named_where_it_was_opened);
    RUN_TEST(test_words_that_cannot_be_read_are_refused);
    RUN_TEST(test_a_call_takes_thirty_arguments);
    RUN_TEST(test_blocks_and_calls_have_a_stated_depth);
    RUN_TEST(test_a_text_has_a_stated_number_of_subroutines);
    return UNITY_END();
}

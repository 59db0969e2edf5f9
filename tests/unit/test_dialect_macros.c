/* host/dialect: calculations, loops, jumps and calls of Fanuc and Haas. */
#include "dialect_expect.h"

static void wrong(const char *from, uint32_t line, const char *message)
{
    TEST_ASSERT_TRUE(dialect_translate(DIALECT_FANUC, &codes, NULL, from, strlen(from), &result));
    TEST_ASSERT_EQUAL_STRING(message, result.wrong);
    TEST_ASSERT_EQUAL_UINT32(line, result.wrong_line);
    dialect_text_free(&result.text);
}

static void test_calculations_are_bracketed_wherever_they_stand(void)
{
    expect(DIALECT_FANUC, "N2 #2=1+1\n#1=7 MOD 3 (c)\n#1=#2+1 #3=4 #4=5*6\n",
           "N2 #2=[1+1]\n#1=[7 MOD 3 ](c)\n#1=[#2+1 ]#3=4 #4=[5*6]\n");
    expect(DIALECT_FANUC, "IF[#1GT2]THEN#2=#1-1\n",
           "o92000001 if [#1GT2]\n|#2=[#1-1]\n|o92000001 endif\n");
}

static void test_operations_on_bits_are_told(void)
{
    wrong("#1=6 AND 3\n", 1,
          "'#1=[6 AND 3]': AND, OR and XOR of bits are not supported, of conditions are");
    wrong("#1=2\n#1=[#2 XOR 3]\n", 2,
          "'#1=[#2 XOR 3]': AND, OR and XOR of bits are not supported, of conditions are");
    wrong("#1=[[#2 EQ 1] OR [#3 EQ 2]]\n", 0, "");
    wrong("#1=ROUND[#2] (AND)\n", 0, "");
}

static void test_loops_that_do_not_match_are_told_by_their_own_names(void)
{
    wrong("END2\n", 1, "END2: no DO2 is open here");
    wrong("WHILE[1]DO1\nWHILE[1]DO2\nEND1\n", 3, "END1 stands inside DO2, which line 2 begins");
    wrong("O1\nWHILE[1]DO1\nM30\nO2\nM99\n", 2, "DO1 has no END1 in this program");
    wrong("WHILE #1 LT 3 DO1\nEND1\n", 1, "WHILE needs a condition in brackets");
}

static void test_what_stands_far_behind_an_if_is_kept(void)
{
    char from[2048], to[2100];

    (void)snprintf(from, sizeof from, "IF [#1 EQ 1] THEN %1500s #2=3\n", "");
    (void)snprintf(to, sizeof to, "o92000001 if [#1 EQ 1]\n| %1500s #2=3\n|o92000001 endif\n", "");
    expect(DIALECT_FANUC, from, to);
}

static void test_a_jump_can_go_to_the_number_that_is_worked_out(void)
{
    expect(DIALECT_FANUC, "GOTO #1\nN5\nN6\nN5\n",
           "o98000001 if [[ #1] EQ 5]\n|o00000185 goto [00000002] [00]\n|o98000001 endif\n"
           "|o98000001 if [[ #1] EQ 6]\n|o00000188 goto [00000003] [00]\n|o98000001 endif\n"
           "|(abort,GOTO: no line has this N)\nN5\nN6\nN5\n");
    /* one in a loop is none that it may go to */
    expect(DIALECT_FANUC, "GOTO[#1]\nDO1\nN5\nEND1\n",
           "o98000001 if [[[#1]] EQ 5]\n|                              \n|o98000001 endif\n"
           "|(abort,GOTO: no line has this N)\n"
           "o91000001 while [1]\nN5\no91000001 endwhile\n");
}

static void test_a_number_is_looked_for_behind_the_jump_first(void)
{
    expect(DIALECT_FANUC, "N5 X1\nGOTO 5\nN5 X2\nN5 X3\n",
           "N5 X1\no00000037 goto [00000003] [00]\nN5 X2\nN5 X3\n");
}

static void test_numbers_stand_behind_slashes_and_comments(void)
{
    expect(DIALECT_FANUC, "GOTO 1\n/N1\n", "o00000031 goto [00000002] [00]\n/  \n");
    expect(DIALECT_FANUC, "GOTO 1\n(c) (d)N1\n", "o00000031 goto [00000002] [00]\n(c) (d)  \n");
    expect(DIALECT_FANUC, "G50 S9\nG70 P1 Q2\n/2 (c)N1 X1\n(d)N2 X3\n",
           "G18 G7 G95\no93000001 sub\n|         X1\n|      X3\n|o93000001 endsub\n"
           "|#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n|G70 Q93000001\n|G0 X#<_turning_x>\n"
           "|Z#<_turning_z>\n/  (c)   X1\n(d)   X3\n");
}

static void test_what_one_line_becomes_is_left_out_with_it(void)
{
    expect(DIALECT_FANUC, "/GOTO 1\nN1\n/IF[1]GOTO 1\n",
           "/o00000032 goto [00000002] [00]\nN1\n"
           "/o92000003 if [1]\n|/o00000032 goto [00000002] [00]\n|/o92000003 endif\n");
}

#define TEN " [0] [0] [0] [0] [0] [0] [0] [0] [0] [0]"

static void test_macros_are_called_as_often_as_l_says(void)
{
    expect(DIALECT_FANUC, "G90 G65 P8 L3 X2.\n",
           "G90 \n|o99000001 repeat [3]\n|o8 call" TEN TEN " [0] [0] [0] [2.] [0] [0]\n"
           "|o99000001 endrepeat\n");
}

static void test_i_j_and_k_may_come_again(void)
{
    expect(DIALECT_FANUC, "G65 P8 I1. J2. K3. I4.\n",
           "o8 call [0] [0] [0] [1.] [2.] [3.] [4.] [0] [0] [0]" TEN " [0] [0] [0] [0] [0] [0]\n");
    expect(DIALECT_FANUC, "G65 P8 I1 I2 I3 I4 I5 I6 I7 I8 J9\n",
           "o8 call [0] [0] [0] [1] [0] [0] [2] [0] [0] [3] [0] [0] [4] [0] [0] [5] [0] [0] [6] "
           "[0] [0] [7] [0] [0] [8] [9]\n");
    wrong("G65 P8 I1 I2 I3 I4 I5 I6 I7 I8 I9 I0\n", 1,
          "'I0': an argument as far as #30, with 47 characters at most");
}

static void test_calls_of_lines_tell_of_haas(void)
{
    TEST_ASSERT_EQUAL_INT(DIALECT_HAAS, guess("$AddRegPart 1 X3 Y2\nO5\nM97 P3").dialect);
    TEST_ASSERT_EQUAL_INT(DIALECT_FANUC, guess("O5\n$AddRegPart 1 X3 Y2").dialect);
    TEST_ASSERT_EQUAL_INT(DIALECT_GRBL, guess("$H\nG0 X1").dialect);
}

static void test_printers_have_splines(void)
{
    expect(DIALECT_MARLIN, "G5 I0 J3 P0 Q-3 X6 Y5 E2\n", "G5 I0 J3 P0 Q-3 X6 Y5   \n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_calculations_are_bracketed_wherever_they_stand);
    RUN_TEST(test_operations_on_bits_are_told);
    RUN_TEST(test_loops_that_do_not_match_are_told_by_their_own_names);
    RUN_TEST(test_what_stands_far_behind_an_if_is_kept);
    RUN_TEST(test_a_jump_can_go_to_the_number_that_is_worked_out);
    RUN_TEST(test_a_number_is_looked_for_behind_the_jump_first);
    RUN_TEST(test_numbers_stand_behind_slashes_and_comments);
    RUN_TEST(test_what_one_line_becomes_is_left_out_with_it);
    RUN_TEST(test_macros_are_called_as_often_as_l_says);
    RUN_TEST(test_i_j_and_k_may_come_again);
    RUN_TEST(test_calls_of_lines_tell_of_haas);
    RUN_TEST(test_printers_have_splines);
    return UNITY_END();
}

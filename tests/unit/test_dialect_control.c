/*
 * host/dialect: offsets and variables of the control, which Fanuc and Haas number and count in
 * other ways than LinuxCNC.
 */
#include "dialect_expect.h"

static void wrong_of(enum dialect dialect, const char *from, const char *message)
{
    TEST_ASSERT_TRUE(dialect_translate(dialect, &codes, NULL, from, strlen(from), &result));
    TEST_ASSERT_EQUAL_STRING(message, result.wrong);
    dialect_text_free(&result.text);
}

static void wrong(const char *from, const char *message)
{
    wrong_of(DIALECT_FANUC, from, message);
}

#define SUM "/[1+24.4*#<_imperial>]]"

static void test_offsets_set_in_g91_are_added(void)
{
    expect(DIALECT_FANUC, "G90 G10 L2 P1 X1.\n", "G90 G10 L2 P1 X1.\n");
    expect(DIALECT_FANUC, "G91 G10 L2 P1 X1. A2.\n",
           "G91 G10 L2 P1 x[[1.]+1*#[5201+20*[1]]" SUM " a[[2.]+1*#[5204+20*[1]]]\n");
    expect(DIALECT_HAAS, "G10 L2 P#1 Y1.\n",
           "G10 L2 P#1 y[[1.]+#<_incremental>*#[5202+20*[#1]]" SUM "\n");
    wrong("G91 G10 L2 P1 X[1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1]\n",
          "this is too long for G10 L2, which adds in G91: work it out on a line of its own");
    expect(DIALECT_GRBL, "G91 G10 L2 P1 X1\n", "G91 G10 L2 P1 X1\n");
}

static void test_what_displaces_all_systems_is_told(void)
{
    const char *text = "G10 L2 P0 displaces all work offsets, which is not supported: add it to "
                       "those of P1 to P6";

    wrong("G90 G10 L2 P0 X0 Y1.\n", text);
    wrong("G90 G10 L2 P0 X0 Y0.\n", "");
    expect(DIALECT_FANUC, "G90 G10 L2 P0 X0 Y0.\n", "G90                 \n");
    expect(DIALECT_GRBL, "G10 L2 P0 X1\n", "G10 L2 P0 X1\n");
}

static void test_more_systems_are_set_where_they_are_here(void)
{
    expect(DIALECT_FANUC, "G90 G10 L20 P2 X1.\n", "G90 G10 L2  P8 X1.\n");
    wrong("G90 G10 L20 P4 X1.\n", "G10 L20 sets G54.1 P1 to P3 here, and no others");
}

static void test_values_of_tools_are_those_that_r_says(void)
{
#define TOLD                                                                                       \
    " sets a value of a tool by R in G90; wear, and what is added in G91, is not supported: set "  \
    "the sum"

    expect(DIALECT_FANUC, "G90 G10 L10 P1 R80.\nG10 L12 P1 R5.\n",
           "G90 G10 L1  P1 Z80.\nG10 L1  P1 R5.\n");
    expect(DIALECT_FANUC, "G90 G10 L11 P1 R0 M8\n", "G90               M8\n");
    wrong("G10 L13 P1 R.1\n", "G10 L13" TOLD);
    wrong("G91\nG10 L10 P1 R1.\n", "G10 L10" TOLD);
    wrong("G10 L10 P1 Z1.\n", "G10 L10" TOLD);
    wrong("G91\nG90 G10 L10 P1 R1.\n", "");
    wrong("G50 S9\nG10 L10 P1 R.4\n", "G10 L10 of a lathe: use the tool table");
    wrong_of(DIALECT_HAAS, "G10 L12 P1 R5.\n",
             "G10 L12: a setting of the control says whether R is a radius or a diameter: use the "
             "tool table");
}

static void test_variables_of_the_control_have_other_names(void)
{
    expect(DIALECT_FANUC, "#1=#5041+#5003 (#5041)\nG0 X#5021\n",
           "#1=[#5420+#5422 ](#5041)\nG0 X#<_abs_x>\n");
    expect(DIALECT_HAAS, "G#4003 F#4109 G#4214\n",
           "G[90+#<_incremental>] F#<_feed> "
           "G[#<_coord_system>/10]\n");
    expect(DIALECT_FANUC, "#1=#[5221+20*#[2]]\n",
           "#1=[#[5221+20*#[2]]/[1+24.4*#<_imperial>*[[[5221+20*#[2]]-5221] MOD 20 LT 3]]]\n");
    expect(DIALECT_FANUC, "#1=#5242+#5244\n", "#1=[[#5242" SUM "+#5244]\n");
    expect(DIALECT_GRBL, "#1=#5041\n", "#1=#5041\n");
    /* the same in LinuxCNC, or only kept */
    expect(DIALECT_FANUC, "#1=#5061\n#3003=1\n#999=#100\n", "#1=#5061\n#3003=1\n#999=#100\n");
}

#define WORKED_OUT                                                                                 \
    "an offset of a number that is worked out cannot be given a value here, nor read on lathes: "  \
    "G10 L2 P#1 X10 sets one"

static void test_places_and_offsets_of_lathes_are_diameters(void)
{
    expect(DIALECT_FANUC, "G50 S9\n#1=#5041+#5042+#5221\n#2=#5021*#5061\n",
           "G18 G7 G95\n#1=[[2*#5420]+#5421+[2*[#5221" SUM "]]\n#2=[[2*#<_abs_x>]*[2*#5061]]\n");
    wrong("G50 S9\n#1=#[5221+#2]\n", WORKED_OUT);
}

static void test_offsets_that_are_given_a_value_count_at_once(void)
{
    expect(DIALECT_FANUC, "#5241=#1+2\nN1 #5223=1.\n",
           "G10 L2 P2 x[[#1+2]]\nG10 L2 P1 z[1.]\n|N1         \n");
    wrong("IF [#1 EQ 1] THEN #5221=2.\n",
          "'#5221' cannot be given a value here: G10 L2 P1 X10 on a line of its own sets G54");
    wrong("#5201=2.\n",
          "'#5201' cannot be given a value here: G10 L2 P1 X10 on a line of its own sets G54");
    wrong("#[5221+#1]=2.\n", WORKED_OUT);
}

static void test_variables_that_are_not_known_are_told(void)
{
    static const char *const texts[] = {"#1=#2001",      "#2001=5.", "#1=#1000",   "#1101=1",
                                        "#1=#[2001+#4]", "#1=#3012", "G0 X#11001", "#7001=1."};
    static const unsigned numbers[] = {2001, 2001, 1000, 1101, 2001, 3012, 11001, 7001};

    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        char text[120];

        (void)snprintf(text, sizeof text,
                       "'#%u' is a variable of the control that is not known here: a number has "
                       "to stand in its place",
                       numbers[i]);
        wrong(texts[i], text);
    }
    wrong("#1=#[#2+1] #3=#[5221+20*#4]\n#2=#[100+#[#5+10]]\n", "");
}

static void test_names_are_no_operators(void)
{
    wrong("#1=#FORCE+1\n#2=[#<_coord>*2]\n", "");
}

static void test_pecks_without_a_point_are_thousandths(void)
{
    expect(DIALECT_FANUC, "G83 Z-9. R1. Q2000 F9\nG73 Z-9. Q99\nG83 Z-9. Q200.\nX1 Q100\n",
           "G83 Z-9. R1. Q[2000*[0.001-0.0009*#<_imperial>]] F9\nG73 Z-9. Q99\nG83 Z-9. Q200.\n"
           "X1 Q[100*[0.001-0.0009*#<_imperial>]]\n");
    expect(DIALECT_MACH3, "G83 Z-9 R1 Q2000 F9\n", "G83 Z-9 R1 Q2000 F9\n");
}

static void test_lathes_begin_with_feeds_per_turn(void)
{
    const char *text = "O5\nG50 S9\nG1 X1. F.2\nM99\n";

    expect(DIALECT_FANUC, "G50 S9\nG1 X1. F.2\n", "G18 G7 G95\nG1 X1. F.2\n");
    /* a subprogram has those of its caller */
    TEST_ASSERT_TRUE(dialect_translate(DIALECT_FANUC, &codes, "5", text, strlen(text), &result));
    TEST_ASSERT_NULL(strstr(result.text.bytes, "G95"));
}

static void test_codes_by_other_names(void)
{
    expect(DIALECT_MACH3, "G31 Z-5 F9\n", "G38.3 Z-5 F9\n");
    expect(DIALECT_HAAS, "G100 X0\nG0 X5\n", "       \nG0 X5\n");
    expect(DIALECT_SIEMENS, "G0 G153 X0\n", "G0 G53  X0 \n");
}

static void test_axis_words_of_codes_that_move_nothing_are_no_places(void)
{
    expect(DIALECT_FANUC, "G0 X5\nG50.1 X0 Y0\nG22 X9. I-9. M8\nX6\n",
           "G0 X5\n           \n             M8\nX6\n");
    expect(DIALECT_FANUC, "G0 X5\nG92.1 Z0 X0 Y0\n", "G0 X5\nG92.1         \n");
    expect(DIALECT_MACH3, "G0 X5\nG50.1 X0\nG5.1 Q2 X0 Y0\n", "G0 X5\n        \n             \n");
    expect(DIALECT_FANUC, "G50 X9. Z5. S2000\nG50 X8. Z4.\nG50 S1000\nG96 S9\n",
           "G18 G7 G95\n|G92 X9. Z5.      \nG92 X8. Z4.\n         \nG96 S9 D1000\n");
}

static void test_shifts_are_taken_away_of_the_axes_that_are_named(void)
{
    expect(DIALECT_FANUC, "G92.1 X0 B0\n", "G92   x[#<_x>+#5211" SUM " b[#<_b>+#5215]\n");
}

static void test_what_looks_like_an_exponent_is_the_extruder_of_a_printer(void)
{
    expect(DIALECT_MARLIN, "G1E-3F300\nG1X10E-3Y2\n", "G1   F300\nG1X10   Y2\n");
    expect(DIALECT_GRBL, "G1X1.5E-1Y2\n", "G1X0.150000000Y2\n");
}

static void test_printers_travel_at_their_feed_and_count_from_home(void)
{
    expect(DIALECT_MARLIN, "G0 X1\nG0 X2 F9\nG0 X3\nG1 X4\n", "G0 X1\nG1 X2 F9\nG1 X3\nG1 X4\n");
    expect(DIALECT_MARLIN, "G28\n", "G28\n|G92.1\n");
    expect(DIALECT_MARLIN, "G28 X\n",
           "G28 X0 G91\n|G92 x[#<_x>+#5211/[1+24.4*#<_imperial>]]\n|G90\n");
}

static void test_fix_and_fup_go_by_the_sign(void)
{
    expect(DIALECT_FANUC, "#1=FIX[#2]\n", "#1=[FIX[ABS[#2]]*[1-2*[[#2] LT 0]]]\n");
    expect(DIALECT_HAAS, "X[FUP[#1-[2]]]\n", "X[[FUP[ABS[#1-[2]]]*[1-2*[[#1-[2]] LT 0]]]]\n");
    expect(DIALECT_FANUC, "#1=FIX[ABS[#2]] (FIX[1])\n#1=FIX\n#1=FIX[2\n",
           "#1=FIX[ABS[#2]] (FIX[1])\n#1=FIX\n#1=FIX[2\n");
    wrong("#1=FIX[#2+100000000*1+100000000*1+100000000*1+100000000*1+100000000*1+100000000*1+1]\n",
          "this line is too long for what stands for a part of it in LinuxCNC: work that out on a "
          "line of its own");
    expect(DIALECT_GRBL, "#1=FIX[#2]\n", "#1=FIX[#2]\n");
}

static void test_orders_of_a_sender_do_not_end_the_program(void)
{
    TEST_ASSERT_EQUAL_INT(DIALECT_GRBL, guess("G0 X1\n%wait\nX2\n%X0=posx\nX3").dialect);
    expect(DIALECT_GRBL, "%wait\nG0 X1\n%msg Hi\n%x0=posx\nX2\n", "\nG0 X1\n\n\nX2\n");
    expect(DIALECT_FANUC, "%O12 (A=B)\n%MPF 90\n", "%\n%\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_offsets_set_in_g91_are_added);
    RUN_TEST(test_what_displaces_all_systems_is_told);
    RUN_TEST(test_more_systems_are_set_where_they_are_here);
    RUN_TEST(test_values_of_tools_are_those_that_r_says);
    RUN_TEST(test_variables_of_the_control_have_other_names);
    RUN_TEST(test_places_and_offsets_of_lathes_are_diameters);
    RUN_TEST(test_offsets_that_are_given_a_value_count_at_once);
    RUN_TEST(test_variables_that_are_not_known_are_told);
    RUN_TEST(test_names_are_no_operators);
    RUN_TEST(test_pecks_without_a_point_are_thousandths);
    RUN_TEST(test_lathes_begin_with_feeds_per_turn);
    RUN_TEST(test_codes_by_other_names);
    RUN_TEST(test_axis_words_of_codes_that_move_nothing_are_no_places);
    RUN_TEST(test_shifts_are_taken_away_of_the_axes_that_are_named);
    RUN_TEST(test_what_looks_like_an_exponent_is_the_extruder_of_a_printer);
    RUN_TEST(test_printers_travel_at_their_feed_and_count_from_home);
    RUN_TEST(test_fix_and_fup_go_by_the_sign);
    RUN_TEST(test_orders_of_a_sender_do_not_end_the_program);
    return UNITY_END();
}

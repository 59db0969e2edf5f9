/* host/dialect: what a program is written for, and what its lines become. */
#include "dialect_expect.h"

#include <stdio.h>
#include <string.h>

static void declare(const char *name, const char *value)
{
    TEST_ASSERT_NULL(dialect_code_read(&codes.code[codes.count++], name, value));
}

static void test_programs_for_linuxcnc_stay_as_they_are(void)
{
    static const char text[] = "%\n; x\n o<a> sub\nG5.1 X1 (G69)\n  #<b>=[1+2]  \n\n\tG1 X#<b>\n";

    expect(DIALECT_LINUXCNC, text, text);
}

/* What a program is taken for, and the line that tells; 0: none does. */
static const struct {
    const char *text;
    enum dialect dialect;
    uint32_t line;
} guesses[] = {
    {"G21\nG1 X1 F100 (haas, fanuc, marlin)\nM30", DIALECT_LINUXCNC, 0},
    {"O1000\nG43 H1 Z1\nM98 P1000\nG81 R1 Z-1\nM99", DIALECT_LINUXCNC, 0},
    {"o<x> sub\nG69\n$H\no<x> endsub", DIALECT_LINUXCNC, 0},
    {"#<x> = 3\nG28 X", DIALECT_LINUXCNC, 0},
    {"G5.1 X1 Y1 I1 J1", DIALECT_LINUXCNC, 0},
    {"M31\nM101", DIALECT_LINUXCNC, 0},
    {"G21\n$H", DIALECT_GRBL, 2},
    {"// mill\nG0 X1", DIALECT_GRBL, 1},
    {"# mill\nG0 X1", DIALECT_GRBL, 1},
    {"G1 X1.5e-17", DIALECT_GRBL, 1},
    {"G2 X1 I1 J0 K0", DIALECT_GRBL, 1},
    {"G0 X1\nG2 X2 CR=5", DIALECT_SIEMENS, 2},
    {"N10 R1 = 5", DIALECT_SIEMENS, 1},
    {"N20 DEF INT A=5\nX1", DIALECT_SIEMENS, 1},
    {"G0 X1\nT=\"DRILL 8\"", DIALECT_SIEMENS, 2},
    {"PROC BORE (REAL A)", DIALECT_SIEMENS, 1},
    {"G0 X1\n#<CR>=5 (CR=5)", DIALECT_LINUXCNC, 0},
    {"G0 X1 (T=\"DRILL\", GOTOF END)", DIALECT_LINUXCNC, 0},
    {"G0 X1\nG28 X", DIALECT_MARLIN, 2},
    {"G54.1 P2", DIALECT_FANUC, 1},
    {"WHILE [#1 LT 3] DO1", DIALECT_FANUC, 1},
    {"N1 IF[#1EQ1]GOTO 5", DIALECT_FANUC, 1},
    {"G0 G28 G91 Z0.", DIALECT_FANUC, 1},
    {":0100", DIALECT_FANUC, 1},
    {"(VF2 HAAS)\nG54.1 P2", DIALECT_HAAS, 2},
    {"G103 P1", DIALECT_HAAS, 1},
    {"G54.1 P2\nG187 P1", DIALECT_HAAS, 1},
    {"G54.1 P2\nG187 P1\nG28 U0", DIALECT_FANUC, 1},
    {"(Mach3)\nG69", DIALECT_MACH3, 2},
    {"G92 E0\nG1 X1 E2", DIALECT_MARLIN, 1},
    {"M104 S200", DIALECT_MARLIN, 1},
    {"%O0003 (FIXTURE)\nG0 X1", DIALECT_FANUC, 1},
    {"% (FIXTURE)\nG0 X1\n%", DIALECT_LINUXCNC, 0},
    {"G28*77", DIALECT_GRBL, 1},
    {"[BILLET X62 Z70\nG0 X1", DIALECT_FANUC, 1},
    {"G0 X1\nMSG \"tool 3\"", DIALECT_GRBL, 2},
    {"G71 G90\nG0 X1", DIALECT_FANUC, 1},
    {"G71 Q100 D1 I2 R1", DIALECT_LINUXCNC, 0},
    {"T1.1 M6", DIALECT_LINUXCNC, 0}, /* a mistake as likely */
    {"G21 H1\nG96 D1000", DIALECT_LINUXCNC, 0},
    {"H1\nT1.1\nG54.1 P2", DIALECT_FANUC, 3},
    {"G4 X2.", DIALECT_FANUC, 1},
    {"G1 X1\nG53 Z0", DIALECT_LINUXCNC, 0},
    {"G53 Z0\nG1 X1", DIALECT_LINUXCNC, 0},
    {"N10 N10 G0 X1", DIALECT_GRBL, 1},
    {"M98 Q300", DIALECT_FANUC, 1},
    {"G74 Z-40. Q5000", DIALECT_FANUC, 1},
};

static void test_only_what_linuxcnc_cannot_read_tells_of_another_dialect(void)
{
    for (size_t i = 0; i < sizeof guesses / sizeof guesses[0]; i++) {
        const struct dialect_guess g = guess(guesses[i].text);

        TEST_ASSERT_EQUAL_STRING_MESSAGE(dialect_name(guesses[i].dialect), dialect_name(g.dialect),
                                         guesses[i].text);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(guesses[i].line, g.line, guesses[i].text);
    }
}

static void test_senders_orders_and_remarks_are_no_lines(void)
{
    expect(DIALECT_GRBL, "$H\n?\n// a\n# b\nG0 X1 G0 (open\nN1 G1 X2*71\n",
           "\n\n\n\nG0 X1 G0 ;open\nN1 G1 X2\n");
}

static void test_numbers_with_exponents_are_written_out(void)
{
    expect(DIALECT_GRBL, "G0 X1 Y-2.5e-3 Z1e+2\n", "G0 X1 Y-0.002500000 Z100.000000000\n");
}

static void test_a_centre_across_the_plane_that_is_0_is_left_out(void)
{
    expect(DIALECT_GRBL, "G2 X1 I1 J0 K0\nG18\nG2 X1 I0 J0 K1\nG17 G2 X1 K1 I1\n",
           "G2 X1 I1 J0   \nG18\nG2 X1 I0    K1\nG17 G2 X1 K1 I1\n");
}

static void test_grbl_begins_with_rapids(void)
{
    expect(DIALECT_GRBL, "G21\nX1\nX2\n", "G21\nX1 G0\nX2\n");
}

static void test_axes_that_are_named_alone_go_to_their_reference(void)
{
    expect(DIALECT_GRBL, "G28 X Y\nG91 G28 Z\nG28 X1\n",
           "G28 X0 Y0 G91\n|G90\nG91 G28 Z0\nG28 X1\n");
    expect(DIALECT_MARLIN, "G28 X1 W\n",
           "G28 X0   G91\n|G92 x[#<_x>+#5211/[1+24.4*#<_imperial>]]\n|G90\n");
}

static void test_a_rapid_beside_a_reference_holds_from_the_next_line_on(void)
{
    expect(DIALECT_FANUC, "G1 X1\nG0 G28 G91 Z0.\nG90 X5\nX6\n",
           "G1 X1\n   G28 G91 Z0.\nG90 X5 G0\nX6\n");
    expect(DIALECT_FANUC, "G28 U0. W0.\n", "G18 G7 G95\n|G28 X0. Z0. G91\n|G90\n");
}

static void test_loops_branches_and_jumps_become_o_words(void)
{
    expect(DIALECT_FANUC, "WHILE[#1LT3]DO2\n#1=#1\nEND2\n",
           "o91000002 while [#1LT3]\n#1=#1\no91000002 endwhile\n");
    expect(DIALECT_FANUC, "IF [#1 EQ 1] THEN #2=3\n",
           "o92000001 if [#1 EQ 1]\n| #2=3\n|o92000001 endif\n");
    expect(DIALECT_FANUC, "N5 G1\nIF[#1EQ1]GOTO5\nGOTO 9\nN9 M30\n",
           "N5 G1\no92000002 if [#1EQ1]\n|o00000000 goto [00000001] [00]\n|o92000002 endif\n"
           "o00000107 goto [00000004] [00]\nN9 M30\n");
    expect(DIALECT_FANUC, "N1 #3000=1(STOP IT)\n#3006=1 (LOOK)\n",
           "(abort,STOP IT)\n(msg,LOOK)\n|M0\n");
}

static void test_a_jump_to_nowhere_has_no_place(void)
{
    expect(DIALECT_FANUC, "G1\nGOTO 7\nO1\nN7 G1\n",
           "G1\no00000000 goto                \nO1\nN7 G1\n");
}

static void test_macros_are_called_with_their_arguments(void)
{
    expect(DIALECT_FANUC, "G65 P9001 A1. B#3 Z-2\nO9001\nM99\n%\n",
           "o9001 call [1.] [#3] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] "
           "[0] [0] [0] "
           "[0] [0] [0] [0] [-2]\no9001 sub\no9001 return\no9001 endsub\n|%\n");
    expect(DIALECT_FANUC, "M98 P31000\nO1000\nM99\n", "M98 P1000 L3\nO1000\nM99\n");
}

static void test_dwells_in_milliseconds_become_seconds(void)
{
    expect(DIALECT_FANUC, "G4 P500\nG4 P1.5\nG4 X2.\nG4 P2\n",
           "G4 P0.500000\nG4 P1.5\nG4 P2.000000\nG4 P2\n");
    expect(DIALECT_MARLIN, "G4 P50\nG4 S2\n", "G4 P0.050000\nG4 P2.000000\n");
}

static void test_turning_has_diameters_and_limits_of_speed(void)
{
    expect(DIALECT_FANUC, "O1\nG50 S2000\nT0101\nG96 S200\nG99 G1 X5 F.1\n",
           "O1\nG18 G7 G95\nT1 M6 G43 H1\nG96 S200 D2000\nG95 G1 X5 F.1\n");
}

static void test_printers_leave_their_way(void)
{
    expect(DIALECT_MARLIN, "M104 S200\nG92 E0\nG1 X1 E2.5 F600 ;E\nM117 Hello X1\nM600\n",
           "\n      \nG1 X1      F600 ;E\n(msg, Hello X1)\nM0  \n");
    TEST_ASSERT_EQUAL_UINT(2, result.notes);
    TEST_ASSERT_EQUAL_STRING("M104", result.note[0].word);
}

static void test_declared_codes_do_what_the_machine_file_says(void)
{
    declare("M31", "ignore");
    declare("m44", "stop");
    declare("M45.1", "output 3 off");
    declare("G187", "subroutine smooth");
    expect(DIALECT_LINUXCNC, "G0 X1 M31 P5 Y2\nM44 M3\nM45.1\nG187 P1 R#3 F5\nM311\n",
           "G0 X1        Y2\n    M3\n|M0\nM65 P3\n            F5\n|o<smooth> call [1] [0] "
           "[#3]\nM311\n");
}

static void test_declarations_that_make_no_sense_are_told(void)
{
    static const char *const wrong[][2] = {
        {"M", "ignore"}, {"X1", "ignore"}, {"M31", "ignored"},  {"M31", "output on"},
        {"M31", ""},     {"M31x", "stop"}, {"M31", "output 3"}, {"M31", "subroutine "}};

    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        TEST_ASSERT_NOT_NULL_MESSAGE(dialect_code_read(&codes.code[0], wrong[i][0], wrong[i][1]),
                                     wrong[i][1]);
}

static void test_polar_words_become_x_and_y(void)
{
    TEST_ASSERT_TRUE(guess("G0 @1 ^2").translates);
    TEST_ASSERT_EQUAL_INT(DIALECT_LINUXCNC, guess("G0 @1 ^2").dialect);
    expect(DIALECT_LINUXCNC, "G90 G1 @1 ^[2*#3] (c)\n",
           "#<_polar_radius>=[[1]+0*[SQRT[#5420*#5420+#5421*#5421]]] "
           "#<_polar_angle>=[[[2*#3]]+0*[ATAN[#5421]/[#5420]]]\n"
           "|G90 G1             X[#<_polar_radius>*COS[#<_polar_angle>]-0*#5420] "
           "Y[#<_polar_radius>*SIN[#<_polar_angle>]-0*#5421](c)\n");
    expect(DIALECT_LINUXCNC, "G91\nG81 ^9 L2\n",
           "G91\n#<_polar_radius>=[SQRT[#5420*#5420+#5421*#5421]] "
           "#<_polar_angle>=[[9]+#<_incremental>*[ATAN[#5421]/[#5420]]]\n"
           "|G81       X[#<_polar_radius>*COS[#<_polar_angle>]-#<_incremental>*#5420] "
           "Y[#<_polar_radius>*SIN[#<_polar_angle>]-#<_incremental>*#5421]\n"
           "|#<_polar_radius>=[SQRT[#5420*#5420+#5421*#5421]] "
           "#<_polar_angle>=[[9]+#<_incremental>*[ATAN[#5421]/[#5420]]]\n"
           "|G81       X[#<_polar_radius>*COS[#<_polar_angle>]-#<_incremental>*#5420] "
           "Y[#<_polar_radius>*SIN[#<_polar_angle>]-#<_incremental>*#5421]\n");
}

static void test_values_of_the_machine_file_are_numbers(void)
{
    TEST_ASSERT_NULL(dialect_value_set(&codes, "_ini[traj]MAX_speed", "2.5"));
    TEST_ASSERT_NULL(dialect_value_set(&codes, "_hal[my.pin]", "-1"));
    TEST_ASSERT_NOT_NULL(dialect_value_set(&codes, "_hal[my.pin]", "1x"));
    TEST_ASSERT_NOT_NULL(dialect_value_set(&codes, "1pin", "1"));
    TEST_ASSERT_TRUE(guess("#1=#<_INI[a]b>").translates);
    expect(DIALECT_LINUXCNC, "G0 X#< _ini[TRAJ]max_speed> Y[1+#<_hal[my.pin]>] Z#<_ini[a]b>\n",
           "G0 X[2.500000000]           Y[1+[-1.000000000] ] Z#<_ini[a]b>\n");
}

static void test_a_feed_can_be_declared_for_programs_without_one(void)
{
    declare("F", "600");
    TEST_ASSERT_TRUE(guess("G1 X1").translates);
    expect(DIALECT_LINUXCNC, "%\n(A)\nG1 X1 F0\nF5\n", "%\n(A)\nF600\n|G1 X1   \nF5\n");
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[1], "F", "0"));
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[1], "F", "1x"));
}

static void test_letters_without_an_axis_drive_one_or_are_left_out(void)
{
    declare("U", "A");
    declare("v", "Y");
    declare("W", "ignore");
    TEST_ASSERT_TRUE(guess("G1 U1").translates);
    expect(DIALECT_LINUXCNC, "G1 X1 u-2.5 V#3 W[4] F5\nG20 U1\nG21 G92 U[#1+1]\n",
           "G1 X1 A[[-2.5]*[1+24.4*#<_imperial>]] Y#3      F5\nG20 A[[1]*[1+24.4*1]]\n"
           "G21 G92 A[[[#1+1]]*[1+24.4*0]]\n");
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[3], "U", "D"));
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[3], "U", "AB"));
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[3], "U", ""));
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[3], "UV", "A"));
}

static void test_names_without_brackets_are_parameters_or_values(void)
{
    TEST_ASSERT_NULL(dialect_value_set(&codes, "safe_z", "7"));
    TEST_ASSERT_EQUAL(DIALECT_GRBL, guess("G0 Z#SAFE_Z").dialect);
    expect(DIALECT_GRBL, "#a=2\nG0 Z#SAFE_Z X#a (#b)\n# remark\n",
           "#<a>=2\nG0 Z[7.000000000] X#<a> (#b)\n\n");
}

static void test_centres_that_only_fit_as_absolute_are_absolute(void)
{
    static const char text[] = "G1 X-40 Y50 F1\nG3 X-30 Y40 I-40 J40\nG2 X-40 Y50 I-40 J40\n";

    TEST_ASSERT_TRUE(guess(text).absolute);
    expect(DIALECT_MACH3, text,
           "G90.1\n|G1 X-40 Y50 F1\nG3 X-30 Y40 I-40 J40\nG2 X-40 Y50 I-40 J40\n");
    TEST_ASSERT_FALSE(guess("G1 X-40 Y50\nG3 X-30 Y40 I-40 J40\n").absolute);
    TEST_ASSERT_FALSE(guess("G1 X-40 Y50\nG3 X-30 Y40 I0 J-10\n").absolute);
    TEST_ASSERT_FALSE(
        guess("G91.1 G1 X-40 Y50\nG3 X-30 Y40 I-40 J40\nG2 X-40 Y50 I-40 J40\n").absolute);
    TEST_ASSERT_FALSE(guess("G1 X0 Y0\nG3 X0 Y0 I5 J5\n").absolute);
    TEST_ASSERT_FALSE(
        guess("o1 if [1]\nG1 X-40 Y50\nG3 X-30 Y40 I-40 J40\nG2 X-40 Y50 I-40 J40\no1 endif")
            .absolute);
}

static void test_axis_words_before_a_motion_move_at_rapid(void)
{
    TEST_ASSERT_EQUAL(DIALECT_GRBL, guess("G21 G91\nZ2\nG1 X1").dialect);
    TEST_ASSERT_EQUAL(DIALECT_LINUXCNC, guess("G21 G91\nZ2\nM2").dialect);
    TEST_ASSERT_EQUAL(DIALECT_LINUXCNC, guess("G92 X0\nG1 X1\nX2").dialect);
    TEST_ASSERT_EQUAL(DIALECT_LINUXCNC, guess("G22 C1 B0\n").dialect);
    expect(DIALECT_GRBL, "G21\nZ2\nG22 X1\n", "G21\nZ2 G0\nG22 X1\n");
}

static void test_words_that_mean_nothing_are_left_out(void)
{
    expect(DIALECT_FANUC, "G81 Z-1 R1 P5\n", "G81 Z-1 R1   \n");
    expect(DIALECT_GRBL, "G0 S1 X1 S0\nM6 P1\nT2 M6\n", "G0    X1 S0\nM0   \nT2 M6\n");
    expect(DIALECT_GRBL, "G28.2 X0 Y0\nG0 X1\n", "\nG0 X1\n");
    expect(DIALECT_FANUC, "#1=[#2-#3]/2 (A)\n", "#1=[[#2-#3]/2 ](A)\n");
}

static void test_profiles_of_fanuc_become_subroutines(void)
{
    expect(DIALECT_FANUC,
           "G50 S9\nG71 P10 Q20 U0.4 W0.1 D2. F0.2\nN10 G0 G42 X1. F3\nG1 Z-5.\nN20 G40 X9.\n"
           "G70 P10 Q20\n",
           "G18 G7 G95\n"
           "o93000010 sub\n|    G0     X1.   \n|G1 Z-5.\n|        X9.\n|o93000010 endsub\n"
           "|#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n"
           "|                          F0.2\n"
           "|G71 Q93000010 D[[ABS[0.4]/2+ABS[0.1]+ABS[ABS[0.4]/2-ABS[0.1]]]/2] I[2.] "
           "R[0.5-0.48*#<_imperial>]\n|G0 X#<_turning_x>\n|Z#<_turning_z>\n\n\n\n"
           "#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n"
           "|G42\n|G70 Q93000010\n|G40\n|G0 X#<_turning_x>\n|Z#<_turning_z>\n");
}

static void test_distances_of_cycles_can_be_whole_thousandths(void)
{
    expect(DIALECT_FANUC, "G50 S9\nG71U1250R500\nG71P10Q20U250W0.1F.2\nN10G0X1.\nN20X9.\n",
           "G18 G7 G95\n            \no93000010 sub\n|   G0X1.\n|   X9.\n|o93000010 endsub\n"
           "|#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n|                 F.2\n"
           "|G71 Q93000010 D[[ABS[250*[0.001-0.0009*#<_imperial>]]/2+ABS[0.1]+"
           "ABS[ABS[250*[0.001-0.0009*#<_imperial>]]/2-ABS[0.1]]]/2] "
           "I[1250*[0.001-0.0009*#<_imperial>]] R[500*[0.001-0.0009*#<_imperial>]]\n"
           "|G0 X#<_turning_x>\n|Z#<_turning_z>\n\n\n");
}

static void test_pecks_along_the_axis_of_a_lathe_become_a_loop(void)
{
    expect(DIALECT_FANUC, "G50 S9\nG74 R0.5\nG74 Z-12. Q5000 F0.1\n",
           "G18 G7 G95\n        \n"
           "#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n"
           "|                F0.1\n"
           "|#<_turning_at>=#<_turning_z>\n|#<_turning_way>=[1-2*[[-12.] GT #<_turning_at>]]\n"
           "|o94000003 repeat "
           "[FUP[ABS[#<_turning_at>-[-12.]]/[1*[5000*[0.001-0.0009*#<_imperial>]]]]]\n"
           "|#<_turning_at>="
           "[#<_turning_at>-#<_turning_way>*[1*[5000*[0.001-0.0009*#<_imperial>]]]]\n"
           "|o95000003 if [#<_turning_way>*[#<_turning_at>-[-12.]] LT 0]\n|#<_turning_at>=[-12.]\n"
           "|o95000003 endif\n|G1 z#<_turning_at>\n"
           "|G0 z[#<_turning_at>+#<_turning_way>*[1.0*[0.5]]]\n|o94000003 endrepeat\n"
           "|G0 X#<_turning_x>\n|Z#<_turning_z>\n");
}

static void test_registers_hold_what_later_lines_mean(void)
{
    expect(DIALECT_FANUC, "G43 H1 D51 Z5\nG41 X1\nG28 Z0\nG40\nG28 Z0\n",
           "G43 H1     Z5\nG41 X1 D51\nG40\n|G28 Z0\n|G41 D51\nG40\nG28 Z0\n");
    expect(DIALECT_FANUC, "G43 H1 D1\nG41 D5 X1\nG28 Z0\n",
           "G43 H1   \nG41 D5 X1\nG40\n|G28 Z0\n|G41 D5\n");
    expect(DIALECT_FANUC, "G43 H1 D[#100+#101+#102+#103+#104]\n",
           "G43 H1 D[#100+#101+#102+#103+#104]\n");
    expect(DIALECT_FANUC, "G50 S[#100+#101+#102+#103+#104]\n",
           "G18 G7 G95\n|G50 S[#100+#101+#102+#103+#104]\n");
    expect(DIALECT_FANUC, "G50 S9\nG0 H90.\n", "G18 G7 G95\nG0 H90.\n");
    expect(DIALECT_FANUC, "H8\nG43 Z5\nH9\nG49 H0\n", "  \nG43 Z5 H8\nH9 G43\nG49   \n");
    expect(DIALECT_FANUC, "T1.1 M6\nG4 X2.\n", "T1   M6\nG4 P2.000000\n");
    expect(DIALECT_FANUC, "G96 M3\nS200 F1\nS300\n", "    M3\nS200 F1 G96 \nS300\n");
}

static void test_other_names_of_what_linuxcnc_has(void)
{
    expect(DIALECT_FANUC, "%O3 (A)\n[BILLET X62\nG71 G90\nG53 Z0\nN10 N10 X1\n%\n",
           "%\n\nG21 G90\nG53 Z0 G0\nN10     X1\n%\n");
    expect(DIALECT_GRBL, "MSG \"a) M3 S1000 (b\"\n", "(msg,a] M3 S1000 [b)\n");
    expect(DIALECT_GRBL, "MSG \"tool 3\"\nG0 X1*52\n#1=#2*3\n", "(msg,tool 3)\nG0 X1\n#1=#2*3\n");
    expect(DIALECT_HAAS, "O1\nM98 Q30\nM30\nN30 X2\nM99\n",
           "O1\nM98 P97000030\nM30\nO97000030\n|N30 X2\nM99\n");
    declare("M649", "ignore");
    expect(DIALECT_GRBL, "M649 S13 L2 P5 W1 G1 X1 P2\n", "     S13          G1 X1 P2\n");
}

#define NO_ARGUMENTS " [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0] [0]"

static void test_modal_macros_are_called_behind_each_line_that_moves(void)
{
    static const char call[] = "o8 call" NO_ARGUMENTS NO_ARGUMENTS;
    char becomes[1024];

    (void)snprintf(
        becomes, sizeof becomes,
        "\nX1.\n|%.*s [0] [0] [0] [5.]\nM8\nG28 X0\n|%.*s [0] [0] [0] [5.]\n   \nX2.\nM30\n",
        7 + 4 * 22, call, 7 + 4 * 22, call);
    expect(DIALECT_FANUC, "G66 P8 Z5.\nX1.\nM8\nG28 X0\nG67\nX2.\nM30\n", becomes);
}

static void test_what_has_no_value_is_nothing(void)
{
    expect(DIALECT_FANUC, "#1=#0\nIF[#1 EQ #0] THEN #2=#01\n",
           "#1=[0]\no92000002 if [#1 EQ [0]]\n| #2=#01\n|o92000002 endif\n");
}

static void test_threads_of_two_lines_become_one(void)
{
    expect(DIALECT_FANUC, "G76 P020560 Q100 R.05\nG76 X8.5 Z-20. P1200 Q400 F1.5\n",
           "G18 G7 G95\n"
           "#<_thread_way>=[1-2*[[8.5] LT 2*#<_x>]]\n"
           "|#<_thread_gap>=[#<_thread_way>*[[8.5]-2*#<_x>]-2*[1200*[0.001-0.0009*#<_imperial>]]]\n"
           "|o96000002 if [#<_thread_gap> LT -0.0001]\n|(abort,G76 begins below its crest)\n"
           "|o96000002 endif\n|G76 P[1.5] Z[-20.] "
           "I[#<_thread_way>*[#<_thread_gap>+0.0000001+ABS[#<_thread_gap>-0.0000001]]/2] "
           "J[2*[400*[0.001-0.0009*#<_imperial>]]] K[2*[1200*[0.001-0.0009*#<_imperial>]]] R2 "
           "Q[30.0000] H1 E[0.5*[1.5]] L2\n");
}

static void test_the_tip_is_led_by_g43_where_nothing_turns(void)
{
    expect(DIALECT_FANUC, "G68.2 X0 Y0 Z0 I0 J0 K0\nG53.1\nG43.4 H1\nX1\n",
           "\n     \nG43   H1\nX1\n");
    expect(DIALECT_FANUC, "G43.4 H1\nA1\n", "G43.4 H1\nA1\n");
    expect(DIALECT_FANUC, "G68.2 X0 Y0 J1\n", "G68.2 X0 Y0 J1\n");
}

static void test_round_pockets_become_arcs(void)
{
    expect(DIALECT_HAAS, "G91\nG12 Z-1 I5. D1 F9\n",
           "G91\nF9\n|G1 Z-1\n|#<_pocket>=[[5.]-#5410/2] #<_pocket_last>=[[5.]-#5410/2]\n"
           "|G91 G91.1 G2 X#<_pocket> Y0 I[#<_pocket>/2] J0\n|G2 I[-#<_pocket>] J0\n"
           "|o96000002 while [#<_pocket> LT #<_pocket_last>]\n|#<_pocket_was>=#<_pocket>\n"
           "|#<_pocket>=[#<_pocket>+[0]]\n|o97000002 if [#<_pocket> GT #<_pocket_last>]\n"
           "|#<_pocket>=#<_pocket_last>\n|o97000002 endif\n|G1 X[#<_pocket>-#<_pocket_was>]\n"
           "|G2 I[-#<_pocket>] J0\n|o96000002 endwhile\n|G2 X[-#<_pocket>] Y0 I[-#<_pocket>/2] J0\n"
           "|G1 G91\n");
}

static void test_behind_a_cycle_goes_on_what_was_before_it(void)
{
    TEST_ASSERT_EQUAL_INT(DIALECT_FANUC, guess("G0 X1\nG81 R1 Z-1\nG80\nZ9").dialect);
    TEST_ASSERT_EQUAL_INT(DIALECT_LINUXCNC, guess("G0 X1\nG81 R1 Z-1\nG80\nG0 Z9\nX1").dialect);
    TEST_ASSERT_EQUAL_INT(DIALECT_LINUXCNC, guess("G80 X1\nG80\nG28 Z9").dialect);
    expect(DIALECT_FANUC, "G0 X1\nG81 R1 Z-1\nG80\nZ9\nX1\n",
           "G0 X1\nG81 R1 Z-1\nG80\nZ9 G0\nX1\n");
    expect(DIALECT_FANUC, "G1 X1\nG81 R1 Z-1\nG80\nX9\n", "G1 X1\nG81 R1 Z-1\nG80\nX9 G1\n");
    expect(DIALECT_FANUC, "G2 X1 R1\nG81 R1 Z-1\nG80\nX9\n", "G2 X1 R1\nG81 R1 Z-1\nG80\nX9\n");
    expect(DIALECT_FANUC, "G1 X1\nG81 R1 Z-1\nM98 P2\nG80\nX9\n",
           "G1 X1\nG81 R1 Z-1\nM98 P2\nG80\nX9\n");
}

static void test_parameters_beyond_those_of_linuxcnc_have_names_and_begin_as_0(void)
{
    expect(DIALECT_FANUC, "%\nO1\n#901200=#5601\nX#900001 Y#10101 (#900009)\n",
           "%\n#<_n901200>=0\n|#<_n900001>=0\n|O1\n#<_n901200>=#5601\n"
           "X#<_n900001> Y#101   (#900009)\n");
}

static void test_lines_called_by_m97_are_programs_when_they_stand_behind_the_end(void)
{
    expect(DIALECT_HAAS, "O1\nG0 X1\nM97 P30 L2\nM30\nN30 X2\nM99\n",
           "O1\nG0 X1\nM98 P97000030 L2\nM30\nO97000030\n|N30 X2\nM99\n");
    expect(DIALECT_HAAS, "O1\nN30 G0 X1\nM97 P30\nM30\n", "O1\nN30 G0 X1\nM97 P30\nM30\n");
}

static void test_a_byte_order_mark_is_no_part_of_the_program(void)
{
    TEST_ASSERT_TRUE(guess("\xef\xbb\xbfG0 X1").translates);
    expect(DIALECT_LINUXCNC, "\xef\xbb\xbfG0 X1\r\n", "G0 X1\n");
}

static void test_a_text_may_end_as_under_dos(void)
{
    TEST_ASSERT_TRUE(guess("M30\n\x1a").translates);
    TEST_ASSERT_EQUAL_INT(DIALECT_FANUC, guess(":0100\nM30\n\x1a").dialect);
    expect(DIALECT_LINUXCNC, "M30\r\n\x1a\x1a", "M30\n\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_programs_for_linuxcnc_stay_as_they_are);
    RUN_TEST(test_only_what_linuxcnc_cannot_read_tells_of_another_dialect);
    RUN_TEST(test_senders_orders_and_remarks_are_no_lines);
    RUN_TEST(test_numbers_with_exponents_are_written_out);
    RUN_TEST(test_a_centre_across_the_plane_that_is_0_is_left_out);
    RUN_TEST(test_grbl_begins_with_rapids);
    RUN_TEST(test_axes_that_are_named_alone_go_to_their_reference);
    RUN_TEST(test_a_rapid_beside_a_reference_holds_from_the_next_line_on);
    RUN_TEST(test_loops_branches_and_jumps_become_o_words);
    RUN_TEST(test_a_jump_to_nowhere_has_no_place);
    RUN_TEST(test_macros_are_called_with_their_arguments);
    RUN_TEST(test_dwells_in_milliseconds_become_seconds);
    RUN_TEST(test_turning_has_diameters_and_limits_of_speed);
    RUN_TEST(test_printers_leave_their_way);
    RUN_TEST(test_declared_codes_do_what_the_machine_file_says);
    RUN_TEST(test_declarations_that_make_no_sense_are_told);
    RUN_TEST(test_a_text_may_end_as_under_dos);
    RUN_TEST(test_polar_words_become_x_and_y);
    RUN_TEST(test_values_of_the_machine_file_are_numbers);
    RUN_TEST(test_a_feed_can_be_declared_for_programs_without_one);
    RUN_TEST(test_letters_without_an_axis_drive_one_or_are_left_out);
    RUN_TEST(test_names_without_brackets_are_parameters_or_values);
    RUN_TEST(test_centres_that_only_fit_as_absolute_are_absolute);
    RUN_TEST(test_axis_words_before_a_motion_move_at_rapid);
    RUN_TEST(test_words_that_mean_nothing_are_left_out);
    RUN_TEST(test_profiles_of_fanuc_become_subroutines);
    RUN_TEST(test_distances_of_cycles_can_be_whole_thousandths);
    RUN_TEST(test_pecks_along_the_axis_of_a_lathe_become_a_loop);
    RUN_TEST(test_registers_hold_what_later_lines_mean);
    RUN_TEST(test_other_names_of_what_linuxcnc_has);
    RUN_TEST(test_modal_macros_are_called_behind_each_line_that_moves);
    RUN_TEST(test_what_has_no_value_is_nothing);
    RUN_TEST(test_threads_of_two_lines_become_one);
    RUN_TEST(test_the_tip_is_led_by_g43_where_nothing_turns);
    RUN_TEST(test_round_pockets_become_arcs);
    RUN_TEST(test_behind_a_cycle_goes_on_what_was_before_it);
    RUN_TEST(test_parameters_beyond_those_of_linuxcnc_have_names_and_begin_as_0);
    RUN_TEST(test_lines_called_by_m97_are_programs_when_they_stand_behind_the_end);
    RUN_TEST(test_a_byte_order_mark_is_no_part_of_the_program);
    return UNITY_END();
}

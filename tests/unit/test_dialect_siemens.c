/* host/dialect: the words, flow, subprograms and orders of Siemens. */
#include "dialect_expect.h"

#include <stdio.h>
#include <string.h>

static void test_words_and_values_of_siemens(void)
{
    expect(DIALECT_SIEMENS, "N10 G1 X=R1+2*(R2-1) Y-2 CR=5 TURN=2 F=R3 ;x=1\n",
           "G1 X[#101+2*[#102-1]] Y-2 R[5] P[1+2] F[#103] ;x=1\n");
    expect(DIALECT_SIEMENS, "R1=5 R2=SIN(R1)/-3\n", "#101=[5]\n|#102=[SIN[#101]/[0-3]]\n");
    expect(DIALECT_SIEMENS, "DEF REAL TOP=2, LOW\nLOW=TOP-1\nZ=LOW\n",
           "#<def_top>=[2]\n|#<def_low>=[0]\n#<def_low>=[#<def_top>-1]\nZ[#<def_low>] \n");
    expect(DIALECT_SIEMENS, "G2 X=IC(5) I=AC(7)\nG91 X=AC(1)\n",
           "G2 X[#<_x>+[5]] I[0-#<_x>+[7]] \nG91 X[[1]] \n");
    expect(DIALECT_SIEMENS, "T1 M6\nD1\nD0\nSOFT G642 SUPA\nG71 M17\n",
           "T1 M6  G43\nG43 \nG49 \n G64  G53 \nG21 M2  \n");
    expect(DIALECT_SIEMENS, "X=$P_EP[X]\nTRAORI\n", "X=$P_EP[X]\no<traori> call\n");
}

static void test_flow_of_siemens(void)
{
    expect(DIALECT_SIEMENS, "IF R1==2\nX1\nELSE\nX2\nENDIF\n",
           "o98000001 if [#101 EQ 2]\nX1 \no98000001 else\nX2 \no98000001 endif\n");
    expect(DIALECT_SIEMENS, "FOR R1=1 TO R2\nENDFOR\n",
           "#101=[[1]-1]\n|o99000001 while [#101 LT [#102]]\n|#101=[#101+1]\n"
           "o99000001 endwhile\n");
    expect(DIALECT_SIEMENS, "REPEAT\nUNTIL R1>1\n",
           "o99000001 do\no99000001 while [1-[#101 GT 1]]\n");
    expect(DIALECT_SIEMENS, "GOTOF END\nX1\nEND: M30\n",
           "o00000035 goto [00000003] [00]\nX1 \nM30 \n");
    expect(DIALECT_SIEMENS, "L10 P2\nM30\n%_N_L10_SPF\nX1\nM17\n",
           "o<l10> call\n|o<l10> call\nM30 \no<l10> sub\nX1 \no<l10> return\n|o<l10> endsub\n");
}

static void test_subprograms_of_siemens(void)
{
    expect(DIALECT_SIEMENS,
           "BORE(1, ,R2+3)\nM30\nN1 PROC BORE (REAL TOP, INT N=2,VAR REAL R)\nX=TOP\n",
           "o<bore> call [[1]] [0] [[#102+3]]\nM30 \n"
           "o<bore> sub\n|#<def_top>=#1\n|#<def_n>=ROUND[#2]\n|#<def_r>=#3\nX[#<def_top>] \n"
           "|o<bore> endsub\n");
    expect(DIALECT_SIEMENS, "R1=80 R2=1.5 L903 P2\nL140(2)\n",
           "#101=[80]\n|#102=[1.5]\n|o<l903> call\n|o<l903> call\no<l140> call [[2]]\n");
    expect(DIALECT_SIEMENS, "CASE(R1-1) OF 2 GOTOF A DEFAULT GOTOF B\nA: X1\nB: X2\n",
           "o98000001 if [[[#101-1]] EQ 2]\n|o00000152 goto [00000002] [00]\n|o98000001 endif\n"
           "|o98000001 if [0 EQ 0]\n|o00000156 goto [00000003] [00]\n|o98000001 endif\nX1 \nX2 \n");
}

static void test_named_tools_have_numbers_of_the_machine_file(void)
{
    TEST_ASSERT_NULL(dialect_value_set(&codes, "TOOL_DRILL_8_5", "7"));
    expect(DIALECT_SIEMENS, "T=\"Drill 8.5\" M6\nT=\"12\"\nT=\"X\"\n",
           "T[7] M6  G43\nT12 \nT#<TOOL_X> \n");
}

static void test_orders_of_siemens(void)
{
    expect(DIALECT_SIEMENS, "MSG(\"a (b)\")\nTRANS X1\nTRANS\n",
           "(msg,a [b])\nG92.1\n|G52 X[1*[1]]\nG92.1\n");
    expect(DIALECT_SIEMENS, "MCALL CYCLE82(50,0,2,-9,,1)\nG0 X1\nMCALL\n",
           "G0 Z[50]\n   X1  G98 G82 R[[0]+[2]] Z[[0-9]] P[1]\nG80 G0\n");
}

static void test_a_shift_takes_the_place_of_all_frames_or_is_added(void)
{
    expect(DIALECT_SIEMENS, "N1 TRANS X10 Y=R1\nATRANS Z-2 ; more\nROT\nMIRROR X0\n",
           "G92.1\n|G52 X[1*[10]] Y[1*[#101]]\nG92 Z[1*[#<_z>-[[0-2]]]]\nG92.1\nMIRROR X0\n");
    expect(DIALECT_SIEMENS, "DIAMON\nTRANS X10\nX=IC(1)\nDIAM90\nG91\n",
           "G7 \nG92.1\n|G52 X[2*[10]]\nX[2*#<_x>+[1]] \nG7 \nG91  G8\n");
}

static void test_functions_and_constants(void)
{
    expect(DIALECT_SIEMENS, "X=POT(R1) Y=ATAN2(1,2) Z=2*$PI\n",
           "X[[[#101]*[#101]]] Y[ATAN[1]/[2]] Z[2*3.14159265358979] \n");
    expect(DIALECT_SIEMENS, "R1=1+7 DIV 2*3 R2=MINVAL(R1,2)\n",
           "#101=[1+[FIX[ABS[7/2]]*[1-2*[[7/2] LT 0]]]*3]\n"
           "|#102=[[[#101]*[[#101] LT [2]]+[2]*[1-[[#101] LT [2]]]]]\n");
    expect(DIALECT_SIEMENS, "DEF BOOL OK=TRUE\nIF NOT OK\nENDIF\n",
           "#<def_ok>=[1]\no98000002 if [[#<def_ok> EQ 0]]\no98000002 endif\n");
}

static void test_dwells_and_no_offset(void)
{
    expect(DIALECT_SIEMENS, "G4 F2\nG4 S10\n", "G4 P2 \nG4 P[60*10/#<_rpm>] \n");
    expect(DIALECT_SIEMENS, "G500 X1\n",
           "o98000001 if [ABS[#5381]+ABS[#5382]+ABS[#5383]+ABS[#5384]+ABS[#5385]+ABS[#5386]+"
           "ABS[#5390] NE 0]\n|(abort,G500 is G59.3 here, whose offsets must be 0)\n"
           "|o98000001 endif\n|G59.3 X1 \n");
}

static void test_a_subprogram_ends_where_the_next_begins(void)
{
    expect(DIALECT_SIEMENS, "BB\nM30\nPROC A\nX1\nM17\nPROC BB\nX2 RET\n",
           "o<bb> call\nM30 \no<a> sub\nX1 \no<a> return\no<a> endsub\n|o<bb> sub\n"
           "X2  \n|o<bb> return\n|o<bb> endsub\n");
}

static void test_what_the_text_begins_with_is_the_main_program(void)
{
    expect(DIALECT_SIEMENS, ";part\nPROC MAIN\nX1\nM30\nPROC A\nM17\n",
           ";part\n\nX1 \nM30 \no<a> sub\no<a> return\n|o<a> endsub\n");
    expect(DIALECT_SIEMENS, "%_N_A_SPF\nPROC A\nX1\nM17\n", "\n\nX1 \nM2  \n");
}

static void test_a_text_that_is_called_is_the_subprogram(void)
{
    static const char text[] = ";bore\nX1\nM17\n";

    TEST_ASSERT_TRUE(
        dialect_translate(DIALECT_SIEMENS, &codes, "l7", text, sizeof text - 1, &result));
    TEST_ASSERT_EQUAL_INT(0, strncmp(result.text.bytes, ";bore\no<l7> sub\n", 16));
}

static void test_jumps_go_the_way_they_say(void)
{
    expect(DIALECT_SIEMENS, "A: X1\nGOTOF A\nA: X2\nGOTOB A\nGOTOF A\n",
           "X1 \no00000035 goto [00000003] [00]\nX2 \no00000035 goto [00000003] [00]\n"
           "o00000000 goto                \n");
}

static void test_a_section_is_repeated(void)
{
    expect(DIALECT_SIEMENS, "A: X1\nREPEAT A P=2\n",
           "X1 \n#1100=[#1100+1]\n|o98000002 if [#1100 LE [2]]\n"
           "|o00000000 goto [00000001] [00]\n|o98000002 endif\n|#1100=0\n");
}

static void test_what_a_line_opens_that_is_not_understood_is_passed_over(void)
{
    expect(DIALECT_SIEMENS, "IF $P_SIM\nX1\nENDIF\n",
           "IF $P_SIM\n|o98000001 if [0]\nX1 \no98000001 endif\n");
}

static void wrong(const char *from, const char *message)
{
    TEST_ASSERT_TRUE(dialect_translate(DIALECT_SIEMENS, &codes, NULL, from, strlen(from), &result));
    TEST_ASSERT_EQUAL_STRING(message, result.wrong);
    dialect_text_free(&result.text);
}

static void test_a_changed_tool_has_its_length(void)
{
    expect(DIALECT_SIEMENS, "T1\nM6\nT2 M6 D1\nM6 D0\nT0 M6\n",
           "T1 \nM6  G43\nT2 M6 G43 \nM6 G49 \nT0 M6  G49\n");
    /* without M6 T changes it, under a spindle that turns on */
    expect(DIALECT_SIEMENS, "T1 D1\nM3 S9\nT2\nM5\nT3 M4\n",
           "T1 G43  M6\nM3 S9 \nT2  M6 G43 M3\nM5 \nT3 M4  M6 G43\n");
    wrong("T1 D2\n", "'D2': tools have one edge here: make a tool of it, and call that by T");
    wrong("T1 D=R1\n", "'D=' has an edge that is known only when the program runs, which is not "
                       "supported: write D1 or D0");
}

static void test_variables_belong_to_their_program_and_whole_ones_are_whole(void)
{
    expect(DIALECT_SIEMENS, "DEF INT N=2.7, M\nN=N/2\nDEF REAL N\nN=1\n",
           "#<def_n>=ROUND[2.7]\n|#<def_m>=[0]\n#<def_n>=ROUND[#<def_n>/2]\n#<def_n>=[0]\n"
           "#<def_n>=[1]\n");
    wrong("PROC A(VAR REAL B)\nX=B\n", "");
    wrong("PROC A(VAR REAL B)\nB=2\n",
          "'B' is VAR: a value that the subprogram gives it does not come back, which is not "
          "supported: use an R parameter");
}

static void test_systems_beside_axis_words_are_told(void)
{
    wrong("G58 X1\n", "'G58' beside axis words shifts, or selects a system and moves: write "
                      "TRANS, or G0 or G1");
    wrong("G0 G58 X1\nG59\nG54 X1\nG505\n", "");
}

static void test_levels_of_skipped_lines_are_one(void)
{
    expect(DIALECT_SIEMENS, "/1 G0 X5\n/ X6\n", "/G0 X5 \n/X6 \n");
}

static void test_feeds_go_with_the_kind_of_speed(void)
{
    expect(DIALECT_SIEMENS, "LIMS=900\nG96 S2\n", "       \nG96 G95 S2  D[900]\n");
    expect(DIALECT_SIEMENS, "G96 S2\nG97 S5\nG961 S2\nG971 S5\nG962 S2\nG972 S5\n",
           "G96 G95 S2  \nG97 G95 S5 \nG96 G94 S2  \nG97 G94 S5 \nG96  S2  \nG97  S5 \n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_words_and_values_of_siemens);
    RUN_TEST(test_flow_of_siemens);
    RUN_TEST(test_subprograms_of_siemens);
    RUN_TEST(test_named_tools_have_numbers_of_the_machine_file);
    RUN_TEST(test_orders_of_siemens);
    RUN_TEST(test_a_shift_takes_the_place_of_all_frames_or_is_added);
    RUN_TEST(test_functions_and_constants);
    RUN_TEST(test_dwells_and_no_offset);
    RUN_TEST(test_a_subprogram_ends_where_the_next_begins);
    RUN_TEST(test_what_the_text_begins_with_is_the_main_program);
    RUN_TEST(test_a_text_that_is_called_is_the_subprogram);
    RUN_TEST(test_jumps_go_the_way_they_say);
    RUN_TEST(test_a_section_is_repeated);
    RUN_TEST(test_what_a_line_opens_that_is_not_understood_is_passed_over);
    RUN_TEST(test_a_changed_tool_has_its_length);
    RUN_TEST(test_variables_belong_to_their_program_and_whole_ones_are_whole);
    RUN_TEST(test_systems_beside_axis_words_are_told);
    RUN_TEST(test_levels_of_skipped_lines_are_one);
    RUN_TEST(test_feeds_go_with_the_kind_of_speed);
    return UNITY_END();
}

/*
 * host/dialect: what shops write: turrets, drilling and threads of lathes, polar coordinates,
 * macros of printers.
 */
#include "dialect_expect.h"

static void test_more_systems_are_the_last_ones_here(void)
{
    expect(DIALECT_FANUC, "G54.1 P2 X1\nG54 P3\n", "G59.2    X1\nG59.3   \n");
    expect(DIALECT_HAAS, "G154 P1\nG110\nG111\n", "G59.1   \nG59.1\nG59.2\n");
}

static void test_a_turret_turns_under_a_turning_spindle(void)
{
    expect(DIALECT_FANUC, "G50 S9\nM3 S9\nT0202\nM5\nT0303\nT0404 M4\nT0505 M6\n",
           "G18 G7 G95\nM3 S9\nT2 M6 G43 H2 M3\nM5\nT3 M6 G43 H3\nT4 M6 G43 H4 M4\nT5 G43 H5 M6\n");
}

static void test_the_limit_of_speed_can_stand_beside_g92(void)
{
    TEST_ASSERT_EQUAL_INT(DIALECT_FANUC, guess("G92 S1300").dialect);
    TEST_ASSERT_EQUAL_INT(DIALECT_LINUXCNC, guess("G92 X0 S1300").dialect);
    expect(DIALECT_FANUC, "G92 S1300\nG96 S100 M3\n", "G18 G7 G95\nG96 S100 M3 D1300\n");
    expect(DIALECT_FANUC, "G92 X0 S13\n", "G92 X0 S13\n");
    /* of a mill, whose X is no diameter and whose F no feed per turn */
    expect(DIALECT_FANUC, "G21 G17\nG92 S1300\nG96 S100 M3\nG1 X5 F9\n",
           "G21 G17\n         \nG96 S100 M3 D1300\nG1 X5 F9\n");
    expect(DIALECT_FANUC, "G50 S13\nG17\n", "G18 G7 G95\nG17\n");
}

static void test_cycles_without_r_drill_from_where_the_tool_is(void)
{
    expect(DIALECT_FANUC, "G81 Z-1 F9\nX2\nG81 Z-2\nG80\nG91 G83 Z-3 Q1\n",
           "G81 Z-1 F9 R#<_z>\nX2\nG81 Z-2\nG80\nG91 G83 Z-3 Q1 R0\n");
    expect(DIALECT_FANUC, "G81 Z-1 R1 F9\nG81 Z-2\n", "G81 Z-1 R1 F9\nG81 Z-2\n");
}

static void test_a_lathe_drills_along_z(void)
{
    expect(DIALECT_FANUC, "G50 S9\nG83 X0 Z-9 Q2000 F.1\nG0 Z5\nG0 X9\n",
           "G18 G7 G95\nG83 X0 Z-9 Q[2000*[0.001-0.0009*#<_imperial>]] F.1 G17 R#<_z>\n"
           "G0 Z5 G18\nG0 X9\n");
    /* a height for Haas, a distance for Fanuc */
    expect(DIALECT_HAAS, "G50 S9\nG83 X0 Z-9 R1 Q2 F.1\nG80\n",
           "G18 G7 G95\nG83 X0 Z-9 R1 Q2 F.1 G17\nG80 G18\n");
    expect(DIALECT_FANUC, "G50 S9\nG83 X0 Z-9 R1 Q2 F.1\n", "G18 G7 G95\nG83 X0 Z-9 R1 Q2 F.1\n");
    codes.count = 1;
    TEST_ASSERT_NULL(dialect_code_read(&codes.code[0], "R", "height"));
    expect(DIALECT_FANUC, "G50 S9\nG83 X0 Z-9 R1 Q2 F.1\n",
           "G18 G7 G95\nG83 X0 Z-9 R1 Q2 F.1 G17\n");
    TEST_ASSERT_NULL(dialect_code_read(&codes.code[0], "r", "distance"));
    expect(DIALECT_FANUC, "G50 S9\nG83 X0 Z-9 R-1 Q2 F.1\nZ-12 R-2\nG80\nG2 Z1 R5\n",
           "G18 G7 G95\n#<_level>=#<_z>\n|G83 X0 Z-9 R[#<_level>+[-1]] Q2 F.1 G17\n"
           "Z-12 R[#<_level>+[-2]]\nG80 G18\nG2 Z1 R5\n");
    TEST_ASSERT_NOT_NULL(dialect_code_read(&codes.code[0], "R", "low"));
}

static void test_fagor_drills_from_z_to_i(void)
{
    expect(DIALECT_FANUC, "G81 G99 X1 Y2 Z2 I-5 F9\nX3\nZ1\nI-4\nG0 Z9\n",
           "G81 G99 X1 Y2 R2 Z-5 F9\nX3\nR1\nZ-4\nG0 Z9\n");
}

static void test_threads_in_one_cut_follow_the_spindle(void)
{
    expect(DIALECT_FANUC, "G50 S9\nG32 Z-9 F1.5\nG0 X9\nG32 Z-8\nZ-10\nG33 Z-7\nG32 X1 Z-9\n",
           "G18 G7 G95\nG33 Z-9 F1.5 K1.5\nG0 X9\nG33 Z-8 K1.5\nZ-10 K1.5\n"
           "G33 Z-7 K1.5\nG32 X1 Z-9\n");
}

static void test_polar_coordinates_of_fanuc_are_polar_words(void)
{
    expect(DIALECT_FANUC, "G16\nG15\nX1\n", "   \n   \nX1\n");
    expect(DIALECT_FANUC, "G16\nG91 X1\n", "   \nG91 X1 G16\n");
    expect(DIALECT_FANUC, "G18\nG16\nX1\n", "G18\nG16\nX1 G16\n");
    TEST_ASSERT_TRUE(dialect_translate(DIALECT_FANUC, &codes, NULL, "G16 X5 Y30", 10, &result));
    TEST_ASSERT_NOT_NULL(strstr(result.text.bytes, "#<_polar_radius>=[[5]+"));
    TEST_ASSERT_NOT_NULL(strstr(result.text.bytes, "#<_polar_angle>=[[30]+"));
}

static void test_macros_of_printers_are_left_out(void)
{
    expect(DIALECT_MARLIN, "PRINT_START BED=60\nPAUSE\nG4 ; wait\nG1X1\nGOO X1\n",
           "\nM0\n   ; wait\nG1X1\nGOO X1\n");
    TEST_ASSERT_EQUAL_UINT(1, result.notes);
    TEST_ASSERT_EQUAL_STRING("PRINT_START", result.note[0].word);
}

static void test_of_words_given_twice_the_last_counts(void)
{
    expect(DIALECT_FANUC, "G1 Z-5 F.00 F.0086\nM1 N02\n", "G1 Z-5      F.0086\nM1    \n");
}

static void test_a_turret_takes_the_offset_behind_the_tool(void)
{
    expect(DIALECT_FANUC, "G50 S9\nT0112\nT0100\n", "G18 G7 G95\nT1 M6 G43 H12\nT1 M6 G49\n");
}

static void test_arcs_of_lathes_without_a_centre_are_straight(void)
{
    expect(DIALECT_FANUC, "G50 S9\nG2 X2 Z-5 R5\nZ-9\nX3 Z-14 R5\nG3 X4\nG1 Z-9\nG4 X1.\n",
           "G18 G7 G95\nG2 X2 Z-5 R5\nZ-9 G1\nX3 Z-14 R5 G2\nG1 X4\nG1 Z-9\nG4 P1.000000\n");
    TEST_ASSERT_EQUAL_UINT(2, result.notes);
    /* a mill's is a mistake */
    expect(DIALECT_FANUC, "G2 X2 Y5 R5\nY9\n", "G2 X2 Y5 R5\nY9\n");
}

static void test_names_that_another_program_sets_can_be_declared(void)
{
    TEST_ASSERT_NULL(dialect_value_set(&codes, "_td", "3"));
    TEST_ASSERT_TRUE(guess("G0 X#<_td>").translates);
    expect(DIALECT_LINUXCNC, "%\nG0 X#<_TD>\nX1\n", "%\n#<_td>=3.000000000\n|G0 X#<_TD>\nX1\n");
    TEST_ASSERT_NOT_NULL(dialect_value_set(&codes, "_", "3"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_more_systems_are_the_last_ones_here);
    RUN_TEST(test_a_turret_turns_under_a_turning_spindle);
    RUN_TEST(test_the_limit_of_speed_can_stand_beside_g92);
    RUN_TEST(test_cycles_without_r_drill_from_where_the_tool_is);
    RUN_TEST(test_a_lathe_drills_along_z);
    RUN_TEST(test_fagor_drills_from_z_to_i);
    RUN_TEST(test_threads_in_one_cut_follow_the_spindle);
    RUN_TEST(test_polar_coordinates_of_fanuc_are_polar_words);
    RUN_TEST(test_macros_of_printers_are_left_out);
    RUN_TEST(test_of_words_given_twice_the_last_counts);
    RUN_TEST(test_a_turret_takes_the_offset_behind_the_tool);
    RUN_TEST(test_arcs_of_lathes_without_a_centre_are_straight);
    RUN_TEST(test_names_that_another_program_sets_can_be_declared);
    return UNITY_END();
}

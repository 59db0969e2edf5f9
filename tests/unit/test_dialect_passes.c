/* host/dialect: passes, increments and threads of lathes; what a series of holes keeps. */
#include "dialect_expect.h"

#define LATHE  "G50 S9\n"
#define BEGINS "G18 G7 G95\n"
#define FROM   "|#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n"

static void wrong(enum dialect dialect, const char *from, uint32_t line, const char *message)
{
    TEST_ASSERT_TRUE(dialect_translate(dialect, &codes, NULL, from, strlen(from), &result));
    TEST_ASSERT_EQUAL_STRING(message, result.wrong);
    TEST_ASSERT_EQUAL_UINT32(line, result.wrong_line);
    dialect_text_free(&result.text);
}

static void test_g90_of_a_lathe_is_a_pass_and_so_are_lines_behind_it(void)
{
    expect(DIALECT_FANUC, LATHE "G90 X45. Z-20. F.2\nU-5.\nG0 X60.\nX1\n",
           BEGINS "               F.2\n|#<_pass_r>=0\n" FROM
                  "|#<_pass_x>=[45.]\n|#<_pass_z>=[-20.]\n|G0 X[#<_pass_x>+2*#<_pass_r>]\n"
                  "|G1 X#<_pass_x> Z#<_pass_z>\n|X#<_turning_x>\n|G0 Z#<_turning_z>\n"
                  "#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>\n"
                  "|#<_pass_x>=[#<_turning_x>+-5.]\n|G0 X[#<_pass_x>+2*#<_pass_r>]\n"
                  "|G1 X#<_pass_x> Z#<_pass_z>\n|X#<_turning_x>\n|G0 Z#<_turning_z>\n"
                  "G0 X60.\nX1\n");
}

static void test_g94_of_a_lathe_faces(void)
{
    expect(DIALECT_HAAS, LATHE "G94 X1. W-2. K-1.\n",
           BEGINS "#<_pass_r>=0\n" FROM "|#<_pass_x>=[1.]\n|#<_pass_z>=[#<_turning_z>+-2.]\n"
                  "|#<_pass_r>=[-1.]\n|G0 Z[#<_pass_z>+#<_pass_r>]\n|G1 X#<_pass_x> Z#<_pass_z>\n"
                  "|Z#<_turning_z>\n|G0 X#<_turning_x>\n");
}

static void test_g92_of_a_lathe_is_a_thread(void)
{
    expect(DIALECT_FANUC, LATHE "G92 X29. Z-20. F1.5\n",
           BEGINS "               F1.5\n|#<_pass_r>=0\n" FROM
                  "|#<_pass_x>=[29.]\n|#<_pass_z>=[-20.]\n|G0 X[#<_pass_x>+2*#<_pass_r>]\n"
                  "|#<_pass_lead>=[1.5]\n|#<_pass_w>=ABS[#<_pass_z>-#<_turning_z>]\n"
                  "|G33 X#<_pass_x> Z#<_pass_z> "
                  "K[2*#<_pass_lead>*SQRT[#<_pass_w>**2+#<_pass_r>**2]/"
                  "[#<_pass_w>+ABS[#<_pass_r>]+ABS[#<_pass_w>-ABS[#<_pass_r>]]]]\n"
                  "|G0 X#<_turning_x>\n|G0 Z#<_turning_z>\n");
    wrong(DIALECT_FANUC, LATHE "G92 X29. Z-20.\n", 2,
          "G92 on a lathe cuts a thread and needs F, its lead");
    wrong(DIALECT_FANUC, LATHE "G90 X29.\n", 2,
          "G90 on a lathe is a cycle and needs X or U, and Z or W");
}

static void test_a_subprogram_called_behind_a_pass_goes_on_with_it(void)
{
    static const char text[] = LATHE "G90 X4 Z-2\nM98 P20007\nG0 X9\nM30\nO7\nX3\nM99\nO8\nX5\n";

    TEST_ASSERT_TRUE(
        dialect_translate(DIALECT_FANUC, &codes, NULL, text, sizeof text - 1, &result));
    TEST_ASSERT_NOT_NULL(strstr(result.text.bytes, "#<_pass_x>=[3]\n"));
    TEST_ASSERT_NOT_NULL(strstr(result.text.bytes, "\nO8\nX5\n"));
    dialect_text_free(&result.text);
    wrong(DIALECT_FANUC, LATHE "G90 X4 Z-2\nM97 P7\n", 3,
          "G90 of a lathe goes on in this call, which is not supported");
}

static void test_where_a_lathe_has_g91_or_g95_g90_is_that_of_mills(void)
{
    expect(DIALECT_FANUC, LATHE "G95 G0 X9\nG90 X4 Z-2\n", BEGINS "G95 G0 X9\nG90 X4 Z-2\n");
    expect(DIALECT_FANUC, LATHE "G90\nG90 G0 X4 Z-2\nX5\n", BEGINS "G90\nG90 G0 X4 Z-2\nX5\n");
}

static void test_u_and_w_of_lathes_are_increments(void)
{
    expect(DIALECT_HAAS, LATHE "G0 U10. W-5.\nG4 U1.\n",
           BEGINS "G0 X[2*#<_x>+10.] Z[#<_z>+-5.]\nG4 P1.000000\n");
    expect(DIALECT_FANUC, "G0 U10.\n", "G0 U10.\n"); /* a mill's is an axis */
    codes.count = 1;
    TEST_ASSERT_NULL(dialect_code_read(&codes.code[0], "W", "A"));
    expect(DIALECT_FANUC, LATHE "G0 U1 W2\n",
           BEGINS "G0 X[2*#<_x>+1] A[[2]*[1+24.4*#<_imperial>]]\n");
}

static void test_a_profile_that_is_repeated_is_told(void)
{
    wrong(DIALECT_FANUC, LATHE "G73 U3. W3. R3\n", 2,
          "'G73', a profile that is repeated, is not supported: G71 is");
    wrong(DIALECT_FANUC, LATHE "N5 G73 P10 Q20 U.5 F.2\n", 2,
          "'G73', a profile that is repeated, is not supported: G71 is");
}

static void test_heights_of_holes_stay_where_they_are_with_g91(void)
{
    expect(DIALECT_FANUC, "G90 G81 Z-9 R2\nG91 X3 L2\nG90 Z-4\nG80\n",
           "#<_hole_level>=#<_z>\n|#<_hole_r>=[[2]+0*#<_hole_level>]\n"
           "|#<_hole_z>=[[-9]+0*#<_hole_r>]\n"
           "|G90 G81 Z[#<_hole_z>-0*#<_hole_r>] R[#<_hole_r>-0*#<_hole_level>]\n"
           "G91 X3 L2 R[#<_hole_r>-1*#<_hole_level>] Z[#<_hole_z>-1*#<_hole_r>]\n"
           "#<_hole_z>=[[-4]+0*#<_hole_r>]\n"
           "|G90 Z[#<_hole_z>-0*#<_hole_r>] R[#<_hole_r>-0*#<_hole_level>]\nG80\n");
    expect(DIALECT_FANUC, "G91 G81 Z-9 R-2\nX3\nG80\nG90\n", "G91 G81 Z-9 R-2\nX3\nG80\nG90\n");
    expect(DIALECT_MACH3, "G90 G81 Z-9 R2\nG91 X3\n", "G90 G81 Z-9 R2\nG91 X3\n");
}

static void test_a_subprogram_called_in_a_series_goes_on_with_it(void)
{
    static const char text[] = "G81 Z-9 R2 L0\nM98 P7\nG80\nM30\nO7\nG91 X3\nM99\n";

    TEST_ASSERT_TRUE(
        dialect_translate(DIALECT_FANUC, &codes, NULL, text, sizeof text - 1, &result));
    TEST_ASSERT_NOT_NULL(strstr(
        result.text.bytes, "\nG91 X3 R[#<_hole_r>-1*#<_hole_level>] Z[#<_hole_z>-1*#<_hole_r>]\n"));
}

static void test_words_of_cycles_that_have_other_letters(void)
{
    expect(DIALECT_FANUC, "G81 Z-9 R2 K3\nX1 K2\n", "G81 Z-9 R2 L3\nX1 L2\n");
    expect(DIALECT_FANUC, "G82 Z-9 R2\nG82 X1\nG82 P5 X2\n", "G82 Z-9 R2 P0\nG82 X1\nG82 P5 X2\n");
    expect(DIALECT_FANUC, "G84 Z-9 R2 P500\n", "G84 Z-9 R2 P0.500000\n");
    expect(DIALECT_HAAS, "G83 Z-9 R2 I2. J.5 K1.\n", "G83 Z-9 R2         Q1.\n");
    TEST_ASSERT_EQUAL_UINT(1, result.notes);
    expect(DIALECT_FANUC, "G30 P2 Z0\nG30 P3 Z0\n", "G30    Z0\nG30 P3 Z0\n");
}

static void test_fine_boring_leaves_at_the_feed(void)
{
    expect(DIALECT_FANUC, "G76 Z-9 R2 Q.1 P500\nX1 Q.2\nG80\n",
           "G89 Z-9 R2     P0.500000\nX1    \nG80\n");
    TEST_ASSERT_EQUAL_UINT(1, result.notes);
    expect(DIALECT_HAAS, "G76 Z-9 R2 I.1\n", "G85 Z-9 R2    \n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_g90_of_a_lathe_is_a_pass_and_so_are_lines_behind_it);
    RUN_TEST(test_g94_of_a_lathe_faces);
    RUN_TEST(test_g92_of_a_lathe_is_a_thread);
    RUN_TEST(test_a_subprogram_called_behind_a_pass_goes_on_with_it);
    RUN_TEST(test_where_a_lathe_has_g91_or_g95_g90_is_that_of_mills);
    RUN_TEST(test_u_and_w_of_lathes_are_increments);
    RUN_TEST(test_a_profile_that_is_repeated_is_told);
    RUN_TEST(test_heights_of_holes_stay_where_they_are_with_g91);
    RUN_TEST(test_a_subprogram_called_in_a_series_goes_on_with_it);
    RUN_TEST(test_words_of_cycles_that_have_other_letters);
    RUN_TEST(test_fine_boring_leaves_at_the_feed);
    return UNITY_END();
}

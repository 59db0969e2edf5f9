/* Table files: read, written, stored, and refused with the cell named. */
#include "correction/table_store.h"
#include "correction/table_text.h"
#include "unity.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct table table, other;
static struct diagnostic wrong;
/* A mill with a rotary axis C; corrections to 0.5 mm, 2 um/mm. */
static const struct table_rules rules = {0x27, 0.5, 0.002};

void setUp(void)
{
    memset(&table, 0, sizeof table);
    memset(&wrong, 0, sizeof wrong);
}

void tearDown(void)
{
}

static bool read_text(const char *text)
{
    return takt_table_read_text(text, strlen(text), &rules, &table, &wrong);
}

static const char plane[] = "# a small grid\n"
                            "X_mm, Y_mm, KX_um, KZ_um\n"
                            "0,0,1,2\n"
                            "100,0,3,4\n"
                            "200,0,5,6\n"
                            "0,50,-1,-2.5e+0\n"
                            "100,50,7,8\n"
                            "200,50,9,10\n";

static void test_a_grid_is_read_with_its_axes_and_units(void)
{
    TEST_ASSERT_TRUE(read_text(plane));
    TEST_ASSERT_EQUAL_UINT(2, table.inputs);
    TEST_ASSERT_EQUAL_UINT(3, table.knots[0]);
    TEST_ASSERT_EQUAL_UINT(2, table.knots[1]);
    TEST_ASSERT_EQUAL_DOUBLE(200.0, table.knot_mm[0][2]);
    TEST_ASSERT_EQUAL_DOUBLE(50.0, table.knot_mm[1][1]);
    TEST_ASSERT_EQUAL_UINT(AXIS_Z, table.output[1].axis);
    TEST_ASSERT_EQUAL_FLOAT(-0.0025F, table.value_mm[7]);
}

static void test_units_separators_and_small_letters_are_understood(void)
{
    TEST_ASSERT_TRUE(
        read_text("c_deg;kc_arcsec;kx_in\r\n-90;3.6;0.0001\r\n 90 ; -36 ; +0.0002 \r\n"));
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, -1.5707963267948966, table.knot_mm[0][0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-11F, 1.7453293e-5F, table.value_mm[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-9F, 0.00508F, table.value_mm[3]);
}

static void test_errors_of_a_unit_are_read_also_about_axes_that_the_machine_has_not(void)
{
    TEST_ASSERT_TRUE(read_text("X_mm,EX_um,EB_urad\n0,1,2\n100,3,4\n"));
    TEST_ASSERT_TRUE(table.errors);
    TEST_ASSERT_EQUAL_UINT(AXIS_B, table.output[1].axis);
    TEST_ASSERT_EQUAL_FLOAT(4e-6F, table.value_mm[3]);
}

static void test_both_directions_of_an_axis_are_read(void)
{
    TEST_ASSERT_TRUE(read_text("X_mm\tKX_up_um\tKX_down_um\tKY_um\n0\t5\t-5\t1\n7\t6\t-4\t2\n"));
    TEST_ASSERT_EQUAL_UINT(3, table.outputs);
    TEST_ASSERT_EQUAL_UINT(TABLE_UP, table.output[0].direction);
    TEST_ASSERT_EQUAL_UINT(TABLE_DOWN, table.output[1].direction);
    TEST_ASSERT_EQUAL_UINT(TABLE_BOTH, table.output[2].direction);
}

struct collected {
    char text[4096];
    size_t length;
};

static void collect(void *context, const char *text, size_t length)
{
    struct collected *c = context;

    TEST_ASSERT_TRUE(c->length + length < sizeof c->text);
    memcpy(c->text + c->length, text, length);
    c->length += length;
    c->text[c->length] = '\0';
}

static void write_table(struct collected *c)
{
    const struct table_sink sink = {c, collect};

    c->length = 0;
    takt_table_write_text(&table, "written again", &sink);
}

static void expect_same_table(void)
{
    TEST_ASSERT_EQUAL_UINT(other.inputs, table.inputs);
    TEST_ASSERT_EQUAL_UINT(other.outputs, table.outputs);
    for (unsigned i = 0; i < table.inputs; i++) {
        TEST_ASSERT_EQUAL_UINT(other.knots[i], table.knots[i]);
        for (unsigned k = 0; k < table.knots[i]; k++)
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, other.knot_mm[i][k], table.knot_mm[i][k]);
    }
    for (uint32_t i = 0; i < takt_table_rows(&table) * table.outputs; i++)
        TEST_ASSERT_FLOAT_WITHIN(1e-9F, other.value_mm[i], table.value_mm[i]);
}

static void test_what_is_written_reads_as_the_same_table(void)
{
    static struct collected c;

    TEST_ASSERT_TRUE(read_text(plane));
    other = table;
    write_table(&c);
    TEST_ASSERT_NOT_NULL(strstr(c.text, "\nchecksum,"));
    TEST_ASSERT_TRUE(read_text(c.text));
    expect_same_table();
}

static void test_a_changed_byte_breaks_the_checksum_of_a_written_table(void)
{
    static struct collected c;

    TEST_ASSERT_TRUE(read_text(plane));
    write_table(&c);
    *(strstr(c.text, ",9,10") + 1) = '8';
    TEST_ASSERT_FALSE(read_text(c.text));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_CHECKSUM, wrong.code);
}

static void test_a_stored_table_comes_back_to_the_last_bit(void)
{
    static uint8_t bytes[1024];

    TEST_ASSERT_TRUE(read_text(plane));
    other = table;
    TEST_ASSERT_TRUE(takt_table_store_size(&table) <= sizeof bytes);
    takt_table_store(&table, bytes);
    memset(&table, 0, sizeof table);
    TEST_ASSERT_TRUE(
        takt_table_restore(bytes, takt_table_store_size(&other), &rules, &table, &wrong));
    expect_same_table();
    TEST_ASSERT_EQUAL_MEMORY(other.value_mm, table.value_mm, sizeof(float) * 12);
}

/*
 * Twelve bytes a point; the rest is a head, eight bytes for each position along an axis, and the
 * checksum.
 */
static void test_a_volume_of_two_thousand_points_is_stored_in_25_kilobytes(void)
{
    static uint8_t bytes[24500];

    table = (struct table){.inputs = 3, .outputs = 3, .knots = {20, 10, 10}};
    for (uint8_t i = 0; i < 3; i++) {
        table.input[i] = i;
        table.output[i] = (struct table_output){i, TABLE_BOTH};
        for (unsigned k = 0; k < table.knots[i]; k++)
            table.knot_mm[i][k] = 25.0 * k;
    }
    for (uint32_t i = 0; i < 3 * takt_table_rows(&table); i++)
        table.value_mm[i] = 1e-3F * (float)(i % 7);
    other = table;
    TEST_ASSERT_EQUAL_UINT(2000, takt_table_rows(&table));
    TEST_ASSERT_EQUAL_UINT(12 * 2000 + 8 * 40 + 30, takt_table_store_size(&table));
    TEST_ASSERT_TRUE(takt_table_store_size(&table) <= sizeof bytes);
    takt_table_store(&table, bytes);
    memset(&table, 0, sizeof table);
    TEST_ASSERT_TRUE(
        takt_table_restore(bytes, takt_table_store_size(&other), &rules, &table, &wrong));
    TEST_ASSERT_EQUAL_MEMORY(other.value_mm, table.value_mm, sizeof(float) * 6000);
}

static void test_every_damaged_byte_and_every_missing_end_of_a_stored_table_is_refused(void)
{
    static uint8_t bytes[1024];
    size_t size;

    TEST_ASSERT_TRUE(read_text(plane));
    size = takt_table_store_size(&table);
    takt_table_store(&table, bytes);
    for (size_t i = 0; i < size; i++) {
        bytes[i] ^= 0x10;
        TEST_ASSERT_FALSE(takt_table_restore(bytes, size, &rules, &other, &wrong));
        TEST_ASSERT_TRUE(wrong.code == TAKT_ERROR_TABLE_CHECKSUM ||
                         wrong.code == TAKT_ERROR_TABLE_DAMAGED);
        bytes[i] ^= 0x10;
        TEST_ASSERT_FALSE(takt_table_restore(bytes, i, &rules, &other, &wrong));
    }
}

static void test_measured_triplets_become_corrections_of_both_directions(void)
{
    static const char comp[] =
        "# nominal forward reverse\n0.0 0.0 0.001\n10.0 10.002 9.999\n\n20 20 20\n";

    TEST_ASSERT_TRUE(
        takt_table_read_triplets(comp, strlen(comp), AXIS_Y, 0, 1.0, &rules, &table, &wrong));
    TEST_ASSERT_EQUAL_UINT(AXIS_Y, table.input[0]);
    TEST_ASSERT_EQUAL_UINT(3, table.knots[0]);
    TEST_ASSERT_FLOAT_WITHIN(1e-8F, -0.002F, table.value_mm[2]); /* forward: 10.002 is too far */
    TEST_ASSERT_FLOAT_WITHIN(1e-8F, 0.001F, table.value_mm[3]);
}

static void test_triplets_of_the_other_type_are_corrections_already(void)
{
    static const char comp[] = "0 0.001 0\n10 0.002 -0.003\n";

    TEST_ASSERT_TRUE(
        takt_table_read_triplets(comp, strlen(comp), AXIS_X, 1, 1.0, &rules, &table, &wrong));
    TEST_ASSERT_FLOAT_WITHIN(1e-9F, 0.002F, table.value_mm[2]);
    TEST_ASSERT_FLOAT_WITHIN(1e-9F, -0.003F, table.value_mm[3]);
}

static void test_triplets_that_are_none_are_refused(void)
{
    static const char comp[] = "0 0 0\n10 10\n";

    TEST_ASSERT_FALSE(
        takt_table_read_triplets(comp, strlen(comp), AXIS_X, 0, 1.0, &rules, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_TRIPLET, wrong.code);
    TEST_ASSERT_EQUAL_UINT(2, wrong.line);
}

struct broken {
    const char *text;
    enum takt_error code;
    const char *cell; /* word of the message; NULL: not looked at */
    uint32_t line;
};

static const struct broken broken[] = {
    /* headers */
    {"", TAKT_ERROR_TABLE_OUTPUTS_MISSING, NULL, 0},
    {"# nothing\n\n", TAKT_ERROR_TABLE_OUTPUTS_MISSING, NULL, 2},
    {"X_mm,Q_mm,KX_um\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "Q_mm", 1},
    {"X_mm,KX\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "KX", 1},
    {"X_deg,KX_um\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "X_deg", 1},
    {"X_um,KX_um\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "X_um", 1},
    {"X_mm,KC_um\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "KC_um", 1},
    {"X_mm,,KX_um\n", TAKT_ERROR_TABLE_COLUMN_UNKNOWN, "", 1},
    {"X_mm,X_mm,KX_um\n", TAKT_ERROR_TABLE_COLUMN_TWICE, "X_mm", 1},
    {"X_mm,KX_um,KX_um\n", TAKT_ERROR_TABLE_COLUMN_TWICE, "KX_um", 1},
    {"X_mm,KX_um,KX_up_um\n", TAKT_ERROR_TABLE_COLUMN_TWICE, "KX_up_um", 1},
    {"X_mm,KX_um,Y_mm\n", TAKT_ERROR_TABLE_COLUMN_ORDER, "Y_mm", 1},
    {"KX_um\n", TAKT_ERROR_TABLE_POSITIONS, "KX_um", 1},
    {"X_mm,Y_mm\n", TAKT_ERROR_TABLE_OUTPUTS_MISSING, NULL, 1},
    {"X_mm,KX_up_um\n", TAKT_ERROR_TABLE_DIRECTION_ALONE, "KX", 1},
    {"X_mm,Y_mm,KX_up_um,KX_down_um\n", TAKT_ERROR_TABLE_DIRECTION_GRID, "KX_up_um", 1},
    {"X_mm,Y_mm,EX_um\n", TAKT_ERROR_TABLE_ERRORS, "EX_um", 1},
    {"X_mm,KX_um,EY_um\n", TAKT_ERROR_TABLE_ERRORS, "EY_um", 1},
    {"X_mm,EX_up_um\n", TAKT_ERROR_TABLE_ERRORS, "EX_up_um", 1},
    {"X_mm,C_deg,B_deg,KX_um\n", TAKT_ERROR_TABLE_ROTARY_SECOND, "B_deg", 1},
    {"B_deg,KB_urad\n0,0\n1,0\n", TAKT_ERROR_AXIS_MISSING, "B", 0},
    /* cells */
    {"X_mm,KX_um\n0,1\n1\n", TAKT_ERROR_TABLE_CELL_COUNT, NULL, 3},
    {"X_mm,KX_um\n0,1,2\n", TAKT_ERROR_TABLE_CELL_COUNT, NULL, 2},
    {"X_mm,KX_um\n0,1\n1,abc\n", TAKT_ERROR_TABLE_NUMBER, "abc", 3},
    {"X_mm,KX_um\n0,1\n1,\n", TAKT_ERROR_TABLE_NUMBER, "", 3},
    {"X_mm,KX_um\n0,1\n1,1.2.3\n", TAKT_ERROR_TABLE_NUMBER, "1.2.3", 3},
    {"X_mm,KX_um\n0,1\n1,NaN\n", TAKT_ERROR_TABLE_NOT_FINITE, "NaN", 3},
    {"X_mm,KX_um\n0,1\n-inf,1\n", TAKT_ERROR_TABLE_NOT_FINITE, "-inf", 3},
    {"X_mm,KX_um\n0,1\n1,1e999\n", TAKT_ERROR_TABLE_NOT_FINITE, "1e999", 3},
    {"X_mm,KX_um\n0,1\n1,1e300\n", TAKT_ERROR_TABLE_NOT_FINITE, "X 1: KX", 3},
    /* points */
    {"X_mm,KX_um\n", TAKT_ERROR_TABLE_POINTS_FEW, "X", 0},
    {"X_mm,KX_um\n0,1\n", TAKT_ERROR_TABLE_POINTS_FEW, "X", 0},
    {"X_mm,Y_mm,KX_um\n0,0,1\n1,0,1\n", TAKT_ERROR_TABLE_POINTS_FEW, "Y", 0},
    {"X_mm,KX_um\n0,1\n5,1\n5,1\n", TAKT_ERROR_TABLE_ORDER, "X", 4},
    {"X_mm,KX_um\n0,1\n5,1\n4,1\n", TAKT_ERROR_TABLE_ORDER, "X", 4},
    {"X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,0,1\n9,0,1\n", TAKT_ERROR_TABLE_ORDER, "Y", 4},
    {"X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n8,7,1\n", TAKT_ERROR_TABLE_POINT, "X 9 Y 7", 5},
    {"X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n", TAKT_ERROR_TABLE_POINT, "X 9 Y 7", 5},
    {"X_mm,Y_mm,KX_um\n0,0,1\n9,0,1\n0,7,1\n9,8,1\n", TAKT_ERROR_TABLE_POINT, "X 9 Y 7", 5},
    {"X_mm,Y_mm,KX_um\n0,0,1\n5,0,1\n11,0,1\n0,7,1\n5,7,1\n11,7,1\n", TAKT_ERROR_TABLE_UNEVEN,
     "X 5 Y 0", 3},
    /* numbers the machine does not accept */
    {"X_mm,KX_um\n0,1\n50,-501\n", TAKT_ERROR_TABLE_LARGE, "X 50: KX", 3},
    {"X_mm,KX_up_um,KX_down_um\n0,0,0\n1,0,3\n", TAKT_ERROR_TABLE_STEEP, "X 1: KX_down", 3},
    {"X_mm,Y_mm,KZ_um\n0,0,1\n9,0,1\n0,7,20\n9,7,1\n", TAKT_ERROR_TABLE_STEEP, "X 0 Y 7: KZ", 4},
    /* checksums */
    {"X_mm,KX_um\n0,1\n9,1\nchecksum,00000000\n", TAKT_ERROR_TABLE_CHECKSUM, "00000000", 4},
    {"X_mm,KX_um\n0,1\n9,1\nchecksum,12\n", TAKT_ERROR_TABLE_CHECKSUM, "12", 4},
    {"X_mm,KX_um\n0,1\n9,1\nchecksum,1x345678\n", TAKT_ERROR_TABLE_CHECKSUM, "1x345678", 4},
    {"X_mm,KX_um\n0,1\n9,1\nchecksum\n", TAKT_ERROR_TABLE_CHECKSUM, NULL, 4},
};

static void test_broken_tables_are_refused_with_the_cell_named(void)
{
    TEST_ASSERT_TRUE(sizeof broken / sizeof broken[0] >= 30);
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        const struct broken *b = &broken[i];

        TEST_ASSERT_FALSE_MESSAGE(read_text(b->text), b->text);
        TEST_ASSERT_EQUAL_INT_MESSAGE(b->code, wrong.code, b->text);
        TEST_ASSERT_EQUAL_UINT_MESSAGE(b->line, wrong.line, b->text);
        if (b->cell != NULL)
            TEST_ASSERT_EQUAL_STRING_MESSAGE(b->cell, wrong.word, b->text);
    }
}

static void test_text_behind_the_checksum_is_refused(void)
{
    static struct collected c;

    TEST_ASSERT_TRUE(read_text(plane));
    write_table(&c);
    collect(&c, "300,0,1,1\n", 10);
    TEST_ASSERT_FALSE(read_text(c.text));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_AFTER_CHECKSUM, wrong.code);
}

static void test_too_many_points_and_too_many_numbers_are_refused(void)
{
    char *text = malloc(400000);
    size_t length = (size_t)sprintf(text, "X_mm,KX_um\n");

    for (int i = 0; i <= TABLE_KNOTS_MAX; i++)
        length += (size_t)sprintf(text + length, "%d,0\n", i);
    TEST_ASSERT_FALSE(read_text(text));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_POINTS_MANY, wrong.code);
    length = (size_t)sprintf(text, "X_mm,Y_mm,KX_um\n");
    for (int i = 0; i < 128 * 129; i++)
        length += (size_t)sprintf(text + length, "%d,%d,0\n", i % 128, i / 128);
    TEST_ASSERT_FALSE(read_text(text));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_FULL, wrong.code);
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_grid_is_read_with_its_axes_and_units);
    RUN_TEST(test_units_separators_and_small_letters_are_understood);
    RUN_TEST(test_errors_of_a_unit_are_read_also_about_axes_that_the_machine_has_not);
    RUN_TEST(test_both_directions_of_an_axis_are_read);
    RUN_TEST(test_what_is_written_reads_as_the_same_table);
    RUN_TEST(test_a_changed_byte_breaks_the_checksum_of_a_written_table);
    RUN_TEST(test_a_stored_table_comes_back_to_the_last_bit);
    RUN_TEST(test_a_volume_of_two_thousand_points_is_stored_in_25_kilobytes);
    RUN_TEST(test_every_damaged_byte_and_every_missing_end_of_a_stored_table_is_refused);
    RUN_TEST(test_measured_triplets_become_corrections_of_both_directions);
    RUN_TEST(test_triplets_of_the_other_type_are_corrections_already);
    RUN_TEST(test_triplets_that_are_none_are_refused);
    RUN_TEST(test_broken_tables_are_refused_with_the_cell_named);
    RUN_TEST(test_text_behind_the_checksum_is_refused);
    RUN_TEST(test_too_many_points_and_too_many_numbers_are_refused);
    return UNITY_END();
}

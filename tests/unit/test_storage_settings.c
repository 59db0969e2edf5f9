/* Settings as bytes: what is packed is read back, and nothing else is taken for it. */
#include "base/crc32.h"
#include "storage/little_words.h"
#include "storage/settings.h"
#include "storage/settings_fields.h"
#include "unity.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ROOM 262144U

static struct machine machine, found;
static struct correction_tables tables, found_tables;
static struct concise_dcf dcf[MACHINE_NODES_MAX], found_dcf[MACHINE_NODES_MAX];
static struct table table;
static struct diagnostic wrong;
static uint64_t memory[ROOM / 8];
static size_t size;

static uint8_t *bytes(void)
{
    return (uint8_t *)memory;
}

static void add_rotary(void)
{
    machine.axis[AXIS_C] = machine.axis[AXIS_X];
    machine.axis[AXIS_C].rotary = true;
    machine.axis[AXIS_C].drive_node = 6;
    machine.axis[AXIS_C].travel_min_mm = -60;
    machine.axis[AXIS_C].travel_max_mm = 60;
}

void setUp(void)
{
    takt_machine_set_default(&machine);
    machine.cycle_us = 2000;
    memset(&tables, 0, sizeof tables);
    memset(dcf, 0, sizeof dcf);
    memset(&wrong, 0, sizeof wrong);
}

void tearDown(void)
{
}

static void pack(void)
{
    memset(memory, 0xA5, sizeof memory);
    size = takt_settings_pack(&machine, &tables, dcf, bytes(), ROOM);
    TEST_ASSERT_GREATER_THAN(SETTINGS_HEAD_BYTES, size);
}

/* After a change by hand. */
static void seal(void)
{
    little_put32(bytes() + 4, (uint32_t)size);
    little_put32(bytes() + 8, takt_crc32_add(CRC32_START, bytes() + 12, size - 12));
}

static bool read_back(void)
{
    return takt_settings_read(bytes(), size, &found, &found_tables, found_dcf, &wrong);
}

static void expect_refusal(enum takt_error code)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    TEST_ASSERT_FALSE(read_back());
    (void)takt_diagnostic_text(&wrong, text);
    TEST_ASSERT_EQUAL_MESSAGE(code, wrong.code, text);
}

static void expect_same(const struct settings_field *field, const void *a, const void *b)
{
    uint8_t first[256], second[256];

    takt_settings_field_get(field, a, first);
    takt_settings_field_get(field, b, second);
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(first, second, takt_settings_field_bytes(field), field->name);
}

static void expect_same_machine(void)
{
    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        const struct settings_field *field = &takt_settings_fields[i];

        if (!field->of_axis)
            expect_same(field, &machine, &found);
        for (unsigned axis = 0; axis < AXIS_COUNT && field->of_axis; axis++) {
            if (machine.axis[axis].present)
                expect_same(field, &machine.axis[axis], &found.axis[axis]);
        }
    }
    TEST_ASSERT_EQUAL_HEX(takt_machine_axes(&machine), takt_machine_axes(&found));
}

static void test_a_machine_is_read_back_bit_for_bit(void)
{
    add_rotary();
    machine.axis[AXIS_Y].present = false;
    machine.axis[AXIS_X].max_jerk_mm_s3 = 12345.678901234567;
    machine.correction.machine[2][1] = 1.0 / 3.0;
    machine.correction.turn_axis = AXIS_C;
    pack();
    TEST_ASSERT_TRUE(read_back());
    expect_same_machine();
    TEST_ASSERT_EQUAL(0, found_tables.volume.inputs);
    TEST_ASSERT_EQUAL(0, found_tables.axes.count);
    TEST_ASSERT_LESS_OR_EQUAL(SETTINGS_BYTES_MIN, size);
}

static void test_every_field_has_a_number_of_its_own(void)
{
    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        for (size_t k = 0; k < i; k++)
            TEST_ASSERT_NOT_EQUAL(takt_settings_fields[i].number, takt_settings_fields[k].number);
    }
}

static void make_volume(uint8_t inputs)
{
    static const uint8_t axes[] = {AXIS_X, AXIS_Y, AXIS_Z, AXIS_C};
    static const uint16_t points[] = {9, 7, 5, 4};

    memset(&table, 0, sizeof table);
    table.inputs = inputs;
    table.outputs = 3;
    for (uint8_t i = 0; i < inputs; i++) {
        table.input[i] = axes[i];
        table.knots[i] = points[i];
        for (unsigned k = 0; k < points[i]; k++)
            table.knot_mm[i][k] = axes[i] == AXIS_C ? 10.0 * k - 20 : 60.0 * k - 200;
    }
    for (uint8_t i = 0; i < 3; i++)
        table.output[i].axis = i;
    for (uint32_t row = 0; row < takt_table_rows(&table); row++) {
        for (unsigned o = 0; o < 3; o++)
            table.value_mm[3 * row + o] = (float)(0.02 * sin(0.7 * row + o));
    }
    TEST_ASSERT_TRUE(takt_grid_set(&tables.volume, &table, &wrong));
}

static void make_axis(uint8_t axis, uint8_t corrected)
{
    memset(&table, 0, sizeof table);
    table.inputs = 1;
    table.outputs = 2;
    table.input[0] = axis;
    table.knots[0] = 17;
    table.output[0] = (struct table_output){corrected, TABLE_UP};
    table.output[1] = (struct table_output){corrected, TABLE_DOWN};
    for (size_t k = 0; k < 17; k++) {
        table.knot_mm[0][k] = 25.0 * (double)k + 0.1 * (double)(k % 3);
        table.value_mm[2 * k] = (float)(0.01 * sin((double)k));
        table.value_mm[2 * k + 1] = (float)(0.01 * cos((double)k));
    }
    TEST_ASSERT_TRUE(takt_axis_tables_add(&tables.axes, &table, &wrong));
}

/* The same bits of the corrections at random points. */
static void expect_same_corrections(void)
{
    srand(1);
    for (int i = 0; i < 2000; i++) {
        float approach[AXIS_COUNT], a[AXIS_COUNT] = {0}, b[AXIS_COUNT] = {0};
        struct point at;

        for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
            at.at[axis] = 0.01 * (rand() % 60000) - 250;
            approach[axis] = (float)(rand() % 3 - 1);
        }
        if (tables.volume.inputs != 0) {
            (void)takt_grid_add(&tables.volume, &at, 1.0F, a);
            (void)takt_grid_add(&found_tables.volume, &at, 1.0F, b);
        }
        (void)takt_axis_tables_sum(&tables.axes, &at, approach, 1.0F, a);
        (void)takt_axis_tables_sum(&found_tables.axes, &at, approach, 1.0F, b);
        TEST_ASSERT_EQUAL_MEMORY(a, b, sizeof a);
    }
}

static void test_tables_correct_as_before_from_where_they_lie(void)
{
    for (uint8_t inputs = 2; inputs <= 4; inputs++) {
        setUp();
        add_rotary();
        make_volume(inputs);
        make_axis(AXIS_X, AXIS_X);
        make_axis(AXIS_Y, AXIS_Z);
        pack();
        TEST_ASSERT_TRUE(read_back());
        expect_same_corrections();
        TEST_ASSERT_EQUAL_FLOAT(tables.volume.reach, found_tables.volume.reach);
        TEST_ASSERT_EQUAL_HEX(tables.axes.inputs, found_tables.axes.inputs);
        TEST_ASSERT_TRUE((const uint8_t *)found_tables.volume.coefficient > bytes() &&
                         (const uint8_t *)found_tables.volume.coefficient < bytes() + size);
    }
}

static void test_a_room_that_is_too_small_is_refused(void)
{
    make_volume(3);
    pack();
    for (size_t room = 0; room < size; room += 8)
        TEST_ASSERT_EQUAL(0, takt_settings_pack(&machine, &tables, dcf, bytes(), room));
    TEST_ASSERT_EQUAL(size, takt_settings_pack(&machine, &tables, dcf, bytes(), size));
}

static void test_every_bit_that_is_wrong_is_found(void)
{
    make_axis(AXIS_X, AXIS_X);
    pack();
    for (size_t bit = 0; bit < 8 * size; bit += bit < 4096 ? 1 : 9) {
        bytes()[bit / 8] ^= (uint8_t)(1U << bit % 8);
        TEST_ASSERT_FALSE(read_back());
        bytes()[bit / 8] ^= (uint8_t)(1U << bit % 8);
    }
    TEST_ASSERT_TRUE(read_back());
}

static void test_a_part_of_settings_is_refused(void)
{
    size_t whole;

    pack();
    whole = size;
    for (size = 0; size < whole; size++)
        TEST_ASSERT_FALSE(read_back());
    TEST_ASSERT_TRUE(read_back());
}

static void test_what_is_no_settings_is_refused_as_that(void)
{
    pack();
    bytes()[0] = 'X';
    expect_refusal(TAKT_ERROR_SETTINGS_KIND);
    pack();
    bytes()[12] = SETTINGS_VERSION + 1;
    seal();
    expect_refusal(TAKT_ERROR_SETTINGS_KIND);
    pack();
    bytes()[100] ^= 1;
    expect_refusal(TAKT_ERROR_SETTINGS_CHECKSUM);
}

static void test_records_of_another_version_are_refused(void)
{
    pack();
    bytes()[SETTINGS_HEAD_BYTES] = 199; /* the number of the first record */
    seal();
    expect_refusal(TAKT_ERROR_SETTINGS_UNKNOWN);
    TEST_ASSERT_EQUAL_DOUBLE(199, wrong.value);
    pack();
    bytes()[SETTINGS_HEAD_BYTES + 4] = 63; /* its size */
    seal();
    expect_refusal(TAKT_ERROR_SETTINGS_SHAPE);
    pack();
    bytes()[SETTINGS_HEAD_BYTES + 7] = 0xFF;
    seal();
    expect_refusal(TAKT_ERROR_SETTINGS_SHAPE);
}

/*
 * Random bytes behind a right checksum: refused or taken, but nothing is read or written beyond its
 * place.
 */
static void test_garbage_with_a_right_checksum_does_no_harm(void)
{
    make_volume(2);
    make_axis(AXIS_X, AXIS_X);
    pack();
    for (int i = 0; i < 5000; i++) {
        uint8_t before[4];
        size_t at[4];

        for (unsigned k = 0; k < 4; k++) {
            at[k] = SETTINGS_HEAD_BYTES + (size_t)rand() % (size - SETTINGS_HEAD_BYTES);
            before[k] = bytes()[at[k]];
            bytes()[at[k]] = (uint8_t)rand();
        }
        seal();
        (void)read_back();
        for (unsigned k = 4; k-- > 0;)
            bytes()[at[k]] = before[k];
    }
    seal();
    TEST_ASSERT_TRUE(read_back());
}

static void test_a_number_out_of_its_range_is_refused_with_its_name(void)
{
    machine.axis[AXIS_Y].max_jerk_mm_s3 = -1;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_VALUE);
    TEST_ASSERT_EQUAL_STRING("Y max_jerk_mm_s3", wrong.word);
    TEST_ASSERT_EQUAL_DOUBLE(-1, wrong.value);
    setUp();
    machine.axis[AXIS_Y].max_jerk_mm_s3 = (double)NAN;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_VALUE);
    setUp();
    machine.cycle_us = 99;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_VALUE);
    setUp();
    memset(machine.name, 'x', sizeof machine.name);
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_VALUE);
    setUp();
    machine.axis[AXIS_Z].rotary = true;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_VALUE);
}

static void test_a_machine_that_cannot_work_is_refused(void)
{
    machine.axis[AXIS_Y].drive_node = 1;
    pack();
    expect_refusal(TAKT_ERROR_MACHINE_NODES);
    setUp();
    machine.can_bitrate = 125000;
    pack();
    expect_refusal(TAKT_ERROR_BUS_OVERLOAD);
    setUp();
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        machine.axis[i].present = false;
    pack();
    expect_refusal(TAKT_ERROR_MACHINE_NO_AXIS);
}

static void test_tables_that_break_the_machines_rules_are_refused(void)
{
    make_volume(3);
    machine.correction.largest_mm = 0.01;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_TABLE);
    machine.correction.largest_mm = 1;
    machine.correction.steepest_ratio = 1e-4;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_TABLE);
    setUp();
    make_axis(AXIS_X, AXIS_X);
    machine.correction.largest_mm = 0.001;
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_TABLE);
    setUp();
    make_volume(4); /* over C, which this machine does not have */
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_TABLE);
    TEST_ASSERT_EQUAL(0, found_tables.volume.inputs);
}

static void test_corrections_that_leave_too_little_of_an_axis_are_refused(void)
{
    static struct correction scratch;

    make_volume(3);
    TEST_ASSERT_TRUE(takt_settings_check_share(&machine, &tables, &scratch, &wrong));
    machine.axis[AXIS_X].max_jerk_mm_s3 = 30;
    machine.correction.fade_s = 0.001;
    TEST_ASSERT_FALSE(takt_settings_check_share(&machine, &tables, &scratch, &wrong));
    TEST_ASSERT_EQUAL(TAKT_ERROR_SETTINGS_SHARE, wrong.code);
}

/* One entry, 1017:00 = 100. */
static const uint8_t configuration[] = {1, 0, 0, 0, 0x17, 0x10, 0, 2, 0, 0, 0, 100, 0};

static void test_configurations_of_drives_are_read_in_place(void)
{
    dcf[1] = dcf[MACHINE_NODES_MAX - 1] = (struct concise_dcf){configuration, sizeof configuration};
    pack();
    TEST_ASSERT_TRUE(read_back());
    TEST_ASSERT_NULL(found_dcf[0].bytes);
    for (unsigned i = 1; i < MACHINE_NODES_MAX; i += MACHINE_NODES_MAX - 2) {
        TEST_ASSERT_EQUAL_UINT(sizeof configuration, found_dcf[i].length);
        TEST_ASSERT_EQUAL_MEMORY(configuration, found_dcf[i].bytes, sizeof configuration);
        TEST_ASSERT_TRUE(found_dcf[i].bytes > bytes() && found_dcf[i].bytes < bytes() + size);
    }
}

static void test_a_configuration_that_cannot_be_gone_through_is_refused(void)
{
    dcf[0] = (struct concise_dcf){configuration, sizeof configuration - 1};
    pack();
    expect_refusal(TAKT_ERROR_SETTINGS_SHAPE);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_machine_is_read_back_bit_for_bit);
    RUN_TEST(test_every_field_has_a_number_of_its_own);
    RUN_TEST(test_tables_correct_as_before_from_where_they_lie);
    RUN_TEST(test_a_room_that_is_too_small_is_refused);
    RUN_TEST(test_every_bit_that_is_wrong_is_found);
    RUN_TEST(test_a_part_of_settings_is_refused);
    RUN_TEST(test_what_is_no_settings_is_refused_as_that);
    RUN_TEST(test_records_of_another_version_are_refused);
    RUN_TEST(test_garbage_with_a_right_checksum_does_no_harm);
    RUN_TEST(test_a_number_out_of_its_range_is_refused_with_its_name);
    RUN_TEST(test_a_machine_that_cannot_work_is_refused);
    RUN_TEST(test_tables_that_break_the_machines_rules_are_refused);
    RUN_TEST(test_corrections_that_leave_too_little_of_an_axis_are_refused);
    RUN_TEST(test_configurations_of_drives_are_read_in_place);
    RUN_TEST(test_a_configuration_that_cannot_be_gone_through_is_refused);
    return UNITY_END();
}

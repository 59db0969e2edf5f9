/*
 * What a drive has stored, as bytes (firmware/servo/stored.h): any bytes are read or refused, and
 * what was written is what is read.
 */
#include "lone_drive.h"
#include "servo/stored.h"

#include <stdlib.h>

#define SAVE 0x65766173u

static struct lone_drive lone;
static uint8_t bytes[SERVO_STORED_MAX];

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static void write(unsigned index, unsigned sub, unsigned width, uint32_t value)
{
    TEST_ASSERT_EQUAL_HEX32(0, lone_write(&lone, (uint16_t)index, (uint8_t)sub, width, value));
}

static size_t store_some(void)
{
    write(0x2000, 0, 4, 0x2078614C);
    write(0x2010, 3, 4, 3000);
    for (unsigned i = 1; i <= 64; i++)
        write(0x2011, i, 4, 3 * i);
    write(0x2010, 1, 1, 64);
    write(0x6098, 0, 1, (uint8_t)-4);
    write(0x1010, 1, 4, SAVE);
    return takt_servo_write_stored(&lone.drive.servo, bytes, sizeof bytes);
}

static void test_what_was_written_is_read(void)
{
    size_t length = store_some();
    struct drive_objects before = lone.drive.servo.stored;
    TEST_ASSERT_TRUE(length > 0);
    lone_start(&lone);
    TEST_ASSERT_TRUE(takt_servo_read_stored(&lone.drive.servo, bytes, length));
    TEST_ASSERT_EQUAL_MEMORY(&before.settings, &lone.drive.servo.stored.settings,
                             sizeof before.settings);
    TEST_ASSERT_EQUAL_MEMORY(&before.settings, &lone.drive.servo.objects.settings,
                             sizeof before.settings);
    TEST_ASSERT_EQUAL_HEX32(0xFC, lone_read(&lone, 0x6098, 0) & 0xFF);
}

static void test_all_that_can_be_stored_has_room(void)
{
    size_t all = 1;
    for (unsigned i = 0; i < takt_object_table_count; i++)
        if (takt_servo_is_stored(&takt_object_table[i]))
            all += 4 + (takt_object_table[i].type == OBJECT_STRING
                            ? DRIVE_LABEL_SIZE
                            : takt_object_type_bytes((enum object_type)takt_object_table[i].type));
    TEST_ASSERT_TRUE(all <= SERVO_STORED_MAX);
    size_t length = store_some();
    for (size_t room = 0; room < length; room++)
        TEST_ASSERT_EQUAL_UINT(0, takt_servo_write_stored(&lone.drive.servo, bytes, room));
}

static void start_anew(void)
{
    lone.sent_count = 0;
    lone_start(&lone);
}

static void assert_fresh(void)
{
    TEST_ASSERT_EQUAL_MEMORY(&lone.drive.servo.initial, &lone.drive.servo.stored,
                             sizeof lone.drive.servo.stored);
}

static void test_a_part_of_it_or_other_bytes_leave_the_values_of_power_on(void)
{
    size_t length = store_some();
    srand(3);
    for (size_t part = 0; part < length; part++) {
        start_anew();
        if (!takt_servo_read_stored(&lone.drive.servo, bytes, part))
            assert_fresh();
    }
    for (unsigned i = 0; i < 3000; i++) {
        uint8_t wrong[64];
        memcpy(wrong, bytes, sizeof wrong);
        for (unsigned k = 0; k < 3; k++)
            wrong[(unsigned)rand() % sizeof wrong] = (uint8_t)rand();
        start_anew();
        if (!takt_servo_read_stored(&lone.drive.servo, wrong, sizeof wrong))
            assert_fresh();
        lone_step(&lone, 2);
    }
}

static void test_each_mistake_is_refused(void)
{
    static const uint8_t mistakes[][8] = {
        {0, 0x17, 0x10, 0, 2, 1, 0}, {200, 0x17, 0x10, 0, 2, 1, 0}, {5, 0x17, 0x10, 0, 3, 1, 0},
        {5, 0x16, 0x10, 0, 2, 1, 0}, {5, 0x41, 0x60, 0, 2, 1, 0},   {5, 0x10, 0x20, 1, 1, 65, 0},
        {5, 0x18, 0x10, 4, 4, 1, 0},
    };
    static const uint8_t good[] = {5, 0x17, 0x10, 0, 2, 1, 0};
    TEST_ASSERT_TRUE(takt_servo_read_stored(&lone.drive.servo, good, sizeof good));
    for (unsigned i = 0; i < sizeof mistakes / sizeof mistakes[0]; i++) {
        lone_start(&lone);
        TEST_ASSERT_FALSE(takt_servo_read_stored(&lone.drive.servo, mistakes[i],
                                                 5u + (mistakes[i][4] < 3 ? mistakes[i][4] : 3u)));
        assert_fresh();
    }
}

static void test_its_node_id_counts_for_its_identifiers(void)
{
    static const uint8_t moved[] = {9, 0x17, 0x10, 0, 2, 100, 0};
    uint32_t id = 0;
    TEST_ASSERT_TRUE(takt_servo_read_stored(&lone.drive.servo, moved, sizeof moved));
    TEST_ASSERT_EQUAL_UINT8(9, lone.drive.servo.config.node);
    TEST_ASSERT_TRUE(takt_servo_read_object(&lone.drive.servo, 0x18000120, &id));
    TEST_ASSERT_EQUAL_HEX32(0x40000189, id);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_was_written_is_read);
    RUN_TEST(test_all_that_can_be_stored_has_room);
    RUN_TEST(test_a_part_of_it_or_other_bytes_leave_the_values_of_power_on);
    RUN_TEST(test_each_mistake_is_refused);
    RUN_TEST(test_its_node_id_counts_for_its_identifiers);
    return UNITY_END();
}

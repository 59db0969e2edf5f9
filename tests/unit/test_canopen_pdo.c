#include "canopen/cia402.h"
#include "canopen/pdo.h"
#include "canopen/target_pdo.h"
#include "unity.h"

void setUp(void)
{
}

void tearDown(void)
{
}

static void test_objects_are_packed_one_after_the_other_least_significant_byte_first(void)
{
    static const uint32_t objects[] = {CIA402_STATUSWORD, CIA402_MODE_DISPLAY,
                                       CIA402_POSITION_ACTUAL};
    static const uint32_t values[] = {0x1237, 0x08, (uint32_t)-2};
    static const uint8_t expected[] = {0x37, 0x12, 0x08, 0xFE, 0xFF, 0xFF, 0xFF};
    struct pdo pdo = {.cob_id = 0x181};
    struct can_frame frame;
    TEST_ASSERT_TRUE(takt_pdo_map(&pdo.mapping, objects, 3));
    takt_pdo_pack(&pdo, values, &frame);
    TEST_ASSERT_EQUAL_HEX16(0x181, frame.id);
    TEST_ASSERT_EQUAL_INT(7, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, frame.data, 7);
}

static uint32_t lcg(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* A random mapping that fills at most eight bytes. */
static unsigned random_mapping(uint32_t *seed, uint32_t objects[PDO_MAPPED_MAX])
{
    unsigned count = 0, length = 0;
    for (;;) {
        unsigned bytes = 1u << lcg(seed) % 3;
        if (length + bytes > CAN_CLASSIC_MAX)
            return count;
        objects[count] = PDO_MAPPED(0x2000 + count, 0, bytes * 8);
        count++;
        length += bytes;
    }
}

static void test_any_mapping_unpacks_what_it_packed(void)
{
    uint32_t seed = 1;
    for (unsigned round = 0; round < 10000; round++) {
        uint32_t objects[PDO_MAPPED_MAX], values[PDO_MAPPED_MAX], read[PDO_MAPPED_MAX];
        struct pdo pdo = {.cob_id = 0x200};
        struct can_frame frame;
        unsigned count = random_mapping(&seed, objects);
        TEST_ASSERT_TRUE(takt_pdo_map(&pdo.mapping, objects, count));
        for (unsigned i = 0; i < count; i++)
            values[i] = (lcg(&seed) << 12 ^ lcg(&seed)) >> (32 - (objects[i] & 0xFF));
        takt_pdo_pack(&pdo, values, &frame);
        takt_pdo_unpack(&pdo.mapping, frame.data, read);
        TEST_ASSERT_EQUAL_HEX32_ARRAY(values, read, count);
    }
}

static void test_a_mapping_of_too_many_or_not_of_bytes_is_refused_and_empty(void)
{
    static const uint32_t nine[] = {CIA402_TARGET_POSITION, CIA402_TARGET_POSITION, CIA402_MODE};
    static const uint32_t bit[] = {PDO_MAPPED(0x2000, 0, 1)};
    static const uint32_t wide[] = {PDO_MAPPED(0x2000, 0, 64)};
    struct pdo_mapping mapping;
    TEST_ASSERT_FALSE(takt_pdo_map(&mapping, bit, 1));
    TEST_ASSERT_EQUAL_INT(0, mapping.count);
    TEST_ASSERT_EQUAL_INT(0, mapping.length);
    TEST_ASSERT_FALSE(takt_pdo_map(&mapping, wide, 1));
    TEST_ASSERT_FALSE(takt_pdo_map(&mapping, nine, PDO_MAPPED_MAX + 1));
    TEST_ASSERT_TRUE(takt_pdo_map(&mapping, nine, 2));
}

static void test_a_frame_may_be_longer_than_its_mapping_but_not_shorter(void)
{
    static const uint32_t objects[] = {CIA402_TARGET_POSITION};
    struct pdo_mapping mapping;
    struct can_frame frame = {.length = 4};
    TEST_ASSERT_TRUE(takt_pdo_map(&mapping, objects, 1));
    TEST_ASSERT_TRUE(pdo_fits(&mapping, &frame));
    frame.length = 8;
    TEST_ASSERT_TRUE(pdo_fits(&mapping, &frame));
    frame.length = 3;
    TEST_ASSERT_FALSE(pdo_fits(&mapping, &frame));
}

static void test_an_object_is_found_at_its_byte(void)
{
    static const uint32_t objects[] = {CIA402_CONTROLWORD, CIA402_MODE, CIA402_TARGET_POSITION};
    struct pdo_mapping mapping;
    TEST_ASSERT_TRUE(takt_pdo_map(&mapping, objects, 3));
    TEST_ASSERT_EQUAL_INT(0, takt_pdo_offset(&mapping, CIA402_CONTROLWORD));
    TEST_ASSERT_EQUAL_INT(3, takt_pdo_offset(&mapping, CIA402_TARGET_POSITION));
    TEST_ASSERT_EQUAL_INT(-1, takt_pdo_offset(&mapping, CIA402_STATUSWORD));
}

static void test_two_drives_read_their_own_target_from_one_frame(void)
{
    static const uint8_t nodes[] = {4, 9};
    static const uint32_t targets[] = {0x11223344, (uint32_t)-100000};
    struct pdo first, second;
    struct can_frame frame;
    uint32_t value[PDO_MAPPED_MAX];
    takt_target_pdo_set(&first, nodes, 2, 0, TARGET_PDO_PAIR);
    takt_target_pdo_set(&second, nodes, 2, 1, TARGET_PDO_PAIR);
    TEST_ASSERT_EQUAL_HEX16(0x304, first.cob_id);
    TEST_ASSERT_EQUAL_HEX16(0x304, second.cob_id);
    takt_pdo_pack(&first, targets, &frame);
    TEST_ASSERT_EQUAL_INT(8, frame.length);
    takt_pdo_unpack(&first.mapping, frame.data, value);
    TEST_ASSERT_EQUAL_HEX32(0x607A0020, first.mapping.object[0]);
    TEST_ASSERT_EQUAL_HEX32(0x00070020, first.mapping.object[1]);
    TEST_ASSERT_EQUAL_HEX32(targets[0], value[0]);
    takt_pdo_unpack(&second.mapping, frame.data, value);
    TEST_ASSERT_EQUAL_HEX32(0x00070020, second.mapping.object[0]);
    TEST_ASSERT_EQUAL_HEX32(0x607A0020, second.mapping.object[1]);
    TEST_ASSERT_EQUAL_HEX32(targets[1], value[1]);
}

/* Six targets to a frame, each drive with its own; no length that CAN FD does not have. */
static void test_with_can_fd_the_drives_of_a_machine_share_a_frame(void)
{
    static const uint8_t nodes[] = {7, 2, 9, 4, 5, 6};
    for (unsigned count = 1; count <= 6; count++)
        for (unsigned i = 0; i < count; i++) {
            struct pdo pdo;
            takt_target_pdo_set(&pdo, nodes, count, i, TARGET_PDO_FD);
            TEST_ASSERT_EQUAL_HEX16(0x307, pdo.cob_id);
            TEST_ASSERT_EQUAL_INT(4 * count, pdo.mapping.length);
            TEST_ASSERT_EQUAL_INT(4 * i, takt_pdo_offset(&pdo.mapping, CIA402_TARGET_POSITION));
        }
}

static void test_drives_are_paired_in_their_order_and_a_last_one_is_alone(void)
{
    static const uint8_t nodes[] = {7, 5, 3, 2, 1};
    static const uint16_t cob_ids[] = {0x307, 0x307, 0x303, 0x303, 0x301};
    static const int offsets[] = {0, 4, 0, 4, 0};
    static const uint8_t lengths[] = {8, 8, 8, 8, 4};
    for (unsigned i = 0; i < 5; i++) {
        struct pdo pdo;
        takt_target_pdo_set(&pdo, nodes, 5, i, TARGET_PDO_PAIR);
        TEST_ASSERT_EQUAL_HEX16(cob_ids[i], pdo.cob_id);
        TEST_ASSERT_EQUAL_INT(offsets[i], takt_pdo_offset(&pdo.mapping, CIA402_TARGET_POSITION));
        TEST_ASSERT_EQUAL_INT(lengths[i], pdo.mapping.length);
        TEST_ASSERT_EQUAL_INT(PDO_EVERY_SYNC, pdo.transmission);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_objects_are_packed_one_after_the_other_least_significant_byte_first);
    RUN_TEST(test_any_mapping_unpacks_what_it_packed);
    RUN_TEST(test_a_mapping_of_too_many_or_not_of_bytes_is_refused_and_empty);
    RUN_TEST(test_a_frame_may_be_longer_than_its_mapping_but_not_shorter);
    RUN_TEST(test_an_object_is_found_at_its_byte);
    RUN_TEST(test_two_drives_read_their_own_target_from_one_frame);
    RUN_TEST(test_with_can_fd_the_drives_of_a_machine_share_a_frame);
    RUN_TEST(test_drives_are_paired_in_their_order_and_a_last_one_is_alone);
    return UNITY_END();
}

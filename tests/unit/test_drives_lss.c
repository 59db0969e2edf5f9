/*
 * Layer setting services of a virtual drive: it is found, configured, and another node from the
 * next reset on.
 */
#define _POSIX_C_SOURCE 200809L /* fmemopen */

#include "lone_drive.h"

#include "drives/drive_store.h"

#include <stdio.h>

static struct lone_drive lone;

void setUp(void)
{
    lone_set_default(&lone);
    lone_start(&lone);
}

void tearDown(void)
{
}

static void start_nameless(void)
{
    lone_set_default(&lone);
    lone.config.is_nameless = true;
    lone_start(&lone);
}

/* Command, four bytes, three bytes. */
static const struct can_frame *lss(uint8_t command, uint32_t value, uint32_t rest)
{
    lone_take(&lone, 0x7E5, 8, command | value << 8, value >> 24 | rest << 8);
    return lone_find(&lone, 0x7E4);
}

static uint32_t ask(uint8_t command, uint32_t value)
{
    const struct can_frame *frame = lss(command, value, 0);
    TEST_ASSERT_NOT_NULL(frame);
    TEST_ASSERT_EQUAL_UINT(8, frame->length);
    TEST_ASSERT_EQUAL_HEX8(command, frame->data[0]);
    return little_endian_read32(frame->data + 1);
}

/* Vendor 0, product 0x402, revision 0x10000, serial number: the node id. */
static const struct can_frame *select_all(uint32_t serial)
{
    TEST_ASSERT_NULL(lss(0x40, 0, 0));
    TEST_ASSERT_NULL(lss(0x41, 0x402, 0));
    TEST_ASSERT_NULL(lss(0x42, 0x10000, 0));
    return lss(0x43, serial, 0);
}

static void test_a_node_is_selected_by_its_whole_identity_alone(void)
{
    TEST_ASSERT_NULL(select_all(LONE_NODE + 1));
    TEST_ASSERT_NULL(lss(0x5E, 0, 0));
    TEST_ASSERT_NULL(lss(0x43, LONE_NODE, 0)); /* out of turn */
    TEST_ASSERT_EQUAL_HEX8(0x44, select_all(LONE_NODE)->data[0]);
    TEST_ASSERT_EQUAL_HEX32(LONE_NODE, ask(0x5E, 0));
    TEST_ASSERT_EQUAL_HEX32(0x402, ask(0x5B, 0));
    TEST_ASSERT_EQUAL_HEX32(LONE_NODE, ask(0x5D, 0));
    TEST_ASSERT_NULL(lss(0x04, 0, 0));
    TEST_ASSERT_NULL(lss(0x5E, 0, 0));
}

static void test_a_new_node_id_is_in_force_from_the_next_reset_on(void)
{
    (void)lss(0x04, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(1, ask(0x11, 0));
    TEST_ASSERT_EQUAL_HEX32(1, ask(0x11, 128));
    TEST_ASSERT_EQUAL_HEX32(0, ask(0x11, 9));
    TEST_ASSERT_EQUAL_HEX32(1, ask(0x13, 0x0000)); /* bit timing cannot be set */
    TEST_ASSERT_EQUAL_HEX32(LONE_NODE, ask(0x5E, 0));
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x709));
    lone_take(&lone, 0x609, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_HEX32(0x00020192, little_endian_read32(lone_find(&lone, 0x589)->data + 4));
    lone_take(&lone, 0x609, 8, 0x01140040, 0); /* 1400:01 */
    TEST_ASSERT_EQUAL_HEX32(0x209, little_endian_read32(lone_find(&lone, 0x589)->data + 4));
    lone_take(&lone, 0x605, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x000, 2, 0x0901, 0);
    lone_sync(&lone);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x189));
}

static void test_a_reset_of_the_node_brings_back_the_id_that_was_stored(void)
{
    (void)lss(0x04, 1, 0);
    (void)ask(0x11, 9);
    lone_nmt(&lone, NMT_RESET_COMMUNICATION);
    lone_take(&lone, 0x000, 2, 0x0981, 0);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x705));
    (void)lss(0x04, 1, 0);
    (void)ask(0x11, 9);
    TEST_ASSERT_EQUAL_HEX32(0, ask(0x17, 0));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x709));
}

static char kept_text[4096];
static bool keeps;

static bool keep(void *context, const struct servo *drive)
{
    FILE *stream = fmemopen(context, sizeof kept_text, "w");
    TEST_ASSERT_NOT_NULL(stream);
    drive_store_write(stream, drive);
    (void)fclose(stream);
    return keeps;
}

static void switch_on(void)
{
    const struct can_port port = {.send = lone_send, .receive = lone_receive, .context = &lone};
    struct drive_store_problem wrong;
    virtual_drive_init(&lone.drive, &lone.config, NULL, &port);
    TEST_ASSERT_TRUE_MESSAGE(
        drive_store_read(&lone.drive.servo, kept_text, strlen(kept_text), &wrong), wrong.text);
    virtual_drive_boot(&lone.drive);
}

static uint32_t store_node(uint8_t node, bool can_be_kept)
{
    keeps = can_be_kept;
    takt_servo_keep(&lone.drive.servo, &(struct drive_keeper){keep, kept_text});
    (void)lss(0x04, 1, 0);
    (void)ask(0x11, node);
    return ask(0x17, 0);
}

static void test_the_id_that_was_stored_is_there_at_the_next_power_on(void)
{
    TEST_ASSERT_EQUAL_UINT32(0, store_node(9, true));
    TEST_ASSERT_EQUAL_STRING("# stored by node 5, object 1010\nnode 9\n", kept_text);
    lone.sent_count = 0;
    switch_on();
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x709));
    lone_take(&lone, 0x609, 8, 0x40 | 0x1800 << 8 | 1 << 24, 0);
    TEST_ASSERT_EQUAL_HEX32(0x40000189, little_endian_read32(lone_find(&lone, 0x589)->data + 4));
}

static void test_a_node_without_an_id_has_the_stored_one_at_the_next_power_on(void)
{
    start_nameless();
    TEST_ASSERT_EQUAL_UINT32(0, store_node(LONE_NODE, true));
    switch_on();
    lone_nmt(&lone, NMT_START);
    TEST_ASSERT_EQUAL_INT(NMT_OPERATIONAL, virtual_drive_get_nmt_state(&lone.drive));
}

static void test_an_id_that_cannot_be_kept_is_not_stored(void)
{
    TEST_ASSERT_EQUAL_UINT32(2, store_node(9, false));
    lone_nmt(&lone, NMT_RESET_NODE);
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x705));
}

static void test_a_stored_id_that_is_none_is_refused(void)
{
    static const char *const texts[] = {"node 0\n", "node 128\n", "node 1234\n", "node 9x\n",
                                        "node x9\n"};
    struct drive_store_problem wrong;
    for (unsigned i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        setUp();
        TEST_ASSERT_FALSE_MESSAGE(
            drive_store_read(&lone.drive.servo, texts[i], strlen(texts[i]), &wrong), texts[i]);
        TEST_ASSERT_EQUAL_UINT(1, wrong.line);
        TEST_ASSERT_EQUAL_STRING("a node id is 1 ... 127, or 255: none", wrong.text);
    }
}

static void test_a_node_without_an_id_says_nothing_but_by_lss(void)
{
    start_nameless();
    lone_step(&lone, 100);
    lone_nmt(&lone, NMT_START);
    lone_sync(&lone);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    lone_take(&lone, 0x605, 8, 0x00100040, 0);
    TEST_ASSERT_EQUAL_UINT(0, lone.sent_count);
    TEST_ASSERT_EQUAL_HEX8(0x50, lss(0x4C, 0, 0)->data[0]);
    (void)lss(0x04, 1, 0);
    TEST_ASSERT_EQUAL_HEX32(255, ask(0x5E, 0));
    (void)ask(0x11, 7);
    lone_take(&lone, 0x000, 2, 0x0082, 0); /* all nodes */
    TEST_ASSERT_NOT_NULL(lone_find(&lone, 0x707));
    TEST_ASSERT_NULL(lss(0x4C, 0, 0));
}

/* As a master does it, bit by bit. */
static void test_a_node_without_an_id_is_found_by_fastscan(void)
{
    static const uint32_t expected[] = {0, 0x402, 0x10000, LONE_NODE};
    TEST_ASSERT_NULL(lss(0x51, 0, 0x80)); /* this one has an id */
    start_nameless();
    TEST_ASSERT_EQUAL_HEX8(0x4F, lss(0x51, 0, 0x80)->data[0]);
    for (uint32_t part = 0; part < 4; part++) {
        uint32_t found = 0;
        for (uint32_t bit = 32; bit-- > 0;)
            if (lss(0x51, found, bit | part << 8 | part << 16) == NULL)
                found |= 1u << bit;
        TEST_ASSERT_EQUAL_HEX32(expected[part], found);
        TEST_ASSERT_NOT_NULL(lss(0x51, found, part << 8 | ((part + 1) & 3) << 16));
    }
    TEST_ASSERT_EQUAL_HEX32(255, ask(0x5E, 0));
}

static void test_a_node_is_identified_by_ranges_of_revision_and_serial_number(void)
{
    static const uint32_t good[] = {0, 0x402, 0x10000, 0x20000, 1, 5},
                          bad[] = {0, 0x402, 0, 0xFFFF, 1, 5};
    for (uint8_t i = 0; i < 5; i++)
        TEST_ASSERT_NULL(lss((uint8_t)(0x46 + i), good[i], 0));
    TEST_ASSERT_EQUAL_HEX8(0x4F, lss(0x4B, good[5], 0)->data[0]);
    for (uint8_t i = 0; i < 6; i++)
        TEST_ASSERT_NULL(lss((uint8_t)(0x46 + i), bad[i], 0));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_node_is_selected_by_its_whole_identity_alone);
    RUN_TEST(test_a_new_node_id_is_in_force_from_the_next_reset_on);
    RUN_TEST(test_a_reset_of_the_node_brings_back_the_id_that_was_stored);
    RUN_TEST(test_the_id_that_was_stored_is_there_at_the_next_power_on);
    RUN_TEST(test_a_node_without_an_id_has_the_stored_one_at_the_next_power_on);
    RUN_TEST(test_an_id_that_cannot_be_kept_is_not_stored);
    RUN_TEST(test_a_stored_id_that_is_none_is_refused);
    RUN_TEST(test_a_node_without_an_id_says_nothing_but_by_lss);
    RUN_TEST(test_a_node_without_an_id_is_found_by_fastscan);
    RUN_TEST(test_a_node_is_identified_by_ranges_of_revision_and_serial_number);
    return UNITY_END();
}

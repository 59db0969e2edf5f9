/*
 * host/simulation/lockstep.h: for which drives a cycle waits. The test is the drive, at the other
 * end of a pseudo-terminal.
 */
#include "link/link.h"
#include "simulation/lockstep.h"
#include "unity.h"

#include <stdio.h>

#define WAIT_NS  UINT64_C(5000000000)
#define CYCLE_NS 1000000u
#define NODE     1

static struct link *drives, *controller;
static struct lockstep lockstep;

void setUp(void)
{
    const struct link_config config = {.bitrate = 1000000};
    const uint8_t nodes[] = {NODE};
    struct link_error error;
    char spec[300];

    drives = link_open("slcan:pty", &config, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(drives, error.text);
    (void)snprintf(spec, sizeof spec, "slcan:%s", link_get_address(drives));
    controller = link_open(spec, &config, &error);
    TEST_ASSERT_NOT_NULL_MESSAGE(controller, error.text);
    while (!link_has_peer(drives))
        TEST_ASSERT_TRUE(link_wait(drives, link_clock_ns() + CYCLE_NS) != LINK_BROKEN);
    lockstep_init(&lockstep, controller, 0, CYCLE_NS, nodes, 1);
}

void tearDown(void)
{
    link_close(controller);
    link_close(drives);
}

static void tell(uint32_t id, uint8_t first, uint8_t length)
{
    const struct wire_frame frame = {.id = id, .length = length, .data = {first}};

    TEST_ASSERT_TRUE(link_send(drives, &frame));
    TEST_ASSERT_TRUE(link_flush(drives, link_clock_ns() + WAIT_NS));
}

static void test_a_drive_that_leaves_operation_behind_its_answer_is_not_waited_for(void)
{
    char text[LOCKSTEP_TEXT_MAX + 1] = "";

    tell(0x180 + NODE, 0, 8);
    tell(0x700 + NODE, 0x7F, 1); /* pre-operational */
    TEST_ASSERT_TRUE(lockstep_end_cycle(&lockstep));
    TEST_ASSERT_TRUE(lockstep_end_cycle(&lockstep));
    TEST_ASSERT_FALSE_MESSAGE(lockstep_take_warning(&lockstep, text), text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_drive_that_leaves_operation_behind_its_answer_is_not_waited_for);
    return UNITY_END();
}

/* Step pulses as levels of the pins. */
#include "stm32/step_slots.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

#define CYCLE_NS 1000000U

static struct step_slots slots;
static uint16_t levels[STEP_SLOTS_MAX];

/* What a driver at the pins sees. */
struct driver {
    uint32_t pins;
    int32_t position[AXIS_COUNT];
    uint64_t slot, rose[AXIS_COUNT], turned[AXIS_COUNT];
    bool is_wrong;
};

static struct driver driver;

void setUp(void)
{
    memset(&driver, 0, sizeof driver);
    TEST_ASSERT_TRUE(takt_step_slots_init(&slots, CYCLE_NS / 1000U));
    TEST_ASSERT_EQUAL(400, slots.slots);
    memset(levels, 0xFF, sizeof levels);
    takt_step_slots_begin(&slots, levels);
}

void tearDown(void)
{
}

/*
 * A step counts when its pin rises; the direction has stood for a slot, and the pulse and the pause
 * are one each.
 */
static void rise(unsigned axis)
{
    const bool backwards = (driver.pins >> (axis + 8) & 1U) != 0;

    driver.position[axis] += backwards ? -1 : 1;
    if (driver.slot - driver.turned[axis] < 1 || driver.slot - driver.rose[axis] < 2)
        driver.is_wrong = true;
    driver.rose[axis] = driver.slot;
}

static void drive(uint16_t level)
{
    const uint32_t before = driver.pins;

    driver.pins = level;
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        if (((before ^ driver.pins) >> (axis + 8) & 1U) != 0)
            driver.turned[axis] = driver.slot;
        if ((~before & driver.pins & 1U << axis) != 0)
            rise(axis);
    }
    driver.slot++;
}

static void end_cycle(void)
{
    takt_step_slots_take(&slots);
    for (unsigned i = 0; i < slots.slots; i++)
        drive(levels[i]);
    takt_step_slots_begin(&slots, levels);
}

static bool step(uint32_t time_ns, unsigned axes, unsigned direction)
{
    const struct step_pulse pulse = {
        .time_ns = time_ns, .axes = (uint8_t)axes, .direction = (uint8_t)direction};

    return takt_step_slots_add(&slots, &pulse);
}

static void test_a_step_comes_two_slots_after_its_time(void)
{
    driver.slot = 100;
    TEST_ASSERT_TRUE(step(50000, 1, 0));
    end_cycle();
    TEST_ASSERT_EQUAL(1, driver.position[0]);
    TEST_ASSERT_EQUAL(100 + 20 + STEP_SLOTS_DELAY, driver.rose[0]);
    TEST_ASSERT_EQUAL_HEX(0, driver.pins & 0x3FU);
}

static void test_the_last_step_of_a_cycle_is_whole_in_the_next(void)
{
    TEST_ASSERT_TRUE(step(CYCLE_NS - 1, 4, 4));
    end_cycle();
    end_cycle();
    TEST_ASSERT_EQUAL(-1, driver.position[2]);
    TEST_ASSERT_EQUAL_HEX(0, driver.pins & 0x3FU);
}

static void test_200000_steps_a_second_go_through_and_more_are_refused(void)
{
    for (unsigned i = 0; i < 200; i++)
        TEST_ASSERT_TRUE(step(5000 * i, 63, 0));
    end_cycle();
    for (unsigned i = 0; i < 200; i++)
        TEST_ASSERT_TRUE(step(5000 * i, 63, 63));
    end_cycle();
    end_cycle();
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++)
        TEST_ASSERT_EQUAL(0, driver.position[axis]);
    TEST_ASSERT_FALSE(driver.is_wrong);
    for (unsigned i = 0; i < 250; i++) {
        if (!step(4000 * i, 1, 0))
            return;
    }
    TEST_FAIL_MESSAGE("250,000 steps a second are taken");
}

static void test_a_cycle_that_is_sent_before_it_is_made_steps_no_axis_the_wrong_way(void)
{
    TEST_ASSERT_TRUE(step(50000, 2, 2));
    end_cycle();
    TEST_ASSERT_TRUE(step(100000, 3, 3));
    for (unsigned i = 0; i < slots.slots; i++) /* not taken */
        drive(levels[i]);
    TEST_ASSERT_EQUAL(-1, driver.position[0]);
    TEST_ASSERT_EQUAL(-2, driver.position[1]);
    TEST_ASSERT_EQUAL_HEX(0x300U, driver.pins);
}

static void test_random_steps_all_arrive_with_their_directions_in_time(void)
{
    int32_t expected[AXIS_COUNT] = {0};

    srand(1);
    driver.slot = 100;
    for (int cycle = 0; cycle < 2000; cycle++) {
        uint32_t time_ns = 0;

        while ((time_ns += (uint32_t)rand() % 20000U) < CYCLE_NS) {
            const unsigned axes = (unsigned)rand() % 64, direction = (unsigned)rand() % 64;

            TEST_ASSERT_TRUE(step(time_ns, axes, direction));
            for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
                if ((axes >> axis & 1U) != 0)
                    expected[axis] += (direction >> axis & 1U) != 0 ? -1 : 1;
            }
            time_ns += 5000;
        }
        end_cycle();
    }
    end_cycle();
    TEST_ASSERT_EQUAL_INT32_ARRAY(expected, driver.position, AXIS_COUNT);
    TEST_ASSERT_FALSE_MESSAGE(driver.is_wrong, "a pulse, a pause or a direction is too short");
}

static void test_cycles_that_are_too_long_or_no_whole_slots_are_refused(void)
{
    TEST_ASSERT_TRUE(takt_step_slots_init(&slots, 2000));
    TEST_ASSERT_TRUE(takt_step_slots_init(&slots, 100));
    TEST_ASSERT_FALSE(takt_step_slots_init(&slots, 2500));
    TEST_ASSERT_FALSE(takt_step_slots_init(&slots, 101));
    TEST_ASSERT_FALSE(takt_step_slots_init(&slots, 0));
    TEST_ASSERT_FALSE(takt_step_slots_init(&slots, 5));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_step_comes_two_slots_after_its_time);
    RUN_TEST(test_the_last_step_of_a_cycle_is_whole_in_the_next);
    RUN_TEST(test_200000_steps_a_second_go_through_and_more_are_refused);
    RUN_TEST(test_a_cycle_that_is_sent_before_it_is_made_steps_no_axis_the_wrong_way);
    RUN_TEST(test_random_steps_all_arrive_with_their_directions_in_time);
    RUN_TEST(test_cycles_that_are_too_long_or_no_whole_slots_are_refused);
    return UNITY_END();
}

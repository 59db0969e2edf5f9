/*
 * Random machines at 0.5, 0.25 and other cycles: drives that move to a second bus never raise what
 * is asked of either bus, in bits or in the longest response, above what one bus had to carry; and
 * what the advice says is so.
 */
#include "config/bus_advice.h"
#include "machine/machine_check.h"
#include "unity.h"

#include <stdlib.h>
#include <string.h>

#define MACHINES 2000

static uint64_t state = 27;

void setUp(void)
{
}

void tearDown(void)
{
}

static uint32_t draw(uint32_t range)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % range;
}

/* All on the first bus, each with a node id of its own. */
static void draw_machine(struct machine *machine)
{
    static const uint32_t cycles_us[] = {250, 500, 750, 1000};
    static const uint32_t data[] = {0, 0, 2000000, 5000000, 8000000};

    takt_machine_set_default(machine);
    machine->cycle_us = cycles_us[draw(4)];
    machine->can_data_bitrate = data[draw(5)];
    machine->error_pdo = (uint8_t)draw(2);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        machine->axis[i] = machine->axis[AXIS_X];
        machine->axis[i].present = i == 0 || draw(3) > 0;
        machine->axis[i].rotary = i >= AXIS_LINEAR_COUNT;
        machine->axis[i].drive_node = (uint8_t)(i + 1);
    }
    for (unsigned i = 0; i < draw(IO_NODES_MAX + 1); i++) {
        machine->io[i].node = (uint8_t)(20 + i);
        machine->io[i].output[draw(IO_BITS_MAX)] = IO_PROGRAM;
        machine->io[i].input[draw(IO_BITS_MAX)] = IO_PROGRAM + 1;
    }
}

/* Every frame of a cycle is given once between two SYNCs: the sum is the longest response, too. */
static uint32_t bits_of(const struct machine *machine, unsigned bus)
{
    struct drives_load load;

    (void)takt_machine_predict_load(machine, bus, &load);
    return load.bits;
}

static void move_some(struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        machine->axis[i].drive_bus = (uint8_t)draw(2);
    for (unsigned i = 0; i < IO_NODES_MAX; i++)
        machine->io[i].bus = (uint8_t)draw(2);
}

static void test_moving_drives_never_raises_a_load(void)
{
    struct machine machine;

    for (unsigned n = 0; n < MACHINES; n++) {
        draw_machine(&machine);
        const uint32_t alone = bits_of(&machine, 0);

        for (unsigned k = 0; k < 4; k++) {
            move_some(&machine);
            TEST_ASSERT_TRUE(bits_of(&machine, 0) <= alone && bits_of(&machine, 1) <= alone);
        }
    }
}

/* One more drive that leaves the first bus: that never takes more, the second never less. */
static void test_each_move_lowers_one_and_raises_the_other(void)
{
    struct machine machine;

    for (unsigned n = 0; n < MACHINES; n++) {
        draw_machine(&machine);
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            const uint32_t first = bits_of(&machine, 0), second = bits_of(&machine, 1);

            machine.axis[i].drive_bus = 1;
            TEST_ASSERT_TRUE(bits_of(&machine, 0) <= first && bits_of(&machine, 1) >= second);
        }
    }
}

/* "drive_bus = 1 for ZA and error_pdo = 0 (two buses)" */
static bool follow_advice(struct machine *machine, const char *text)
{
    const char *at = strstr(text, "drive_bus = 1 for ");
    const char *end = at != NULL ? strstr(at, " (two buses)") : NULL;

    if (at == NULL || end == NULL)
        return false;
    for (at += strlen("drive_bus = 1 for "); strchr(AXIS_LETTERS, *at) != NULL; at++)
        machine->axis[strchr(AXIS_LETTERS, *at) - AXIS_LETTERS].drive_bus = 1;
    if (strstr(at, " and error_pdo = 0") == at)
        machine->error_pdo = 0;
    return true;
}

static bool are_carried(const struct machine *machine)
{
    struct drives_load load;

    return takt_machine_predict_load(machine, 0, &load) &&
           takt_machine_predict_load(machine, 1, &load);
}

/* Two buses are advised only where they do, and whenever some split from the last axis on does. */
static void test_two_buses_are_advised_truly(void)
{
    unsigned advised = 0, useless = 0;
    char text[BUS_ADVICE_MAX + 1];
    struct machine machine;

    for (unsigned n = 0; n < MACHINES; n++) {
        draw_machine(&machine);
        if (are_carried(&machine))
            continue;
        bus_advice_write(&machine, 0, text);
        if (follow_advice(&machine, text)) {
            advised++;
            TEST_ASSERT_TRUE_MESSAGE(are_carried(&machine), text);
            continue;
        }
        useless++;
        machine.error_pdo = 0;
        for (unsigned i = AXIS_COUNT; i-- > 0;) {
            machine.axis[i].drive_bus = 1;
            TEST_ASSERT_FALSE_MESSAGE(are_carried(&machine), text);
        }
    }
    TEST_ASSERT_TRUE(advised > 50 && useless > 50);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_moving_drives_never_raises_a_load);
    RUN_TEST(test_each_move_lowers_one_and_raises_the_other);
    RUN_TEST(test_two_buses_are_advised_truly);
    return UNITY_END();
}

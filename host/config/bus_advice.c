#include "config/bus_advice.h"

#include "bus/bus.h"
#include "drive/drives.h"

#include <stdio.h>
#include <string.h>

#define CYCLE_STEP_US 50
#define CYCLE_MAX_US  10000

static bool carries(const struct machine *machine, uint32_t bitrate, uint32_t data_bitrate,
                    uint32_t cycle_us)
{
    const struct drives_rates rates = {bitrate, data_bitrate};
    uint8_t node[MACHINE_NODES_MAX];
    struct drives_load load;

    return drives_predict_whole_load(machine_drive_nodes(machine, node), machine->io,
                                     machine_io_count(machine), &rates, cycle_us, &load);
}

/* "KEY = VALUE", or one more of them. */
static void add(char text[BUS_ADVICE_MAX + 1], const char *key, uint32_t value, const char *kind)
{
    const size_t used = strlen(text);

    (void)snprintf(text + used, BUS_ADVICE_MAX + 1 - used, "%s%s = %u%s", used > 0 ? " or " : "",
                   key, (unsigned)value, kind);
}

/* Classical CAN at a higher rate, for machines that have it. */
static void add_bitrate(const struct machine *machine, char text[BUS_ADVICE_MAX + 1])
{
    static const uint32_t rates[] = {250000, 500000, 800000, BUS_BITRATE_MAX};

    for (unsigned i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        if (rates[i] > machine->can_bitrate && machine->can_data_bitrate == 0 &&
            carries(machine, rates[i], 0, machine->cycle_us)) {
            add(text, "bitrate", rates[i], "");
            return;
        }
    }
}

/* The lowest usual rate of CAN FD, where drives and adapters have it. */
static void add_data_bitrate(const struct machine *machine, char text[BUS_ADVICE_MAX + 1])
{
    static const uint32_t rates[] = {2000000, 4000000, 5000000, BUS_DATA_BITRATE_MAX};

    for (unsigned i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        if (rates[i] > machine->can_data_bitrate && rates[i] >= machine->can_bitrate &&
            carries(machine, machine->can_bitrate, rates[i], machine->cycle_us)) {
            add(text, "data_bitrate", rates[i], " (CAN FD)");
            return;
        }
    }
}

static void add_cycle(const struct machine *machine, char text[BUS_ADVICE_MAX + 1])
{
    for (uint32_t us = CYCLE_STEP_US; us <= CYCLE_MAX_US; us += CYCLE_STEP_US) {
        if (us > machine->cycle_us &&
            carries(machine, machine->can_bitrate, machine->can_data_bitrate, us)) {
            add(text, "cycle_us", us, "");
            return;
        }
    }
}

void bus_advice_write(const struct machine *machine, char text[BUS_ADVICE_MAX + 1])
{
    text[0] = '\0';
    add_bitrate(machine, text);
    add_data_bitrate(machine, text);
    add_cycle(machine, text);
    if (text[0] == '\0')
        (void)snprintf(text, BUS_ADVICE_MAX + 1, "it takes fewer drives on it");
    else
        (void)snprintf(text + strlen(text), BUS_ADVICE_MAX + 1 - strlen(text), " would do");
}

#include "config/bus_advice.h"

#include "bus/bus.h"
#include "machine/machine_check.h"

#include <stdio.h>
#include <string.h>

#define CYCLE_STEP_US 50
#define CYCLE_MAX_US  10000

/* Every bus of the machine, at another rate and cycle. */
static bool carries(const struct machine *machine, uint32_t bitrate, uint32_t data_bitrate,
                    uint32_t cycle_us)
{
    struct machine other = *machine;
    struct drives_load load;
    bool good = true;

    other.can_bitrate = bitrate;
    other.can_data_bitrate = data_bitrate;
    other.cycle_us = cycle_us;
    for (unsigned bus = 0; bus < takt_machine_bus_count(&other); bus++)
        good = good && takt_machine_predict_load(&other, bus, &load);
    return good;
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

/* Fewer TPDOs: emergencies tell the same. */
static void add_error_pdo(const struct machine *machine, char text[BUS_ADVICE_MAX + 1])
{
    struct machine other = *machine;

    other.error_pdo = 0;
    if (machine->error_pdo != 0 &&
        carries(&other, other.can_bitrate, other.can_data_bitrate, other.cycle_us))
        add(text, "error_pdo", 0, "");
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

/* The fewest axes, from the last one on, whose drives on bus `to` make it do. False: none do. */
static bool find_moved(const struct machine *machine, unsigned bus, unsigned to,
                       char axes[AXIS_COUNT + 1])
{
    struct machine other = *machine;

    memset(axes, 0, AXIS_COUNT + 1);
    for (unsigned i = AXIS_COUNT; i-- > 0;) {
        if (!machine_axis_is_on_can(&other.axis[i]) || other.axis[i].drive_bus != bus)
            continue;
        other.axis[i].drive_bus = (uint8_t)to;
        memmove(axes + 1, axes, AXIS_COUNT - 1);
        axes[0] = AXIS_LETTERS[i];
        if (carries(&other, other.can_bitrate, other.can_data_bitrate, other.cycle_us))
            return true;
    }
    return false;
}

/* "drive_bus = 1 for ZA (two buses)"; where that alone does not, with error_pdo = 0. */
static void add_bus(const struct machine *machine, unsigned bus, char text[BUS_ADVICE_MAX + 1])
{
    const unsigned to = (bus + 1) % CAN_BUSES_MAX;
    struct machine other = *machine;
    char axes[AXIS_COUNT + 1];
    const bool is_alone = find_moved(&other, bus, to, axes);
    const size_t used = strlen(text);

    other.error_pdo = 0;
    if (is_alone || find_moved(&other, bus, to, axes))
        (void)snprintf(text + used, BUS_ADVICE_MAX + 1 - used,
                       "%sdrive_bus = %u for %s%s (two buses)", used > 0 ? " or " : "", to, axes,
                       is_alone ? "" : " and error_pdo = 0");
}

void bus_advice_write(const struct machine *machine, unsigned bus, char text[BUS_ADVICE_MAX + 1])
{
    text[0] = '\0';
    add_bitrate(machine, text);
    add_data_bitrate(machine, text);
    add_error_pdo(machine, text);
    add_bus(machine, bus, text);
    add_cycle(machine, text);
    if (text[0] == '\0')
        (void)snprintf(text, BUS_ADVICE_MAX + 1, "it takes fewer drives on it");
    else
        (void)snprintf(text + strlen(text), BUS_ADVICE_MAX + 1 - strlen(text), " would do");
}

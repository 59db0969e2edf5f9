#include "outside/drive_setup.h"

#include "base/maths.h"
#include "cli/message.h"
#include "config/machine_file.h"
#include "tables/inject_file.h"
#include "tables/probe_file.h"

#include <stdlib.h>

#define NODE_MAX_ID 127

static unsigned bus_of(const struct drive_setup *setup)
{
    return (unsigned)maths_min(setup->options->can, CAN_BUSES_MAX);
}

static bool add_drive(struct drive_setup *setup, unsigned node)
{
    struct virtual_drives_config *drives = &setup->drives;
    struct virtual_drive_config *drive = &drives->drive[drives->count];

    if (drives->count == VIRTUAL_DRIVES_MAX) {
        message_command_error("--nodes: more than %d drives", VIRTUAL_DRIVES_MAX);
        return false;
    }
    for (unsigned i = 0; i < drives->count; i++) {
        if (drives->drive[i].node == node) {
            message_command_error("--nodes: %u is named twice", node);
            return false;
        }
    }
    drives->count++;
    *drive = (struct virtual_drive_config){.node = (uint8_t)node,
                                           .bus = (uint8_t)bus_of(setup),
                                           .increments_per_mm = 100000,
                                           .cycle_us = setup->machine.machine.cycle_us};
    drive_plant_set_default(&drive->plant);
    return true;
}

/* An axis of the machine with this node lends the drive its plant and its data sheet. */
static bool use_axis(struct drive_setup *setup, struct virtual_drive_config *drive)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &setup->machine.machine.axis[i];

        if (!axis->present || axis->drive_node != drive->node || axis->drive_bus != bus_of(setup))
            continue;
        drive->increments_per_mm = axis->increments_per_mm;
        drive->velocity_units_per_mm_s = axis->velocity_units_per_mm_s;
        if (!data_sheet_set_drive(drive, &setup->machine.drive[i], &setup->sheet[i]))
            return false;
    }
    return true;
}

/* Reads "N" or "N-M" and steps over it. */
static bool read_range(const char **text, unsigned long *from, unsigned long *to)
{
    char *end;

    if (**text < '0' || **text > '9')
        return false;
    *from = *to = strtoul(*text, &end, 10);
    if (*end == '-') {
        const char *second = end + 1;

        if (*second < '0' || *second > '9')
            return false;
        *to = strtoul(second, &end, 10);
    }
    *text = end;
    return *from >= 1 && *to <= NODE_MAX_ID && *from <= *to;
}

/* "1-3", "1,2,5-6". */
static bool read_nodes(struct drive_setup *setup, const char *nodes)
{
    const char *at = nodes;
    unsigned long from;
    unsigned long to;

    for (;;) {
        if (!read_range(&at, &from, &to) || (*at != ',' && *at != '\0')) {
            message_command_error("--nodes %s: node ids 1 ... 127 are expected, as 1-3 or 1,2,5",
                                  nodes);
            return false;
        }
        for (unsigned long node = from; node <= to; node++) {
            if (!add_drive(setup, (unsigned)node))
                return false;
        }
        if (*at == '\0')
            return true;
        at++;
    }
}

/* Drives without a machine, but for those whose nodes it has. */
static bool set_nodes(struct drive_setup *setup)
{
    if (!read_nodes(setup, setup->options->nodes))
        return false;
    for (unsigned i = 0; i < setup->drives.count; i++)
        if (!use_axis(setup, &setup->drives.drive[i]))
            return false;
    return true;
}

/* The other buses of the machine are other processes'. */
static void keep_bus(struct virtual_drives_config *drives, uint32_t bus)
{
    unsigned kept = 0;

    for (unsigned i = 0; i < drives->count; i++) {
        if (drives->drive[i].bus == bus)
            drives->drive[kept++] = drives->drive[i];
    }
    drives->count = kept;
}

static bool set_drives(struct drive_setup *setup)
{
    struct virtual_drives_config *drives = &setup->drives;
    const bool good = setup->options->nodes != NULL
                          ? set_nodes(setup)
                          : data_sheet_set_machine(drives, &setup->machine, setup->sheet);

    keep_bus(drives, bus_of(setup));
    if (good && drives->count == 0 && setup->options->bus != NULL) {
        message_command_error("--can %u: the machine has no drive on that bus", bus_of(setup));
        return false;
    }
    for (unsigned i = 0; i < drives->count; i++) {
        drives->drive[i].is_nameless = setup->options->unconfigured;
        if (setup->given.count > 0 && !drives->drive[i].is_io)
            drives->drive[i].dictionary = &setup->given;
    }
    return good;
}

static bool load_script(struct drive_setup *setup)
{
    const char *path = setup->options->inject;
    uint16_t nodes[VIRTUAL_DRIVES_MAX];

    if (path == NULL)
        return true;
    if (!inject_file_load(&setup->script, path))
        return false;
    for (unsigned i = 0; i < setup->drives.count; i++)
        nodes[i] = INJECT_ADDRESS(setup->drives.drive[i].bus, setup->drives.drive[i].node);
    if (!inject_file_check_nodes(&setup->script, path, nodes, setup->drives.count))
        return false;
    for (unsigned i = 0; i < setup->script.count; i++) {
        const struct inject_fault *fault = &setup->script.fault[i];

        if (inject_is_of_bus(fault->kind)) {
            message_error(path, fault->line, 0,
                          "bus %s is a fault of the embedded bus; here only drives can fail",
                          inject_name(fault->kind));
            return false;
        }
    }
    return true;
}

/* With a bus the drives are those of a data sheet; without one theirs are written. */
static bool load_given(struct drive_setup *setup)
{
    return setup->options->bus == NULL || setup->options->eds == NULL ||
           data_sheet_load(&setup->given, setup->options->eds);
}

bool drive_setup_read(struct drive_setup *setup, const struct options *options)
{
    setup->options = options;
    return machine_file_load(&setup->machine, options) && load_given(setup) && set_drives(setup) &&
           load_script(setup) && probe_file_load(&setup->probe, options->probe);
}

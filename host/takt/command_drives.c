/* takt drives: virtual CiA 402 drives, for any CANopen master. */
#define _POSIX_C_SOURCE 200809L

#include "takt/command.h"

#include "base/maths.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "config/data_sheet.h"
#include "config/machine_file.h"
#include "serving/drive_service.h"
#include "serving/serving_options.h"
#include "serving/spindle_service.h"
#include "simulation/drive_images.h"
#include "tables/inject_file.h"
#include "tables/probe_file.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>

#define NODE_MAX_ID 127

/* How soon a signal is noticed while there is nothing else to do; it also ends the wait by itself. */
#define SIGNAL_LOOK_MS 100

/* Between two looks at Ctrl-C, which also ends a wait. */
#define WAIT_MS 100

/* Everything a command line has been read into. */
struct drives_command {
    const struct options *options;
    struct machine_setup setup;
    struct virtual_drives_config drives;
    struct dictionary sheet[DATA_SHEETS_MAX]; /* of the machine's drives that have one */
    struct dictionary given;                  /* --eds with --bus: of all drives */
    struct inject script;
    struct virtual_probe probe;
};

static unsigned bus_of(const struct drives_command *command)
{
    return (unsigned)maths_min(command->options->can, CAN_BUSES_MAX);
}

static bool add_drive(struct drives_command *command, unsigned node)
{
    struct virtual_drives_config *drives = &command->drives;
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
                                           .bus = (uint8_t)bus_of(command),
                                           .increments_per_mm = 100000,
                                           .cycle_us = command->setup.machine.cycle_us};
    drive_plant_set_default(&drive->plant);
    return true;
}

/* An axis of the machine with this node lends the drive its plant and its data sheet. */
static bool use_axis(struct drives_command *command, struct virtual_drive_config *drive)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &command->setup.machine.axis[i];

        if (!axis->present || axis->drive_node != drive->node || axis->drive_bus != bus_of(command))
            continue;
        drive->increments_per_mm = axis->increments_per_mm;
        drive->velocity_units_per_mm_s = axis->velocity_units_per_mm_s;
        if (!data_sheet_set_drive(drive, &command->setup.drive[i], &command->sheet[i]))
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
static bool read_nodes(struct drives_command *command, const char *nodes)
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
            if (!add_drive(command, (unsigned)node))
                return false;
        }
        if (*at == '\0')
            return true;
        at++;
    }
}

/* Drives without a machine, but for those whose nodes it has. */
static bool set_nodes(struct drives_command *command)
{
    if (!read_nodes(command, command->options->nodes))
        return false;
    for (unsigned i = 0; i < command->drives.count; i++)
        if (!use_axis(command, &command->drives.drive[i]))
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

static bool set_drives(struct drives_command *command)
{
    struct virtual_drives_config *drives = &command->drives;
    const bool good = command->options->nodes != NULL
                          ? set_nodes(command)
                          : data_sheet_set_machine(drives, &command->setup, command->sheet);

    keep_bus(drives, bus_of(command));
    if (good && drives->count == 0 && command->options->bus != NULL) {
        message_command_error("--can %u: the machine has no drive on that bus", bus_of(command));
        return false;
    }
    for (unsigned i = 0; i < drives->count; i++) {
        drives->drive[i].is_nameless = command->options->unconfigured;
        if (command->given.count > 0 && !drives->drive[i].is_io)
            drives->drive[i].dictionary = &command->given;
    }
    return good;
}

static bool load_script(struct drives_command *command)
{
    const char *path = command->options->inject;
    uint16_t nodes[VIRTUAL_DRIVES_MAX];

    if (path == NULL)
        return true;
    if (!inject_file_load(&command->script, path))
        return false;
    for (unsigned i = 0; i < command->drives.count; i++)
        nodes[i] = INJECT_ADDRESS(command->drives.drive[i].bus, command->drives.drive[i].node);
    if (!inject_file_check_nodes(&command->script, path, nodes, command->drives.count))
        return false;
    for (unsigned i = 0; i < command->script.count; i++) {
        const struct inject_fault *fault = &command->script.fault[i];

        if (inject_is_of_bus(fault->kind)) {
            message_error(path, fault->line, 0,
                          "bus %s is a fault of the embedded bus; here only drives can fail",
                          inject_name(fault->kind));
            return false;
        }
    }
    return true;
}

/* Where the log goes; NULL: nowhere. False after a message. */
static bool open_log(const struct options *options, FILE **log)
{
    *log = options->quiet ? NULL : stdout;
    if (options->log == NULL)
        return true;
    *log = strcmp(options->log, "-") == 0 ? stdout : fopen(options->log, "w");
    if (*log == NULL)
        message_command_error("--log %s: it cannot be written", options->log);
    return *log != NULL;
}

static enum command_status serve(struct drives_command *command)
{
    const struct options *options = command->options;
    FILE *log;
    enum command_status status;

    if (!open_log(options, &log))
        return STATUS_ENVIRONMENT;
    status = drive_service_run(&(struct drive_service_config){
        .bus = options->bus,
        .rates = machine_setup_get_rates(&command->setup.machine),
        .cycle_us = command->setup.machine.cycle_us,
        .is_paced = options->realtime,
        .drives = &command->drives,
        .script = options->inject != NULL ? &command->script : NULL,
        .log = log,
        .bus_log = options->bus_log,
        .store = options->store,
        .target = options->target,
        .image = options->image,
        .machine = &command->setup.machine,
        .probe = &command->probe,
    });
    if (log != NULL && log != stdout && fclose(log) != 0 && status == STATUS_DONE) {
        message_command_error("--log %s: not everything could be written", options->log);
        status = STATUS_ENVIRONMENT;
    }
    return status;
}

/* The spindle alone, until a signal comes; its own thread answers. */
static void wait_for_signal(void)
{
    while (!interrupt_asked())
        (void)poll(NULL, 0, SIGNAL_LOOK_MS);
}

static enum command_status serve_with_spindle(struct drives_command *command)
{
    static struct spindle_service spindle;
    const struct options *options = command->options;
    enum command_status status = STATUS_DONE;
    uint8_t unit;

    if (!serving_options_unit(options->panel.unit, &unit))
        return STATUS_INPUT;
    if (!spindle_service_start(&spindle, &command->setup, options->panel.spindle, unit,
                               options->quiet))
        return STATUS_ENVIRONMENT;
    if (options->bus != NULL)
        status = serve(command);
    else
        wait_for_signal();
    spindle_service_stop(&spindle);
    return status;
}

/* With a bus the drives are those of a data sheet; without one theirs are written. */
static bool load_given(struct drives_command *command)
{
    const struct options *options = command->options;

    return options->bus == NULL || options->eds == NULL ||
           data_sheet_load(&command->given, options->eds);
}

static bool check_logs(const struct options *options)
{
    const char *bus_log = options->bus_log;

    if (options->store != NULL && options->bus == NULL) {
        message_command_error("--store needs --bus: nobody tells the drives to store anything");
        return false;
    }
    if (bus_log == NULL)
        return true;
    if (options->bus == NULL) {
        message_command_error("--bus-log needs --bus: there is nothing to log");
        return false;
    }
    if (options->log != NULL ? strcmp(bus_log, options->log) == 0
                             : strcmp(bus_log, "-") == 0 && !options->quiet) {
        message_command_error("--log and --bus-log would go to the same place: %s", bus_log);
        return false;
    }
    return true;
}

static bool check_target(const struct options *options)
{
    if (options->target != NULL && !drive_image_is_known(options->target))
        message_command_error("--target %s: m4f or m7 is expected", options->target);
    else if ((options->target == NULL) != (options->image == NULL))
        message_command_error(
            "--target and --image, takt-drive.elf of a build of that target, belong "
            "together");
    else if (options->target != NULL && options->bus == NULL)
        message_command_error("--target needs --bus: drives that nobody reaches do not run");
    else if (options->target != NULL && options->store != NULL)
        message_command_error("--store: what an image stores is not kept");
    else
        return true;
    return false;
}

static enum command_status command_drives_execute(const struct options *options)
{
    static struct drives_command command;
    enum command_status status = STATUS_DONE;

    command.options = options;
    if (options->bus == NULL && options->eds == NULL && options->panel.spindle == NULL) {
        message_command_error("--bus says where the drives are to be reached, --spindle where the "
                              "spindle is, --eds where their data sheets go: one of them is "
                              "needed");
        return STATUS_INPUT;
    }
    if (!check_logs(options) || !check_target(options))
        return STATUS_INPUT;
    if (!machine_file_load(&command.setup, options) || !load_given(&command) ||
        !set_drives(&command) || !load_script(&command) ||
        !probe_file_load(&command.probe, options->probe))
        return STATUS_INPUT;
    if (options->eds != NULL && options->bus == NULL)
        status = data_sheet_write(&command.drives, options->eds);
    if (status == STATUS_DONE && options->panel.spindle != NULL)
        status = serve_with_spindle(&command);
    else if (status == STATUS_DONE && options->bus != NULL)
        status = serve(&command);
    return status;
}

static const struct option_row rows[] = {
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "socketcan:IF, slcan:PATH, slcan:pty, socketcand:HOST:PORT, socketcand:listen:PORT"},
    {"spindle", OPTION_TEXT, offsetof(struct options, panel.spindle), "WHERE",
     "virtual spindle on Modbus: HOST:PORT, or PATH[,BAUD[,PARITY]] of a serial line"},
    {"unit", OPTION_NUMBER, offsetof(struct options, panel.unit), "N",
     "unit of the spindle on its serial line (default 1)"},
    {"nodes", OPTION_TEXT, offsetof(struct options, nodes), "LIST",
     "node ids, 1-3 or 1,2,5 (default: those of the machine's axes)"},
    {"can", OPTION_NUMBER, offsetof(struct options, can), "N",
     "which bus of the machine this is: 0 (default) or 1; each has a process of its own"},
    OPTIONS_MACHINE,
    {"eds", OPTION_TEXT, offsetof(struct options, eds), "FILE|FOLDER",
     "electronic data sheet: with --bus the drives are those of FILE; without, theirs are written "
     "there"},
    {"inject", OPTION_TEXT, offsetof(struct options, inject), "FILE",
     "scripted faults; takt help inject explains them"},
    {"probe", OPTION_TEXT, offsetof(struct options, probe), "FILE",
     "what the drives' touch probes meet, as of takt run"},
    {"target", OPTION_TEXT, offsetof(struct options, target), "NAME",
     "run each drive's firmware in QEMU, on a Cortex-M4 (m4f) or M7 (m7), compared bit for bit"},
    {"image", OPTION_TEXT, offsetof(struct options, image), "FILE",
     "its image, takt-drive.elf of a build of that target"},
    {"unconfigured", OPTION_FLAG, offsetof(struct options, unconfigured), NULL,
     "drives have no node id before they get one by LSS; --nodes are their serial numbers"},
    {"store", OPTION_TEXT, offsetof(struct options, store), "FOLDER",
     "what drives store (object 1010) is kept there, and they start with it"},
    {"realtime", OPTION_FLAG, offsetof(struct options, realtime), NULL,
     "keep to the wall clock even if SYNC has a period"},
    {"log", OPTION_TEXT, offsetof(struct options, log), "FILE",
     "one line an event (default: standard output)"},
    {"bus-log", OPTION_TEXT, offsetof(struct options, bus_log), "FILE",
     "every CAN frame, as candump -L writes it; takt replay reads it"},
    {"quiet", OPTION_FLAG, offsetof(struct options, quiet), NULL, "no log on standard output"},
    OPTIONS_END,
};

const struct command command_drives = {
    .name = "drives",
    .usage = "--bus BUS|--spindle WHERE [options]",
    .summary = "virtual CiA 402 drives, for any CANopen master",
    .help =
        "Every drive is a CANopen node with the drive profile CiA 402 (homing, interpolated "
        "position, profile and cyclic\n"
        "synchronous position, velocity and torque) and a simulated motor, described by [drive N] "
        "of the machine file.\n"
        "They run until Ctrl-C or SIGTERM, which is status 0.\n"
        "\n"
        "Drives run by the wall clock, unless a controller sets the SYNC period in all of them "
        "(object 1006), as takt\n"
        "does. Then each SYNC is one period, however fast they arrive.\n"
        "\n"
        "--eds FILE, with --bus, makes them drives of another maker by his electronic data sheet "
        "(CiA 306): their objects,\n"
        "access, defaults, limits, PDOs and modes are those of the file, the motor is the same. "
        "[drive N] of the machine\n"
        "file has a sheet for each drive, and how long it takes to boot and to answer.\n"
        "\n"
        "--store FOLDER keeps what a master has the drives store (object 1010) in a file for each "
        "node, which they have "
        "again\n"
        "when they are next switched on, with the node id that LSS has stored. Without it stored "
        "values live as long as the command.\n"
        "\n"
        "Drives can be found and given their node id by LSS (CiA 305), as they are, or with "
        "--unconfigured as they come "
        "from\n"
        "the maker, without one.\n"
        "\n"
        "--spindle adds a spindle behind the registers of a Delta VFD-B or MS300 converter, "
        "with inertia, ramp,\n"
        "torque limit and trips as [spindle] of the machine file says. Register 3000 (hex) "
        "takes the torque of a cut,\n"
        "0.1 % of the rated one; a number written to 3001 trips it.\n"
        "\n"
        "Examples:\n"
        "  takt drives --bus socketcan:vcan0\n"
        "  takt drives --spindle 127.0.0.1:1503\n"
        "  takt drives --bus slcan:pty:can0.pty --machine mill3.ini --log drives.log\n"
        "  takt drives --bus socketcan:vcan0 --quiet --bus-log bus.log\n"
        "  takt drives --bus socketcan:vcan0 --eds epos4.eds --store stored\n"
        "  takt drives --nodes 1-6 --eds data-sheets\n"
        "  takt drives --bus socketcand:listen:29536 --inject faults.inject\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 0,
    .run = command_drives_execute,
};

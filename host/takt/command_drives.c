/* takt drives: virtual CiA 402 drives, for any CANopen master. */
#define _POSIX_C_SOURCE 200809L

#include "takt/command.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "outside/drive_service.h"
#include "outside/drive_setup.h"
#include "outside/spindle_service.h"
#include "serving/serving_options.h"
#include "simulation/drive_images.h"

#include <poll.h>
#include <string.h>

/*
 * How soon a signal is noticed while there is nothing else to do; it also ends the wait by itself.
 */
#define SIGNAL_LOOK_MS 100

/* Where the log goes; NULL: nowhere. False after a message. */
static bool open_log(const struct options *options, FILE **log)
{
    *log = options->quiet ? NULL : stdout;
    if (options->log == NULL)
        return true;
    if (!output_file_may_write(options->log))
        return false;
    *log = strcmp(options->log, "-") == 0 ? stdout : fopen(options->log, "w");
    if (*log == NULL)
        message_command_error("--log %s: it cannot be written", options->log);
    return *log != NULL;
}

static enum command_status serve(struct drive_setup *setup)
{
    const struct options *options = setup->options;
    FILE *log;
    enum command_status status;

    if (!open_log(options, &log))
        return STATUS_ENVIRONMENT;
    status = drive_service_run(&(struct drive_service_config){
        .bus = options->bus,
        .rates = machine_setup_get_rates(&setup->machine.machine),
        .cycle_us = setup->machine.machine.cycle_us,
        .is_paced = options->realtime,
        .drives = &setup->drives,
        .script = options->inject != NULL ? &setup->script : NULL,
        .log = log,
        .bus_log = options->bus_log,
        .store = options->store,
        .target = options->target,
        .image = options->image,
        .machine = &setup->machine.machine,
        .probe = &setup->probe,
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

static enum command_status serve_with_spindle(struct drive_setup *setup)
{
    static struct spindle_service spindle;
    const struct options *options = setup->options;
    enum command_status status;
    uint8_t unit;

    if (!serving_options_unit(options->panel.unit, &unit))
        return STATUS_INPUT;
    status = spindle_service_start(&spindle, &setup->machine, options->panel.spindle, unit,
                                   options->quiet);
    if (status != STATUS_DONE)
        return status;
    if (options->bus != NULL)
        status = serve(setup);
    else
        wait_for_signal();
    spindle_service_stop(&spindle);
    return status;
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
    static struct drive_setup setup;
    enum command_status status = STATUS_DONE;

    if (options->bus == NULL && options->eds == NULL && options->panel.spindle == NULL) {
        message_command_error("--bus says where the drives are to be reached, --spindle where the "
                              "spindle is, --eds where their data sheets go: one of them is "
                              "needed");
        return STATUS_INPUT;
    }
    if (!check_logs(options) || !check_target(options))
        return STATUS_INPUT;
    if (!drive_setup_read(&setup, options))
        return STATUS_INPUT;
    if (options->eds != NULL && options->bus == NULL)
        status = data_sheet_write(&setup.drives, options->eds);
    if (status == STATUS_DONE && options->panel.spindle != NULL)
        status = serve_with_spindle(&setup);
    else if (status == STATUS_DONE && options->bus != NULL)
        status = serve(&setup);
    return status;
}

static const struct option_row rows[] = {
    {"bus", OPTION_TEXT, offsetof(struct options, bus), "BUS",
     "socketcan:IF, slcan:PATH, slcan:pty, socketcand:HOST:PORT, socketcand:listen:PORT"},
    {"spindle", OPTION_TEXT, offsetof(struct options, panel.spindle), "WHERE",
     "virtual spindle on Modbus: HOST:PORT, or PATH[,BAUD[,PARITY]] of a serial line"},
    {"unit", OPTION_POSITIVE, offsetof(struct options, panel.unit), "N",
     "unit of the spindle on its serial line (default 1)"},
    {"nodes", OPTION_TEXT, offsetof(struct options, nodes), "LIST",
     "node ids, 1-3 or 1,2,5 (default: those of the machine's axes)"},
    {"can", OPTION_WHOLE, offsetof(struct options, can), "N",
     "which bus of the machine this is: 0 (default) or 1; each has a process of its own"},
    OPTIONS_MACHINE,
    {"eds", OPTION_TEXT, offsetof(struct options, eds), "FILE|FOLDER",
     "electronic data sheet: with --bus the drives are those of FILE; without, theirs are written "
     "there"},
    {"inject", OPTION_INPUT, offsetof(struct options, inject), "FILE",
     "scripted faults; takt help inject explains them"},
    {"probe", OPTION_INPUT, offsetof(struct options, probe), "FILE",
     "what the drives' touch probes meet, as of takt run"},
    {"target", OPTION_TEXT, offsetof(struct options, target), "NAME",
     "run each drive's firmware in QEMU, on a Cortex-M4 (m4f) or M7 (m7), compared bit for bit"},
    {"image", OPTION_INPUT, offsetof(struct options, image), "FILE",
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

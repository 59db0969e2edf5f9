/* takt machine: check a machine file and print it with every key, or pack it for a target. */
#include "cli/message.h"
#include "config/data_sheet.h"
#include "config/machine_file.h"
#include "config/machine_pack.h"
#include "serving/serving_options.h"
#include "session/session.h"
#include "takt/command.h"

#include <stdio.h>

/* What goes together. False after a message. */
static bool check(const struct options *options)
{
    const bool packs = options->pack.pack;

    if (packs && options->pack.unpack) {
        message_command_error("--pack and --unpack: one of them");
    } else if (packs && options->output == NULL) {
        message_command_error("--pack needs -o FILE: settings are no text");
    } else if (!packs && (options->output != NULL || options->pack.sector)) {
        message_command_error("-o and --sector go with --pack");
    } else if (options->pack.unpack &&
               (options->operands == 0 || options->set.count > 0 || options->with.count > 0)) {
        message_command_error("--unpack needs the file of settings, and goes with no other option");
    } else {
        return true;
    }
    return false;
}

/* The data sheets of its drives are there, and good, and its panel can be served. */
static bool check_more(const struct machine_setup *setup)
{
    static struct dictionary sheet[DATA_SHEETS_MAX];
    static struct virtual_drives_config drives;

    return data_sheet_set_machine(&drives, setup, sheet) && serving_options_check(setup);
}

/* With all files that it names, as other commands will read them. */
static enum command_status print(struct session *session, const struct options *options)
{
    if (session_open_machine(session, options) != STATUS_DONE || !check_more(&session->setup))
        return STATUS_INPUT;
    if (options->pack.pack)
        return machine_pack_write(&session->setup, options->output, options->pack.sector);
    machine_file_write(stdout, &session->setup);
    return STATUS_DONE;
}

static enum command_status command_machine_execute(const struct options *options)
{
    static struct session session;
    struct options given = *options;
    enum command_status status;

    if (!check(options))
        return STATUS_INPUT;
    if (options->pack.unpack)
        return machine_pack_print(options->operand[0]);
    given.machine = options->operand[0];
    status = print(&session, &given);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    {"with", OPTION_LIST, offsetof(struct options, with), "FILE",
     "sections that friction, resonance or tune have written: their keys take the place of FILE's"},
    {"set", OPTION_LIST, offsetof(struct options, set), "KEY=VALUE",
     "override a key: axis.X.max_jerk_mm_s3=20000"},
    {"pack", OPTION_FLAG, offsetof(struct options, pack.pack), NULL,
     "write it, with its correction tables, as settings for a target"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE", "or -o FILE: of --pack"},
    {"sector", OPTION_FLAG, offsetof(struct options, pack.sector), NULL,
     "--pack: as a flash sector, to be flashed; without it: to be loaded over Modbus"},
    {"unpack", OPTION_FLAG, offsetof(struct options, pack.unpack), NULL,
     "FILE holds settings: check them and print them as a machine file"},
    OPTIONS_END,
};

const struct command command_machine = {
    .name = "machine",
    .usage = "[FILE] [options]",
    .summary = "check a machine file and print it with every key, or pack it for a target",
    .help = "Without FILE: the built-in mill. The output is a machine file.\n"
            "\n"
            "A target keeps its machine in flash: --pack makes the settings for it, loaded by "
            "`takt panel settings` or by\n"
            "flashing (hal/stm32f405/README.md). They contain limits, drives, bus and correction, "
            "with all tables and the\n"
            "configurations of drives (dcf), but no keys of virtual drives and of this computer.\n"
            "\n"
            "Examples:\n"
            "  takt machine > my-mill.ini\n"
            "  takt machine my-mill.ini --set axis.X.max_jerk_mm_s3=20000 > stiffer.ini\n"
            "  takt friction --machine my-mill.ini -o friction.ini\n"
            "  takt machine my-mill.ini --with friction.ini > measured.ini\n"
            "  takt machine my-mill.ini --pack -o my-mill.settings\n"
            "  takt machine my-mill.settings --unpack\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 1,
    .run = command_machine_execute,
};

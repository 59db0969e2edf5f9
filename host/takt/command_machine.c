#include "takt/command.h"
#include "takt/machine_file.h"

#include <stdio.h>

static enum command_status command_machine_execute(const struct options *options)
{
    static struct machine_setup setup;
    struct options given = *options;

    given.machine = options->operand[0];
    if (!machine_file_load(&setup, &given))
        return STATUS_INPUT;
    machine_file_write(stdout, &setup);
    return STATUS_DONE;
}

static const struct option_row rows[] = {
    {"set", OPTION_LIST, offsetof(struct options, set), "KEY=VALUE",
     "override a key: axis.X.max_jerk_mm_s3=20000"},
    OPTIONS_END,
};

const struct command command_machine = {
    .name = "machine",
    .usage = "[FILE] [options]",
    .summary = "check a machine file and print it with every key, commented",
    .help = "Without FILE: the built-in mill. What is printed is a machine file itself.\n"
            "\n"
            "Examples:\n"
            "  takt machine > my-mill.ini\n"
            "  takt machine my-mill.ini --set machine.cycle_us=500\n",
    .options = rows,
    .operands_min = 0,
    .operands_max = 1,
    .run = command_machine_execute,
};

/* takt trace: check a trace against limits, or compare two. */
#include "config/machine_file.h"
#include "takt/command.h"
#include "trace/trace_check.h"
#include "trace/trace_reader.h"

static enum command_status compare(const struct options *options)
{
    struct trace_reader a, b = {0};
    enum command_status status = STATUS_INPUT;

    if (trace_reader_open(&a, options->operand[0]) && trace_reader_open(&b, options->operand[1]))
        status = trace_check_equal(&a, &b, options->tolerance);
    trace_reader_close(&a);
    trace_reader_close(&b);
    return status;
}

static enum command_status summarise(const struct options *options)
{
    static struct machine_setup setup;
    struct trace_reader reader = {0};
    enum command_status status = STATUS_INPUT;

    if (machine_file_load(&setup, options) && trace_reader_open(&reader, options->operand[0]))
        status = trace_check_limits(&reader, &setup.machine);
    trace_reader_close(&reader);
    return status;
}

static enum command_status command_trace_execute(const struct options *options)
{
    return options->operands == 2 ? compare(options) : summarise(options);
}

static const struct option_row rows[] = {
    OPTIONS_MACHINE,
    {"tolerance", OPTION_NUMBER, offsetof(struct options, tolerance), "VALUE",
     "largest difference that counts as equal, in the columns' units (default 0)"},
    OPTIONS_END,
};

const struct command command_trace = {
    .name = "trace",
    .usage = "A [B] [options]",
    .summary = "check a trace against limits, or compare two",
    .help = "With A alone: peaks of velocity, acceleration and jerk of every axis by differences "
            "of its set column,\n"
            "compared with the machine's limits, and the first row above them. The cycle time is "
            "that of the trace. With\n"
            "A and B: the columns that differ, where first and by how much.\n"
            "\n"
            "Exit status: 1 when a limit is broken or the traces differ.\n"
            "\n"
            "Examples:\n"
            "  takt trace part.csv --machine mill3.ini\n"
            "  takt trace before.csv after.csv --tolerance 1e-6\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 2,
    .run = command_trace_execute,
};

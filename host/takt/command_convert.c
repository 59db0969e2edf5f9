/* takt convert: write the moves of a part program in the words of another controller. */
#include "cli/output_file.h"
#include "session/convert_write.h"
#include "session/session.h"
#include "takt/command.h"

static enum command_status write_file(const struct session *session, const struct options *options,
                                      enum dialect dialect)
{
    static struct output_file file;
    enum command_status status;

    if (!output_file_replace(&file, options->output != NULL ? options->output : "-",
                             options->operand[0]))
        return STATUS_ENVIRONMENT;
    status = convert_write(session, file.stream, dialect);
    if (status == STATUS_DONE && !(output_file_finish(&file) && output_file_place(&file)))
        status = STATUS_ENVIRONMENT;
    output_file_discard(&file);
    return status;
}

static enum command_status command_convert_execute(const struct options *options)
{
    static struct session session;
    struct session_totals totals;
    enum dialect dialect;
    enum command_status status;

    if (!convert_read_dialect(options->to_dialect, &dialect))
        return STATUS_INPUT;
    status = session_open(&session, options);
    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE)
        status = write_file(&session, options, dialect);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    {"to", OPTION_TEXT, offsetof(struct options, to_dialect), "DIALECT",
     "linuxcnc, grbl, fanuc, haas or mach3"},
    {"output", OPTION_TEXT, offsetof(struct options, output), "FILE", "the program (default: -)"},
    OPTIONS_END,
};

const struct command command_convert = {
    .name = "convert",
    .usage = "PROGRAM --to DIALECT [options]",
    .summary = "write the moves of a part program in the words of another controller",
    .help =
        "Arcs stay arcs. Cycles, loops, subroutines, expressions, offsets, tool lengths and cutter "
        "compensation have become\n"
        "moves: they are in machine coordinates, mm, so no offset and no length may count when "
        "they "
        "run. Overrides that the\n"
        "program switches are left out, and for all but linuxcnc G61 and G64. What the other "
        "controller has no words for is an\n"
        "error. takt reads the result, with --dialect, as the same moves.\n"
        "\n"
        "Examples:\n"
        "  takt convert part.ngc --to grbl -o part.gcode\n"
        "  takt convert part.nc --dialect fanuc --to linuxcnc\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_convert_execute,
};

/* takt convert: write the moves of a part program in the words of another controller. */
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "session/convert.h"
#include "session/session.h"
#include "takt/command.h"

#include <stdio.h>

static bool read_dialect(const char *name, enum dialect *dialect)
{
    const unsigned found = name != NULL ? dialect_find(name) : DIALECT_COUNT;

    *dialect = (enum dialect)found;
    if (found < DIALECT_COUNT && found != DIALECT_MARLIN && found != DIALECT_SIEMENS)
        return true;
    message_command_error("--to %s: known are linuxcnc, grbl, fanuc, haas and mach3",
                          name != NULL ? name : "DIALECT is needed");
    return false;
}

static enum command_status write_moves(const struct session *session, FILE *out,
                                       enum dialect dialect)
{
    static struct session_reading reading;
    struct program_config config;
    struct source source;
    struct diagnostic ignored;
    struct convert convert;
    struct move move;

    session_begin_reading(session, &reading, &config, &source);
    program_open(&reading.program, &config, &source);
    offset_open(&reading.offset, &config);
    convert_open(&convert, out, dialect, config.axes, &config.start);
    while (offset_next(&reading.offset, &reading.program, &move, &ignored) == PROGRAM_MOVE &&
           !interrupt_asked()) {
        const char *lacking = convert_move(&convert, &move);

        if (lacking != NULL) {
            uint32_t line = move.line;
            const char *name = program_text_place(&session->program, &line);

            message_error(name, line, 1, "%s has no words for %s", dialect_name(dialect), lacking);
            return STATUS_INPUT;
        }
    }
    convert_close(&convert);
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

static enum command_status write_file(const struct session *session, const struct options *options,
                                      enum dialect dialect)
{
    static struct output_file file;
    enum command_status status;

    if (!output_file_open(&file, options->output != NULL ? options->output : "-"))
        return STATUS_ENVIRONMENT;
    status = write_moves(session, file.stream, dialect);
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

    if (!read_dialect(options->to_dialect, &dialect))
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

#include "session/convert_write.h"

#include "cli/interrupt.h"
#include "cli/message.h"

#include <stdlib.h>

bool convert_read_dialect(const char *name, enum dialect *dialect)
{
    const unsigned found = name != NULL ? dialect_find(name) : DIALECT_COUNT;

    *dialect = (enum dialect)found;
    if (found < DIALECT_COUNT && found != DIALECT_MARLIN && found != DIALECT_SIEMENS)
        return true;
    message_command_error("--to %s: known are linuxcnc, grbl, fanuc, haas and mach3",
                          name != NULL ? name : "DIALECT is needed");
    return false;
}

/* After a message. */
static enum command_status tell_lacking(const struct session *session, const struct move *move,
                                        enum dialect dialect, const char *lacking)
{
    uint32_t line = move->line;
    const char *name = program_text_place(&session->program, &line);

    message_error(name, line, 1, "%s has no words for %s", dialect_name(dialect), lacking);
    return STATUS_INPUT;
}

static enum command_status write_moves(const struct session *session, FILE *out,
                                       enum dialect dialect, struct session_reading *reading)
{
    struct program_config config;
    struct source source;
    struct diagnostic ignored;
    struct convert convert;
    struct move move;

    session_begin_reading(session, reading, &config, &source);
    takt_program_open(&reading->program, &config, &source);
    takt_cutter_compensation_open(&reading->offset, &config);
    convert_open(&convert, out, dialect, config.axes, &config.start);
    while (takt_cutter_compensation_next(&reading->offset, &reading->program, &move, &ignored) ==
               PROGRAM_MOVE &&
           !interrupt_asked()) {
        const char *lacking = convert_move(&convert, &move);

        if (lacking != NULL)
            return tell_lacking(session, &move, dialect, lacking);
    }
    convert_close(&convert);
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

enum command_status convert_write(const struct session *session, FILE *out, enum dialect dialect)
{
    struct session_reading *reading = calloc(1, sizeof *reading);
    enum command_status status = STATUS_ENVIRONMENT;

    if (reading == NULL)
        message_command_error("out of memory");
    else
        status = write_moves(session, out, dialect, reading);
    free(reading);
    return status;
}

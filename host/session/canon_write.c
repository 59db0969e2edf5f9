#include "session/canon_write.h"

#include "cli/interrupt.h"
#include "session/canon.h"

enum command_status canon_write(FILE *stream, const struct session *session)
{
    static _Thread_local struct session_reading reading;
    struct program_config config;
    struct source source;
    struct diagnostic diagnostic;
    struct point at;
    struct move move;

    session_begin_reading(session, &reading, &config, &source);
    takt_program_open(&reading.program, &config, &source);
    takt_cutter_compensation_open(&reading.offset, &config);
    at = config.start;
    while (takt_cutter_compensation_next(&reading.offset, &reading.program, &move, &diagnostic) ==
               PROGRAM_MOVE &&
           !interrupt_asked()) {
        char text[CANON_TEXT_MAX];

        (void)canon_format(&move, config.axes, &at, text);
        (void)fprintf(stream, "%s\n", text);
        if (move_is_motion(&move))
            at = move.end;
    }
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

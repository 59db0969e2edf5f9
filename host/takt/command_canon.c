#include "takt/canon.h"
#include "takt/command.h"
#include "takt/interrupt.h"
#include "takt/session.h"

#include <stdio.h>

static enum command_status print_moves(const struct session *session)
{
    static struct session_reading reading;
    struct program_config config;
    struct source source;
    struct diagnostic diagnostic;
    struct point at;
    struct move move;

    session_begin_reading(session, &reading, &config, &source);
    program_open(&reading.program, &config, &source);
    offset_open(&reading.offset, &config);
    at = config.start;
    while (offset_next(&reading.offset, &reading.program, &move, &diagnostic) == PROGRAM_MOVE &&
           !interrupt_asked()) {
        char text[CANON_TEXT_MAX];

        (void)canon_format(&move, config.axes, &at, text);
        (void)printf("%s\n", text);
        if (move_is_motion(&move))
            at = move.end;
    }
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}

static enum command_status command_canon_execute(const struct options *options)
{
    static struct session session;
    struct session_totals totals;
    enum command_status status = session_open(&session, options);

    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE)
        status = print_moves(&session);
    session_close(&session);
    return status;
}

static const struct option_row rows[] = {
    OPTIONS_PROGRAM,
    OPTIONS_END,
};

const struct command command_canon = {
    .name = "canon",
    .usage = "PROGRAM [options]",
    .summary = "print the canonical moves of a part program as text",
    .help = "One move per line: LINE KIND X... Y... Z... in machine coordinates, mm and degrees; "
            "for arcs also the\n"
            "absolute centre I... J... K..., the turns P... and the plane; then the feed F... in "
            "mm/min.\n"
            "\n"
            "Examples:\n"
            "  takt canon part.ngc\n"
            "  takt canon part.ngc --block-delete | grep arc\n",
    .options = rows,
    .operands_min = 1,
    .operands_max = 1,
    .run = command_canon_execute,
};

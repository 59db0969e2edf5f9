/* takt canon: print the canonical moves of a part program as text. */
#include "session/canon_write.h"
#include "session/session.h"
#include "takt/command.h"

#include <stdio.h>

static enum command_status command_canon_execute(const struct options *options)
{
    static struct session session;
    struct session_totals totals;
    enum command_status status = session_open(&session, options);

    if (status == STATUS_DONE)
        status = session_check(&session, 1, &totals);
    if (status == STATUS_DONE)
        status = canon_write(stdout, &session);
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

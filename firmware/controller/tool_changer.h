/*
 * The handshake with a tool changer at I/O nodes: at M6 the program stands until it has been gone
 * through.
 *
 *     tool_change   ____/^^^^^^^^^^^^^^^^^\___________
 *     tool_changed  ___________________/^^^^^^^\____
 *                       ASKED           TOLD    DONE: the program goes on
 *
 * An answer that is high before it has been asked for is an old one: it is waited for to fall.
 */
#ifndef TAKT_CONTROLLER_TOOL_CHANGER_H
#define TAKT_CONTROLLER_TOOL_CHANGER_H

#include "base/error.h"

#include <stdbool.h>
#include <stdint.h>

enum tool_changer_phase { CHANGER_IDLE, CHANGER_ASKED, CHANGER_TOLD, CHANGER_DONE };

struct tool_changer {
    enum tool_changer_phase phase;
    uint32_t waited; /* cycles of the change under way */
    uint32_t most;   /* that it may take */
    bool is_there;
};

void takt_tool_changer_init(struct tool_changer *t, double cycle_s, double change_s);

/*
 * After a cycle: the program stands at a change; the answer. TOOL_CHANGE_SLOW: it has taken too
 * long.
 */
enum takt_error takt_tool_changer_cycle(struct tool_changer *t, bool stands_at_change,
                                        bool is_changed);

static inline bool tool_changer_asks(const struct tool_changer *t)
{
    return t->phase == CHANGER_ASKED;
}
/* A change must not be passed. */
static inline bool tool_changer_waits(const struct tool_changer *t)
{
    return t->is_there && t->phase != CHANGER_DONE;
}

#endif

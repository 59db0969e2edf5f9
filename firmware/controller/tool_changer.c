#include "controller/tool_changer.h"

#include "base/assert.h"
#include "base/maths.h"

void takt_tool_changer_init(struct tool_changer *t, double cycle_s, double change_s)
{
    TAKT_ASSERT(cycle_s > 0.0 && change_s >= 0.0);
    *t = (struct tool_changer){.most = (uint32_t)takt_maths_ceil(change_s / cycle_s)};
}

static enum tool_changer_phase next_phase(enum tool_changer_phase phase, bool is_changed)
{
    switch (phase) {
    case CHANGER_IDLE:
        return is_changed ? CHANGER_IDLE : CHANGER_ASKED;
    case CHANGER_ASKED:
        return is_changed ? CHANGER_TOLD : CHANGER_ASKED;
    case CHANGER_TOLD:
        return is_changed ? CHANGER_TOLD : CHANGER_DONE;
    case CHANGER_DONE:
        break;
    }
    return CHANGER_DONE;
}

enum takt_error takt_tool_changer_cycle(struct tool_changer *t, bool stands_at_change,
                                        bool is_changed)
{
    if (!stands_at_change) {
        t->phase = CHANGER_IDLE;
        t->waited = 0;
        return TAKT_OK;
    }
    TAKT_ASSERT(t->phase <= CHANGER_DONE);
    t->phase = next_phase(t->phase, is_changed);
    return t->waited++ < t->most ? TAKT_OK : TAKT_ERROR_TOOL_CHANGE_SLOW;
}

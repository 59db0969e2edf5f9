#include "simulation/ending.h"

#include "canopen/cia402.h"
#include "cli/interrupt.h"
#include "controller/restart.h"

/*
 * Two controlwords for each of six drives, one drive a cycle in turn, and for each the time of a
 * report; several times over for frames that are lost. A drive that does not follow then stays off.
 */
#define SWITCHING_CYCLES_MAX 100

void ending_ask(struct ending *ending, struct controller *c, enum ending_way way)
{
    if (way <= ending->way)
        return;
    ending->way = way;
    takt_controller_end(c, way == ENDING_AT_ONCE);
}

enum ending_way ending_by_signals(void)
{
    const unsigned times = interrupt_times();

    if (times == 0)
        return ENDING_NOT;
    return times == 1 ? ENDING_ON_PATH : ENDING_AT_ONCE;
}

static bool are_switched_on(const struct controller *c)
{
    uint16_t statusword[AXIS_COUNT];

    takt_drives_get_statuswords(&c->drives, statusword);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_on_can(&c->machine.axis[i]) &&
            takt_cia402_state(statusword[i]) != CIA402_SWITCHED_ON)
            return false;
    }
    return true;
}

/* Drives that have a fault of their own are left as they are. */
static bool is_switching(struct ending *ending, struct controller *c)
{
    if (!ending->stays_on || takt_drives_get_fault(&c->drives)->code != TAKT_ERROR_ENDED ||
        are_switched_on(c) || ending->switching_cycles++ >= SWITCHING_CYCLES_MAX)
        return false;
    takt_drives_switch_on_at_rest(&c->drives, c->can.port);
    return true;
}

bool ending_is_over(struct ending *ending, struct controller *c)
{
    if (drives_get_state(&c->drives) >= DRIVES_BRAKING)
        takt_controller_quieten(c);
    return takt_controller_has_ended(c) && !is_switching(ending, c);
}

/*
 * What the controller shows.
 */
#include "controller/controller.h"

enum controller_state takt_controller_get_state(const struct controller *c)
{
    return c->state;
}

const struct drives *takt_controller_get_drives(const struct controller *c)
{
    return &c->drives;
}

const struct diagnostic *takt_controller_get_fault(const struct controller *c)
{
    return &c->fault;
}

const struct cycle_record *takt_controller_get_record(const struct controller *c)
{
    return c->has_record ? &c->record : NULL;
}

const struct diagnostic *takt_controller_get_warning(const struct controller *c)
{
    return &c->warning;
}

const struct interpolator_errors *
takt_controller_get_interpolator_errors(const struct controller *c)
{
    return takt_interpolator_get_errors(&c->interpolator);
}

struct correction *takt_controller_get_correction(struct controller *c)
{
    return &c->correction;
}

uint32_t takt_controller_get_answers(const struct controller *c, struct program_answer *last)
{
    *last = c->probe.taken;
    return c->probe.answers;
}

bool takt_controller_is_starved(const struct controller *c)
{
    return (c->replays && c->replay.waits) ||
           (c->program_late && motion_has_ceiling(&c->motion) && c->path.first == c->path.closed);
}

uint64_t takt_controller_get_late(const struct controller *c)
{
    return c->motion.late;
}

const struct outputs *takt_controller_get_outputs(const struct controller *c)
{
    return &c->outputs;
}

const struct block *takt_controller_get_block(const struct controller *c)
{
    return c->has_record ? motion_block(&c->motion) : NULL;
}

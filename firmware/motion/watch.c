#include "motion/watch.h"

#include "motion/motion.h"
#include "plan/path_unit.h"

/* Is something known ahead of the trapezoidal reference, in the ceiling that it is in? */
static bool has_way(const struct reference *l)
{
    const struct ceiling *c = l->here.ceiling;

    return c != NULL && c->count > 0 && path_mm(c->origin, l->at) < c->end_mm[c->count - 1];
}

static double explained_cycles(const struct motion *m)
{
    const uint32_t index = m->path->first;
    const uint32_t cycles =
        reference_stands(&m->reference) ? path_at(m->path, index)->cycles : m->reference.cycles;
    const double feed = takt_ceiling_block_feed(m->path, index, &m->request) * m->cycle_s;
    const double a = takt_ceiling_block_acceleration(m->path, index, cycles);

    return takt_path_length(m->path, index) / feed + 2.0 * feed / a + 4.0 * m->reference.window +
           WATCH_EVERY_CYCLES;
}

bool takt_watch_look(struct motion *m, bool may_move)
{
    struct watch *w = &m->watch;

    if (!may_move || !has_way(&m->reference) || w->block != m->path->first) {
        w->block = m->path->first;
        w->parts = 0.0F;
        return true;
    }
    w->parts += (float)(WATCH_EVERY_CYCLES / explained_cycles(m));
    return w->parts <= WATCH_PARTS;
}

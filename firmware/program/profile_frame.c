/*
 * The profile of a turning cycle in the frame of its cuts: facing is roughing turned by a quarter.
 */
#include "base/assert.h"
#include "program/profile.h"

/* (u, v) to (v, -u) */
static void turn_point(struct profile_point *q)
{
    *q = (struct profile_point){q->v, -q->u};
}

void takt_profile_turn(struct profile *p)
{
    for (unsigned i = 0; i < p->count; i++) {
        turn_point(&p->segment[i].start);
        turn_point(&p->segment[i].end);
        if (p->segment[i].kind == PROFILE_ARC) {
            turn_point(&p->segment[i].centre);
        }
    }
}

static void mirror_point(struct profile_point *q, bool u, bool v)
{
    q->u = u ? -q->u : q->u;
    q->v = v ? -q->v : q->v;
}

void takt_profile_mirror_segment(struct profile_segment *s, bool u, bool v)
{
    mirror_point(&s->start, u, v);
    mirror_point(&s->end, u, v);
    if (s->kind == PROFILE_ARC) {
        mirror_point(&s->centre, u, v);
        s->left = s->left != (u != v);
    }
}

void takt_profile_mirror(struct profile *p, bool u, bool v)
{
    for (unsigned i = 0; i < p->count; i++) {
        takt_profile_mirror_segment(&p->segment[i], u, v);
    }
}

/* An arc must stay above its centre if it turns left, below if right. */
static bool falls(const struct profile_segment *s)
{
    const double way = s->end.u - s->start.u;

    if (s->kind != PROFILE_ARC) {
        return way <= PROFILE_SHORT_MM;
    }
    const double side = s->left ? 1.0 : -1.0;

    return way <= -PROFILE_SHORT_MM && side * (s->start.v - s->centre.v) >= -PROFILE_SHORT_MM &&
           side * (s->end.v - s->centre.v) >= -PROFILE_SHORT_MM;
}

bool takt_profile_falls(const struct profile *p, unsigned first)
{
    TAKT_ASSERT(first <= p->count);
    for (unsigned i = first; i < p->count; i++) {
        const uint8_t kind = p->segment[i].kind;

        if (kind != PROFILE_FILLET && kind != PROFILE_CHAMFER && !falls(&p->segment[i])) {
            return false;
        }
    }
    return true;
}

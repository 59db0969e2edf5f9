#include "smooth/head.h"

#include "base/assert.h"

#include <string.h>

static unsigned most_samples(const struct route *r)
{
    return SMOOTH_HEAD_MAX / r->slots.groups;
}

void takt_head_keep(struct smooth_head *h, const struct window *w, const struct route *r,
                    unsigned proved)
{
    const unsigned most = most_samples(r);

    TAKT_ASSERT(most > SMOOTH_FIXED);
    h->proved = proved + SMOOTH_FIXED < most ? proved : most - SMOOTH_FIXED;
    memcpy(h->origin, w->origin, sizeof h->origin);
    for (unsigned i = 0; i < most && i < w->count; i++) {
        h->at_mm[i] = w->at_mm[i];
        h->element[i] = w->element[i];
        for (unsigned g = 0; g < r->slots.groups; g++) {
            h->x[g * most + i] = w->x[g * w->capacity + i];
        }
    }
}

void takt_head_take(const struct smooth_head *h, struct window *w, const struct route *r)
{
    const unsigned most = most_samples(r);

    TAKT_ASSERT(h->proved + SMOOTH_FIXED <= most);
    memcpy(w->origin, h->origin, sizeof h->origin);
    w->count = h->proved + SMOOTH_FIXED;
    w->at_end = false;
    for (unsigned i = 0; i < w->count; i++) {
        w->at_mm[i] = h->at_mm[i];
        w->element[i] = h->element[i];
        for (unsigned g = 0; g < r->slots.groups; g++) {
            w->x[g * w->capacity + i] = h->x[g * most + i];
        }
    }
}

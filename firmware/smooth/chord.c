#include "smooth/chord.h"

#include "base/assert.h"
#include "smooth/single.h"

void takt_chord_init(struct chord_reach *chord, double cycle_s, double interval_s)
{
    const double cycles = cycle_s / interval_s;

    TAKT_ASSERT(cycle_s > 0.0 && interval_s > 0.0);
    chord->per_second = (float)(cycles * cycles / 8.0);
    chord->pieces = 1;
    while ((double)chord->pieces < cycles) {
        chord->pieces++;
    }
}

/* Square of c_0 - 2 c_1 + c_2 at a sample: the second derivative. */
static float second_square(const struct window *w, const struct route *r, unsigned sample)
{
    lanes second[SMOOTH_GROUPS_MAX];

    TAKT_ASSERT(sample > 0 && sample + 1 < w->count);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        const lanes_int *c = w->x + (size_t)g * w->capacity + sample;

        second[g] = window_weighted(w, g, c[-1] - 2 * c[0] + c[1]);
    }
    return route_dot(r, second, second);
}

/* Piece i lies between samples i + 1 and i + 2; on it the second derivative is between theirs. */
float takt_chord_leaves(const struct window *w, const struct route *r, unsigned piece)
{
    const unsigned reach = r->chord.pieces;
    const unsigned end = piece + 3 + reach;
    float most = 0.0f;

    for (unsigned i = piece + 1 > reach ? piece + 1 - reach : 1; i < end && i + 1 < w->count; i++) {
        most = i > 0 ? single_max(most, second_square(w, r, i)) : most;
    }
    return single_sqrt(most) * r->chord.per_second;
}

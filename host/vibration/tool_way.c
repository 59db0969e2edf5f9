#include "vibration/tool_way.h"

#include "base/maths.h"

static const struct point *kept(const struct tool_way *w, uint64_t n)
{
    return &w->kept[n % TOOL_WAY_KEPT];
}

void tool_way_add(struct tool_way *w, const struct point *commanded)
{
    if (w->count > 0 && point_is_same(kept(w, w->count - 1), commanded))
        return; /* standing is no way: the tool would be looked for in it */
    w->kept[w->count % TOOL_WAY_KEPT] = *commanded;
    w->count++;
}

/* Square of the distance from a chord: along it by the part of it that is nearest, 0 ... 1. */
static double square_from(const struct point *from, const struct point *to,
                          const struct point *tool)
{
    double along = 0, length = 0, square = 0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double way = to->at[i] - from->at[i];

        along += (tool->at[i] - from->at[i]) * way;
        length += way * way;
    }
    const double part = length > 0 ? maths_clamp(along / length, 0, 1) : 0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double off = tool->at[i] - from->at[i] - part * (to->at[i] - from->at[i]);

        square += off * off;
    }
    return square;
}

/*
 * The nearest chord from the one it was at on, never one behind: the first of those that are as
 * near.
 */
static double find_square(struct tool_way *w, const struct point *tool)
{
    const uint64_t oldest = w->count > TOOL_WAY_KEPT ? w->count - TOOL_WAY_KEPT : 0;
    uint64_t n = w->at > oldest ? w->at : oldest + 1;
    double least = square_from(kept(w, n - 1), kept(w, n), tool);

    w->at = n;
    for (uint64_t end = n + TOOL_WAY_AHEAD; n + 1 < w->count && n < end;) {
        n++;
        const double square = square_from(kept(w, n - 1), kept(w, n), tool);

        if (square < least) {
            least = square;
            w->at = n;
        }
    }
    return least;
}

void tool_way_measure(struct tool_way *w, const struct point *tool)
{
    if (w->count == 0)
        return;
    const double square =
        w->count > 1 ? find_square(w, tool) : square_from(kept(w, 0), kept(w, 0), tool);

    w->measured++;
    w->square_sum_mm2 += square;
    w->max_mm = maths_max(w->max_mm, maths_sqrt(square));
}

double tool_way_rms_mm(const struct tool_way *w)
{
    return w->measured > 0 ? maths_sqrt(w->square_sum_mm2 / (double)w->measured) : 0;
}

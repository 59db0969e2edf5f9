#include "smooth/merge.h"

#include "base/assert.h"
#include "base/maths.h"

void takt_merge_open(struct merge *m, const struct move *move, uint32_t number,
                     const struct curve *curve)
{
    m->move = *move;
    m->number = number;
    m->curve = *curve;
    m->lines = 1;
}

static bool is_alike(const struct merge *m, const struct move *move, const struct curve *curve)
{
    return m->curve.kind == CURVE_LINE && curve->kind == CURVE_LINE &&
           m->curve.rotary == curve->rotary && m->move.kind == move->kind &&
           m->move.feed_mm_s == move->feed_mm_s && m->move.overrides == move->overrides &&
           m->move.correction_off == move->correction_off &&
           m->move.contour_side == move->contour_side;
}

/*
 * Place of p along the line from start to end, 0 ... 1, and how far it is beside it; weighted
 * (limits.h).
 */
static double place_beside(const struct point *start, const struct point *end,
                           const struct point *p, double *distance_mm)
{
    double dot = 0.0;
    double square = 0.0;
    double rest = 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d = smooth_weight(i) * (end->at[i] - start->at[i]);

        dot += smooth_weight(i) * (p->at[i] - start->at[i]) * d;
        square += d * d;
    }
    const double place = square > 0.0 ? dot / square : 0.0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d =
            smooth_weight(i) * (p->at[i] - start->at[i] - place * (end->at[i] - start->at[i]));

        rest += d * d;
    }
    *distance_mm = maths_sqrt(rest);
    return place;
}

/* Every programmed end beside the line from start to end, in order. */
static bool passes_all(const struct merge *m, const struct point *end, double within_mm)
{
    double last = 0.0;

    TAKT_ASSERT(m->lines > 0 && m->lines <= MERGE_POINTS_MAX);
    for (unsigned i = 0; i < m->lines; i++) {
        double distance;
        const double place = place_beside(&m->curve.start, end, &m->point[i], &distance);

        if (distance > within_mm || place < last || place > 1.0) {
            return false;
        }
        last = place;
    }
    return true;
}

bool takt_merge_take(struct merge *m, const struct move *move, uint32_t number,
                     const struct curve *curve, double within_mm)
{
    struct curve longer;

    TAKT_ASSERT(within_mm >= 0.0);
    if (m->lines == 0 || m->lines > MERGE_POINTS_MAX || !is_alike(m, move, curve)) {
        return false;
    }
    m->point[m->lines - 1] = m->curve.end;
    if (!passes_all(m, &curve->end, within_mm) ||
        !takt_curve_set_line(&longer, &m->curve.start, &curve->end) ||
        longer.rotary != curve->rotary) {
        return false;
    }
    m->move = *move;
    m->number = number;
    m->curve = longer;
    m->lines++;
    return true;
}

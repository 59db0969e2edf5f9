#include "takt/judge_smooth.h"

#include "base/maths.h"
#include "takt/judge_curve.h"

/* The setpoint is on the present motion or so near to it in the queue, unless it is farther from all of them. */
#define NEAR 8

struct judge_motion *judge_motion_at(struct judge_motions *m, uint32_t index)
{
    return &m->motion[index % JUDGE_MOTIONS_MAX];
}

bool judge_motions_have_room(const struct judge_motions *m)
{
    return m->read < m->current + JUDGE_AHEAD;
}

static void raise_to(double *largest, double value)
{
    if (value > *largest)
        *largest = value;
}

/* Goes along the curve to where p lies across it (Newton's method): beside a steep helix that is not at p's angle. */
static double distance_across(const struct curve *c, const struct point *p, double *fraction)
{
    double s = *fraction * c->length_mm;
    struct point on, tangent;

    for (int i = 0; i < 3; i++) {
        double along = 0, square = 0;

        curve_point(c, s, &on);
        curve_tangent(c, s, &tangent);
        for (int axis = 0; axis < AXIS_COUNT; axis++) {
            along += (p->at[axis] - on.at[axis]) * tangent.at[axis];
            square += tangent.at[axis] * tangent.at[axis];
        }
        s = maths_clamp(s + along / square, 0, c->length_mm);
    }
    curve_point(c, s, &on);
    *fraction = s / c->length_mm;
    return judge_distance(p, &on);
}

/*
 * A curve of more than half a turn is near in several places: looked for near its ends, its middle, and where it was
 * nearest last.
 */
static double distance_from(struct judge_motion *motion, const struct point *p)
{
    const double near[] = {motion->fraction, 0, 0.5, 1};
    const unsigned tries = motion->curve.kind == CURVE_LINE ? 1 : 4;
    double least = MATHS_INFINITY;

    for (unsigned i = 0; i < tries; i++) {
        double fraction = near[i];
        double distance = judge_curve_distance(&motion->curve, p, &fraction);

        if (motion->curve.kind != CURVE_LINE)
            distance = maths_min(distance, distance_across(&motion->curve, p, &fraction));
        if (distance < least) {
            least = distance;
            motion->fraction = fraction;
        }
    }
    return least;
}

/* Lowers *least to the distance of p from motions first ... last - 1, as a part of the present tolerance. */
static void look_among(struct judge_motions *m, uint32_t first, uint32_t last,
                       const struct point *p, double *least)
{
    for (uint32_t i = first; i < last; i++) {
        struct judge_motion *motion = judge_motion_at(m, i);

        if (motion->has_length)
            *least = maths_min(*least, distance_from(motion, p));
    }
}

static uint32_t behind(const struct judge_motions *m, uint32_t count)
{
    return m->current > count ? m->current - count : 0;
}

static uint32_t ahead(const struct judge_motions *m, uint32_t count)
{
    return m->current + count < m->read ? m->current + count : m->read;
}

/* From the motions next to the present one outwards, until one is near enough. */
static double distance_from_path(struct judge_motions *m, const struct point *p,
                                 double tolerance_mm)
{
    double least = MATHS_INFINITY;

    look_among(m, behind(m, NEAR), ahead(m, NEAR), p, &least);
    if (least > tolerance_mm) {
        look_among(m, behind(m, JUDGE_BEHIND), behind(m, NEAR), p, &least);
        look_among(m, ahead(m, NEAR), ahead(m, JUDGE_AHEAD), p, &least);
    }
    return least;
}

/* Over all axes; a radian counts as a millimetre. */
static double segment_distance(const struct point *corner, const struct point *from,
                               const struct point *to)
{
    struct point step, off;
    double square = 0, along = 0, rest = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        step.at[i] = to->at[i] - from->at[i];
        off.at[i] = corner->at[i] - from->at[i];
        square += step.at[i] * step.at[i];
        along += step.at[i] * off.at[i];
    }
    const double part = square > 0 ? maths_clamp(along / square, 0, 1) : 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double d = off.at[i] - part * step.at[i];

        rest += d * d;
    }
    return maths_sqrt(rest);
}

static void look_at_corners(struct judge_motions *m, const struct point *from,
                            const struct point *to)
{
    const uint32_t last = ahead(m, JUDGE_AHEAD);

    for (uint32_t i = m->settled; i < last; i++) {
        struct judge_motion *motion = judge_motion_at(m, i);

        motion->smoothed = motion->smoothed || i < m->current;
        motion->corner_mm =
            maths_min(motion->corner_mm, segment_distance(&motion->move.end, from, to));
    }
}

static void settle(struct judge_motions *m, struct judge_smoothing *s, uint32_t until)
{
    for (; m->settled < until; m->settled++) {
        const struct judge_motion *motion = judge_motion_at(m, m->settled);

        if (motion->smoothed && motion->has_length && motion->move.tolerance_mm > 0)
            raise_to(&s->corner_part, motion->corner_mm / motion->move.tolerance_mm);
    }
}

void judge_smooth_add(struct judge_motions *m, struct judge_smoothing *s, const struct point *from,
                      const struct point *to)
{
    const double tolerance_mm = judge_motion_at(m, m->current - 1)->move.tolerance_mm;

    raise_to(&s->path_part, distance_from_path(m, to, tolerance_mm) / tolerance_mm);
    look_at_corners(m, from, to);
    settle(m, s, behind(m, JUDGE_BEHIND));
}

void judge_smooth_begin(struct judge_motions *m)
{
    m->settled = m->current - 1;
}

void judge_smooth_end(struct judge_motions *m, struct judge_smoothing *s)
{
    settle(m, s, m->current);
}

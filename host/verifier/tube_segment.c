#include "verifier/tube_segment.h"

#include "base/maths.h"

/*
 * The place f >= from of a segment nearest to p, and all places within w of p:
 *
 *     |p - start - f way| <= w      <=>     |f - g| <= sqrt((w^2 - d^2) / way^2)
 *
 * with g the closest point of the perpendicular from p on the line, d its length.
 */
struct tube_beside tube_segment_beside(const struct tube_segment *s, double from,
                                       const struct point *p, double within_mm)
{
    struct tube_beside b = {.part = from, .first = 2};
    double along = 0, square = 0, closest = 0, half;

    for (int i = 0; i < AXIS_COUNT; i++)
        along += (p->at[i] - s->start.at[i]) * s->way.at[i];
    if (s->square_mm2 > 0) {
        closest = along / s->square_mm2;
        b.part = maths_clamp(closest, from, 1);
    }
    for (int i = 0; i < AXIS_COUNT; i++) {
        const double off = p->at[i] - s->start.at[i] - b.part * s->way.at[i];

        square += off * off;
    }
    b.distance_mm = maths_sqrt(square);
    if (b.distance_mm > within_mm)
        return b;
    b.first = from;
    b.last = 1;
    if (s->square_mm2 > 0) {
        half = (within_mm * within_mm - square) / s->square_mm2 +
               (b.part - closest) * (b.part - closest);
        half = maths_sqrt(maths_max(half, 0));
        b.first = maths_clamp(closest - half, from, b.part);
        b.last = maths_clamp(closest + half, b.part, 1);
    }
    return b;
}

struct point tube_segment_end(const struct tube_segment *s)
{
    struct point end;

    for (int i = 0; i < AXIS_COUNT; i++)
        end.at[i] = s->start.at[i] + s->way.at[i];
    return end;
}

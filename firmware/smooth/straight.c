#include "smooth/straight.h"

#include "smooth/single.h"

/* A bent element counts as straight where it leaves its tangent by no more than this part of the tolerance. */
#define STRAIGHT_PART 0.02f

/* The end of the element, or as far as it is straight, or as an interval at its feed goes. */
static double next_rest(const struct window *w, const struct route *r, uint32_t element)
{
    const double at = w->at_mm[SMOOTH_FIXED - 1];
    const float straight = route_straight(r, element, at, STRAIGHT_PART * (float)r->tolerance_mm);
    const float once = route_element(r, element)->feed_mm_s * (float)w->interval_s;

    return maths_min(route_end_of(r, element), at + (double)single_min(straight, once));
}

/*
 * On the straight way to a spot as far as every axis comes in an interval at its velocity: where an interval is short beside the
 * tolerance, what is left for changes of rate would be less than nothing, and the axes stand for ever.
 */
static void come_nearer(const struct window *w, const struct route *r, struct window_spot *spot)
{
    float part = 1.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        const float way = (float)(spot->at[i] - window_x(w, i, SMOOTH_FIXED - 1));
        const float most = r->slots.velocity_mm_s[i] * (float)(w->interval_s / w->unit_mm[i]);

        part = part * single_abs(way) > most ? most / single_abs(way) : part;
    }
    for (unsigned i = 0; i < r->slots.count && part < 1.0f; i++) {
        const int32_t from = window_x(w, i, SMOOTH_FIXED - 1);

        spot->at[i] = from + single_round(part * (float)(spot->at[i] - from));
    }
}

/* From rest to the path itself, if the axes are not there, else straight on along it; where to? */
static void find_next_rest(const struct window *w, const struct route *r, double *at_mm,
                           uint32_t *element, struct window_spot *spot)
{
    double p[AXIS_COUNT];

    route_point(r, *at_mm, element, p);
    window_nearest(w, r, p, spot);
    if (!window_is_at(w, r, SMOOTH_FIXED - 1, spot)) {
        come_nearer(w, r, spot);
        return;
    }
    *element = route_find(r, *at_mm, *element);
    *at_mm = next_rest(w, r, *element);
    route_point(r, *at_mm, element, p);
    window_nearest(w, r, p, spot);
}

/* From rest straight on, and to rest again. */
unsigned straight_on(struct window *w, const struct route *r)
{
    const unsigned last = SMOOTH_FIXED - 1;
    double at = w->at_mm[last];
    struct window_spot spot;

    w->element[SMOOTH_FIXED] = w->element[last];
    find_next_rest(w, r, &at, &w->element[SMOOTH_FIXED], &spot);
    w->count = 2 * SMOOTH_FIXED;
    w->at_end = false;
    for (unsigned i = SMOOTH_FIXED; i < w->count; i++) {
        w->at_mm[i] = at;
        w->element[i] = w->element[SMOOTH_FIXED];
        window_set(w, r, i, &spot);
    }
    return SMOOTH_FIXED;
}

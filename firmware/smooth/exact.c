#include "smooth/exact.h"

#include "base/assert.h"
#include "base/maths.h"

/*
 * A curved element that is no arc is gone along in lines that leave it by this part of the
 * tolerance.
 */
#define STRAIGHT_PART 0.02f

/* As far as the element is straight, if it is no arc. */
static double straight_end(const struct route *r, uint32_t element, double at_mm)
{
    const float straight =
        takt_route_straight(r, element, at_mm, STRAIGHT_PART * (float)r->tolerance_mm);

    return maths_min(route_end_of(r, element), at_mm + (double)straight);
}

/*
 * Must the axes be on it before they go along it? Of a curve so that it is one; where rotary axes
 * move, because a feed counts the way of the linear ones alone.
 */
static bool begins_on_route(const struct route *r, uint32_t element, bool along)
{
    float d[AXIS_COUNT];
    bool turns = false;

    (void)takt_route_direction(r, element, route_element(r, element)->start_mm, d);
    for (unsigned i = 0; i < r->slots.count; i++) {
        turns = turns || (r->slots.axis[i] >= AXIS_LINEAR_COUNT && d[i] != 0.0f);
    }
    return along || turns;
}

/* To a place of an element: as it is programmed, or in a line. False: the axes are there. */
static bool go_to(const struct route *r, uint32_t element, double to_mm, const struct point *start,
                  double p[], struct move *move, struct curve *curve)
{
    takt_route_place(r, element, to_mm, p);
    takt_route_scatter(r, p, &move->end);
    return takt_move_curve(move, start, curve);
}

/*
 * As it is programmed to its end, or to that of the piece that plan divides it into (plan/path.c):
 * the place to which that goes. No farther than it is: it is no such motion.
 */
static double go_along(const struct route *r, uint32_t element, double at_mm,
                       const struct point *start, double p[], struct move *move,
                       struct curve *curve)
{
    const double to_mm = route_end_of(r, element);

    if (!go_to(r, element, to_mm, start, p, move, curve)) {
        return at_mm;
    }
    const struct curve whole = *curve;
    const double end_mm = takt_curve_piece_end(&whole, 0.0);

    TAKT_ASSERT(end_mm > 0.0 && to_mm > at_mm);
    if (end_mm >= whole.length_mm) {
        return to_mm;
    }
    takt_curve_cut(&whole, 0.0, end_mm, curve);
    takt_route_gather(r, &curve->end, p);
    return at_mm + (to_mm - at_mm) * end_mm / whole.length_mm;
}

bool takt_exact_next(struct window *w, const struct route *r, struct move *move,
                     struct curve *curve)
{
    const uint32_t element = w->element[0];
    const double at_mm = w->at_mm[0];
    const bool along = takt_route_along(r, element, at_mm, move);
    const enum move_kind kind = move->kind;
    const enum move_kind line = kind == MOVE_RAPID ? MOVE_RAPID : MOVE_FEED;
    const bool beside = begins_on_route(r, element, along);
    double to_mm = beside ? at_mm : straight_end(r, element, at_mm);
    struct point start;
    double p[AXIS_COUNT];

    takt_window_sample(w, r, 0, p);
    takt_route_scatter(r, p, &start);
    move->kind = line;
    bool goes = go_to(r, element, to_mm, &start, p, move, curve);

    if (!goes && along) {
        move->kind = kind;
        to_mm = go_along(r, element, at_mm, &start, p, move, curve);
        goes = to_mm > at_mm;
    }
    if (!goes && beside) {
        to_mm = straight_end(r, element, at_mm);
        move->kind = line;
        goes = go_to(r, element, to_mm, &start, p, move, curve);
    }
    takt_window_stand(w, r, p, to_mm, element);
    return goes;
}

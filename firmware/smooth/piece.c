/*
 * What is handed on: the piece of the curve that is taken next, and those in which the axes stand
 * before and behind a curve.
 */
#include "smooth/parts.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Windows are whole cycles, and so is where the trapezoidal reference begins. */
#define STANDING_CYCLES 3.0

/* The end of a route is that of a window but for this many of its units. */
#define ROUNDED 2.0

/*
 * At both ends of what begins and ends at rest by itself the axes stand, and the rate of nominal
 * time rises and falls: over a cycle, and the setpoint's over the windows W of its averages more.
 * By then nominal time is at W/2.
 */
static double ramp_s(const struct smooth *s)
{
    return 0.5 * (s->limits.cycle_s + s->limits.windows * s->change.rounding_s);
}

static double standing_s(const struct smooth *s)
{
    return ramp_s(s) + STANDING_CYCLES * s->limits.cycle_s;
}

double takt_smooth_rest_s(const struct smooth *s)
{
    return standing_s(s) + ramp_s(s);
}

/*
 * Control point of a piece; exactly the programmed end where it is that: what has come since the
 * window was filled ends elsewhere.
 */
static void set_control(const struct smooth *s, unsigned i, struct point *control)
{
    const struct window *w = &s->window;
    const bool end = smooth_is_finished(s) && s->known_mm == takt_route_end(&s->route) &&
                     w->at_end && i + SMOOTH_FIXED >= w->count;
    double p[AXIS_COUNT];

    takt_window_sample(w, &s->route, i, p);
    memset(control, 0, sizeof(*control));
    for (unsigned k = 0; k < s->route.slots.count; k++) {
        TAKT_ASSERT(!end || maths_abs(s->route.end[k] - p[k]) <= ROUNDED * w->unit_mm[k]);
        control->at[s->route.slots.axis[k]] = end ? s->route.end[k] : p[k];
    }
}

uint32_t takt_smooth_tell(struct smooth *s, uint32_t element)
{
    s->told = element < s->told ? s->told : element;
    return s->told;
}

/* The last one that is ready, with nothing proved behind it: is that where the chain ends? */
static enum smooth_end end_of(const struct smooth *s, unsigned i)
{
    if (i + 1 < s->ready || s->proved > 0) {
        return SMOOTH_GOES_ON;
    }
    return takt_search_is_stuck(s) ? SMOOTH_STOPS : SMOOTH_ENDS;
}

void takt_smooth_set_piece(struct smooth *s, unsigned i, struct smooth_piece *piece)
{
    const struct window *w = &s->window;
    const uint32_t element = w->element[i + 1];
    const uint32_t told = takt_smooth_tell(s, element);
    struct verifier_need need;
    struct verifier_rate rate;

    TAKT_ASSERT(i < s->ready && i + 3 < w->count);
    takt_route_move(&s->route, told, &s->move);
    piece->move = &s->move;
    piece->number = route_element(&s->route, told)->number;
    piece->rotary = route_element(&s->route, element)->rotary;
    piece->interval_s = w->interval_s;
    for (unsigned k = 0; k < 4; k++) {
        set_control(s, i + k, &piece->control[k]);
    }
    takt_verifier_need(w, &s->route, i, &need);
    takt_verifier_rate(&need, &s->route, s->route.first + w->paced[i], &s->change, &rate);
    piece->rate.most = maths_min((double)rate.most, 1.0);
    piece->rate.programmed = (double)rate.programmed;
    piece->change.by = (double)takt_verifier_change_on(&need, &s->route, &s->change, &rate);
    piece->change.rounded = piece->change.by / s->change.rounding_s;
    piece->end = end_of(s, i);
}

void takt_smooth_stand(struct smooth *s, struct smooth_piece *piece)
{
    const double change_per_s = 1.0 / s->limits.cycle_s;
    const bool behind = s->standing == SMOOTH_STANDS_BEHIND;
    const struct point at = piece->control[behind ? 3 : 0];

    TAKT_ASSERT(s->standing != SMOOTH_STANDS_NOT);
    *piece = (struct smooth_piece){
        .move = &s->move,
        .number = piece->number,
        .control = {at, at, at, at},
        .interval_s = standing_s(s),
        .rate = {.most = 1.0, .programmed = MATHS_INFINITY},
        .change = {.by = change_per_s, .rounded = change_per_s / s->change.rounding_s},
        .rotary = piece->rotary,
        .end = behind ? SMOOTH_ENDS : SMOOTH_GOES_ON,
    };
    s->standing = SMOOTH_STANDS_NOT;
    if (behind) {
        takt_smooth_end(s);
    }
}

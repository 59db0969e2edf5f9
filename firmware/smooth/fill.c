/*
 * The window is filled with samples along the route, as far as that is known: at an interval that
 * fits the axes that move on it.
 */
#include "smooth/parts.h"

#include "base/assert.h"
#include "base/maths.h"
#include "smooth/chord.h"
#include "smooth/interval.h"
#include "smooth/nominal.h"

/* A chain that goes on behind what is known is expected to be so many times as long: README.md. */
#define EXPECTED 4.0

/* So short that changes of rate are rounded over as little as they may be. */
#define WAY_LEAST_MM 1e-9

/* From where the axes rest. */
static struct verifier_way way_of(const struct smooth *s)
{
    const struct route *r = &s->route;
    const double start_mm =
        s->window.count > 0 ? s->window.at_mm[0] : route_element(r, r->first)->start_mm;
    const double known_mm = maths_max(takt_route_end(r) - start_mm, WAY_LEAST_MM);

    return (struct verifier_way){known_mm, smooth_is_finished(s) ? known_mm : EXPECTED * known_mm};
}

/* How the rate may change: as these axes allow. What others do is nothing to it. */
static void find_change(const struct smooth *s, unsigned axes, double interval_s,
                        const struct verifier_way *way, struct verifier_change *change)
{
    struct smooth_limits limits = s->limits;

    limits.axes &= axes;
    takt_smooth_limit(&limits);
    takt_verifier_change(&limits, interval_s, way, change);
}

/* What merging uses of the tolerance makes no interval shorter. */
static double find_interval(const struct smooth *s, unsigned axes)
{
    return takt_interval_of(&s->limits, &s->route, axes,
                            (double)s->route.part * s->merge.move.tolerance_mm,
                            smooth_is_finished(s));
}

/* The time between samples, and what depends on it; the window is empty. */
static void set_interval(struct smooth *s, float fine)
{
    const double interval_s =
        maths_max(takt_interval_least(&s->limits), (double)fine * find_interval(s, s->route.moved));
    const struct verifier_way way = way_of(s);

    TAKT_ASSERT(interval_s > 0.0);
    find_change(s, s->route.moved, interval_s, &way, &s->change);
    s->route.slots.change_per_s = (float)s->change.wanted;
    s->route.slots.rounded_per_s2 = (float)(s->change.wanted / s->change.rounding_s);
    takt_chord_init(&s->route.chord, s->limits.cycle_s, interval_s);
    takt_window_init(&s->window, &s->route, interval_s);
}

/* In a tolerance of all its reach a chain is not held at all. */
float takt_fill_useful(const struct smooth *s)
{
    const double most = takt_interval_reach(&s->route) / s->merge.move.tolerance_mm;

    return smooth_is_finished(s) && most < 1.0 ? (float)most : 1.0f;
}

void takt_fill_within(struct smooth *s, float part, float fine)
{
    TAKT_ASSERT(part > 0.0f && part <= 1.0f && fine > 0.0f);
    s->route.part = part;
    takt_nominal_again(&s->route);
    set_interval(s, fine);
    s->window.count = SMOOTH_FIXED;
}

void takt_fill_begin_anew(struct smooth *s)
{
    TAKT_ASSERT(smooth_is_open(s) && s->ready == 0);
    takt_fill_within(s, 1.0f, 1.0f);
    s->standing = SMOOTH_STANDS_BEFORE;
    s->since.rate = 1.0f;
    s->proved = 0;
}

/* Is the nominal feed at a place lower because the route is known no farther than so? */
static bool feels_end(const struct smooth *s, double at_mm, uint32_t element, double known_mm)
{
    const struct route_element *e = route_element(&s->route, element);
    const float ahead = (float)(known_mm - at_mm);

    TAKT_ASSERT(element >= s->route.first && element < s->route.count);
    return takt_braking_way(&e->along, e->feed_mm_s, 0.0f, 0.0f) > ahead;
}

static bool last_feels_end(const struct smooth *s, double known_mm)
{
    const unsigned last = s->window.count - 1;

    TAKT_ASSERT(s->window.count > 0);
    return feels_end(s, s->window.at_mm[last], s->window.element[last], known_mm);
}

/* Is the end known, or no more of the route can be? */
static bool is_all_known(const struct smooth *s)
{
    return smooth_is_finished(s) || !takt_route_has_room(&s->route);
}

/*
 * The route has gone on since: samples that were slow before its end only, or that end itself, are
 * taken anew.
 */
static void forget_end(struct smooth *s)
{
    struct window *w = &s->window;

    if (w->count <= SMOOTH_FIXED || !(s->known_mm < takt_route_end(&s->route))) {
        return;
    }
    w->at_end = false;
    while (w->count > SMOOTH_FIXED && last_feels_end(s, s->known_mm)) {
        w->count--;
    }
}

bool takt_fill_fits(const struct smooth *s, unsigned axes)
{
    const struct verifier_way shortest = {0.0, WAY_LEAST_MM};
    struct verifier_change least;

    if (s->window.count == 0 || (axes & ~s->route.moved) == 0) {
        return true;
    }
    axes |= s->route.moved;
    find_change(s, axes, s->window.interval_s, &shortest, &least);
    return find_interval(s, axes) <= s->window.interval_s && least.by >= s->change.by &&
           least.rounding_s <= s->change.rounding_s;
}

/* From rest the interval is that of what is known now: whether that is all of the chain. */
static void begin_window(struct smooth *s)
{
    const bool stands = s->window.count > 0;

    if (stands && s->standing != SMOOTH_STANDS_BEFORE) {
        return;
    }
    set_interval(s, 1.0f);
    if (stands) {
        s->window.count = SMOOTH_FIXED;
    } else {
        takt_window_start(&s->window, &s->route);
    }
}

bool takt_fill(struct smooth *s)
{
    struct window *w = &s->window;

    TAKT_ASSERT(w->count <= SMOOTH_SAMPLES_MAX);
    if (s->route.count == 0 || !is_all_known(s)) {
        return false;
    }
    begin_window(s);
    forget_end(s);
    takt_window_extend(w, &s->route);
    s->known_mm = takt_route_end(&s->route);
    return true;
}

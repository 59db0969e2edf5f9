#include "smooth/worth.h"

#include "base/assert.h"
#include "smooth/exact_time.h"
#include "smooth/parts.h"
#include "smooth/single.h"

static void set_piece(const struct worth_window *now, unsigned i, struct worth_pace *p)
{
    const struct window *w = &now->of->window;
    struct verifier_need need;
    struct verifier_rate rate;

    takt_verifier_need(w, &now->of->route, i, &need);
    takt_verifier_rate(&need, &now->of->route, now->of->route.first + w->paced[i], &now->of->change,
                       &rate);
    p->most[i] = single_min(1.0f, single_min(rate.most, rate.programmed));
    p->change[i] = 2.0f * (float)w->interval_s *
                   takt_verifier_change_on(&need, &now->of->route, &now->of->change, &rate);
}

/* What a curve takes longer where it begins, or ends, at rest. */
static float rest_s(const struct worth_window *now)
{
    return (float)takt_smooth_rest_s(now->of);
}

/*
 * The rate as the trapezoidal reference has it: r^2 rises and falls by 2 r' d on a piece of d at
 * most, from what it is where the pieces begin. What follows them binds it no more than the last
 * one does.
 */
static void find_pace(const struct worth_window *now, float from)
{
    struct worth_pace *p = &now->work->pace;
    const unsigned n = now->pieces;
    float next = SINGLE_INFINITY;

    for (unsigned i = 0; i < n; i++) {
        set_piece(now, i, p);
    }
    for (unsigned i = n; i > 0; i--) {
        p->at[i] = single_min(next, p->most[i - 1]);
        next = single_min(p->most[i - 1], single_sqrt(p->at[i] * p->at[i] + p->change[i - 1]));
    }
    p->at[0] = single_min(from, next);
    for (unsigned i = 0; i < n; i++) {
        p->at[i + 1] = single_min(p->at[i + 1], single_sqrt(p->at[i] * p->at[i] + p->change[i]));
    }
}

/*
 * The place where the path rests first behind the start of an element, or its end: index of an
 * element.
 */
static uint32_t next_rest(const struct worth_window *now, uint32_t element)
{
    uint32_t i = element + 1;

    while (i < now->of->route.count && !takt_exact_rests(&now->of->route, &now->of->limits, i)) {
        i++;
    }
    return i;
}

/*
 * A rest that the curve has passed: the start of an element, and when; and when those that are kept
 * end.
 */
struct passed {
    uint32_t element;
    float time;
    float kept;
    float rate; /* there */
    float stop; /* r/2r': what coming to rest where they begin takes longer than to go on */
};

/* v/2a + w a/2j, a^2 <= v j/w: what a ramp from rest takes longer than its way at the feed. */
static float ramp(const struct worth_window *now, uint32_t element, float feed)
{
    const struct route_element *e = route_element(&now->of->route, element);
    const float j = e->along.jerk / (float)now->of->limits.windows;
    const float a = single_min(e->along.acceleration, single_sqrt(feed * j));

    return a > 0.0f ? 0.5f * (feed / a + a / j) : 0.0f;
}

/* Goes along the pieces from a rate on; returns the time for them. */
static float go(const struct worth_window *now, float from, struct passed *last)
{
    const struct worth_pace *pace = &now->work->pace;
    const struct window *w = &now->of->window;
    uint32_t next = next_rest(now, w->element[0]);
    float time = now->begin_s;

    find_pace(now, from);
    *last = (struct passed){.element = next, .rate = pace->at[now->kept]};
    if (now->pieces > 0) {
        last->stop = pace->at[0] * (float)w->interval_s / pace->change[0];
    }
    for (unsigned i = 0; i < now->pieces; i++) {
        const float takes = 2.0f * (float)w->interval_s / (pace->at[i] + pace->at[i + 1]);

        time += takes;
        last->kept = i < now->kept ? time : last->kept;
        while (next < now->of->route.count &&
               route_element(&now->of->route, next)->start_mm <= w->at_mm[i + 2]) {
            last->element = next;
            last->time = time;
            next = next_rest(now, next);
        }
    }
    return time;
}

/*
 * What a part of a way from rest to rest takes: half of what getting going and braking take longer
 * than its feed, r, and its way at that; before the feed is reached sqrt(2 x r), x the way at the
 * feed. all: what all of it takes; cruise: at its feed.
 */
static float time_of_part(float all, float cruise, float part)
{
    const float at_feed =
        single_max(cruise, 0.5f * all); /* half the time where it is not reached */
    const float ramps = all - at_feed;
    const float x = single_min(part, 1.0f - part) * at_feed;
    const float time = 2.0f * x < ramps ? single_sqrt(2.0f * x * ramps) : x + 0.5f * ramps;

    return part > 0.5f ? all - time : time;
}

/* The last rest of the path at or before the start of an element and behind first; else first. */
static uint32_t rest_before(const struct worth_window *now, uint32_t element, uint32_t first)
{
    while (element > first && !takt_exact_rests(&now->of->route, &now->of->limits, element)) {
        element--;
    }
    return element;
}

/* From rest at the start of an element to that of another. */
static float time_between(const struct worth_window *now, uint32_t from, uint32_t to)
{
    return takt_exact_time(&now->of->route, &now->of->limits, 0.0, from, to, &now->work->exact);
}

/*
 * From rest at the start of an element to a place: of the way between two rests a part.
 */
static float path_time(const struct worth_window *now, uint32_t first, double at_mm)
{
    const struct route *r = &now->of->route;
    const uint32_t found = takt_route_find(r, at_mm, now->of->window.element[now->pieces + 1]);
    const uint32_t last = found > first ? found : first;
    const uint32_t from = rest_before(now, last, first);
    const uint32_t to = next_rest(now, last);
    const double start_mm = route_element(r, from)->start_mm;
    const float cruise = takt_route_time(r, from, start_mm, route_end_of(r, to - 1));

    TAKT_ASSERT(from >= first && to > last && cruise > 0.0f);
    return (from > first ? time_between(now, first, from) : 0.0f) +
           time_of_part(time_between(now, from, to), cruise,
                        takt_route_time(r, from, start_mm, at_mm) / cruise);
}

/*
 * A curve takes up to so many times what its pieces seem to take: of 1,200 random programs most are
 * within it.
 */
#define LONGER 1.04f

static float path_time_of_all(const struct worth_window *now)
{
    return takt_exact_time(&now->of->route, &now->of->limits, now->of->window.at_mm[0],
                           now->of->window.element[0], now->of->route.count, &now->work->exact);
}

/*
 * How long a curve takes on all of the path that is known, if it takes so many times as long as
 * that.
 */
static float time_of_all(const struct worth_window *now, float times)
{
    return (smooth_is_finished(now->of) ? 2.0f : 1.0f) * rest_s(now) +
           times * path_time_of_all(now);
}

void takt_worth_run(const struct worth_window *now, float rate, struct worth_run *run)
{
    struct passed last;

    TAKT_ASSERT(now->pieces > 0 && now->kept <= now->pieces);
    run->time_s = go(now, rate, &last);
    run->kept_s = last.kept;
    run->rate = last.rate;
}

/*
 * What the path on all that is known is slower than its feed, but where it begins and ends: on what
 * is not known yet, where it has no rest, a curve gains no more.
 */
static float slower_than_feed(const struct worth_window *now, float path_s)
{
    const struct route *r = &now->of->route;
    const struct window *w = &now->of->window;
    const uint32_t last = r->count - 1;
    const float cruise = takt_route_time(r, w->element[0], w->at_mm[0], takt_route_end(r));

    return path_s - cruise - ramp(now, w->element[0], route_element(r, w->element[0])->feed_mm_s) -
           ramp(now, last, route_element(r, last)->feed_mm_s);
}

bool takt_worth_path_from_rest(const struct worth_window *now, const struct worth_far *curve,
                               double *to_mm)
{
    const struct route *r = &now->of->route;
    const double end_mm = takt_route_end(r);
    const bool whole = curve->to_mm >= end_mm && smooth_is_finished(now->of);
    const float times = (curve->time_s - rest_s(now)) /
                        path_time(now, now->of->window.element[0], maths_min(curve->to_mm, end_mm));
    struct passed last;

    (void)go(now, 1.0f, &last);
    *to_mm = last.element == r->count ? end_mm : route_element(r, last.element)->start_mm;
    if (smooth_is_finished(now->of) || last.time > 0.0f) {
        return path_time_of_all(now) < time_of_all(now, whole ? times : LONGER * times);
    }
    const float path_s = path_time_of_all(now);
    const float gain = single_max(0.0f, slower_than_feed(now, path_s));

    return times > 1.0f || path_s + gain < time_of_all(now, times);
}

/*
 * To change over the curve must first come to rest, and the path get going from there. Of the
 * stretch's time before the window what is not known counts as none: the curve seems the quicker.
 */
bool takt_worth_path(const struct worth_window *now, struct worth_since *since)
{
    const struct window *w = &now->of->window;
    const float feed = (float)((w->at_mm[2] - w->at_mm[1]) / w->interval_s);
    const uint32_t first = rest_before(now, w->element[1], now->of->route.first);
    struct passed last;
    const float time = go(now, since->rate, &last);

    if (first != since->element) {
        *since = (struct worth_since){.element = first};
    }
    const float spent = since->spent_s;
    const float change = rest_s(now) + last.stop + ramp(now, w->element[1], feed);

    since->rate = last.rate;
    since->spent_s += last.kept;
    return path_time(now, first, w->at_mm[now->pieces + 1]) + change < spent + time;
}

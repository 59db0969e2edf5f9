#include "smooth/worth.h"

#include "smooth/exact.h"
#include "smooth/single.h"

/* Time of a piece at its rate, s. */
static float piece_time(const struct worth_window *now, unsigned piece)
{
    const struct window *w = now->window;
    struct verifier_need need;
    struct verifier_rate rate;

    takt_verifier_need(w, now->route, piece, &need);
    takt_verifier_rate(&need, now->route, now->route->first + w->paced[piece], now->change, &rate);
    return (float)w->interval_s / single_min(1.0f, single_min(rate.most, rate.programmed));
}

/* The place where the path rests first behind the start of an element, or its end: index of an element. */
static uint32_t next_rest(const struct worth_window *now, uint32_t element)
{
    uint32_t i = element + 1;

    while (i < now->route->count && !takt_exact_rests(now->route, now->machine, i)) {
        i++;
    }
    return i;
}

/* A rest that the curve has passed: the start of an element, when, and how fast; and when those that are kept end. */
struct passed {
    uint32_t element;
    float time;
    float feed;
    float kept;
};

/* v/2a + w a/2j, a^2 <= v j/w: what a ramp from rest takes longer than its way at the feed. */
static float ramp(const struct worth_window *now, uint32_t element, float feed)
{
    const struct route_element *e = route_element(now->route, element);
    const float j = e->along.jerk / (float)now->machine->windows;
    const float a = single_min(e->along.acceleration, single_sqrt(feed * j));

    return a > 0.0f ? 0.5f * (feed / a + a / j) : 0.0f;
}

/* Goes along the pieces; returns the time for them. */
static float go(const struct worth_window *now, struct passed *last)
{
    const struct window *w = now->window;
    uint32_t next = next_rest(now, w->element[0]);
    float time = now->starts ? now->standing_s : 0.0f;

    *last = (struct passed){.element = next};
    for (unsigned i = 0; i < now->pieces; i++) {
        const float takes = piece_time(now, i);

        time += takes;
        last->kept = i < now->kept ? time : last->kept;
        while (next < now->route->count &&
               route_element(now->route, next)->start_mm <= w->at_mm[i + 2]) {
            last->element = next;
            last->time = time;
            last->feed = (float)(w->at_mm[i + 2] - w->at_mm[i + 1]) / takes;
            next = next_rest(now, next);
        }
    }
    return time;
}

/* Time of a stretch at its nominal feed: neither a curve nor the path is quicker. */
static float time_between(const struct worth_window *now, uint32_t element, double from_mm,
                          double to_mm)
{
    const struct route *r = now->route;
    float time = 0.0f;

    for (uint32_t i = element; i < r->count && from_mm < to_mm; i++) {
        const double end_mm = maths_min(route_end_of(r, i), to_mm);

        time += (float)(maths_max(end_mm, from_mm) - from_mm) / route_element(r, i)->feed_mm_s;
        from_mm = maths_max(end_mm, from_mm);
    }
    return time;
}

/* What the path takes to where the pieces end, all of it at nominal feed but for getting going. */
static float time_to(const struct worth_window *now)
{
    const struct route_element *e = route_element(now->route, now->window->element[0]);

    return time_between(now, now->window->element[0], now->window->at_mm[0],
                        now->window->at_mm[now->pieces + 1]) +
           ramp(now, now->window->element[0], e->feed_mm_s);
}

/* What all rests ahead cost it, beyond that. */
static float time_of_rests(const struct worth_window *now)
{
    uint32_t rest = next_rest(now, now->window->element[0]);
    float time = 0.0f;

    while (rest < now->route->count) {
        time += ramp(now, rest - 1, route_element(now->route, rest - 1)->feed_mm_s) +
                ramp(now, rest, route_element(now->route, rest)->feed_mm_s);
        rest = next_rest(now, rest);
    }
    return time;
}

bool takt_worth_path_from_rest(const struct worth_window *now, double *to_mm)
{
    const struct window *w = now->window;
    const struct route *r = now->route;
    const double at_mm = w->at_mm[0];
    struct passed last;
    const float time = go(now, &last);

    *to_mm = takt_route_end(r);
    if (now->finished &&
        takt_exact_time(r, now->machine, at_mm, w->element[0], r->count) <
            time + now->standing_s +
                time_between(now, w->element[now->pieces + 1], w->at_mm[now->pieces + 1], *to_mm)) {
        return true;
    }
    *to_mm = last.element < r->count ? route_element(r, last.element)->start_mm : *to_mm;
    if (last.time > 0.0f) {
        return takt_exact_time(r, now->machine, at_mm, w->element[0], last.element) <
               last.time - ramp(now, last.element, last.feed);
    }
    const float gained = now->finished ? time_of_rests(now) - now->standing_s : now->standing_s;

    return time_to(now) + gained < time ||
           takt_exact_time(r, now->machine, at_mm, w->element[0], last.element) < time;
}

/* From rest at the start of an element to where the pieces end, of the last element a part. */
static float path_time(const struct worth_window *now, uint32_t first)
{
    const struct route *r = now->route;
    const double at_mm = now->window->at_mm[now->pieces + 1];
    const uint32_t last = takt_route_find(r, at_mm, now->window->element[now->pieces + 1]);
    const double start_mm = route_element(r, last)->start_mm;
    const double part = (at_mm - start_mm) / (route_end_of(r, last) - start_mm);

    return takt_exact_time(r, now->machine, 0.0, first, last) +
           (float)part * takt_exact_time(r, now->machine, 0.0, last, last + 1);
}

/* To change over the curve must first come to rest, and the path get going from there. Where a stretch begins nothing can be told. */
bool takt_worth_path(const struct worth_window *now, struct worth_since *since)
{
    const struct window *w = now->window;
    const float feed = (float)((w->at_mm[2] - w->at_mm[1]) / w->interval_s);
    const float change = now->standing_s + 2.0f * ramp(now, w->element[1], feed);
    uint32_t first = w->element[1];
    struct passed last;
    const float time = go(now, &last);

    while (first > now->route->first && !takt_exact_rests(now->route, now->machine, first)) {
        first--;
    }
    if (first != since->element) {
        *since = (struct worth_since){.element = first};
    }
    const float spent = since->spent_s;

    since->spent_s += last.kept;
    return spent > 0.0f && path_time(now, first) + change < spent + time;
}

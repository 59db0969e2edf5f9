/*
 * Goal: how long the exact path takes, without making it.
 *
 * Between two junctions that slow it down its feed squared is, at each element's start, what the
 * ends and all feeds allow, backwards and then forwards: u = min(c^2, u_next + 2 a L), as in
 * plan/span.c. That is a polygon of feed over time, which a moving average of the window W rounds:
 * both ends, and every change of feed on the way, come half a window before or behind.
 */
#include "smooth/exact_time.h"

#include "base/assert.h"
#include "smooth/exact_course.h"
#include "smooth/single.h"

bool takt_exact_rests(const struct route *r, const struct smooth_limits *machine, uint32_t index)
{
    struct course before = takt_course_of(r, machine, 0.0, index - 1);
    struct course after = takt_course_of(r, machine, 0.0, index);

    return takt_course_join(r, machine, index, &before, &after).feed == 0.0f;
}

/* Elements between two junctions that slow it down, and the feeds there. */
struct span {
    unsigned count;
    float start, stop;
};

static void add(struct exact_work *work, struct span *s, const struct course *c, float budget)
{
    struct exact_leg *leg = &work->leg[s->count++];
    const struct braking_limits l = takt_course_ramps(c, budget);

    *leg = (struct exact_leg){c->length, course_feed(c, budget), l.acceleration, l.jerk};
}

/* Ramps by a window of so many seconds: a = J N. */
static float ramp_of(const struct exact_leg *leg, float box)
{
    return single_min(leg->acceleration, leg->jerk * box);
}

/* v^2 where elements begin, backwards: what the end and all feeds allow. */
static void find_squares(struct exact_work *work, const struct span *s, float box)
{
    float next = s->stop * s->stop;

    for (unsigned k = s->count; k > 0; k--) {
        const struct exact_leg *leg = &work->leg[k - 1];
        const float top = leg->feed * leg->feed;

        work->square[k] = single_min(next, top);
        next = single_min(top, work->square[k] + 2.0f * ramp_of(leg, box) * leg->length);
    }
    work->square[0] = single_min(next, s->start * s->start);
}

/* Where the feed of a span is highest, and how far it is kept. */
struct crest {
    float feed;
    float ramp;
    float length;
};

/* Along an element, from v^2 to v^2: ramps of a, and between them its feed. */
static float time_along(const struct exact_leg *leg, float a, float from, float to,
                        struct crest *crest)
{
    const float v = single_min(leg->feed, single_sqrt(0.5f * (from + to) + a * leg->length));
    const float kept = single_max(0.0f, leg->length - (2.0f * v * v - from - to) / (2.0f * a));

    if (v > crest->feed) {
        *crest = (struct crest){.feed = v, .ramp = a};
    }
    crest->length += v == crest->feed ? kept : 0.0f;
    return (2.0f * v - single_sqrt(from) - single_sqrt(to)) / a + kept / v;
}

/*
 * The highest feed is kept for a window or is lower, q: W q = l + (p^2 - q^2)/a (plan/span.c). What
 * that takes longer.
 */
static float time_of_crest(const struct crest *c, float window)
{
    const float half = 0.5f * window;
    const float most = (c->length + c->feed * c->feed / c->ramp) / c->ramp;
    const float feed = c->ramp * (single_sqrt(half * half + most) - half);

    return single_max(0.0f, window - 2.0f * (c->feed - feed) / c->ramp - c->length / c->feed);
}

/* The part of half a window that a change between two feeds takes. */
static float felt(float a, float b)
{
    return 1.0f - single_min(a, b) / single_max(a, b);
}

static float felt_of_all(const struct exact_work *work, const struct span *s, float top)
{
    float sum = 0.0f;
    float before = s->start;

    for (unsigned k = 0; k < s->count; k++) {
        const float feed = single_min(work->leg[k].feed, top);

        sum += felt(before, feed);
        before = feed;
    }
    return sum + felt(before, s->stop);
}

static float time_with(struct exact_work *work, const struct smooth_limits *machine,
                       const struct span *s, float box)
{
    const float window = (float)machine->windows * box;
    struct crest crest = {0.0f, 0.0f, 0.0f};
    float time = 0.0f;

    find_squares(work, s, box);
    for (unsigned k = 0; k < s->count; k++) {
        const struct exact_leg *leg = &work->leg[k];
        const float a = ramp_of(leg, box);

        work->square[k + 1] =
            single_min(work->square[k + 1], work->square[k] + 2.0f * a * leg->length);
        time += time_along(leg, a, work->square[k], work->square[k + 1], &crest);
    }
    return time + time_of_crest(&crest, window) + 0.5f * window * felt_of_all(work, s, crest.feed);
}

/*
 * The best acceleration for ramps by a law of w windows, from rest to rest: of v/a + w a/j it is
 * sqrt(v j/w); where the feed is not reached four windows take the least, 2 a W^2 = L:
 * cbrt(L (j/w)^2/2). The second is less than the first where it is not, L < 2 v W.
 */
static float box_of(const struct exact_leg *leg, const struct smooth_limits *machine)
{
    const float j = leg->jerk / (float)machine->windows;
    const float full = single_sqrt(leg->feed * j);
    const float low = takt_single_cbrt(0.5f * leg->length * j * j);

    return single_min(leg->acceleration, single_min(full, low)) / leg->jerk;
}

/* All elements as one: of the highest feed, and the lowest limits. */
static struct exact_leg whole_of(const struct exact_work *work, const struct span *s)
{
    struct exact_leg all = work->leg[0];

    for (unsigned k = 1; k < s->count; k++) {
        const struct exact_leg *leg = &work->leg[k];

        all.length += leg->length;
        all.feed = single_max(all.feed, leg->feed);
        all.acceleration = single_min(all.acceleration, leg->acceleration);
        all.jerk = single_min(all.jerk, leg->jerk);
    }
    return all;
}

/* With windows that suit all of them, the first one, or the last one. */
static float least_time(struct exact_work *work, const struct smooth_limits *machine,
                        const struct span *s)
{
    const struct exact_leg all = whole_of(work, s);
    const struct exact_leg *const suited[3] = {&all, &work->leg[0], &work->leg[s->count - 1]};
    const unsigned tried = s->count == 1 ? 1 : 3;
    float least = SINGLE_INFINITY;

    for (unsigned i = 0; i < tried && all.length > 0.0f; i++) {
        least = single_min(least, time_with(work, machine, s, box_of(suited[i], machine)));
    }
    return all.length > 0.0f ? least : 0.0f;
}

float takt_exact_time(const struct route *r, const struct smooth_limits *machine, double at_mm,
                      uint32_t element, uint32_t end, struct exact_work *work)
{
    struct span s = {.count = 0};
    struct course_joint start = {0.0f, 0.0f};
    float time = 0.0f;

    TAKT_ASSERT(element < end && end - element <= SMOOTH_ELEMENTS_MAX);
    while (element + 1 < end && route_end_of(r, element) - at_mm < CURVE_LENGTH_MIN_MM) {
        element++; /* at its end: what rests at a corner is on the element before */
    }
    struct course before = takt_course_of(r, machine, at_mm, element);

    for (uint32_t i = element + 1; i < end; i++) {
        struct course after = takt_course_of(r, machine, 0.0, i);
        const struct course_joint at = takt_course_join(r, machine, i, &before, &after);

        add(work, &s, &before, single_max(start.budget, at.budget));
        if (!course_goes_on(&at, &before, &after)) {
            s.stop = at.feed;
            time += least_time(work, machine, &s);
            s = (struct span){.start = at.feed};
        }
        start = at;
        before = after;
    }
    add(work, &s, &before, start.budget);
    return time + least_time(work, machine, &s);
}

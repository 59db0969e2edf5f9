#include "smooth/exact.h"

#include "smooth/single.h"

/* What plan leaves to joints that are passed: parts of jerk and of acceleration (plan/block.h, joint.c). */
#define JOINT_JERK         0.5f
#define JOINT_ACCELERATION 0.1f

/* A joint is no joint below so many times jerk x cycle^2: the axes rest; and so many cycles belong to one. */
#define LEAST_CYCLES 4.0f
#define APART_CYCLES 6.0f

/* Of jerk that an arc at constant feed may take; for ramps on it, across and along (plan/block.c). */
#define ARC_JERK    0.5f
#define RAMP_NORMAL 0.6f
#define RAMP_ALONG  0.8f

/* A bent element that is no arc is gone along in lines that leave it by this part of the tolerance. */
#define STRAIGHT_PART 0.02f

/* What bounds the exact path on an element: mm of route and s. */
struct course {
    float length;
    float feed;
    float acceleration;
    float jerk;
};

/* Of a line: what each axis leaves along it. */
static void bound_line(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                       struct course *c)
{
    float d[AXIS_COUNT];

    (void)route_direction(r, index, route_element(r, index)->start_mm, d);
    c->acceleration = SINGLE_INFINITY;
    c->jerk = SINGLE_INFINITY;
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float part = single_abs(d[i]) / r->slots.weight[i];

        if (part > 0.0f) {
            c->acceleration =
                single_min(c->acceleration, (float)machine->acceleration_mm_s2[axis] / part);
            c->jerk = single_min(c->jerk, (float)machine->jerk_mm_s3[axis] / part);
        }
    }
}

/* 3 v a / R <= RAMP_NORMAL J and j + v^3 / R^2 <= RAMP_ALONG J, v^3 / R^2 <= ARC_JERK J. */
static void bound_bent(const struct route *r, uint32_t index, struct course *c)
{
    const struct route_element *e = route_element(r, index);
    float k[AXIS_COUNT];
    const float radius = 1.0f / route_curvature(r, index, e->start_mm, k);

    c->jerk = e->along.jerk;
    c->feed = single_min(c->feed, single_cbrt(ARC_JERK * c->jerk * radius * radius));
    c->acceleration =
        single_min(e->along.acceleration, RAMP_NORMAL * c->jerk * radius / (3.0f * c->feed));
    c->jerk = RAMP_ALONG * c->jerk - c->feed * c->feed * c->feed / (radius * radius);
}

static struct course course_of(const struct route *r, const struct smooth_limits *machine,
                               double from_mm, uint32_t index)
{
    const struct route_element *e = route_element(r, index);
    struct course c = {.length = (float)(route_end_of(r, index) - maths_max(from_mm, e->start_mm)),
                       .feed = e->feed_mm_s};

    if (e->bent) {
        bound_bent(r, index, &c);
    } else {
        bound_line(r, machine, index, &c);
    }
    return c;
}

/* The highest feed at a joint: D v / cycle^2 + 3/4 K v^2 / cycle within a part of J, D v / cycle of A (plan/joint.c). */
static float alone_feed(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                        float reach)
{
    const float cycle = (float)machine->cycle_s;
    float d[2][AXIS_COUNT];
    float k[2][AXIS_COUNT];
    float feed = SINGLE_INFINITY;

    route_corner(r, index, d[0], d[1]);
    (void)route_curvature(r, index - 1, route_element(r, index)->start_mm, k[0]);
    (void)route_curvature(r, index, route_element(r, index)->start_mm, k[1]);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float turn = single_abs(d[1][i] - d[0][i]) / r->slots.weight[i];
        const float bend = single_abs(k[1][i] - k[0][i]) / r->slots.weight[i];
        const float j = JOINT_JERK * (float)machine->jerk_mm_s3[axis] * cycle;
        const float a = JOINT_ACCELERATION * (float)machine->acceleration_mm_s2[axis] * cycle;

        if (turn > 0.0f) {
            const float most = single_min(j * cycle, a) / turn;

            feed = single_min(feed, most > reach ? single_sqrt(most * reach) : most);
        }
        if (bend > 0.0f) {
            feed = single_min(feed, single_sqrt(j / (0.75f * bend)));
        }
    }
    return feed;
}

/* 0: the axes rest. */
static float joint_feed(const struct route *r, const struct smooth_limits *machine, uint32_t index)
{
    const struct course before = course_of(r, machine, 0.0, index - 1);
    const struct course after = course_of(r, machine, 0.0, index);
    const float cycle = (float)machine->cycle_s;
    const float reach = single_min(before.length, after.length) / (APART_CYCLES * cycle);
    const float feed = alone_feed(r, machine, index, reach);

    return feed < LEAST_CYCLES * before.jerk * cycle * cycle ? 0.0f : feed;
}

bool exact_rests(const struct route *r, const struct smooth_limits *machine, uint32_t index)
{
    return joint_feed(r, machine, index) == 0.0f;
}

/* Elements between two joints that are not passed at full feed, and the feeds there. */
struct span {
    uint32_t first, end;
    double from_mm;
    float start, stop;
    float length;
    float feed; /* the highest */
    float acceleration, jerk;
};

/* Time of a ramp from one feed to another beyond what its way takes at the higher one. */
static float lost(float low, float high, float a)
{
    const float change = single_max(0.0f, high - low);

    return change * change / (2.0f * a * high);
}

/*
 * With ramps of acceleration a, rounded over a window of cycles of a/J, times what the law makes of it: the window is lost
 * once, but for what is gone in it at both ends (plan/span.c).
 */
static float time_with(const struct route *r, const struct smooth_limits *machine,
                       const struct span *s, float a)
{
    const float peak =
        single_sqrt(a * s->length + 0.5f * (s->start * s->start + s->stop * s->stop));
    float time = 0.0f;
    float first = 0.0f;
    float last = 0.0f;

    for (uint32_t i = s->first; i < s->end; i++) {
        const struct course c = course_of(r, machine, s->from_mm, i);

        last = single_min(c.feed, peak);
        first = i == s->first ? last : first;
        time += c.length / last;
    }
    const float window = (float)machine->windows * a / s->jerk;

    return time + lost(s->start, first, a) + lost(s->stop, last, a) +
           window * (1.0f - 0.5f * (s->start / first + s->stop / last));
}

/*
 * The best acceleration for ramps by a law of w windows, from rest to rest: of v/a + w a/j it is sqrt(v j/w), and of
 * 2 sqrt(L/a) + w a/j, where the feed is not reached, cbrt(L (j/w)^2).
 */
static float least_time(const struct route *r, const struct smooth_limits *machine,
                        const struct span *s)
{
    const float j = s->jerk / (float)machine->windows;
    const float full = single_min(s->acceleration, single_sqrt(s->feed * j));
    const float low = single_min(s->acceleration, single_cbrt(s->length * j * j));

    return single_min(time_with(r, machine, s, full), time_with(r, machine, s, low));
}

/* The elements from the first one on to the next joint that is not passed at full feed. */
static void find_span(const struct route *r, const struct smooth_limits *machine, uint32_t end,
                      struct span *s)
{
    struct course c = course_of(r, machine, s->from_mm, s->first);

    s->length = c.length;
    s->feed = c.feed;
    s->acceleration = c.acceleration;
    s->jerk = c.jerk;
    s->stop = 0.0f;
    for (s->end = s->first + 1; s->end < end; s->end++) {
        const struct course next = course_of(r, machine, 0.0, s->end);
        const float joint = joint_feed(r, machine, s->end);

        if (joint < single_min(c.feed, next.feed)) {
            s->stop = joint;
            return;
        }
        c = next;
        s->length += c.length;
        s->feed = single_max(s->feed, c.feed);
        s->acceleration = single_min(s->acceleration, c.acceleration);
        s->jerk = single_min(s->jerk, c.jerk);
    }
}

float exact_time(const struct route *r, const struct smooth_limits *machine, double at_mm,
                 uint32_t element, uint32_t end)
{
    struct span s = {.first = element, .from_mm = at_mm};
    float time = 0.0f;

    while (s.first < end) {
        find_span(r, machine, end, &s);
        time += s.length > 0.0f ? least_time(r, machine, &s) : 0.0f;
        s.first = s.end;
        s.start = s.stop;
    }
    return time;
}

/* As far as the element is straight, if it is no arc; of an arc to where the axes stand beside it. */
static double line_end(const struct window *w, const struct route *r, bool arc)
{
    const uint32_t e = w->element[0];
    const double at = w->at_mm[0];
    const float straight = route_straight(r, e, at, STRAIGHT_PART * (float)r->tolerance_mm);

    return arc ? at : maths_min(route_end_of(r, e), at + (double)straight);
}

bool exact_next(struct window *w, const struct route *r, struct move *move, struct curve *curve)
{
    const uint32_t element = w->element[0];
    const bool arc = route_arc(r, element, w->at_mm[0], move);
    double to_mm = line_end(w, r, arc);
    struct point start;
    double p[AXIS_COUNT];

    window_sample(w, r, 0, p);
    route_scatter(r, p, &start);
    route_place(r, element, to_mm, p);
    route_scatter(r, p, &move->end);
    bool goes = curve_set_line(curve, &start, &move->end);

    if (goes) {
        move->kind = move->kind == MOVE_RAPID ? MOVE_RAPID : MOVE_FEED;
    } else if (arc) {
        to_mm = route_end_of(r, element);
        route_place(r, element, to_mm, p);
        route_scatter(r, p, &move->end);
        goes = move_curve(move, &start, curve);
    }
    window_stand(w, r, p, to_mm, element);
    return goes;
}

#include "smooth/exact.h"

#include "base/assert.h"
#include "smooth/exact_parts.h"
#include "smooth/route_curved.h"
#include "smooth/single.h"

/* In single precision. */
static const float junction_share = (float)BLOCK_JERK_BUDGET_MAX;
static const float junction_acceleration = (float)JUNCTION_ACCELERATION;
static const float arc_acceleration = (float)ARC_ACCELERATION;
static const float arc_jerk = (float)ARC_JERK;
static const float ramp_normal = (float)RAMP_NORMAL;
static const float ramp_along = (float)RAMP_ALONG;
static const float cycles_apart = (float)JUNCTION_CYCLES_APART;
static const float least_cycles = (float)JUNCTION_LEAST_CYCLES;
static const float worth = (float)JUNCTION_WORTH;

/*
 * A curved element that is no arc is gone along in lines that leave it by this part of the
 * tolerance.
 */
#define STRAIGHT_PART 0.02f

/* What bounds the exact path on an element: mm of route and s. */
struct course {
    float length;
    float feed;
    float acceleration;
    float jerk;
};

/* Bounds on a line: what each axis leaves along it. */
static void bound_line(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                       struct course *c)
{
    float d[AXIS_COUNT];

    (void)takt_route_direction(r, index, route_element(r, index)->start_mm, d);
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

/*
 * The highest feed at a junction: D v / cycle^2 + 3/4 K v^2 / cycle within a part of J, D v / cycle
 * of A, |D| v cycle / 4 over X, Y and Z within the largest chord error; beside blocks shorter than
 * some cycles at v less, v^2 up to that times reach (plan/junction.c).
 */
static float alone_feed(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                        float reach)
{
    const float cycle = (float)machine->cycle_s;
    float d[2][AXIS_COUNT];
    float k[2][AXIS_COUNT];
    float feed = SINGLE_INFINITY;
    float curved = SINGLE_INFINITY;
    float square = 0.0f;

    takt_route_corner(r, index, d[0], d[1]);
    (void)takt_route_curvature(r, index - 1, route_element(r, index)->start_mm, k[0]);
    (void)takt_route_curvature(r, index, route_element(r, index)->start_mm, k[1]);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float turn = single_abs(d[1][i] - d[0][i]) / r->slots.weight[i];
        const float jump = single_abs(k[1][i] - k[0][i]) / r->slots.weight[i];
        const float j = junction_share * (float)machine->jerk_mm_s3[axis] * cycle;
        const float a = junction_acceleration * (float)machine->acceleration_mm_s2[axis] * cycle;

        square += axis < AXIS_LINEAR_COUNT ? turn * turn : 0.0f;
        if (turn > 0.0f) {
            const float most = single_min(j * cycle, a) / turn;

            feed = single_min(feed, most);
        }
        if (jump > 0.0f) {
            curved = single_min(curved, single_sqrt(j / ((float)JUNCTION_CURVATURE * jump)));
        }
    }
    if (square > 0.0f) {
        feed = single_min(feed, 4.0f * (float)machine->chord_error_max_mm /
                                    (cycle * single_sqrt(square)));
    }
    feed = feed > reach ? single_sqrt(feed * reach) : feed;
    return single_min(feed, curved);
}

static float length_of(const struct route *r, uint32_t index)
{
    return (float)(route_end_of(r, index) - route_element(r, index)->start_mm);
}

/*
 * May the junction at the start of an element be passed, and take of the jerk beside it? What came
 * before may be forgotten.
 */
static bool may_pass(const struct route *r, const struct smooth_limits *machine, uint32_t index)
{
    const float cycle = (float)machine->cycle_s;

    if (index == 0 || index == r->count) {
        return false;
    }
    if (index == r->first) {
        return true;
    }
    const float shorter = single_min(length_of(r, index - 1), length_of(r, index));
    const float jerk = route_element(r, index - 1)->along.jerk;

    return alone_feed(r, machine, index, shorter / (cycles_apart * cycle)) >=
           least_cycles * jerk * cycle * cycle;
}

/* What a curved element leaves in any direction, and how much of a circle it is. */
struct arc_limits {
    float jerk;
    float acceleration;
    float radius;
};

/*
 * What axes allow along a curved element: those in its plane may be along it, of others their part.
 */
static float along_curved(const struct route *r, const double limit[], uint32_t index,
                          const float k[])
{
    float d[AXIS_COUNT];
    float most = SINGLE_INFINITY;

    (void)takt_route_direction(r, index, route_element(r, index)->start_mm, d);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const float part = k[i] != 0.0f ? 1.0f : single_abs(d[i]);
        const float all = r->slots.weight[i] * (float)limit[r->slots.axis[i]];

        most = part > 0.0f ? single_min(most, all / part) : most;
    }
    return most;
}

/* a^2 + (v^2 / R)^2 <= A^2, 3 v a / R <= RAMP_NORMAL J and j + v^3 / R^2 <= RAMP_ALONG J. */
static void bound_ramps(const struct arc_limits *b, struct course *c)
{
    const float normal = c->feed * c->feed / b->radius;
    const float square = b->acceleration * b->acceleration - normal * normal;

    c->acceleration = single_min(single_sqrt(single_max(0.0f, square)),
                                 ramp_normal * b->jerk * b->radius / (3.0f * c->feed));
    c->jerk = ramp_along * b->jerk - c->feed * normal / b->radius;
}

/* v = 2/cycle sqrt(d (2 R - d)): chords of a cycle leave a circle by d (plan/block.c). */
static float chord_feed(const struct smooth_limits *machine, float radius)
{
    const float d = (float)machine->chord_error_max_mm;

    return radius > d ? 2.0f / (float)machine->cycle_s * single_sqrt(d * (2.0f * radius - d))
                      : SINGLE_INFINITY;
}

/*
 * v^3 / R^2 <= ARC_JERK J, v^2 / R <= ARC_ACCELERATION A: of the machine's limits, which a smoothed
 * curve may not have all of.
 */
static void bound_curved(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                         struct course *c)
{
    const struct route_element *e = route_element(r, index);
    float k[AXIS_COUNT];
    const bool joined = may_pass(r, machine, index) || may_pass(r, machine, index + 1);
    const float curvature = takt_route_curvature(r, index, e->start_mm, k); /* k is used below */
    const struct arc_limits b = {.jerk = (joined ? 1.0f - junction_share : 1.0f) *
                                         along_curved(r, machine->jerk_mm_s3, index, k),
                                 .radius = 1.0f / curvature,
                                 .acceleration =
                                     along_curved(r, machine->acceleration_mm_s2, index, k)};

    c->feed = single_min(takt_route_per_mm(r, index) * e->programmed_mm_s,
                         along_curved(r, machine->velocity_mm_s, index, k));
    c->feed = single_min(c->feed, takt_single_cbrt(arc_jerk * b.jerk * b.radius * b.radius));
    c->feed = single_min(c->feed, single_sqrt(arc_acceleration * b.acceleration * b.radius));
    c->feed = single_min(c->feed, chord_feed(machine, b.radius));
    bound_ramps(&b, c);
}

static struct course course_of(const struct route *r, const struct smooth_limits *machine,
                               double from_mm, uint32_t index)
{
    const struct route_element *e = route_element(r, index);
    struct course c = {.length = (float)(route_end_of(r, index) - maths_max(from_mm, e->start_mm)),
                       .feed = e->feed_mm_s};

    if (e->curved) {
        bound_curved(r, machine, index, &c);
    } else {
        bound_line(r, machine, index, &c);
    }
    return c;
}

/*
 * Time of a ramp from one feed to another: F/A + A/J, or 2 sqrt(F/J) where full acceleration is not
 * reached.
 */
static float ramp_time(float change, float a, float j)
{
    return change * j >= a * a ? change / a + a / j : 2.0f * single_sqrt(change / j);
}

/* Does it take so much less time to pass a junction than to rest there (plan/junction.c)? */
static bool is_worth_passing(const struct course *before, const struct course *after, float feed)
{
    const float a = single_min(before->acceleration, after->acceleration);
    const float j = single_min(before->jerk, after->jerk);
    const float length = single_min(before->length, after->length);
    const float over =
        single_min(single_sqrt(2.0f * length * a), takt_single_cbrt(length * length * j));
    const float top = single_min(single_min(before->feed, after->feed), over);
    const float fall = single_max(0.0f, top - feed);

    return fall * ramp_time(fall, a, (1.0f - junction_share) * j) <=
           worth * top * ramp_time(top, a, j);
}

/* 0: the axes rest. */
static float junction_feed(const struct route *r, const struct smooth_limits *machine,
                           uint32_t index)
{
    const struct course before = course_of(r, machine, 0.0, index - 1);
    const struct course after = course_of(r, machine, 0.0, index);
    const float cycle = (float)machine->cycle_s;
    const float reach = single_min(before.length, after.length) / (cycles_apart * cycle);
    const float feed = alone_feed(r, machine, index, reach);

    return feed < least_cycles * before.jerk * cycle * cycle ||
                   !is_worth_passing(&before, &after, feed)
               ? 0.0f
               : feed;
}

bool takt_exact_rests(const struct route *r, const struct smooth_limits *machine, uint32_t index)
{
    return junction_feed(r, machine, index) == 0.0f;
}

/* Elements between two junctions that are not passed at full feed, and the feeds there. */
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
 * The feed of an element beside a junction is that of the junction if it would be gone along in
 * less than some cycles, and the other one is not shorter still (plan/junction.c).
 */
static float short_feed(const struct route *r, const struct smooth_limits *machine,
                        const struct span *s, uint32_t index)
{
    const float first = index == s->first && s->start > 0.0f ? s->start : SINGLE_INFINITY;
    const float last = index + 1 == s->end && s->stop > 0.0f ? s->stop : SINGLE_INFINITY;
    const float apart = cycles_apart * (float)machine->cycle_s;

    return single_max(single_min(first, last), length_of(r, index) / apart);
}

/*
 * With ramps of acceleration a, rounded over a window of cycles of a/J, times what the law makes of
 * it: the window is lost once, but for what is gone in it at both ends (plan/span.c).
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

        last = single_min(single_min(c.feed, peak), short_feed(r, machine, s, i));
        first = i == s->first ? last : first;
        time += c.length / last;
    }
    const float window = (float)machine->windows * a / s->jerk;

    return time + lost(s->start, first, a) + lost(s->stop, last, a) +
           window * (1.0f - 0.5f * (s->start / first + s->stop / last));
}

/*
 * The best acceleration for ramps by a law of w windows, from rest to rest: of v/a + w a/j it is
 * sqrt(v j/w), and of 2 sqrt(L/a) + w a/j, where the feed is not reached, cbrt(L (j/w)^2).
 */
static float least_time(const struct route *r, const struct smooth_limits *machine,
                        const struct span *s)
{
    const float j = s->jerk / (float)machine->windows;
    const float full = single_min(s->acceleration, single_sqrt(s->feed * j));
    const float low = single_min(s->acceleration, takt_single_cbrt(s->length * j * j));

    return single_min(time_with(r, machine, s, full), time_with(r, machine, s, low));
}

/* The elements from the first one on to the next junction that is not passed at full feed. */
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
        const float junction = junction_feed(r, machine, s->end);

        if (junction < single_min(c.feed, next.feed)) {
            s->stop = junction;
            return;
        }
        c = next;
        s->length += c.length;
        s->feed = single_max(s->feed, c.feed);
        s->acceleration = single_min(s->acceleration, c.acceleration);
        s->jerk = single_min(s->jerk, c.jerk);
    }
}

float takt_exact_time(const struct route *r, const struct smooth_limits *machine, double at_mm,
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

#include "smooth/exact_course.h"

#include "base/assert.h"
#include "smooth/exact_parts.h"
#include "smooth/route_curved.h"
#include "smooth/single.h"

/* In single precision. */
static const float budget_max = (float)BLOCK_JERK_BUDGET_MAX;
static const float acceleration_per_budget = (float)ACCELERATION_PER_JERK_BUDGET;
static const float override_max = (float)BLOCK_OVERRIDE_MAX;
static const float arc_acceleration = (float)ARC_ACCELERATION;
static const float arc_jerk = (float)ARC_JERK;
static const float ramp_normal = (float)RAMP_NORMAL;
static const float ramp_along = (float)RAMP_ALONG;
static const float junction_acceleration = (float)JUNCTION_ACCELERATION;
static const float cycles_apart = (float)JUNCTION_CYCLES_APART;
static const float least_cycles = (float)JUNCTION_LEAST_CYCLES;
static const float worth = (float)JUNCTION_WORTH;

/* Does a feed on it count what this axis moves? */
static bool counts(const struct route_element *e, unsigned axis)
{
    return e->rotary ? axis >= AXIS_LINEAR_COUNT : axis < AXIS_LINEAR_COUNT;
}

/* What an axis leaves along the path, of which it moves a part. */
static void bound_axis(const struct smooth_limits *machine, unsigned axis, float part,
                       struct course *c)
{
    c->line.acceleration =
        single_min(c->line.acceleration, (float)machine->acceleration_mm_s2[axis] / part);
    c->line.jerk = single_min(c->line.jerk, (float)machine->jerk_mm_s3[axis] / part);
}

static void bound_velocity(const struct smooth_limits *machine, unsigned axis, float part,
                           struct course *c)
{
    c->cap = single_min(c->cap, (float)machine->velocity_mm_s[axis] / part);
}

static void bound_line(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                       struct course *c)
{
    const struct route_element *e = route_element(r, index);
    float d[AXIS_COUNT];
    float square = 0.0f;

    (void)takt_route_direction(r, index, e->start_mm, d);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float part = single_abs(d[i]) / r->slots.weight[i];

        square += counts(e, axis) ? part * part : 0.0f;
        if (part > 0.0f) {
            bound_velocity(machine, axis, part, c);
            bound_axis(machine, axis, part, c);
        }
    }
    c->program = e->programmed_mm_s / single_sqrt(square);
}

/* v = 2/cycle sqrt(d (2 R - d)): chords of a cycle leave a circle by d (plan/block.c). */
static float chord_feed(const struct smooth_limits *machine, float radius)
{
    const float d = (float)machine->chord_error_max_mm;

    return radius > d ? 2.0f / (float)machine->cycle_s * single_sqrt(d * (2.0f * radius - d))
                      : SINGLE_INFINITY;
}

/*
 * Of an involute, which plan divides into pieces and whose curvature may be a thousandfold at an
 * end, that of its middle.
 */
static void bend(const struct curve *curve, enum axis first, enum axis second,
                 struct curve_bounds *b)
{
    struct point k;

    takt_curve_bound(curve, b);
    if (curve->kind != CURVE_INVOLUTE) {
        return;
    }
    takt_curve_curvature(curve, 0.5 * curve->length_mm, &k);
    b->second[first] = maths_sqrt(k.at[first] * k.at[first] + k.at[second] * k.at[second]);
    b->third[first] = b->second[first] * b->second[first];
    b->radius_min_mm = 1.0 / b->second[first];
    b->second_along = 0.0;
    b->third_across = 0.0;
}

/* The plane's part of it (plan/block.c). */
static void bound_plane(const struct smooth_limits *machine, const struct curve_bounds *b,
                        enum axis first, enum axis second, float per_mm, struct course *c)
{
    TAKT_ASSERT(b->second[first] > 0.0 && b->third[first] > 0.0);
    const float along = (float)(b->second_along / b->second[first]);
    const float across = (float)(b->third_across / b->third[first]);
    const float a =
        (float)maths_min(machine->acceleration_mm_s2[first], machine->acceleration_mm_s2[second]);
    const float j = (float)maths_min(machine->jerk_mm_s3[first], machine->jerk_mm_s3[second]);

    c->first = (float)b->first[first] / per_mm;
    c->second = (float)b->second[first] / (per_mm * per_mm);
    c->third = (float)b->third[first] / (per_mm * per_mm * per_mm);
    c->plane.acceleration = a / (1.0f + arc_acceleration * along);
    c->plane.jerk = j / (1.0f + ramp_normal * along + arc_jerk * across);
}

static void bound_curved(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                         struct course *c)
{
    const float per_mm = takt_route_per_mm(r, index);
    struct curve curve;
    struct curve_bounds b;
    enum axis first = AXIS_COUNT;
    enum axis second = AXIS_COUNT;

    takt_route_curve(r, index, &curve);
    (void)takt_curve_plane(&curve, &first, &second);
    bend(&curve, first, second, &b);
    c->program = per_mm * route_element(r, index)->programmed_mm_s;
    c->cap = per_mm * chord_feed(machine, (float)b.radius_min_mm);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float part = (float)b.first[axis] / per_mm;

        if (part > 0.0f) {
            bound_velocity(machine, axis, part, c);
        }
        if (part > 0.0f && axis != first && axis != second) {
            bound_axis(machine, axis, part, c);
        }
    }
    bound_plane(machine, &b, first, second, per_mm, c);
}

struct course takt_course_of(const struct route *r, const struct smooth_limits *machine,
                             double from_mm, uint32_t index)
{
    const struct route_element *e = route_element(r, index);
    struct course c = {.length = (float)(route_end_of(r, index) - maths_max(from_mm, e->start_mm)),
                       .cap = SINGLE_INFINITY,
                       .line = {SINGLE_INFINITY, SINGLE_INFINITY}};

    if (e->curved) {
        bound_curved(r, machine, index, &c);
    } else {
        bound_line(r, machine, index, &c);
    }
    return c;
}

/* What junctions leave of limits. */
static struct braking_limits left(const struct braking_limits *l, float budget)
{
    return (struct braking_limits){l->acceleration * (1.0f - acceleration_per_budget * budget),
                                   l->jerk * (1.0f - budget)};
}

/* x_ss v^2 <= ARC_ACCELERATION A, x_sss v^3 <= ARC_JERK J. */
float takt_course_top(const struct course *c, float budget)
{
    const struct braking_limits l = left(&c->plane, budget);
    const float feed = single_min(override_max * c->program, c->cap);

    if (c->first == 0.0f) {
        return feed;
    }
    return single_min(single_min(feed, single_sqrt(arc_acceleration * l.acceleration / c->second)),
                      takt_single_cbrt(arc_jerk * l.jerk / c->third));
}

/*
 * In the plane (x_s a)^2 + (x_ss v^2)^2 <= A^2, 3 x_ss v a <= RAMP_NORMAL J and
 * x_s j + x_sss v^3 <= RAMP_ALONG J.
 */
struct braking_limits takt_course_ramps(const struct course *c, float budget)
{
    const struct braking_limits line = left(&c->line, budget);
    const struct braking_limits l = left(&c->plane, budget);

    if (c->first == 0.0f) {
        return line;
    }
    const float v = takt_course_top(c, budget);
    const float normal = c->second * v * v;
    const float square = l.acceleration * l.acceleration - normal * normal;
    const float a = single_min(single_sqrt(single_max(0.0f, square)) / c->first,
                               ramp_normal * l.jerk / (3.0f * c->second * v));
    const float j = (ramp_along * l.jerk - c->third * v * v * v) / c->first;

    return (struct braking_limits){single_min(line.acceleration, a), single_min(line.jerk, j)};
}

/* -- junctions -- */

/*
 * P v + Q v^2 is what one takes of the jerk, R v of the acceleration; its chord is |D| cycle/4 v
 * long over X, Y and Z, and may be so long.
 */
struct steps {
    float p, q, r;
    float chord_s;
    float chord_mm;
};

static void measure(const struct route *r, const struct smooth_limits *machine, uint32_t index,
                    struct steps *s)
{
    const float cycle = (float)machine->cycle_s;
    float d[2][AXIS_COUNT];
    float k[2][AXIS_COUNT];
    float square = 0.0f;

    *s = (struct steps){.chord_mm = (float)machine->chord_error_max_mm};
    takt_route_corner(r, index, d[0], d[1]);
    (void)takt_route_curvature(r, index - 1, route_element(r, index)->start_mm, k[0]);
    (void)takt_route_curvature(r, index, route_element(r, index)->start_mm, k[1]);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];
        const float turn = single_abs(d[1][i] - d[0][i]) / r->slots.weight[i];
        const float jump = single_abs(k[1][i] - k[0][i]) / r->slots.weight[i];
        const float j = (float)machine->jerk_mm_s3[axis] * cycle;

        square += axis < AXIS_LINEAR_COUNT ? turn * turn : 0.0f;
        s->p = single_max(s->p, turn / (j * cycle));
        s->q = single_max(s->q, (float)JUNCTION_CURVATURE * jump / j);
        s->r = single_max(s->r, turn / ((float)machine->acceleration_mm_s2[axis] * cycle));
    }
    s->chord_s = 0.25f * single_sqrt(square) * cycle;
}

/* By itself: P v + Q v^2 <= the budget, R v <= JUNCTION_ACCELERATION. */
static float alone_feed(const struct steps *s)
{
    const float root = s->p + single_sqrt(s->p * s->p + 4.0f * s->q * budget_max);
    float v = root > 0.0f ? 2.0f * budget_max / root : SINGLE_INFINITY;

    v = s->r > 0.0f ? single_min(v, junction_acceleration / s->r) : v;
    return s->chord_s > 0.0f ? single_min(v, s->chord_mm / s->chord_s) : v;
}

/* Beside short elements the same with reach/v of the limits. */
static float crowded_feed(const struct steps *s, float reach)
{
    const float most = budget_max * reach;
    float v = s->p > 0.0f ? single_sqrt(most / s->p) : SINGLE_INFINITY;

    v = s->q > 0.0f ? single_min(v, takt_single_cbrt(most / s->q)) : v;
    v = v < SINGLE_INFINITY ? v * single_sqrt(most / (v * v * (s->p + s->q * v))) : v;
    v = s->r > 0.0f ? single_min(v, single_sqrt(junction_acceleration * reach / s->r)) : v;
    return s->chord_s > 0.0f ? single_min(v, single_sqrt(s->chord_mm * reach / s->chord_s)) : v;
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
static bool is_worth_passing(const struct smooth_limits *machine, const struct course *before,
                             const struct course *after, const struct course_joint *at, float top)
{
    const float cycle = (float)machine->cycle_s;
    const struct braking_limits b = takt_course_ramps(before, budget_max);
    const struct braking_limits c = takt_course_ramps(after, budget_max);
    const float a = single_min(b.acceleration, c.acceleration);
    const float j = single_min(b.jerk, c.jerk) / (1.0f - budget_max);
    const float length = single_min(before->length, after->length);
    const float over =
        single_min(single_sqrt(2.0f * length * a), takt_single_cbrt(length * length * j));
    const float reached = single_min(top, over);
    const float fall = single_max(0.0f, reached - at->feed);

    return at->feed >= least_cycles * b.jerk * cycle * cycle &&
           fall * ramp_time(fall, a, j * (1.0f - at->budget)) <=
               worth * reached * ramp_time(reached, a, j);
}

/* Is what follows so slow that the axes come to rest before it (plan/junction.c)? */
static bool is_too_slow(const struct smooth_limits *machine, const struct course *before,
                        const struct course *after)
{
    const float top = takt_course_top(after, 0.0f);

    return 4.0f * top < takt_course_top(before, 0.0f) &&
           16.0f * top <
               takt_course_ramps(before, budget_max).acceleration * (float)machine->cycle_s;
}

/* Does an element lose nothing by the feed of a junction beside it (plan/junction.c)? */
static bool may_keep(const struct smooth_limits *machine, const struct course *c, float v,
                     float top)
{
    const struct braking_limits l = takt_course_ramps(c, budget_max);

    if (v >= c->program) {
        return true;
    }
    if (c->length > v * ramp_time(v, l.acceleration, l.jerk)) {
        return false;
    }
    const float a = single_min(l.acceleration, single_sqrt(top * l.jerk));
    const float window = (float)machine->windows * a / l.jerk;

    return c->length <= v * (0.5f * window + ramp_time(top - v, l.acceleration, l.jerk));
}

static void cap(struct course *c, float feed)
{
    c->cap = single_min(c->cap, feed);
}

static float top_beside(const struct course *before, const struct course *after)
{
    return single_min(takt_course_top(before, 0.0f), takt_course_top(after, 0.0f));
}

/* The feed that both allow: that of the junction, if one of them loses nothing by it. */
static float meet_at(const struct smooth_limits *machine, struct course *before,
                     struct course *after, float v)
{
    const float top = top_beside(before, after);
    struct course *shorter = after->length < before->length ? after : before;
    struct course *longer = shorter == before ? after : before;

    if (v < top && may_keep(machine, shorter, v, top)) {
        cap(shorter, v);
        return v;
    }
    if (v < top && may_keep(machine, longer, v, top)) {
        cap(longer, v);
        return v;
    }
    return top;
}

/* How much of the limits it takes there, more where the elements beside it are short. */
static float budget_of(const struct steps *s, const struct course *before,
                       const struct course *after, float v, float apart)
{
    const float rate = single_max(takt_course_top(before, 0.0f) / before->length,
                                  takt_course_top(after, 0.0f) / after->length);
    const float jerk = v * (s->p + s->q * v);
    const float acceleration = s->r * v * (budget_max / junction_acceleration);

    return single_min(budget_max, single_max(jerk, acceleration) * single_max(1.0f, apart * rate));
}

struct course_joint takt_course_join(const struct route *r, const struct smooth_limits *machine,
                                     uint32_t index, struct course *before, struct course *after)
{
    const float apart = cycles_apart * (float)machine->cycle_s;
    const float shorter = single_min(before->length, after->length);
    struct steps s;

    measure(r, machine, index, &s);
    float v = alone_feed(&s);

    if (single_min(v, top_beside(before, after)) * apart > shorter) {
        v = crowded_feed(&s, shorter / apart);
    }
    const float top = meet_at(machine, before, after, v);
    const struct course_joint joint = {v, budget_of(&s, before, after, single_min(v, top), apart)};

    if (is_too_slow(machine, before, after) ||
        (v < top && !is_worth_passing(machine, before, after, &joint, top))) {
        return (struct course_joint){0.0f, 0.0f};
    }
    cap(before, single_max(v * before->length / shorter, before->length / apart));
    cap(after, single_max(v * after->length / shorter, after->length / apart));
    return joint;
}

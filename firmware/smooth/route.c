#include "smooth/route_curved.h"

#include "base/assert.h"
#include "smooth/nominal.h"
#include "smooth/single.h"

#include <string.h>

/* What is missing of a whole number of turns by rounding does not make it one more. */
#define WHOLE_TURNS (1.0 - 1e-9)

static void set_slots(struct route_slots *s, const struct smooth_limits *limits)
{
    memset(s, 0, sizeof(*s));
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        const unsigned i = s->count;

        if ((limits->axes >> axis & 1U) != 0) {
            s->axis[i] = (unsigned char)axis;
            s->weight[i] = (float)smooth_weight(axis);
            s->velocity_mm_s[i] = (float)limits->velocity_mm_s[axis];
            s->acceleration_mm_s2[i] = (float)limits->acceleration_mm_s2[axis];
            s->jerk_mm_s3[i] = (float)limits->jerk_mm_s3[axis];
            s->count++;
        }
    }
    TAKT_ASSERT(s->count > 0);
    s->groups = (s->count + SMOOTH_LANES - 1) / SMOOTH_LANES;
}

void takt_route_init(struct route *r, const struct smooth_limits *limits, double tolerance_mm)
{
    set_slots(&r->slots, limits);
    r->tolerance_mm = tolerance_mm;
    r->moved = 0;
    r->part = 1.0f;
    r->first = 0;
    r->count = 0;
    r->curved_first = 0;
    r->curved_count = 0;
    r->capacity = r->slots.count > 3 ? SMOOTH_ELEMENTS_MAX / 2 : SMOOTH_ELEMENTS_MAX;
    for (unsigned i = 0; i < SMOOTH_MODES_MAX; i++) {
        r->mode[i].used = 0;
    }
}

static bool has_free_mode(const struct route *r)
{
    for (unsigned i = 0; i < SMOOTH_MODES_MAX; i++) {
        if (r->mode[i].used == 0) {
            return true;
        }
    }
    return false;
}

bool takt_route_has_room(const struct route *r)
{
    return r->count - r->first < r->capacity &&
           r->curved_count - r->curved_first < SMOOTH_CURVED_MAX && has_free_mode(r);
}

double takt_route_end(const struct route *r)
{
    return r->count == 0 ? 0.0 : r->end_mm;
}

float takt_route_time(const struct route *r, uint32_t element, double from_mm, double to_mm)
{
    float time = 0.0f;

    for (uint32_t i = element; i < r->count && from_mm < to_mm; i++) {
        const double end_mm = maths_min(route_end_of(r, i), to_mm);

        time += (float)(maths_max(end_mm, from_mm) - from_mm) / route_element(r, i)->feed_mm_s;
        from_mm = maths_max(end_mm, from_mm);
    }
    return time;
}

void takt_route_gather(const struct route *r, const struct point *p, double by_slot[])
{
    for (unsigned i = 0; i < r->slots.count; i++) {
        by_slot[i] = p->at[r->slots.axis[i]];
    }
}

void takt_route_scatter(const struct route *r, const double by_slot[], struct point *p)
{
    memset(p, 0, sizeof(*p));
    for (unsigned i = 0; i < r->slots.count; i++) {
        p->at[r->slots.axis[i]] = by_slot[i];
    }
}

static bool is_alike(const struct move *a, const struct move *b)
{
    bool same = a->overrides == b->overrides && a->correction_off == b->correction_off &&
                a->contour_side == b->contour_side && a->tool == b->tool;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        same = same && a->work_mm[i] == b->work_mm[i] && a->overhang_mm[i] == b->overhang_mm[i];
    }
    return same;
}

/* The index of a mode like this motion's; a new one takes the place of one that is not used. */
static unsigned char find_mode(struct route *r, const struct move *move)
{
    unsigned found = 0;

    for (unsigned i = 0; i < SMOOTH_MODES_MAX; i++) {
        if (r->mode[i].used > 0 && is_alike(&r->mode[i].move, move)) {
            r->mode[i].used++;
            return (unsigned char)i;
        }
        found = r->mode[i].used == 0 ? i : found;
    }
    TAKT_ASSERT(r->mode[found].used == 0);
    r->mode[found].move = *move;
    r->mode[found].used = 1;
    return (unsigned char)found;
}

static const struct route_curved *curved_at(const struct route *r, const struct route_element *e)
{
    TAKT_ASSERT(e->curved);
    return &r->curved[e->curved_number % SMOOTH_CURVED_MAX];
}

void takt_route_move(const struct route *r, uint32_t index, struct move *move)
{
    const struct route_element *e = route_element(r, index);
    const bool rapid = e->programmed_mm_s == SINGLE_INFINITY;

    *move = r->mode[e->mode].move;
    move->kind = e->curved ? (enum move_kind)curved_at(r, e)->move_kind
                 : rapid   ? MOVE_RAPID
                           : MOVE_FEED;
    move->plane = (enum plane)e->plane;
    move->line = e->line;
    move->feed_mm_s = rapid ? 0.0 : (double)e->programmed_mm_s;
    takt_route_scatter(r, route_end_point(r, index), &move->end);
}

/*
 * Weighted length for a mm of a curve, or a rad where only rotary axes move: that of the linear
 * axes is 1.
 */
static float weighted_length(const struct curve *curve)
{
    float square = curve->rotary ? 0.0f : 1.0f;

    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        const float slope = (float)(smooth_weight(i) * curve->slope.at[i]);

        square += slope * slope;
    }
    return single_sqrt(square);
}

static void keep_curved(struct route *r, enum move_kind kind, const struct curve *curve,
                        float per_mm)
{
    struct route_curved *b = &r->curved[r->curved_count % SMOOTH_CURVED_MAX];

    TAKT_ASSERT(r->curved_count - r->curved_first < SMOOTH_CURVED_MAX);
    b->kind = (uint8_t)curve->kind;
    b->move_kind = (uint8_t)kind;
    b->per_mm = per_mm;
    if (curve->kind == CURVE_ARC) {
        b->arc = curve->arc;
    } else if (curve->kind == CURVE_INVOLUTE) {
        b->involute = curve->involute;
    } else {
        b->quintic = curve->quintic;
    }
    r->curved_count++;
}

void takt_route_push(struct route *r, const struct move *move, uint32_t number,
                     const struct curve *curve)
{
    struct route_element *e = &r->element[route_slot(r, r->count)];
    const double start_mm = takt_route_end(r);
    const float per_mm = weighted_length(curve);

    TAKT_ASSERT(takt_route_has_room(r));
    TAKT_ASSERT(curve->length_mm > 0.0 && per_mm > 0.0F);
    takt_route_gather(r, &curve->start,
                      &r->start[(size_t)route_slot(r, r->count) * r->slots.count]);
    takt_route_gather(r, &curve->end, r->end);
    memset(e, 0, sizeof(*e));
    e->start_mm = start_mm;
    r->end_mm = start_mm + curve->length_mm * (double)per_mm;
    e->line = move->line;
    e->number = number;
    e->mode = find_mode(r, move) & ROUTE_MODES;
    e->plane = (unsigned char)move->plane & ROUTE_PLANES;
    e->rotary = takt_curve_is_rotary(curve);
    e->curved = curve->kind != CURVE_LINE;
    e->curved_number = (unsigned char)r->curved_count;
    if (e->curved) {
        keep_curved(r, move->kind, curve, per_mm);
    }
    e->programmed_mm_s = move->kind == MOVE_RAPID ? SINGLE_INFINITY : (float)move->feed_mm_s;
    takt_nominal_set(e, curve, per_mm, r);
    r->count++;
    takt_nominal_update(r);
}

void takt_route_forget(struct route *r, double at_mm)
{
    while (r->first + 1 < r->count && route_end_of(r, r->first) < at_mm) {
        const struct route_element *e = route_element(r, r->first);

        TAKT_ASSERT(r->mode[e->mode].used > 0);
        r->mode[e->mode].used--;
        r->curved_first += e->curved ? 1 : 0;
        r->first++;
    }
}

uint32_t takt_route_find(const struct route *r, double at_mm, uint32_t hint)
{
    uint32_t i = hint < r->first ? r->first : hint;

    TAKT_ASSERT(r->count > r->first);
    if (i >= r->count) {
        i = r->count - 1;
    }
    while (i + 1 < r->count && route_element(r, i + 1)->start_mm <= at_mm) {
        i++;
    }
    while (i > r->first && route_element(r, i)->start_mm > at_mm) {
        i--;
    }
    return i;
}

float takt_route_per_mm(const struct route *r, uint32_t index)
{
    return curved_at(r, route_element(r, index))->per_mm;
}

/* Its own length at a place on the route. */
static double curved_place(const struct route *r, uint32_t index, const struct curve *c,
                           double at_mm)
{
    const double s =
        (at_mm - route_element(r, index)->start_mm) / (double)takt_route_per_mm(r, index);

    return maths_clamp(s, 0.0, c->length_mm);
}

void takt_route_curve(const struct route *r, uint32_t index, struct curve *c)
{
    const struct route_element *e = route_element(r, index);
    const struct route_curved *b = curved_at(r, e);

    c->kind = (enum curve_kind)b->kind;
    c->rotary = e->rotary;
    c->length_mm = (route_end_of(r, index) - e->start_mm) / (double)b->per_mm;
    takt_route_scatter(r, route_start(r, index), &c->start);
    takt_route_scatter(r, route_end_point(r, index), &c->end);
    if (b->kind == CURVE_ARC) {
        c->arc = b->arc;
    } else if (b->kind == CURVE_INVOLUTE) {
        c->involute = b->involute;
    } else {
        c->quintic = b->quintic;
    }
    enum axis first = AXIS_COUNT;
    enum axis second = AXIS_COUNT;

    (void)takt_curve_plane(c, &first, &second);
    memset(&c->slope, 0, sizeof c->slope);
    for (unsigned i = 0; i < r->slots.count; i++) {
        const unsigned axis = r->slots.axis[i];

        if (axis != first && axis != second) {
            c->slope.at[axis] = (c->end.at[axis] - c->start.at[axis]) / c->length_mm;
        }
    }
}

void takt_route_place(const struct route *r, uint32_t index, double at_mm, double p[])
{
    const struct route_element *e = route_element(r, index);
    const double length = route_end_of(r, index) - e->start_mm;
    const double part = maths_clamp(at_mm - e->start_mm, 0.0, length) / length;
    const double *start = route_start(r, index);
    const double *end = route_end_point(r, index);

    TAKT_ASSERT(index >= r->first && index < r->count && length > 0.0);
    if (e->curved && part < 1.0) {
        struct curve c;
        struct point q;

        takt_route_curve(r, index, &c);
        takt_curve_point(&c, curved_place(r, index, &c, at_mm), &q);
        takt_route_gather(r, &q, p);
        return;
    }
    for (unsigned i = 0; i < r->slots.count; i++) {
        p[i] = part < 1.0 ? start[i] + part * (end[i] - start[i]) : end[i];
    }
}

void takt_route_point(const struct route *r, double at_mm, uint32_t *hint, double p[])
{
    *hint = takt_route_find(r, at_mm, *hint);
    takt_route_place(r, *hint, at_mm, p);
}

/* left: the part of it that is. */
static void tell_arc(const struct curve_arc *arc, double left, struct move *move)
{
    const double turns = maths_abs(arc->sweep_rad) * left / (2.0 * MATHS_PI);

    move->centre_mm[0] = arc->centre_mm[0];
    move->centre_mm[1] = arc->centre_mm[1];
    move->turns = 1U + (uint32_t)(turns * WHOLE_TURNS);
}

static void tell_involute(const struct curve_involute *involute, struct move *move)
{
    move->centre_mm[0] = involute->centre_mm[0];
    move->centre_mm[1] = involute->centre_mm[1];
    move->base_radius_mm = involute->radius_mm;
}

/* Its course: direction and curvature at both ends. */
static void tell_spline(const struct curve *c, struct move *move)
{
    const unsigned first = c->quintic.first;
    const unsigned second = c->quintic.second;

    TAKT_ASSERT(c->kind == CURVE_QUINTIC && first < AXIS_COUNT && second < AXIS_COUNT);
    for (unsigned i = 0; i < 2; i++) {
        const double s_mm = i == 0 ? 0.0 : c->length_mm;
        struct point t;
        struct point k;

        takt_curve_tangent(c, s_mm, &t);
        takt_curve_curvature(c, s_mm, &k);
        move->heading_rad[i] = takt_maths_atan2(t.at[second], t.at[first]);
        move->curvature_1_mm[i] = t.at[first] * k.at[second] - t.at[second] * k.at[first];
    }
    move->spline_mm = c->length_mm;
}

bool takt_route_along(const struct route *r, uint32_t index, double at_mm, struct move *move)
{
    const struct route_element *e = route_element(r, index);
    const double end_mm = route_end_of(r, index);
    struct curve c;

    takt_route_move(r, index, move);
    if (!e->curved || at_mm >= end_mm) { /* an arc to where it begins is a circle */
        return false;
    }
    takt_route_curve(r, index, &c);
    switch (c.kind) {
    case CURVE_ARC:
        tell_arc(&c.arc, (end_mm - at_mm) / (end_mm - e->start_mm), move);
        return true;
    case CURVE_INVOLUTE: /* at a cusp the axes must stand */
        tell_involute(&c.involute, move);
        return !c.involute.cusp_start && !c.involute.cusp_end;
    case CURVE_QUINTIC: /* a part of it has another course */
        tell_spline(&c, move);
        return at_mm <= e->start_mm;
    case CURVE_LINE:
    case CURVE_SPLINE:
        break;
    }
    return false;
}

static void curved_direction(const struct route *r, uint32_t index, double at_mm, float direction[])
{
    struct curve c;
    struct point t;

    takt_route_curve(r, index, &c);
    takt_curve_tangent(&c, curved_place(r, index, &c, at_mm), &t);
    for (unsigned i = 0; i < r->slots.count; i++) {
        direction[i] = (float)t.at[r->slots.axis[i]];
    }
}

float takt_route_direction(const struct route *r, uint32_t index, double at_mm, float direction[])
{
    float square = 0.0f;
    float length = 1.0f;

    if (route_element(r, index)->curved) {
        curved_direction(r, index, at_mm, direction);
        length = takt_route_per_mm(r, index);
    } else {
        const double *start = route_start(r, index);
        const double *end = route_end_point(r, index);

        for (unsigned i = 0; i < r->slots.count; i++) {
            direction[i] = (float)(end[i] - start[i]);
        }
        length = (float)(route_end_of(r, index) - route_element(r, index)->start_mm);
    }
    for (unsigned i = 0; i < r->slots.count; i++) {
        direction[i] *= r->slots.weight[i];
        square += direction[i] * direction[i];
    }
    const float weighted = single_sqrt(square);
    const float per_weighted = 1.0f / weighted;

    for (unsigned i = 0; i < r->slots.count; i++) {
        direction[i] *= per_weighted;
    }
    return weighted / length;
}

float takt_route_curvature(const struct route *r, uint32_t index, double at_mm, float curvature[])
{
    struct curve c;
    struct point k;
    float square = 0.0f;

    memset(curvature, 0, r->slots.count * sizeof curvature[0]);
    if (!route_element(r, index)->curved) {
        return 0.0f;
    }
    const float per_mm = takt_route_per_mm(r, index);

    takt_route_curve(r, index, &c);
    takt_curve_curvature(&c, curved_place(r, index, &c, at_mm), &k);
    for (unsigned i = 0; i < r->slots.count; i++) {
        curvature[i] = r->slots.weight[i] * (float)k.at[r->slots.axis[i]] / (per_mm * per_mm);
        square += curvature[i] * curvature[i];
    }
    return single_sqrt(square);
}

float takt_route_radius(const struct route *r, uint32_t index, double at_mm)
{
    float k[AXIS_COUNT];
    const float curvature = takt_route_curvature(r, index, at_mm, k);

    return curvature > 0.0f ? 1.0f / curvature : SINGLE_INFINITY;
}

/* s^2/2R = within */
float takt_route_straight(const struct route *r, uint32_t index, double at_mm, float within_mm)
{
    return single_sqrt(2.0f * within_mm * takt_route_radius(r, index, at_mm));
}

void takt_route_corner(const struct route *r, uint32_t index, float before[], float after[])
{
    const double at_mm = route_element(r, index)->start_mm;

    TAKT_ASSERT(index > r->first && index < r->count);
    (void)takt_route_direction(r, index - 1, at_mm, before);
    (void)takt_route_direction(r, index, at_mm, after);
}

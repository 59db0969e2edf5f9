/*
 * Looks for control points c that keep all of these (alternating directions, Boyd et al. 2011,
 * section 5):
 *     the curve at every sample (c[i-1] + 4 c[i] + c[i+1])/6 and at every corner within the tolerance of the route,
 *     |c[i-1] - 2 c[i] + c[i+1]| <= A d^2 and |c[i+2] - 3 c[i+1] + 3 c[i] - c[i-1]| <= J d^3 on every axis.
 * With K the rows, z the nearest values that are allowed, u the sums of what was missing, R the
 * weights and a the over-relaxation, one iteration is
 *     c += (K' R K)^-1 K' R (z - u - K c),    t = a K c + (1 - a) z + u,    z = nearest(t),    u = t - z.
 * Only p = (1 - a) z + u is kept of z and u. The rows are counted so that R is 1 but for the
 * tolerance. The matrix has three bands beside its diagonal (bands.c). Where the timing asks for
 * too much there is no such c; the last iterations then favour the tolerance, and the timing is
 * changed.
 */
#include "smooth/relax.h"

#include "base/assert.h"
#include "smooth/relax_parts.h"
#include "smooth/single.h"

#include <string.h>

#define ITERATIONS 16

/* Over-relaxation. */
#define ALPHA 1.6f

/* The last iterations, and how many times more they weigh the tolerance. */
#define LAST             4
#define LAST_TUBE_WEIGHT 30.0f

/* How much less acceleration and jerk are preferred to more, inside their boxes. */
#define BOX_WEIGHT 0.3f

/* What a curved route may leave its tangent by for that to stand for it: s^2/2R, in tolerances. */
#define CURVED 0.05f

/* The tube beside a curve is narrower than its radius: places in it have one closest point. */
#define TUBE_OF_RADIUS 0.25f

/* How one iteration forms t and p; weight: of the tolerance. */
struct relax_pass {
    float alpha;
    float box_weight;
    float keep_boxes; /* part of their sums that is kept */
    float keep_near;
    float weight;
};

/* Direction of the route at a closest point, and tolerances in a mm of the route there. */
struct relax_ahead {
    uint32_t element; /* of a line it still holds for; else UINT32_MAX */
    float along[SMOOTH_SLOTS_MAX];
    float per_mm;
};

static void look_ahead(struct relax_ahead *a, const struct route *r,
                       const struct route_closest *closest, float tolerance_mm)
{
    if (closest->element != a->element) {
        a->per_mm =
            takt_route_direction(r, closest->element, closest->at_mm, a->along) / tolerance_mm;
        a->element = route_element(r, closest->element)->curved ? UINT32_MAX : closest->element;
    }
}

/* The route beside sample i: the nearest point, and as far as the direction there serves for it. */
static void set_closest(struct relax *x, const struct window *w, const struct route *r, unsigned i,
                        float tolerance_mm, struct relax_ahead *ahead)
{
    struct route_closest closest = {.element = w->element[i], .at_mm = w->at_mm[i]};
    struct window_spot spot;
    double from;
    double to;
    double p[AXIS_COUNT];

    takt_window_reach(w, i, &from, &to);
    takt_window_beside(w, r, i, &spot);
    takt_window_place(w, r, &spot, p);
    takt_route_closest(r, p, from, to, &closest);
    look_ahead(ahead, r, &closest, tolerance_mm);
    const float radius = takt_route_radius(r, closest.element, closest.at_mm) / tolerance_mm;
    const float straight =
        TUBE_OF_RADIUS * radius < 1.0f ? 0.0f : single_sqrt(2.0f * CURVED * radius);
    const double start = maths_max(from, route_element(r, closest.element)->start_mm);
    const double end = maths_min(to, route_end_of(r, closest.element));

    x->tube[i] = route_element(r, closest.element)->curved
                     ? takt_relax_most(w, r, i - 1, tolerance_mm)
                     : 1.0f;
    x->low[i] = single_max((float)(start - closest.at_mm) * ahead->per_mm, -straight);
    x->high[i] = single_min((float)(end - closest.at_mm) * ahead->per_mm, straight);
    for (unsigned k = 0; k < r->slots.count; k++) {
        const unsigned row = k / SMOOTH_LANES * w->capacity + i;

        x->closest[row][k % SMOOTH_LANES] =
            spot.at[k] + single_round(closest.off[k] / w->weighted_unit_mm[k]);
        x->along[row][k % SMOOTH_LANES] = ahead->along[k];
    }
}

/* t, z, u of rows that must lie in -most ... most; p is replaced, z - u - k returned. */
static inline lanes into_box(const struct relax_pass *pass, lanes k, lanes most, lanes *p)
{
    const lanes t = pass->alpha * k + *p;
    const lanes z = lanes_clamp(t * pass->box_weight, most);
    const lanes u = (t - z) * pass->keep_boxes;

    *p = (1.0f - ALPHA) * z + u;
    return z - u - k;
}

/*
 * R (z - u - K c) of the curve at a sample. Where nothing is missing, z = t, that is t - now, and
 * p = (1 - a) t; elsewhere pull() has put other values in the place of t and now.
 */
static inline lanes near_of(lanes *near, lanes now, float weight)
{
    const lanes e = weight * (*near - now);

    *near *= 1.0f - ALPHA;
    return e;
}

/* What a change of rate leaves of what an axis may, half of it at least. */
static inline lanes left_of(lanes all, lanes change)
{
    return all - lanes_clamp(change, 0.5f * all);
}

/*
 * K' R (z - u - K c) of all rows but corners. A third difference is that of two second ones, and (1
 * 4 1)/6 is a sixth of (1 -2 1) more than the sample itself: so what all rows of a sample ask for
 * is first put together as second differences.
 */
static void gather(struct relax *x, const struct window *w, const struct relax_pass *pass,
                   unsigned group)
{
    const unsigned first = group * w->capacity;
    const struct relax_pass now = *pass;
    const lanes_int *restrict c = w->x + first;
    lanes *restrict step = x->step + first;
    lanes *restrict near = x->near + first;
    lanes *restrict second = x->second + first;
    lanes *restrict third = x->third + first;
    const float second_per_near = x->scale.second_per_near[group];
    const float third_per_near = x->scale.third_per_near[group];
    const lanes second_per_unit = second_per_near * x->scale.near_per_unit[group];
    const lanes third_per_unit = third_per_near * x->scale.near_per_unit[group];
    const lanes second_all = x->scale.second_most[group];
    const lanes third_all = x->scale.third_most[group];
    const lanes second_change = 0.5f * x->scale.change * second_per_unit;
    const lanes third_first = 0.5f * x->scale.rounded * third_per_unit;
    const lanes third_second = 3.0f * x->scale.change * third_per_unit;
    lanes_int b0 = c[0] - 2 * c[1] + c[2];
    lanes before = {
        0.0f}; /* third difference, bow and near of the sample before, bow of the one before that */
    lanes bow1 = before;
    lanes bow2 = before;
    lanes near1 = before;

    for (unsigned i = 1; i + 2 < w->count; i++) {
        const lanes_int b1 = c[i] - 2 * c[i + 1] + c[i + 2];
        const lanes way = lanes_size(lanes_of(c[i + 1] - c[i - 1]));
        const lanes bow0 = lanes_of(b0);
        const lanes second_most = left_of(second_all, second_change * way);
        const lanes third_most =
            left_of(third_all, third_first * way + third_second * lanes_size(bow0));
        const lanes b = into_box(&now, bow0 * second_per_unit, second_most, &second[i]);
        const lanes t = into_box(&now, lanes_of(b1 - b0) * third_per_unit, third_most, &third[i]);
        const lanes e = near_of(&near[i], step[i], now.weight);
        const lanes after = third_per_near * t;
        const lanes bow = before + second_per_near * b - after + e * (1.0f / 6.0f);

        step[i - 1] = near1 + bow2 - 2.0f * bow1 + bow;
        before = after;
        bow2 = bow1;
        bow1 = bow;
        near1 = e;
        b0 = b1;
    }
}

/* z of t beside sample i where the route bends: within the tolerance of its closest point. */
static void pull_to_route(const struct relax *x, const struct window *w, const struct route *r,
                          float tolerance_mm, unsigned i, lanes z[])
{
    struct route_closest closest = {.element = w->element[i], .at_mm = w->at_mm[i]};
    double p[AXIS_COUNT];
    double from;
    double to;

    for (unsigned k = 0; k < r->slots.count; k++) {
        const unsigned row = k / SMOOTH_LANES * w->capacity + i;
        const unsigned g = k / SMOOTH_LANES;
        const unsigned l = k % SMOOTH_LANES;

        p[k] = w->origin[k] +
               w->unit_mm[k] * ((double)x->closest[row][l] +
                                (double)(x->near[row][l] * x->scale.unit_per_near[g][l]));
    }
    takt_window_reach(w, i, &from, &to);
    takt_route_closest(r, p, from, to, &closest);
    const float tube_mm =
        single_min(x->tube[i] * tolerance_mm,
                   TUBE_OF_RADIUS * takt_route_radius(r, closest.element, closest.at_mm));
    const float less = closest.distance_mm > tube_mm ? 1.0f - tube_mm / closest.distance_mm : 0.0f;

    for (unsigned k = 0; k < r->slots.count; k++) {
        z[k / SMOOTH_LANES][k % SMOOTH_LANES] =
            x->near[k / SMOOTH_LANES * w->capacity + i][k % SMOOTH_LANES] +
            less * closest.off[k] / tolerance_mm;
    }
}

/* The curve at the samples, less their closest points: now to step, t to near. */
static void measure_near(struct relax *x, const struct window *w, const struct relax_pass *pass,
                         unsigned group)
{
    const unsigned first = group * w->capacity;
    const lanes_int *restrict c = w->x + first;
    const lanes_int *restrict closest = x->closest + first;
    lanes *restrict near = x->near + first;
    lanes *restrict step = x->step + first;
    const float alpha = pass->alpha;
    const lanes per_unit = x->scale.near_per_unit[group];

    for (unsigned i = 1; i + 2 < w->count; i++) {
        const lanes_int second = c[i - 1] - 2 * c[i] + c[i + 1];
        const lanes now =
            (lanes_of(c[i] - closest[i]) + lanes_of(second) * (1.0f / 6.0f)) * per_unit;

        step[i] = now;
        near[i] += alpha * now;
    }
}

/* z of t in the tube around a straight piece of route. False: it reaches its ends. */
static bool pull_to_line(const struct relax *x, const struct window *w, unsigned groups, unsigned i,
                         float s, lanes z[])
{
    lanes off[SMOOTH_GROUPS_MAX];
    float square = 0.0f;

    for (unsigned g = 0; g < groups; g++) {
        off[g] = x->near[g * w->capacity + i] - s * x->along[g * w->capacity + i];
        square += lanes_sum(off[g] * off[g]);
    }
    const float distance = single_sqrt(square);
    const float tube = x->tube[i];
    const float less = distance > tube ? 1.0f - tube / distance : 0.0f;

    for (unsigned g = 0; g < groups; g++) {
        z[g] = x->near[g * w->capacity + i] - off[g] * less;
    }
    return s - x->low[i] > distance && x->high[i] - s > distance;
}

/*
 * Where something is missing beside sample i: t and now are replaced so that near_of() comes to
 * (1 - a) z + u and z - u - now. s: t along the route.
 */
static void pull(struct relax *x, const struct window *w, const struct route *r,
                 const struct relax_pass *pass, float tolerance_mm, unsigned i, float s)
{
    lanes z[SMOOTH_GROUPS_MAX] = {{0.0f}};

    if (!pull_to_line(x, w, r->slots.groups, i, s, z)) {
        pull_to_route(x, w, r, tolerance_mm, i, z);
    }
    for (unsigned g = 0; g < r->slots.groups; g++) {
        const unsigned row = g * w->capacity + i;
        const lanes u = (x->near[row] - z[g]) * pass->keep_near;
        const lanes e = z[g] - u - x->step[row];

        x->near[row] = z[g] + u * (1.0f / (1.0f - ALPHA));
        x->step[row] = x->near[row] - e;
    }
}

/* A sum over all axes for each of as many samples as there are lanes, as (x0 + x2) + (x1 + x3). */
struct relax_sum {
    lanes even, odd;
};

static inline void add_up(struct relax_sum *s, lanes a, lanes b, lanes c, lanes d)
{
    const lanes ab = (lanes){a[0], b[0], a[1], b[1]} + (lanes){a[2], b[2], a[3], b[3]};
    const lanes cd = (lanes){c[0], d[0], c[1], d[1]} + (lanes){c[2], d[2], c[3], d[3]};

    s->even += (lanes){ab[0], ab[1], cd[0], cd[1]};
    s->odd += (lanes){ab[2], ab[3], cd[2], cd[3]};
}

/* The squares of t of samples from i on, and those of how far it is along the route beside them. */
static inline lanes squares_of(const struct relax *x, const struct window *w, unsigned groups,
                               unsigned i, lanes *s)
{
    struct relax_sum square = {lanes_all(0.0f), lanes_all(0.0f)};
    struct relax_sum way = square;

    for (unsigned g = 0; g < groups; g++) {
        const lanes *t = &x->near[g * w->capacity + i];
        const lanes *along = &x->along[g * w->capacity + i];

        add_up(&way, t[0] * along[0], t[1] * along[1], t[2] * along[2], t[3] * along[3]);
        add_up(&square, t[0] * t[0], t[1] * t[1], t[2] * t[2], t[3] * t[3]);
    }
    *s = way.even + way.odd;
    return square.even + square.odd;
}

/* Places t outside the tube, or where it is not that straight, are pulled there. */
static void into_tube(struct relax *x, const struct window *w, const struct route *r,
                      const struct relax_pass *pass, float tolerance_mm)
{
    for (unsigned i = 0; i + 2 < w->count; i += SMOOTH_LANES) {
        lanes s;
        const lanes square = squares_of(x, w, r->slots.groups, i, &s);
        const lanes tube = lanes_at(x->tube + i) - CURVED;
        const lanes_int inside = (s >= lanes_at(x->low + i)) & (s <= lanes_at(x->high + i)) &
                                 (square - s * s <= tube * tube);

        for (unsigned k = 0; k < SMOOTH_LANES && lanes_any(~inside); k++) {
            if (!inside[k] && i + k > 0 && i + k + 2 < w->count) {
                pull(x, w, r, pass, tolerance_mm, i + k, s[k]);
            }
        }
    }
}

/* How far the curve is from corner k, beside which its samples weigh so much. */
static lanes corner_of(const struct relax *x, const struct window *w, unsigned group, unsigned k,
                       const float row[4])
{
    const lanes_int *c = &w->x[group * w->capacity + x->corners.piece[k]];
    const lanes_int spot = x->corners.spot[group * x->corners.capacity + k];

    return (row[0] * lanes_of(c[0] - spot) + row[1] * lanes_of(c[1] - spot) +
            row[2] * lanes_of(c[2] - spot) + row[3] * lanes_of(c[3] - spot)) *
           x->scale.near_per_unit[group];
}

/* The same of the curve at a corner: across the mean direction it is within the tolerance. */
static void into_corner(struct relax *x, const struct window *w, const struct relax_pass *pass,
                        unsigned groups, unsigned k)
{
    lanes now[SMOOTH_GROUPS_MAX];
    lanes t[SMOOTH_GROUPS_MAX];
    const float most = x->corners.most[k];
    float weight[4];
    float along = 0.0f;
    float square = 0.0f;

    takt_window_weights(x->corners.fraction[k], weight);
    for (unsigned g = 0; g < groups; g++) {
        const unsigned row = g * x->corners.capacity + k;

        now[g] = corner_of(x, w, g, k, weight);
        t[g] = pass->alpha * now[g] + x->corners.state[row];
        along += lanes_sum(t[g] * x->corners.along[row]);
        square += lanes_sum(t[g] * t[g]);
    }
    const float distance = single_sqrt(single_max(0.0f, square - along * along));
    const float less = distance > most ? 1.0f - most / distance : 0.0f;

    for (unsigned g = 0; g < groups; g++) {
        const unsigned row = g * x->corners.capacity + k;
        const lanes z = t[g] - less * (t[g] - along * x->corners.along[row]);
        const lanes u = (t[g] - z) * pass->keep_near;
        const lanes e = pass->weight * (z - u - now[g]);
        lanes *step = &x->step[g * w->capacity + x->corners.piece[k]];

        x->corners.state[row] = (1.0f - ALPHA) * z + u;
        for (unsigned j = 0; j < 4; j++) {
            step[j] += weight[j] * e;
        }
    }
}

static void project(struct relax *x, const struct window *w, const struct route *r,
                    float tolerance_mm, const struct relax_pass *pass)
{
    for (unsigned g = 0; g < r->slots.groups; g++) {
        measure_near(x, w, pass, g);
    }
    into_tube(x, w, r, pass, tolerance_mm);
    for (unsigned g = 0; g < r->slots.groups; g++) {
        gather(x, w, pass, g);
    }
    for (unsigned k = 0; k < x->corners.count; k++) {
        into_corner(x, w, pass, r->slots.groups, k);
    }
}

static void begin(struct relax *x, const struct window *w, const struct route *r,
                  float tolerance_mm)
{
    struct relax_ahead ahead = {.element = UINT32_MAX};

    takt_relax_set_scale(&x->scale, w, r, tolerance_mm);
    takt_relax_find_corners(&x->corners, w, r, tolerance_mm);
    memset(x->near, 0, sizeof x->near);
    memset(x->second, 0, sizeof x->second);
    memset(x->third, 0, sizeof x->third);
    memset(x->closest, 0, sizeof x->closest);
    memset(x->along, 0, sizeof x->along);
    memset(x->band, 0, sizeof x->band);
    for (unsigned i = 1; i + 2 < w->count; i++) {
        set_closest(x, w, r, i, tolerance_mm, &ahead);
    }
}

void takt_relax_window(struct relax *x, struct window *w, const struct route *r,
                       double tolerance_mm)
{
    const float tolerance = (float)tolerance_mm;
    struct relax_pass pass = {.alpha = 1.0f, .box_weight = 1.0f, .weight = 1.0f};

    begin(x, w, r, tolerance);
    takt_bands_build(x, w, r, pass.weight);
    project(x, w, r, tolerance, &pass);
    pass.alpha = ALPHA;
    pass.box_weight = 1.0f / (1.0f + BOX_WEIGHT);
    pass.keep_boxes = 1.0f;
    for (unsigned i = ITERATIONS; i > 0; i--) {
        for (unsigned g = 0; g < r->slots.groups; g++) {
            takt_bands_step(x, w, g);
        }
        if (i == LAST + 1) {
            pass.weight = LAST_TUBE_WEIGHT;
            takt_bands_build(x, w, r, pass.weight);
        }
        pass.keep_near = i == LAST + 1 ? 1.0f / LAST_TUBE_WEIGHT : 1.0f;
        if (i > 1) {
            project(x, w, r, tolerance, &pass);
        }
    }
}

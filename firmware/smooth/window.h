/*
 * The samples being smoothed: control points of a uniform cubic B-spline, one every interval of
 * nominal time.
 *
 *     q(u) = sum of b_k(f) x[i + k], k = 0..3, for u = i + 1 + f: the piece i lies between samples i + 1 and i + 2
 *
 * Coordinates are integers: units from the window's origin, a unit being a power of two that is
 * small enough for differences of every order to be exact. What is handed on is rounded in this way
 * once and for all, so pieces of different windows fit together.
 *
 * at_mm tells where on the route the curve is beside each sample. The first SMOOTH_FIXED samples
 * are kept for good, the last ones as well while they are in the window.
 */
#ifndef TAKT_SMOOTH_WINDOW_H
#define TAKT_SMOOTH_WINDOW_H

#include "smooth/order.h"
#include "smooth/route.h"

#include <stdbool.h>

struct window {
    unsigned count;
    unsigned capacity;
    bool at_end; /* its last samples are the end of the route, where the path comes to rest */
    double interval_s;
    double reach_min_mm; /* along the route to both sides, where a sample's place is looked for */
    double origin[AXIS_COUNT];                /* by slot, mm */
    double unit_mm[AXIS_COUNT];               /* by slot */
    float weighted_unit_mm[SMOOTH_SLOTS_MAX]; /* what it counts in a distance (limits.h) */
    double at_mm[SMOOTH_SAMPLES_MAX];
    uint32_t element[SMOOTH_SAMPLES_MAX]; /* of the route, at at_mm */
    unsigned char paced
        [SMOOTH_SAMPLES_MAX]; /* by piece: whose feed is its, elements from the route's first on */
    lanes_int x[SMOOTH_SAMPLES_MAX]; /* one group of lanes after the other */
};

/*
 * Where a sample, or a place of the curve, is: units from the origin, by slot; 0 in lanes that no
 * slot has.
 */
struct window_spot {
    union {
        int32_t at[SMOOTH_SLOTS_MAX];
        lanes_int group[SMOOTH_GROUPS_MAX];
    };
};

/* Weights of four neighbours at fraction f of a piece. */
void takt_window_weights(float f, float weight[4]);

/* Samples there is room for. */
static inline unsigned window_capacity(const struct route *r)
{
    return SMOOTH_SAMPLES_MAX / r->slots.groups;
}
/* Sets sizes and units for a chain on this route. Empty. */
void takt_window_init(struct window *w, const struct route *r, double interval_s);
/* Begins at rest at the start of the route. */
void takt_window_start(struct window *w, const struct route *r);
/* Begins at rest in a point, which is beside a place of the route. */
void takt_window_stand(struct window *w, const struct route *r, const double p[], double at_mm,
                       uint32_t element);
/* Begins anew at rest where the curve has come to: at the end of its first three samples. */
void takt_window_rest(struct window *w, const struct route *r, const struct order *order);
/* Appends samples at the nominal feed until the window is full or the route's end is in it. */
void takt_window_extend(struct window *w, const struct route *r);
/* Drops the oldest samples. */
void takt_window_drop(struct window *w, const struct route *r, unsigned count);

/*
 * Coordinates of sample i from slot to slot: lane slot % SMOOTH_LANES of group slot / SMOOTH_LANES.
 */
static inline int32_t window_x(const struct window *w, unsigned slot, unsigned i)
{
    return w->x[slot / SMOOTH_LANES * w->capacity + i][slot % SMOOTH_LANES];
}

/* Differences of coordinates in what they count in a distance. */
static inline lanes window_weighted(const struct window *w, unsigned group, lanes_int units)
{
    return lanes_at(&w->weighted_unit_mm[(size_t)group * SMOOTH_LANES]) * lanes_of(units);
}

void takt_window_set(struct window *w, const struct route *r, unsigned i,
                     const struct window_spot *s);
/* A sample in mm. */
void takt_window_sample(const struct window *w, const struct route *r, unsigned i, double p[]);
/* The curve at a piece's fraction that has these weights, and where that is on the route. */
void takt_window_spot(const struct window *w, const struct route *r, unsigned i,
                      const float weight[4], struct window_spot *s);
double takt_window_at(const struct window *w, unsigned i, const float weight[4]);
/* The curve beside sample i. */
void takt_window_beside(const struct window *w, const struct route *r, unsigned i,
                        struct window_spot *s);
/* A spot in mm; a place in mm as the nearest spot. */
void takt_window_place(const struct window *w, const struct route *r, const struct window_spot *s,
                       double p[]);
void takt_window_nearest(const struct window *w, const struct route *r, const double p[],
                         struct window_spot *s);
/* The curve beside every sample: its place on the route anew. */
void takt_window_locate(struct window *w, const struct route *r);

/* How far a sample may be from where it was thought to be, along the route. */
void takt_window_reach(const struct window *w, unsigned i, double *from_mm, double *to_mm);

#endif

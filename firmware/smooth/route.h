/*
 * The programmed path of one chain: curves that follow each other without a stop, with a nominal
 * feed along them.
 *
 *     push -> [ element | element | ... ] -> forget
 *
 * Places on it are told by the length from the chain's start, over all axes as distances are: a
 * degree counts like a millimetre (limits.h). Points have a slot for every axis the machine has, in
 * the order of the axes.
 */
#ifndef TAKT_SMOOTH_ROUTE_H
#define TAKT_SMOOTH_ROUTE_H

#include "geometry/curve.h"
#include "program/move.h"
#include "smooth/braking.h"
#include "smooth/limits.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * The axes of the machine, and their limits, by slot. Slots that no axis has are for filling groups
 * of lanes.
 */
struct route_slots {
    unsigned count;
    unsigned groups; /* of lanes */
    unsigned char axis[AXIS_COUNT];
    float weight[SMOOTH_SLOTS_MAX];
    float velocity_mm_s[SMOOTH_SLOTS_MAX];
    float acceleration_mm_s2[SMOOTH_SLOTS_MAX];
    float jerk_mm_s3[SMOOTH_SLOTS_MAX];
    /* how fast the rate is to change where the axes are slow enough (verifier.h), */
    float change_per_s;
    float rounded_per_s2; /* and to begin to */
};

/*
 * What a curve has that a line between the same two points does not have; its slope is found from
 * those.
 */
struct route_curved {
    uint8_t kind;      /* enum curve_kind */
    uint8_t move_kind; /* enum move_kind */
    float per_mm;      /* length of the route for a mm of it: 1 without rotary axes */
    union {
        struct curve_arc arc;
        struct curve_involute involute;
        struct curve_quintic quintic;
    };
};

/* Its start stands in the route's coordinates, its end is the start of the next one. */
struct route_element {
    double start_mm;       /* on the route */
    uint32_t line;         /* of the program */
    uint32_t number;       /* of the motion */
    float programmed_mm_s; /* feed; infinite for a rapid */
    float feed_mm_s;       /* highest nominal feed: programmed, and what its curvature allows */
    struct braking_limits along; /* nominal acceleration and jerk along it */
    float start_mm_s;            /* highest nominal feed at its start, for the corner there */
    uint16_t turn;               /* |change of direction| at its start, in ROUTE_TURN */
    unsigned char curved_number; /* curved elements before it, modulo ROUTE_CURVED_NUMBERS */
    unsigned char mode : 2;      /* index among the route's modes */
    unsigned char plane : 2;     /* enum plane */
    unsigned char curved : 1;
    unsigned char binds : 1;  /* its start is slower than what follows asks for */
    unsigned char rotary : 1; /* only rotary axes move: its feed counts radians */
};

#define ROUTE_CURVED_NUMBERS 256U
_Static_assert(ROUTE_CURVED_NUMBERS % SMOOTH_CURVED_MAX == 0, "each number has one place");

/* Bits of a plane. */
#define ROUTE_PLANES 3U

/* Bits of a mode's index. */
#define ROUTE_MODES 3U
_Static_assert(SMOOTH_MODES_MAX <= ROUTE_MODES + 1, "a mode's index has its bits");

/* Turns are up to 2. */
#define ROUTE_TURN (1.0f / 32767.0f)

/* Motions that are alike but for where they go, on what curve, and how fast. */
struct route_mode {
    struct move move;
    unsigned used; /* elements of it */
};

/* How lines through setpoints, a cycle apart, leave the curve. */
struct chord_reach {
    float per_second; /* by so much of c_0 - 2 c_1 + c_2 at most: cycle^2/8 d^2 */
    unsigned pieces;  /* into so many before one, and behind it, a line reaches that is in it */
};

struct route {
    struct route_slots slots;
    struct chord_reach chord;
    unsigned moved; /* axes that the chain moves, as far as is known, by bit */
    float part;     /* of the tolerance, within which a curve is looked for */
    double tolerance_mm;
    uint32_t first;                      /* elements forgotten so far */
    uint32_t count;                      /* elements pushed so far */
    uint32_t capacity;                   /* elements there is room for */
    unsigned curved_first, curved_count; /* curved ones forgotten, and pushed */
    double end_mm;
    double end[AXIS_COUNT]; /* of the newest element; by slot */
    double start[SMOOTH_COORDINATES_MAX];
    struct route_element element[SMOOTH_ELEMENTS_MAX];
    struct route_curved curved[SMOOTH_CURVED_MAX];
    struct route_mode mode[SMOOTH_MODES_MAX];
};

/* Over all slots. */
static inline float route_dot(const struct route *r, const lanes a[], const lanes b[])
{
    float dot = 0.0f;

    for (unsigned g = 0; g < r->slots.groups; g++) {
        const lanes product = a[g] * b[g];

        dot = dot + product[0] + product[1] + product[2] + product[3];
    }
    return dot;
}

static inline float route_length(const struct route *r, const float weighted[])
{
    float square = 0.0f;

    for (unsigned i = 0; i < r->slots.count; i++) {
        square += weighted[i] * weighted[i];
    }
    return __builtin_sqrtf(square);
}

/* A place on the route near to a point. */
struct route_closest {
    uint32_t element;            /* index of an element */
    double at_mm;                /* on the route */
    float off[SMOOTH_SLOTS_MAX]; /* from the point to it, weighted */
    float distance_mm;
};

void takt_route_init(struct route *r, const struct smooth_limits *limits, double tolerance_mm);
bool takt_route_has_room(const struct route *r);
/* Appends a curve that begins where the last one ended. Needs room. */
void takt_route_push(struct route *r, const struct move *move, uint32_t number,
                     const struct curve *curve);
/* Elements that end before at_mm are no longer asked for. */
void takt_route_forget(struct route *r, double at_mm);

/* Where the element is kept. */
static inline uint32_t route_slot(const struct route *r, uint32_t index)
{
    return r->slots.count > 3 ? index % (SMOOTH_ELEMENTS_MAX / 2) : index % SMOOTH_ELEMENTS_MAX;
}
static inline const struct route_element *route_element(const struct route *r, uint32_t index)
{
    return &r->element[route_slot(r, index)];
}
/* |Change of direction| at its start. */
static inline float route_turn(const struct route *r, uint32_t index)
{
    return (float)route_element(r, index)->turn * ROUTE_TURN;
}
/* Its start and its end, by slot. */
static inline const double *route_start(const struct route *r, uint32_t index)
{
    return &r->start[(size_t)route_slot(r, index) * r->slots.count];
}
static inline const double *route_end_point(const struct route *r, uint32_t index)
{
    return index + 1 < r->count ? route_start(r, index + 1) : r->end;
}
static inline double route_end_of(const struct route *r, uint32_t index)
{
    return index + 1 < r->count ? route_element(r, index + 1)->start_mm : r->end_mm;
}
double takt_route_end(const struct route *r);
/* Time from a place, of an element or behind, to another at the nominal feed, s. */
float takt_route_time(const struct route *r, uint32_t element, double from_mm, double to_mm);
/* The motion it belongs to, but for centres and turns of arcs. */
void takt_route_move(const struct route *r, uint32_t index, struct move *move);
/* The programmed feed; infinite for a rapid. */
static inline float route_programmed(const struct route *r, uint32_t index)
{
    return route_element(r, index)->programmed_mm_s;
}
/* Index of the element at a place; the later one at a junction. hint: an index near by. */
uint32_t takt_route_find(const struct route *r, double at_mm, uint32_t hint);
void takt_route_point(const struct route *r, double at_mm, uint32_t *hint, double p[]);
/* On an element; a place outside is its nearer end. */
void takt_route_place(const struct route *r, uint32_t index, double at_mm, double p[]);
void takt_route_scatter(const struct route *r, const double by_slot[], struct point *p);
void takt_route_gather(const struct route *r, const struct point *p, double by_slot[]);
/*
 * The motion of an element, as it is programmed, from a place on; false: it is not curved, or is no
 * such motion from there on: lines go along it.
 */
bool takt_route_along(const struct route *r, uint32_t index, double at_mm, struct move *move);
/* Second derivative by the route, weighted; 0 on lines. Returns its size, 1/mm. */
float takt_route_curvature(const struct route *r, uint32_t index, double at_mm, float curvature[]);
/*
 * Unit vector (weighted) along an element; a place outside is its nearer end. Weighted length for a
 * mm of it.
 */
float takt_route_direction(const struct route *r, uint32_t index, double at_mm, float direction[]);
/* Radius of its curvature there; infinite on lines. */
float takt_route_radius(const struct route *r, uint32_t index, double at_mm);
/* How far from that place to both sides an element leaves its tangent by no more than so much. */
float takt_route_straight(const struct route *r, uint32_t index, double at_mm, float within_mm);
/* Those at both sides of the start of an element that is not the first. */
void takt_route_corner(const struct route *r, uint32_t index, float before[], float after[]);
/*
 * The nearest place to x between from_mm and to_mm that can be walked to from f->at_mm in
 * f->element without moving away: at a retrace it stays on the branch it is on.
 */
void takt_route_closest(const struct route *r, const double x[], double from_mm, double to_mm,
                        struct route_closest *f);

#endif

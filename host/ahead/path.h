/*
 * The programmed path of one section, from rest to rest: elements in order, told by the length
 * along them.
 */
#ifndef TAKT_HOST_AHEAD_PATH_H
#define TAKT_HOST_AHEAD_PATH_H

#include "geometry/curve.h"
#include "program/move.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* How the path goes on from one element to the next. */
enum ahead_junction {
    /* the curve is close to the junction if it is close to the path at every half knot */
    AHEAD_SMOOTH,
    AHEAD_CURVED, /* it has to be led close to the junction, sideways */
    AHEAD_SHARP   /* and along the path as well */
};

/* What a motion is, beside its end (program/move.h). */
struct ahead_shape {
    enum move_kind kind;
    enum plane plane;
    unsigned turns;
    double heading_rad[2],
        curvature_1_mm[2]; /* of splines; arcs and involutes have centre and radius there */
    double spline_mm;
};

struct ahead_element {
    struct curve curve;
    struct ahead_shape shape;
    double start_mm;     /* along the section's path */
    double feed_mm_s;    /* programmed; infinite for a rapid */
    double tolerance_mm; /* largest distance of the setpoints from it */
    uint32_t block;      /* of the motion, from 1 */
    uint32_t line;
    bool exact;                   /* G61: corners are not rounded */
    bool stop;                    /* G61.1: the axes stop at its end */
    enum ahead_junction junction; /* at its end */
};

struct ahead_path {
    struct ahead_element *element; /* owned */
    size_t count;
    size_t capacity;
};

/* Where on the path something is nearest. */
struct ahead_closest {
    double place_mm; /* along the path */
    double distance_mm;
    size_t element;
    double point[AXIS_LINEAR_COUNT];
    double tangent[AXIS_LINEAR_COUNT]; /* unit vector along the path there */
};

void ahead_path_init(struct ahead_path *path);
void ahead_path_free(struct ahead_path *path);
/* Appends an element; start_mm is set here. False: out of memory. */
bool ahead_path_add(struct ahead_path *path, const struct ahead_element *element);
/* Empties it, keeps the memory. */
void ahead_path_clear(struct ahead_path *path);
double ahead_path_length(const struct ahead_path *path);

/* The element that holds a place; hint: where to begin to look. */
size_t ahead_path_find(const struct ahead_path *path, double place_mm, size_t hint);

/* The place of an element that is nearest to a point; near_mm: where to begin to look. */
double ahead_path_place(const struct ahead_path *path, size_t element,
                        const double x[AXIS_LINEAR_COUNT], double near_mm);

/* The point and the unit tangent at a place of an element. */
void ahead_path_at(const struct ahead_path *path, size_t element, double place_mm,
                   double point[AXIS_LINEAR_COUNT], double tangent[AXIS_LINEAR_COUNT]);

/*
 * The nearest place within reach_mm of place_mm, where farther ones along the path count as a
 * little farther away, so that a path that turns back on itself is not mixed up. hint: an element
 * near by.
 */
void ahead_path_closest(const struct ahead_path *path, const double x[AXIS_LINEAR_COUNT],
                        double place_mm, double reach_mm, size_t hint,
                        struct ahead_closest *closest);

#endif

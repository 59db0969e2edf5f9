#include "ahead/path.h"

#include "base/maths.h"
#include "convex/vector.h"

#include <stdlib.h>

/* A place that is farther along the path by 1 mm counts as farther away by this. */
#define FAR_ALONG_MM 0.5

/* Cosines between tangents of sharp and of curved junctions: 20 and 0.5 degrees. */
#define SHARP_COSINE  0.94
#define CURVED_COSINE 0.99996

/* Steps to the nearest place of an arc from a place near by. */
#define CLOSEST_STEPS 3

void ahead_path_init(struct ahead_path *path)
{
    *path = (struct ahead_path){0};
}

void ahead_path_free(struct ahead_path *path)
{
    free(path->element);
    ahead_path_init(path);
}

void ahead_path_clear(struct ahead_path *path)
{
    path->count = 0;
}

double ahead_path_length(const struct ahead_path *path)
{
    const struct ahead_element *last;

    if (path->count == 0)
        return 0;
    last = &path->element[path->count - 1];
    return last->start_mm + last->curve.length_mm;
}

static bool grow(struct ahead_path *path)
{
    const size_t capacity = path->capacity != 0 ? 2 * path->capacity : 64;
    struct ahead_element *grown = realloc(path->element, capacity * sizeof *grown);

    if (grown == NULL)
        return false;
    path->element = grown;
    path->capacity = capacity;
    return true;
}

static enum ahead_junction junction_of(const struct curve *before, const struct curve *after)
{
    struct point in;
    struct point out;
    double cosine;

    takt_curve_tangent(before, before->length_mm, &in);
    takt_curve_tangent(after, 0, &out);
    cosine = vector_dot(in.at, out.at);
    if (cosine < SHARP_COSINE)
        return AHEAD_SHARP;
    return cosine < CURVED_COSINE ? AHEAD_CURVED : AHEAD_SMOOTH;
}

bool ahead_path_add(struct ahead_path *path, const struct ahead_element *element)
{
    const double start_mm = ahead_path_length(path);

    if (path->count == path->capacity && !grow(path))
        return false;
    path->element[path->count] = *element;
    path->element[path->count].start_mm = start_mm;
    path->element[path->count].junction = AHEAD_SMOOTH;
    if (path->count > 0)
        path->element[path->count - 1].junction =
            junction_of(&path->element[path->count - 1].curve, &element->curve);
    path->count++;
    return true;
}

static bool holds(const struct ahead_path *path, size_t k, double place_mm)
{
    return (k == 0 || path->element[k].start_mm <= place_mm) &&
           (k + 1 >= path->count || path->element[k + 1].start_mm > place_mm);
}

size_t ahead_path_find(const struct ahead_path *path, double place_mm, size_t hint)
{
    size_t low = 0;
    size_t high = path->count; /* the element is in low ... high - 1 */

    if (hint < path->count && holds(path, hint, place_mm))
        return hint;
    if (hint + 1 < path->count && holds(path, hint + 1, place_mm))
        return hint + 1;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;

        if (path->element[middle].start_mm <= place_mm)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void ahead_path_at(const struct ahead_path *path, size_t element, double place_mm,
                   double point[AXIS_LINEAR_COUNT], double tangent[AXIS_LINEAR_COUNT])
{
    const struct ahead_element *e = &path->element[element];
    const double s_mm = maths_clamp(place_mm - e->start_mm, 0, e->curve.length_mm);
    struct point p;
    struct point t;

    takt_curve_point(&e->curve, s_mm, &p);
    takt_curve_tangent(&e->curve, s_mm, &t);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        point[i] = p.at[i];
        tangent[i] = t.at[i];
    }
}

/* Newton's steps on the length, each as if the curve were straight. */
static double nearest_on_curve(const struct ahead_path *path, size_t k, const double x[3],
                               double from_mm, double to_mm, double near_mm)
{
    double s_mm = maths_clamp(near_mm, from_mm, to_mm);
    const int steps = path->element[k].curve.kind == CURVE_LINE ? 1 : CLOSEST_STEPS;

    for (int i = 0; i < steps; i++) {
        double p[3];
        double t[3];
        double way[3];

        ahead_path_at(path, k, s_mm, p, t);
        vector_from_to(p, x, way);
        s_mm = maths_clamp(s_mm + vector_dot(way, t), from_mm, to_mm);
    }
    return s_mm;
}

double ahead_path_place(const struct ahead_path *path, size_t element, const double x[3],
                        double near_mm)
{
    const struct ahead_element *e = &path->element[element];

    return nearest_on_curve(path, element, x, e->start_mm, e->start_mm + e->curve.length_mm,
                            near_mm);
}

/* Compares the nearest place of one element with the best so far. */
static void try_element(const struct ahead_path *path, size_t k, const double x[3], double place_mm,
                        double reach_mm, double *best, struct ahead_closest *closest)
{
    const struct ahead_element *e = &path->element[k];
    const double end_mm = e->start_mm + e->curve.length_mm;
    const double from_mm = maths_clamp(place_mm - reach_mm, e->start_mm, end_mm);
    const double to_mm = maths_clamp(place_mm + reach_mm, from_mm, end_mm);
    struct ahead_closest here = {.element = k};
    double way[3];
    double cost;

    here.place_mm = nearest_on_curve(path, k, x, from_mm, to_mm, place_mm);
    ahead_path_at(path, k, here.place_mm, here.point, here.tangent);
    vector_from_to(here.point, x, way);
    here.distance_mm = vector_length(way);
    cost = here.distance_mm + FAR_ALONG_MM * maths_abs(here.place_mm - place_mm);
    if (cost < *best) {
        *best = cost;
        *closest = here;
    }
}

void ahead_path_closest(const struct ahead_path *path, const double x[AXIS_LINEAR_COUNT],
                        double place_mm, double reach_mm, size_t hint,
                        struct ahead_closest *closest)
{
    double best = MATHS_INFINITY;
    size_t k = ahead_path_find(path, place_mm - reach_mm, hint);

    *closest = (struct ahead_closest){.element = k, .place_mm = place_mm, .distance_mm = best};
    for (; k < path->count && path->element[k].start_mm <= place_mm + reach_mm; k++)
        try_element(path, k, x, place_mm, reach_mm, &best, closest);
}

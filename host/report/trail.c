#include "report/trail.h"

#include "base/maths.h"

#include <stdlib.h>

/* A thousandth of what a mill can hold; lines and most arcs never need more. */
#define TRAIL_TOLERANCE_START_MM 0.0005
/* A fifth is about the smallest step of a colour scale that the eye tells apart. */
#define TRAIL_FEED_RATIO_START 0.2
#define TRAIL_FEED_FLOOR_RATIO 0.002

bool trail_open(struct trail *t, double feed_max_mm_s)
{
    *t = (struct trail){.tolerance_mm = TRAIL_TOLERANCE_START_MM,
                        .feed_ratio = TRAIL_FEED_RATIO_START,
                        .feed_floor_mm_s = TRAIL_FEED_FLOOR_RATIO * feed_max_mm_s,
                        .keep_lines = true};
    t->kept = malloc(TRAIL_POINTS_MAX * sizeof *t->kept);
    return t->kept != NULL;
}

void trail_close(struct trail *t)
{
    free(t->kept);
    t->kept = NULL;
}

static double dot(const double a[AXIS_LINEAR_COUNT], const double b[AXIS_LINEAR_COUNT])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/*
 * With way = point - start, along = way . direction, aside = |way - along direction|: inside when
 * aside <= tolerance and along >= reach - tolerance. Until the path has left the ball of that
 * tolerance about start there is no direction, and everything is inside.
 */
static bool strip_holds(struct trail_strip *s, const double way[AXIS_LINEAR_COUNT],
                        double tolerance_mm)
{
    const double distance_mm = maths_sqrt(dot(way, way));
    if (s->reach_mm <= 0.0) {
        if (distance_mm <= tolerance_mm)
            return true;
        for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
            s->direction[i] = way[i] / distance_mm;
        s->reach_mm = distance_mm;
        return true;
    }
    const double along_mm = dot(way, s->direction);
    double aside[AXIS_LINEAR_COUNT];
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        aside[i] = way[i] - along_mm * s->direction[i];
    if (dot(aside, aside) > tolerance_mm * tolerance_mm || along_mm < s->reach_mm - tolerance_mm)
        return false;
    s->reach_mm = maths_max(s->reach_mm, along_mm);
    return true;
}

static bool feeds_differ(const struct trail *t, double a_mm_s, double b_mm_s)
{
    return maths_abs(a_mm_s - b_mm_s) >
           t->feed_ratio * maths_max(a_mm_s, b_mm_s) + t->feed_floor_mm_s;
}

/*
 * May the trail go from the point kept last straight to point? One step always may. Inside the ball
 * about that point only the line counts, so that growing tolerances thin any path, however often it
 * changes.
 */
static bool trail_fits(struct trail *t, const struct trail_point *point)
{
    const struct trail_point *start = &t->kept[t->count - 1];
    const struct trail_point *newest = &t->strip.newest;
    double way[AXIS_LINEAR_COUNT];
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        way[i] = point->at_mm[i] - start->at_mm[i];
    const bool holds = strip_holds(&t->strip, way, t->tolerance_mm);
    if (!t->strip.is_used)
        return true;
    if (!holds || (t->keep_lines && point->line != newest->line))
        return false;
    return t->strip.reach_mm <= 0.0 ||
           (point->rapid == newest->rapid && !feeds_differ(t, point->feed_mm_s, start->feed_mm_s));
}

static void trail_keep(struct trail *t, const struct trail_point *point)
{
    t->kept[t->count++] = *point;
    t->strip = (struct trail_strip){.newest = *point};
}

static void trail_thin(struct trail *t, const struct trail_point *point)
{
    if (t->count == 0) {
        trail_keep(t, point);
        return;
    }
    if (!trail_fits(t, point)) {
        trail_keep(t, &t->strip.newest);
        (void)trail_fits(t, point); /* the first step of the new strip gives it its direction */
    }
    t->strip.newest = *point;
    t->strip.is_used = true;
}

/* Thins the kept points in place: at most one is written for one that was read. */
static void trail_coarsen(struct trail *t)
{
    const uint32_t count = t->count;
    t->tolerance_mm *= 2.0;
    t->feed_ratio *= 2.0;
    t->keep_lines = false;
    t->count = 0;
    for (uint32_t k = 0; k < count; k++) {
        const struct trail_point point = t->kept[k];
        trail_thin(t, &point);
    }
    trail_finish(t);
}

void trail_add(struct trail *t, const struct trail_point *point)
{
    /* Room for the one point this step may keep, and for the one that finishing keeps. */
    if (t->count + 2 > TRAIL_POINTS_MAX) {
        while (t->count > TRAIL_POINTS_MAX / 4 * 3)
            trail_coarsen(t);
    }
    trail_thin(t, point);
}

void trail_finish(struct trail *t)
{
    if (t->count > 0 && t->strip.is_used)
        trail_keep(t, &t->strip.newest);
}

/*
 * A point and the end of its strip are each within one tolerance of the same ray, and the point at
 * most one tolerance beyond that end: so it is within sqrt(2^2 + 1^2) tolerances of the way drawn.
 * Every coarsening before had half the tolerance of the next, and sqrt(5)
 * (1 + 1/2 + 1/4 + ...) < 5.
 */
double trail_get_error_mm(const struct trail *t)
{
    return 5.0 * t->tolerance_mm;
}

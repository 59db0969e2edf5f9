#include "ahead/exact.h"

#include "base/maths.h"
#include "convex/vector.h"
#include "motion/motion.h"

#include <stdlib.h>

/* Blocks beyond the setpoint that are planned. */
#define LOOK_AHEAD 128

/* Rounding of differences, as the verifier has it of jerk. */
#define LIMIT_ROOM 1.001

/* The curve is off a bend's setpoints by v^2 step^2 / 6R, a chord by v^2 step^2 / 8R. */
#define CHORD_PART (0.9 * 6 / 8)

struct exact {
    const struct ahead_path *of;
    struct plan_limits limits;
    struct path path;
    struct motion motion;
    bool stops;
    size_t pushed; /* elements */
    double last_mm;
    struct trail *trail; /* intervals: of control points so far */
    size_t capacity;
};

/* As the program has it, on the exact path. */
static void push_next(struct exact *x)
{
    const struct ahead_element *e = &x->of->element[x->pushed];
    const struct move move = {
        .kind = e->shape.kind,
        .path = x->stops ? PATH_EXACT_STOP : PATH_EXACT,
        .plane = e->shape.plane,
        .line = e->line,
        .end = e->curve.end,
        .feed_mm_s = maths_is_finite(e->feed_mm_s) ? e->feed_mm_s : 0,
        .turns = e->shape.turns,
        .heading_rad = {e->shape.heading_rad[0], e->shape.heading_rad[1]},
        .curvature_1_mm = {e->shape.curvature_1_mm[0], e->shape.curvature_1_mm[1]},
        .spline_mm = e->shape.spline_mm};

    takt_path_push(&x->path, &move);
    if (++x->pushed == x->of->count)
        takt_path_finish(&x->path);
}

static void plan(struct exact *x)
{
    if (takt_motion_wanted(&x->motion) == NULL)
        return;
    takt_path_go_on(&x->path);
    while (x->pushed < x->of->count && takt_path_has_room(&x->path) &&
           takt_motion_ahead(&x->motion) < LOOK_AHEAD)
        push_next(x);
    takt_motion_build(&x->motion);
}

static bool grow(struct exact *x)
{
    const size_t capacity = x->capacity != 0 ? 2 * x->capacity : 256;
    void *control = realloc(x->trail->control, capacity * sizeof *x->trail->control);
    void *place;

    if (control == NULL)
        return false;
    x->trail->control = control;
    place = realloc(x->trail->place_mm, 2 * capacity * sizeof *x->trail->place_mm);
    if (place == NULL)
        return false;
    x->trail->place_mm = place;
    x->capacity = capacity;
    return true;
}

/*
 * The next control point, which has knot k - 1; its place stands at half knot 2 (k - 1), the
 * middle's before it.
 */
static bool append(struct exact *x, const double point[3], double place_mm)
{
    const size_t k = x->trail->intervals;

    if (k == x->capacity && !grow(x))
        return false;
    vector_copy(point, x->trail->control[k]);
    if (k > 0)
        x->trail->place_mm[2 * k - 2] = place_mm;
    if (k > 1)
        x->trail->place_mm[2 * k - 3] = 0.5 * (x->last_mm + place_mm);
    x->last_mm = place_mm;
    x->trail->intervals++;
    return true;
}

static bool append_rest(struct exact *x, const struct point *at, double place_mm, int points)
{
    bool done = true;

    for (int i = 0; i < points && done; i++)
        done = append(x, at->at, place_mm);
    return done;
}

static bool append_cycle(struct exact *x, const struct cycle_record *record)
{
    const size_t element = record->block > 0 ? record->block - 1 : 0;
    const double place_mm = ahead_path_place(x->of, element, record->cmd.at, x->last_mm);

    return append(x, record->cmd.at, maths_max(place_mm, x->last_mm));
}

static bool drive(struct exact *x)
{
    static const struct motion_operator as_programmed = {.feed_ratio = 1, .rapid_ratio = 1};
    enum motion_result result = MOTION_CYCLE;
    struct cycle_record record = {0};
    bool done = true;

    while (done && (result == MOTION_CYCLE || result == MOTION_NOT_YET)) {
        plan(x);
        result = takt_motion_cycle(&x->motion, &as_programmed, &record);
        if (result == MOTION_CYCLE)
            done = append_cycle(x, &record);
    }
    return done && result != MOTION_STALLED;
}

/* The last setpoint is the first of three control points at the end. */
static bool drive_from_rest_to_rest(struct exact *x)
{
    const struct point *start = &x->of->element[0].curve.start;
    const struct point *end = &x->of->element[x->of->count - 1].curve.end;

    takt_path_init(&x->path, &x->limits, start);
    takt_motion_init(&x->motion, &x->path, start, false);
    return append_rest(x, start, 0, TRAIL_ENDS) && drive(x) &&
           append_rest(x, end, ahead_path_length(x->of), TRAIL_ENDS - 1);
}

/* Bends may be left by what the path may be. */
static double smallest_tolerance(const struct ahead_path *path)
{
    double least = MATHS_INFINITY;

    for (size_t k = 0; k < path->count; k++)
        least = maths_min(least, path->element[k].tolerance_mm);
    return least;
}

bool exact_trail(const struct ahead_path *path, const struct plan_limits *limits, bool stops,
                 struct trail *trail, uint32_t *stalled)
{
    struct exact *x = calloc(1, sizeof *x);
    bool done;

    *trail = (struct trail){0};
    *stalled = 0;
    if (x == NULL)
        return false;
    x->of = path;
    x->stops = stops;
    x->limits = *limits;
    x->limits.chord_error_max_mm = CHORD_PART * smallest_tolerance(path);
    x->trail = trail;
    done = drive_from_rest_to_rest(x);
    *stalled = takt_motion_stalled_line(&x->motion);
    if (done) {
        trail->intervals -= TRAIL_ENDS;
        trail->motor = trail->control;
        trail->tool = trail->control;
        trail->beyond = calloc(trail->intervals, sizeof *trail->beyond);
        done = trail->beyond != NULL;
    }
    free(x);
    if (!done)
        trail_free(trail);
    return done;
}

static bool is_within(double (*c)[3], int axis, const struct plan_limits *l)
{
    const double h = LIMIT_ROOM * l->cycle_s;
    const double first = c[1][axis] - c[0][axis];
    const double second = c[2][axis] - 2 * c[1][axis] + c[0][axis];
    const double third = c[3][axis] - 3 * (c[2][axis] - c[1][axis]) - c[0][axis];

    return maths_abs(first) <= l->velocity_mm_s[axis] * h &&
           maths_abs(second) <= l->acceleration_mm_s2[axis] * h * l->cycle_s &&
           maths_abs(third) <= l->jerk_mm_s3[axis] * h * l->cycle_s * l->cycle_s;
}

bool exact_is_legal(const struct trail *trail, const struct plan_limits *limits)
{
    bool legal = true;

    for (size_t k = 0; k < trail->intervals && legal; k++) {
        for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
            legal = legal &&
                    ((limits->axes & (1U << i)) == 0 || is_within(trail->motor + k, i, limits));
    }
    return legal;
}

static double fastest(const struct ahead_element *e, const struct plan_limits *limits)
{
    double t[3];
    double speed = vector_length(limits->velocity_mm_s);

    if (e->curve.kind == CURVE_LINE) {
        vector_from_to(e->curve.start.at, e->curve.end.at, t);
        for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
            if (t[i] != 0)
                speed = maths_min(speed,
                                  limits->velocity_mm_s[i] * e->curve.length_mm / maths_abs(t[i]));
        }
    }
    return maths_min(speed, e->feed_mm_s);
}

double exact_least_s(const struct ahead_path *path, const struct plan_limits *limits)
{
    double sum_s = 0;

    for (size_t k = 0; k < path->count; k++)
        sum_s += path->element[k].curve.length_mm / fastest(&path->element[k], limits);
    return sum_s;
}

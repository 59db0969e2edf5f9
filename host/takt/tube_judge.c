#include "takt/tube_judge.h"

#include "base/maths.h"
#include "takt/judge_curve.h"

#include <stdlib.h>
#include <string.h>

/* How far ahead on the path the nearest place is looked for: so many steps, and so many tolerances. */
#define REACH_STEPS      4
#define REACH_TOLERANCES 20

/* Steps to the nearest place of a bent curve. */
#define REFINE_STEPS 5

void tube_judge_init(struct tube_judge *t, const struct program_config *program,
                     const struct source *source, double exact_mm)
{
    memset(t, 0, sizeof *t);
    program_open(&t->program, program, source);
    offset_open(&t->offset, program);
    t->exact_mm = exact_mm;
    t->end = program->start;
    t->last = program->start;
    t->figures.beyond_mm = -MATHS_INFINITY;
}

void tube_judge_free(struct tube_judge *t)
{
    free(t->element);
    t->element = NULL;
}

static struct tube_element *element(const struct tube_judge *t, size_t k)
{
    return &t->element[(t->first + k) % t->capacity];
}

static double end_of(const struct tube_element *e)
{
    return e->start_mm + e->curve.length_mm;
}

static bool grow(struct tube_judge *t)
{
    const size_t capacity = t->capacity != 0 ? 2 * t->capacity : 64;
    struct tube_element *grown = calloc(capacity, sizeof *grown);

    if (grown == NULL)
        return false;
    for (size_t k = 0; k < t->count; k++)
        grown[k] = *element(t, k);
    free(t->element);
    t->element = grown;
    t->first = 0;
    t->capacity = capacity;
    return true;
}

static bool push(struct tube_judge *t, const struct move *move)
{
    const bool rounded = move->path == PATH_BLEND && move->tolerance_mm > 0;
    struct tube_element e = {.start_mm = t->length_mm, .line = move->line};
    const struct point start = t->end;

    t->end = move->end;
    if (!move_curve(move, &start, &e.curve))
        return true;
    e.tolerance_mm = rounded ? maths_max(move->tolerance_mm, t->exact_mm) : t->exact_mm;
    e.corner_mm = MATHS_INFINITY;
    if (t->count == t->capacity && !grow(t))
        return false;
    t->length_mm += e.curve.length_mm;
    t->count++;
    *element(t, t->count - 1) = e;
    return true;
}

static bool read_move(struct tube_judge *t)
{
    struct move move;
    struct diagnostic error;

    if (offset_next(&t->offset, &t->program, &move, &error) != PROGRAM_MOVE) {
        t->program_ended = true;
        return true;
    }
    return !move_is_motion(&move) || push(t, &move);
}

static void beyond(struct tube_judge *t, double distance_mm, double tolerance_mm, uint32_t line)
{
    if (distance_mm - tolerance_mm <= t->figures.beyond_mm)
        return;
    t->figures.beyond_mm = distance_mm - tolerance_mm;
    t->figures.beyond_line = line;
}

/* Every corner has the tolerance of the wider of the two motions it joins. */
static void drop_first(struct tube_judge *t)
{
    const struct tube_element *e = element(t, 0);
    double tolerance_mm = e->tolerance_mm;

    if (t->count > 1)
        tolerance_mm = maths_max(tolerance_mm, element(t, 1)->tolerance_mm);
    t->figures.corner_mm = maths_max(t->figures.corner_mm, e->corner_mm);
    beyond(t, e->corner_mm, tolerance_mm, e->line);
    t->first = (t->first + 1) % t->capacity;
    t->count--;
}

static double segment_distance(const struct point *a, const struct point *b, const struct point *p)
{
    struct point nearest = *a;
    double way = 0;
    double square = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        way += (p->at[i] - a->at[i]) * (b->at[i] - a->at[i]);
        square += (b->at[i] - a->at[i]) * (b->at[i] - a->at[i]);
    }
    for (int i = 0; i < AXIS_COUNT && square > 0; i++)
        nearest.at[i] += maths_clamp(way / square, 0, 1) * (b->at[i] - a->at[i]);
    return judge_distance(&nearest, p);
}

/* Ends of motions near the place: how near does this step come to them? */
static void judge_corners(struct tube_judge *t, const struct point *setpoint, double reach_mm)
{
    for (size_t k = 0; k < t->count && end_of(element(t, k)) <= t->place_mm + reach_mm; k++) {
        struct tube_element *e = element(t, k);

        e->corner_mm = maths_min(e->corner_mm, segment_distance(&t->last, setpoint, &e->curve.end));
    }
}

/*
 * Of a helix judge_curve_distance compares the point at the same angle, which is not the nearest one: from there steps
 * along the tangent, as if the curve were straight.
 */
static double refine(const struct tube_element *e, const struct point *setpoint, double distance,
                     double *part)
{
    double s_mm = *part * e->curve.length_mm;

    for (int k = 0; k < REFINE_STEPS && e->curve.kind != CURVE_LINE; k++) {
        struct point on;
        struct point along;
        double way = 0;

        curve_point(&e->curve, s_mm, &on);
        curve_tangent(&e->curve, s_mm, &along);
        for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
            way += (setpoint->at[i] - on.at[i]) * along.at[i];
        s_mm = maths_clamp(s_mm + way, 0, e->curve.length_mm);
        curve_point(&e->curve, s_mm, &on);
        if (judge_distance(&on, setpoint) < distance) {
            distance = judge_distance(&on, setpoint);
            *part = s_mm / e->curve.length_mm;
        }
    }
    return distance;
}

/* The distance from a motion, of which what is behind the last place does not count; *place: of the nearest point. */
static double distance_ahead(const struct tube_judge *t, const struct tube_element *e,
                             const struct point *setpoint, double *place)
{
    const double from_mm = maths_clamp(t->place_mm - e->start_mm, 0, e->curve.length_mm);
    double part = from_mm / e->curve.length_mm;
    double distance = judge_curve_distance(&e->curve, setpoint, &part);
    struct point from;

    distance = refine(e, setpoint, distance, &part);
    *place = e->start_mm + part * e->curve.length_mm;
    if (*place >= t->place_mm)
        return distance;
    *place = e->start_mm + from_mm;
    curve_point(&e->curve, from_mm, &from);
    return judge_distance(&from, setpoint);
}

/*
 * The place goes on to the first motion within its tolerance, not to the nearest: of a path that turns back on itself both
 * legs are near. What counts as the deviation is the nearest place from there on, within reach.
 */
static void judge_place(struct tube_judge *t, const struct point *setpoint, double reach_mm)
{
    const struct tube_element *nearest = NULL;
    double best = MATHS_INFINITY;
    double place = t->place_mm;
    bool kept = false;

    for (size_t k = 0; k < t->count && element(t, k)->start_mm <= t->place_mm + reach_mm; k++) {
        const struct tube_element *e = element(t, k);
        double here;
        double distance;

        if (end_of(e) < t->place_mm)
            continue;
        distance = distance_ahead(t, e, setpoint, &here);
        if (!kept && (distance <= e->tolerance_mm || distance < best))
            place = here;
        kept = kept || distance <= e->tolerance_mm;
        if (distance < best) {
            best = distance;
            nearest = e;
        }
    }
    if (nearest == NULL)
        return;
    t->place_mm = maths_max(t->place_mm, place);
    t->figures.deviation_mm = maths_max(t->figures.deviation_mm, best);
    beyond(t, best, nearest->tolerance_mm, nearest->line);
}

/* Of the motions near by: the place may lag behind the setpoint by it. */
static double widest_tolerance(const struct tube_judge *t)
{
    double widest = t->exact_mm;

    for (size_t k = 0; k < t->count; k++)
        widest = maths_max(widest, element(t, k)->tolerance_mm);
    return widest;
}

bool tube_judge_add(struct tube_judge *t, const struct point *setpoint)
{
    const double reach_mm =
        REACH_STEPS * judge_distance(&t->last, setpoint) + REACH_TOLERANCES * widest_tolerance(t);

    while (!t->program_ended && t->length_mm <= t->place_mm + reach_mm) {
        if (!read_move(t))
            return false;
    }
    judge_place(t, setpoint, reach_mm);
    judge_corners(t, setpoint, reach_mm);
    t->last = *setpoint;
    while (t->count > 1 && end_of(element(t, 0)) < t->place_mm - reach_mm)
        drop_first(t);
    return true;
}

void tube_judge_finish(struct tube_judge *t)
{
    while (t->count > 0)
        drop_first(t);
}

/*
 * The forms by evaluation functions along a block's curve: which axes step is told by the lattice,
 * when by the setpoints. A tick is due at a part of the curve, and setpoints say when that part has
 * been passed.
 */
#include "base/assert.h"
#include "step/steps_private.h"

#include "base/maths.h"
#include "geometry/place.h"

#include <string.h>

/* A setpoint farther from the curve, in steps, is not on it: corrected, blended, offset. */
#define OFF_CURVE_STEPS 0.01

/* A part of the curve that may have been passed already, by rounding. */
#define PART_ROOM 1e-9

static bool fits(double steps)
{
    return maths_abs(steps) < 0.5 * (double)EVALUATE_STEPS_MAX;
}

/* Nearest position of every step axis. */
static bool to_lattice(const struct steps *s, const struct point *p, int64_t lattice[AXIS_COUNT])
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const double steps = steps_has(s, i) ? p->at[i] * s->config.axis[i].steps_per_mm : 0.0;

        if (!fits(steps)) {
            return false;
        }
        lattice[i] = (int64_t)takt_maths_round(steps);
    }
    return true;
}

/* A circle, in axes of equal steps. */
static bool is_evaluable_arc(const struct steps *s, const struct curve *c)
{
    const unsigned first = c->arc.first;
    const unsigned second = c->arc.second;
    const double ratio = s->config.axis[first].steps_per_mm;

    return steps_has(s, first) && steps_has(s, second) &&
           ratio == s->config.axis[second].steps_per_mm && fits(c->arc.radius_start_mm * ratio) &&
           maths_abs(c->arc.radius_change_mm) * ratio < OFF_CURVE_STEPS;
}

/*
 * Whole turns that start, end and sweep on the lattice leave over. Below 0: the arc is shorter than
 * its rounding.
 */
static double lattice_turns(const struct curve *c, const struct evaluate_arc_config *arc)
{
    const double from = takt_maths_atan2((double)arc->start[1], (double)arc->start[0]);
    const double to = takt_maths_atan2((double)arc->end[1], (double)arc->end[0]);
    const double rest = arc->clockwise ? from - to : to - from;
    const bool same = arc->start[0] == arc->end[0] && arc->start[1] == arc->end[1];
    const double part = same ? 0.0 : rest - MATHS_TWO_PI * takt_maths_floor(rest / MATHS_TWO_PI);

    return takt_maths_round((maths_abs(c->arc.sweep_rad) - part) / MATHS_TWO_PI);
}

/* The circle on the lattice: its centre is the nearest position too. False: too small to be one. */
static bool begin_arc(struct steps *s, const struct curve *c, const int64_t start[AXIS_COUNT],
                      const int64_t end[AXIS_COUNT])
{
    const unsigned plane[2] = {c->arc.first, c->arc.second};
    struct evaluate_arc_config arc = {
        .form = s->config.form == STEPS_PLAIN ? EVALUATE_PLAIN : EVALUATE_IMPROVED,
        .clockwise = c->arc.sweep_rad < 0.0,
    };
    int64_t delta[AXIS_COUNT];

    for (unsigned i = 0; i < 2; i++) {
        const double ratio = s->config.axis[plane[i]].steps_per_mm;
        const int64_t centre = (int64_t)takt_maths_round(c->arc.centre_mm[i] * ratio);

        arc.start[i] = start[plane[i]] - centre;
        arc.end[i] = end[plane[i]] - centre;
    }
    const double turns = lattice_turns(c, &arc);

    if (turns < 0.0 || (arc.start[0] == 0 && arc.start[1] == 0) ||
        (arc.end[0] == 0 && arc.end[1] == 0)) {
        return false;
    }
    arc.turns = (unsigned)turns;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        delta[i] = end[i] - start[i];
    }
    takt_evaluate_helix_begin(&s->path.helix, &arc, plane, delta);
    s->path.due = takt_evaluate_helix_due(&s->path.helix);
    return true;
}

static void set_line_due(struct steps_path *path)
{
    TAKT_ASSERT(path->made >= 0 && path->made <= path->ticks);
    path->due = path->ticks > 0 ? ((double)path->made + 0.5) / (double)path->ticks : 1.0;
}

static void begin_line(struct steps *s, const int64_t start[AXIS_COUNT],
                       const int64_t end[AXIS_COUNT])
{
    int64_t delta[AXIS_COUNT];

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        delta[i] = end[i] - start[i];
    }
    takt_evaluate_line_begin(
        &s->path.line, s->config.form == STEPS_PLAIN ? EVALUATE_PLAIN : EVALUATE_IMPROVED, delta);
    s->path.ticks = s->path.line.left;
    set_line_due(&s->path);
}

bool takt_steps_path_begin(struct steps *s, const struct steps_target *target)
{
    const struct curve *c = &target->curve;
    int64_t start[AXIS_COUNT];
    int64_t end[AXIS_COUNT];

    memset(&s->path, 0, sizeof(s->path));
    s->path.curve = *c;
    s->path.curved = c->kind == CURVE_ARC;
    if (!to_lattice(s, &c->start, start) || !to_lattice(s, &c->end, end)) {
        return false;
    }
    if (c->kind == CURVE_LINE) {
        begin_line(s, start, end);
        s->path.active = true;
    } else if (c->kind == CURVE_ARC && is_evaluable_arc(s, c)) {
        s->path.active = begin_arc(s, c, start, end);
    }
    return s->path.active;
}

static bool is_near(const struct steps *s, const struct point *a, const struct point *b)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (steps_has(s, i) &&
            maths_abs(a->at[i] - b->at[i]) * s->config.axis[i].steps_per_mm > OFF_CURVE_STEPS) {
            return false;
        }
    }
    return true;
}

double takt_steps_path_place(const struct steps *s, const struct point *p)
{
    const struct curve *c = &s->path.curve;
    const double part = takt_curve_place(c, p, s->path.part);
    struct point on;

    if (part < -PART_ROOM || part > 1.0 + PART_ROOM) {
        return -1.0;
    }
    takt_curve_point(c, maths_clamp(part, 0.0, 1.0) * c->length_mm, &on);
    return is_near(s, &on, p) ? maths_clamp(part, 0.0, 1.0) : -1.0;
}

/* False: the end has been reached. */
static bool next_tick(struct steps_path *path, struct evaluate_tick *tick)
{
    if (path->curved) {
        const bool any = takt_evaluate_helix_next(&path->helix, tick);

        path->due = takt_evaluate_helix_due(&path->helix);
        return any;
    }
    path->made++;
    set_line_due(path);
    return takt_evaluate_line_next(&path->line, tick);
}

void takt_steps_path_follow(struct steps *s, const struct step_port *port, double part,
                            struct steps_span span)
{
    struct steps_path *path = &s->path;
    const double from = path->part;
    struct evaluate_tick tick;

    while (path->due <= part && s->held.axes == 0) {
        const double passed = part > from ? (path->due - from) / (part - from) : 0.0;

        if (!next_tick(path, &tick)) {
            break;
        }
        (void)takt_steps_emit(s, port, span.from + (span.to - span.from) * passed, &tick);
    }
    path->part = maths_max(path->part, part);
}

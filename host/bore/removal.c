/*
 * The cutter, a disc of radius c, goes out from the hole's centre O without leaving a core. What it
 * has cleared is then seen from O without anything in between, so that its edge is a distance over
 * the angle alpha. A disc at p, |p| = rho, in the direction gamma, clears as far as
 *
 *     rho cos(alpha - gamma) + sqrt(c^2 - rho^2 sin^2(alpha - gamma))
 *
 * and the area that it removes is the sum of (edge'^2 - edge^2) / 2 d alpha. Area by length of way
 * is the radial engagement; engaged is the part of the cutter's front half whose points are beyond
 * the edge.
 *
 * A helix comes down to one level after the other, and clears each by a disc, where it is reached,
 * and a turn around it. With a cutter of more than half the hole every disc holds O, so that a
 * level's edge is a distance over the angle, too. At each moment all levels of a turn are under
 * way, evenly over their turns.
 */
#include "bore/removal.h"

#include "base/maths.h"

#include <stdlib.h>

#define ANGLES     3600 /* of the edge */
#define ANGLE_RAD  (MATHS_TWO_PI / ANGLES)
#define STEP_RATIO (1 / 100.0) /* way between two discs, of c */
#define POINTS     720         /* of the cutter's front half */
#define BEYOND     1e-5        /* of c: rounding of the edge between its angles */
#define HALVINGS   40
#define LEVELS     BORE_WINDOWS_PER_TURN /* of a turn of a helix: one is reached in each window */

/* At one angle: how far it is cleared; how far it was before this turn, and when that turn came. */
struct edge {
    double unit[2];
    double now_mm, before_mm;
    double turned_rad;
};

struct sweep {
    double cutter_mm;
    struct edge edge[ANGLES];
    double at_mm[2], heading_rad; /* of the last disc */
    double turned_rad;            /* since the start */
    bool moves;
};

static double square(double x)
{
    return x * x;
}

static const struct edge *edge_at(const struct sweep *s, long angle)
{
    return &s->edge[(angle % ANGLES + ANGLES) % ANGLES];
}

/* How far a disc reaches from the centre in a direction; 0: it is not there. */
static double reach(double cutter_mm, const double at_mm[2], const double unit[2])
{
    double along = at_mm[0] * unit[0] + at_mm[1] * unit[1];
    double root = square(cutter_mm) - square(at_mm[0] * unit[1] - at_mm[1] * unit[0]);

    return root > 0 ? maths_max(0, along + maths_sqrt(root)) : 0;
}

/* Takes away what is under a disc; its area. */
static double clear(struct sweep *s, const double at_mm[2])
{
    double twice_mm2 = 0;

    for (unsigned i = 0; i < ANGLES; i++) {
        struct edge *edge = &s->edge[i];
        double to_mm = reach(s->cutter_mm, at_mm, edge->unit);

        if (!(to_mm > edge->now_mm))
            continue;
        if (s->turned_rad - edge->turned_rad > MATHS_PI)
            edge->before_mm = edge->now_mm;
        edge->turned_rad = s->turned_rad;
        twice_mm2 += square(to_mm) - square(edge->now_mm);
        edge->now_mm = to_mm;
    }
    return 0.5 * twice_mm2 * ANGLE_RAD;
}

/* Between two angles of the edge. */
static double edge_mm(const struct sweep *s, double x_mm, double y_mm, bool before)
{
    double angle = takt_maths_atan2(y_mm, x_mm) / ANGLE_RAD + ANGLES;
    double part = angle - takt_maths_floor(angle);
    const struct edge *a = edge_at(s, (long)angle);
    const struct edge *b = edge_at(s, (long)angle + 1);

    return before ? (1 - part) * a->before_mm + part * b->before_mm
                  : (1 - part) * a->now_mm + part * b->now_mm;
}

static bool is_material(const struct sweep *s, double x_mm, double y_mm, bool before)
{
    return maths_sqrt(square(x_mm) + square(y_mm)) >
           edge_mm(s, x_mm, y_mm, before) + BEYOND * s->cutter_mm;
}

/*
 * From the cutter's right side, which is at the wall, inwards: to where the turn before had
 * cleared.
 */
static double layer_at(const struct sweep *s, const double at_mm[2], double heading_rad)
{
    double least_mm = 0;
    double most_mm = 2 * s->cutter_mm;
    double sine, cosine;

    takt_maths_sincos(heading_rad, &sine, &cosine);
    for (unsigned i = 0; i < HALVINGS; i++) {
        double layer_mm = 0.5 * (least_mm + most_mm);
        double side_mm = s->cutter_mm - layer_mm;
        bool is_in = is_material(s, at_mm[0] + side_mm * sine, at_mm[1] - side_mm * cosine, true);

        *(is_in ? &least_mm : &most_mm) = layer_mm;
    }
    return least_mm;
}

/*
 * Part of the front half, from right to left of the direction of motion, that stands in material.
 */
static double engaged_at(const struct sweep *s, const double at_mm[2], double heading_rad)
{
    unsigned inside = 0;

    for (unsigned i = 0; i < POINTS; i++) {
        double angle = heading_rad + MATHS_PI * ((i + 0.5) / POINTS - 0.5);
        double sine, cosine;

        takt_maths_sincos(angle, &sine, &cosine);
        inside +=
            is_material(s, at_mm[0] + s->cutter_mm * cosine, at_mm[1] + s->cutter_mm * sine, false);
    }
    return MATHS_PI * inside / POINTS;
}

static bool add_window(struct bore_removal *r, double turn)
{
    if (r->count == r->capacity) {
        size_t capacity = r->capacity == 0 ? 1024 : 2 * r->capacity;
        struct bore_window *window = realloc(r->window, capacity * sizeof *window);

        if (window == NULL)
            return false;
        r->window = window;
        r->capacity = capacity;
    }
    r->window[r->count++] = (struct bore_window){.turn = turn};
    return true;
}

/* The window of the turn so far; windows between, which a corner passes over, have no length. */
static bool reach_window(struct bore_removal *r, double turns, const struct sweep *s,
                         const double at_mm[2])
{
    while (r->count == 0 || turns * BORE_WINDOWS_PER_TURN >= (double)r->count) {
        if (!add_window(r, ((double)r->count + 0.5) / BORE_WINDOWS_PER_TURN))
            return false;
        r->window[r->count - 1].engaged_rad = engaged_at(s, at_mm, s->heading_rad);
        r->window[r->count - 1].layer_mm = layer_at(s, at_mm, s->heading_rad);
    }
    return true;
}

static double unwound(double angle_rad)
{
    return angle_rad - MATHS_TWO_PI * takt_maths_floor(angle_rad / MATHS_TWO_PI + 0.5);
}

static bool advance(struct bore_removal *r, struct sweep *s, const double at_mm[2])
{
    double dx = at_mm[0] - s->at_mm[0];
    double dy = at_mm[1] - s->at_mm[1];
    double way_mm = maths_sqrt(dx * dx + dy * dy);
    double heading_rad = takt_maths_atan2(dy, dx);

    if (way_mm < STEP_RATIO * s->cutter_mm)
        return true;
    s->turned_rad += s->moves ? unwound(heading_rad - s->heading_rad) : 0;
    s->heading_rad = heading_rad;
    s->moves = true;
    if (!reach_window(r, s->turned_rad / MATHS_TWO_PI, s, at_mm))
        return false;
    r->window[r->count - 1].area_mm2 += clear(s, at_mm);
    r->window[r->count - 1].length_mm += way_mm;
    s->at_mm[0] = at_mm[0];
    s->at_mm[1] = at_mm[1];
    return true;
}

/*
 * A level where the cutter stands, and its way since, for this many turns. first_mm2: what its
 * first disc has removed.
 */
static bool sweep_level(struct bore_removal *r, const struct bore_track *t, size_t first,
                        double cutter_mm, double turns, double *first_mm2)
{
    struct sweep *s = calloc(1, sizeof *s);
    bool good = s != NULL;

    if (good) {
        s->cutter_mm = cutter_mm;
        s->at_mm[0] = t->at_mm[first][0];
        s->at_mm[1] = t->at_mm[first][1];
        for (unsigned i = 0; i < ANGLES; i++)
            takt_maths_sincos(i * ANGLE_RAD, &s->edge[i].unit[1], &s->edge[i].unit[0]);
        *first_mm2 = clear(s, s->at_mm);
        for (unsigned i = 0; i < ANGLES && first == 0; i++) /* the hole to begin in */
            s->edge[i].before_mm = cutter_mm;
    }
    for (size_t i = first; i < t->count && good && s->turned_rad < MATHS_TWO_PI * turns; i++)
        good = advance(r, s, t->at_mm[i]);
    free(s);
    return good;
}

bool bore_removal_make(struct bore_removal *r, const struct bore_track *t, double cutter_radius_mm)
{
    double hole_mm2;

    *r = (struct bore_removal){0};
    return t->count == 0 || sweep_level(r, t, 0, cutter_radius_mm, MATHS_INFINITY, &hole_mm2);
}

/* The cycle in which the cutter comes down to a level. */
static size_t reached(const struct bore_track *t, double down_mm)
{
    size_t i = 0;

    while (i + 1 < t->count && -t->at_mm[i][2] < down_mm)
        i++;
    return i;
}

/* A level's part of the mean; it begins this many windows behind in the turn. */
static void add_level(struct bore_removal *r, const struct bore_removal *level, size_t behind)
{
    for (size_t i = 0; i < level->count && i < BORE_WINDOWS_PER_TURN; i++) {
        const struct bore_window *from = &level->window[i];
        struct bore_window *to = &r->window[(behind + i) % BORE_WINDOWS_PER_TURN];

        to->area_mm2 += from->area_mm2 / LEVELS;
        to->length_mm += from->length_mm / LEVELS;
        to->layer_mm += from->layer_mm / LEVELS;
        to->engaged_rad += from->engaged_rad / LEVELS;
    }
}

static bool make_level(struct bore_removal *level, const struct bore_track *t, double cutter_mm,
                       double down_mm)
{
    double first_mm2 = 0;

    bore_removal_free(level);
    if (!sweep_level(level, t, reached(t, down_mm), cutter_mm, 1, &first_mm2))
        return false;
    if (level->count > 0)
        level->window[0].area_mm2 += first_mm2;
    return true;
}

/* Windows of this many turns, the first turn's as they are in the others. */
static bool add_turns(struct bore_removal *r, unsigned turns)
{
    for (size_t i = 0; i < (size_t)turns * BORE_WINDOWS_PER_TURN; i++) {
        if (!add_window(r, ((double)i + 0.5) / BORE_WINDOWS_PER_TURN))
            return false;
    }
    return true;
}

static void repeat_turn(struct bore_removal *r)
{
    for (size_t i = BORE_WINDOWS_PER_TURN; i < r->count; i++) {
        const double turn = r->window[i].turn;

        r->window[i] = r->window[i % BORE_WINDOWS_PER_TURN];
        r->window[i].turn = turn;
    }
}

bool bore_removal_make_helix(struct bore_removal *r, struct bore_removal *level,
                             const struct bore_track *t, double cutter_radius_mm, double down_mm,
                             unsigned turns)
{
    bool good;

    *r = *level = (struct bore_removal){0};
    good = add_turns(r, turns);
    for (unsigned k = 0; k < LEVELS && good && t->count > 0; k++) {
        good = make_level(level, t, cutter_radius_mm, down_mm * (k + 0.5) / LEVELS);
        if (good)
            add_level(r, level, k);
    }
    repeat_turn(r);
    return good;
}

void bore_removal_free(struct bore_removal *r)
{
    free(r->window);
    *r = (struct bore_removal){0};
}

double bore_window_width(const struct bore_window *w)
{
    return w->length_mm > 0 ? w->area_mm2 / w->length_mm : 0;
}

static void widen(struct bore_range *range, double value)
{
    range->least = maths_min(range->least, value);
    range->most = maths_max(range->most, value);
}

void bore_removal_evenness(const struct bore_removal *r, double first_turn, double last_turn,
                           struct bore_evenness *e)
{
    const struct bore_range none = {MATHS_INFINITY, -MATHS_INFINITY};

    *e = (struct bore_evenness){none, none, none};
    for (size_t i = 0; i < r->count; i++) {
        const struct bore_window *w = &r->window[i];

        if (w->turn < first_turn || w->turn > last_turn || !(w->length_mm > 0))
            continue;
        widen(&e->layer_mm, w->layer_mm);
        widen(&e->width_mm, bore_window_width(w));
        widen(&e->engaged_rad, w->engaged_rad);
    }
}

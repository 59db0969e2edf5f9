/*
 * Inner corners. The tool cannot follow both ways up to their common point: it leaves the first
 * where its centre line crosses that of the second.
 *
 *         k: ----------X- - - -            ways in between are swallowed when k and e cross before and behind
 *                       \                  them; then e may be far down the program and k far back
 *                    e:  \
 *
 * The newest piece of the contour is tried first, then those before it. When e crosses none of them
 * it is swallowed too and the next one is tried: the contour has a gap until one crosses. A
 * crossing that would let the tool touch what has been swallowed does not count. So a contour is
 * either followed at the tool's radius or refused.
 */
#include "cutter_compensation/contour.h"

#include "base/assert.h"
#include "base/maths.h"
#include "cutter_compensation/nose.h"

#include <string.h>

/* Crossings may be beyond the end of a way by this much. */
#define PLACE_SLACK_MM 1e-7

/* Sine of an angle by which a turn may have the wrong sign: two ways that only touch. */
#define TURN_SLACK 1e-6

/* Distances from a cusp that differ by less than this share are the same. */
#define CUSP_RATIO 1e-6

/* Where two pieces cross. */
struct crossing {
    double point[2];
    double end_mm, begin_mm; /* places on the first and on the second */
    /* another one is nearer to their corner: this one may belong to the other end of an arc */
    bool far;
};

struct compensation_item *takt_contour_item(struct cutter_compensation *o, unsigned place)
{
    TAKT_ASSERT(place < COMPENSATION_ITEMS_MAX);
    return &o->item[(o->first + place) % COMPENSATION_ITEMS_MAX];
}

struct compensation_live *takt_contour_live(struct cutter_compensation *o,
                                            const struct compensation_item *item)
{
    TAKT_ASSERT(item->live < COMPENSATION_WAYS_MAX);
    return &o->live[item->live];
}

/* For each plane its axes, and those across. */
static const uint8_t axes_turned[][AXIS_COUNT] = {
    [PLANE_XY] = {AXIS_X, AXIS_Y, AXIS_Z, AXIS_A, AXIS_B, AXIS_C},
    [PLANE_ZX] = {AXIS_Z, AXIS_X, AXIS_Y, AXIS_A, AXIS_B, AXIS_C},
    [PLANE_YZ] = {AXIS_Y, AXIS_Z, AXIS_X, AXIS_A, AXIS_B, AXIS_C},
};

void takt_contour_turned(enum plane plane, const struct point *p, double turned[AXIS_COUNT])
{
    TAKT_ASSERT(plane <= PLANE_YZ);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        turned[i] = p->at[axes_turned[plane][i]];
    }
}

void takt_contour_point(enum plane plane, const double turned[AXIS_COUNT], struct point *p)
{
    TAKT_ASSERT(plane <= PLANE_YZ);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        p->at[axes_turned[plane][i]] = turned[i];
    }
}

bool takt_contour_wanted(const struct compensation_item *i, struct planar *wanted)
{
    const struct compensation_wanted *w = &i->wanted;

    if (i->programmed == MOVE_INVOLUTE_CW || i->programmed == MOVE_INVOLUTE_CCW) {
        return takt_planar_set_involute(wanted, w->from, w->to, w->centre, w->base_mm,
                                        i->programmed == MOVE_INVOLUTE_CW);
    }
    if (i->programmed == MOVE_ARC_CW || i->programmed == MOVE_ARC_CCW) {
        takt_planar_set_arc(wanted, w->from, w->to, w->centre,
                            i->programmed == MOVE_ARC_CCW ? 1.0 : -1.0, i->turns);
        return true;
    }
    return takt_planar_set_line(wanted, w->from, w->to);
}

static bool is_way(const struct compensation_item *i)
{
    return i->kind >= COMPENSATION_CORNER && !i->left_out;
}

void takt_contour_add(struct cutter_compensation *o, const struct compensation_item *item)
{
    TAKT_ASSERT(o->count < COMPENSATION_ITEMS_MAX);
    *takt_contour_item(o, o->count++) = *item;
}

static void append(struct cutter_compensation *o, struct compensation_piece *piece)
{
    if (is_way(&piece->item)) {
        TAKT_ASSERT(o->ways < COMPENSATION_WAYS_MAX);
        piece->item.live = (uint8_t)((o->live_first + o->ways++) % COMPENSATION_WAYS_MAX);
        o->live[piece->item.live] = piece->live;
    }
    takt_contour_add(o, &piece->item);
}

void takt_contour_drop_first(struct cutter_compensation *o)
{
    TAKT_ASSERT(o->count > 0);
    if (is_way(takt_contour_item(o, 0))) {
        o->live_first = (o->live_first + 1) % COMPENSATION_WAYS_MAX;
        TAKT_ASSERT(o->ways > 0);
        o->ways--;
    }
    o->first = (o->first + 1) % COMPENSATION_ITEMS_MAX;
    o->count--;
}

struct compensation_live *takt_contour_newest(struct cutter_compensation *o)
{
    return o->ways > 0 ? &o->live[(o->live_first + o->ways - 1) % COMPENSATION_WAYS_MAX] : NULL;
}

static void warn(struct cutter_compensation *o, const struct compensation_item *i)
{
    if (o->warnings < COMPENSATION_WARNINGS_MAX) {
        o->warning[o->warnings++] =
            (struct compensation_left_out){i->line, o->pattern.cutter_radius_mm};
    }
}

/* Forgets the pieces of way behind a place; commands among them stay. */
static void remove_behind(struct cutter_compensation *o, unsigned place)
{
    unsigned kept = place + 1;

    TAKT_ASSERT(place < o->count);
    for (unsigned i = place + 1; i < o->count; i++) {
        const struct compensation_item *item = takt_contour_item(o, i);

        if (item->kind == COMPENSATION_WAY) {
            warn(o, item);
        }
        o->ways -= is_way(item) ? 1 : 0;
        if (item->kind < COMPENSATION_CORNER) {
            *takt_contour_item(o, kept++) = *item;
        }
    }
    o->count = kept;
}

static bool is_inside(double place_mm, const struct planar *way)
{
    return place_mm >= -PLACE_SLACK_MM && place_mm <= takt_planar_length(way) + PLACE_SLACK_MM;
}

/* As it is, with places beyond the ends. */
static struct crossing crossing_at(const struct planar *k, const struct planar *e,
                                   const double point[2])
{
    return (struct crossing){
        .point = {point[0], point[1]},
        .end_mm = takt_planar_place_near_to(k, point),
        .begin_mm = takt_planar_place_near_from(e, point),
    };
}

static bool is_within(const struct planar *k, const struct planar *e, const struct crossing *c)
{
    return is_inside(c->end_mm, k) && is_inside(c->begin_mm, e);
}

/*
 * How far the crossing is from the common corner along both ways. In a cusp there are two at the
 * same distance: the one within both ways comes first.
 */
static double cut_mm(const struct planar *k, const struct planar *e, const struct crossing *c)
{
    const double cut = maths_abs(takt_planar_length(k) - c->end_mm) + maths_abs(c->begin_mm);

    return is_within(k, e, c) ? cut * (1.0 - CUSP_RATIO) : cut;
}

/* All crossings, the nearest to the corner first, which alone is not far. */
static unsigned sorted_crossings(const struct planar *k, const struct planar *e,
                                 struct crossing found[2])
{
    double points[2][2];
    const unsigned count = takt_planar_cross(k, e, points);

    for (unsigned i = 0; i < count; i++) {
        found[i] = crossing_at(k, e, points[i]);
    }
    if (count == 2 && cut_mm(k, e, &found[1]) < cut_mm(k, e, &found[0])) {
        const struct crossing first = found[0];

        found[0] = found[1];
        found[1] = first;
    }
    for (unsigned i = 0; i < count; i++) {
        found[i].far = i > 0;
    }
    return count;
}

/* The crossings within both ways. */
static unsigned find_crossings(const struct planar *k, const struct planar *e,
                               struct crossing found[2])
{
    const unsigned all = sorted_crossings(k, e, found);
    unsigned count = 0;

    for (unsigned i = 0; i < all; i++) {
        if (is_within(k, e, &found[i])) {
            found[count] = found[i];
            found[count].end_mm = maths_min(found[i].end_mm, takt_planar_length(k));
            found[count].begin_mm = maths_max(found[i].begin_mm, 0.0);
            count++;
        }
    }
    return count;
}

/* How far the tool would cut into an item's programmed way when it follows both. */
static double gouge_of(const struct compensation_item *item, const struct planar *k,
                       const struct planar *e, double radius_mm)
{
    struct planar wanted;

    (void)takt_contour_wanted(item, &wanted);
    return radius_mm -
           maths_min(takt_planar_distance(k, &wanted), takt_planar_distance(e, &wanted));
}

/* The way that is really gone of an item's: the first of a contour comes from where the tool is. */
static struct planar real_way(const struct cutter_compensation *o,
                              const struct compensation_item *i, const struct planar *way)
{
    struct planar real = *way;
    double from[2];

    if (i->entry && !way->arc) {
        takt_nose_centre(&o->pattern, i->wanted.from, from);
        (void)takt_planar_set_line(&real, from, way->to);
    }
    return real;
}

/* Both ways as they are when they meet at a crossing. */
struct trial {
    struct planar k, e;
};

/*
 * The tool's path turns to the tool's side in an inner corner; another crossing leads into the
 * contour.
 */
static bool turns_inside(const struct cutter_compensation *o, const struct trial *t)
{
    double before[2];
    double behind[2];

    takt_planar_tangent_to(&t->k, before);
    takt_planar_tangent_from(&t->e, behind);
    const double turn = planar_turn(before, behind);

    return (o->pattern.cutter_side == CUTTER_LEFT ? turn : -turn) >= -TURN_SLACK;
}

/*
 * How far the tool cuts into a programmed way on the corner before a place, and on the way before
 * that.
 */
static double gouge_before(struct cutter_compensation *o, unsigned place,
                           const struct planar *wanted, double radius_mm)
{
    double gouge_mm = 0.0;

    TAKT_ASSERT(place < o->count && radius_mm > 0.0);
    for (unsigned i = place; i > 0 && takt_contour_item(o, i)->kind == COMPENSATION_CORNER; i--) {
        const struct compensation_item *item = takt_contour_item(o, i - 1);

        if (item->kind >= COMPENSATION_CORNER) {
            const struct planar way = real_way(o, item, &takt_contour_live(o, item)->way);

            gouge_mm = maths_max(gouge_mm, radius_mm - takt_planar_distance(&way, wanted));
        }
    }
    return gouge_mm;
}

/*
 * What the tool would cut away of everything from place on when the piece there and the new one
 * meet at the crossing; nothing to worry about when they are neighbours and it is the one at their
 * corner.
 */
static double gouge_behind(struct cutter_compensation *o, unsigned place,
                           const struct compensation_item *piece, const struct trial *t,
                           bool between)
{
    const struct compensation_item *at = takt_contour_item(o, place);
    const struct planar k = real_way(o, at, &t->k);
    struct planar before;
    struct planar behind;
    const double radius_mm = o->pattern.cutter_radius_mm;
    double gouge_mm = 0.0;

    for (unsigned i = place + 1; i < o->count; i++) {
        const struct compensation_item *item = takt_contour_item(o, i);

        between = between || item->kind >= COMPENSATION_CORNER;
        if (item->kind == COMPENSATION_WAY) {
            gouge_mm = maths_max(gouge_mm, gouge_of(item, &k, &t->e, radius_mm));
            gouge_mm = item->across ? radius_mm : gouge_mm;
        }
    }
    if (between) {
        (void)takt_contour_wanted(at, &before);
        (void)takt_contour_wanted(piece, &behind);
        gouge_mm = maths_max(gouge_mm, radius_mm - takt_planar_distance(&t->e, &before));
        gouge_mm = maths_max(gouge_mm, radius_mm - takt_planar_distance(&k, &behind));
        gouge_mm = maths_max(gouge_mm, gouge_before(o, place, &behind, radius_mm));
    }
    return gouge_mm;
}

/* Begins or goes on with a gap. The first way in it tells how far the tool is in the way. */
void takt_contour_leave_out(struct cutter_compensation *o, struct compensation_piece *piece)
{
    const struct compensation_live *newest = takt_contour_newest(o);
    struct planar wanted;

    if (piece->item.kind != COMPENSATION_WAY) {
        return;
    }
    if (!o->gap) {
        (void)takt_contour_wanted(&piece->item, &wanted);
        o->gap = true;
        o->gouge_line = piece->item.line;
        o->gouge_mm = newest == NULL ? 0.0
                                     : o->pattern.cutter_radius_mm -
                                           takt_planar_distance_point(&wanted, newest->way.to);
    }
    piece->item.left_out = true;
    append(o, piece);
}

/* Both ways end and begin at the crossing, if that is one that counts. */
static bool meet_at(struct cutter_compensation *o, unsigned place, struct compensation_piece *piece,
                    const struct crossing *c, bool neighbours)
{
    struct planar *k = &takt_contour_live(o, takt_contour_item(o, place))->way;
    struct trial t = {*k, piece->live.way};

    TAKT_ASSERT(place < o->count);
    takt_planar_end_at(&t.k, c->end_mm, c->point);
    takt_planar_begin_at(&t.e, c->begin_mm, c->point);
    const bool far = neighbours && c->far;
    const double most_mm = far ? COMPENSATION_ROUNDING_MM : COMPENSATION_GOUGE_MM;

    if (!turns_inside(o, &t) || gouge_behind(o, place, &piece->item, &t, far) > most_mm) {
        return false;
    }
    *k = t.k;
    piece->live.way = t.e;
    return true;
}

static bool join_at(struct cutter_compensation *o, unsigned place, struct compensation_piece *piece,
                    bool neighbours)
{
    const struct compensation_item *k = takt_contour_item(o, place);
    struct crossing found[2];
    unsigned count = 0;

    TAKT_ASSERT(place < o->count);
    if (is_way(k)) {
        count = find_crossings(&takt_contour_live(o, k)->way, &piece->live.way, found);
    }
    for (unsigned i = 0; i < count; i++) {
        if (meet_at(o, place, piece, &found[i], neighbours)) {
            remove_behind(o, place);
            append(o, piece);
            o->gap = false;
            return true;
        }
    }
    return false;
}

/*
 * at_corner: the piece begins where the contour's last one ends, in an inner corner. False: it
 * crosses none.
 */
static bool join(struct cutter_compensation *o, struct compensation_piece *piece, bool at_corner)
{
    const struct compensation_live *newest = at_corner && !o->gap ? takt_contour_newest(o) : NULL;

    for (unsigned i = o->count; i > 0; i--) {
        const struct compensation_item *k = takt_contour_item(o, i - 1);

        if (join_at(o, i - 1, piece, is_way(k) && takt_contour_live(o, k) == newest)) {
            return true;
        }
    }
    return false;
}

void takt_contour_continue(struct cutter_compensation *o, struct compensation_piece *piece)
{
    if (!o->gap) {
        append(o, piece);
    } else if (!join(o, piece, false)) {
        takt_contour_leave_out(o, piece);
    }
}

bool takt_contour_meet_inside(struct cutter_compensation *o, struct compensation_piece *piece)
{
    return join(o, piece, true);
}

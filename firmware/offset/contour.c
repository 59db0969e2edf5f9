/*
 * Inner corners. The tool cannot follow both ways up to their common point: it leaves the first where its centre line
 * crosses that of the second.
 *
 *         k: ----------X- - - -            ways in between are swallowed when k and e cross before and behind
 *                       \                  them; then e may be far down the program and k far back
 *                    e:  \
 *
 * The newest piece of the contour is tried first, then those before it. When e crosses none of them it is swallowed
 * too and the next one is tried: the contour has a gap until one crosses. A crossing that would let the tool touch
 * what has been swallowed does not count. So a contour is either followed at the tool's radius or refused.
 */
#include "offset/contour.h"

#include "base/maths.h"
#include "offset/nose.h"

#include <assert.h>
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
};

struct offset_item *contour_item(struct offset *o, unsigned place)
{
    return &o->item[(o->first + place) % OFFSET_ITEMS_MAX];
}

void contour_in_plane(enum plane plane, const struct point *p, double result[2])
{
    enum axis first;
    enum axis second;

    plane_axes(plane, &first, &second);
    result[0] = p->at[first];
    result[1] = p->at[second];
}

bool contour_wanted(const struct offset_item *i, struct planar *wanted)
{
    const struct move *m = &i->move;
    double to[2];

    contour_in_plane(m->plane, &m->end, to);
    if (i->wanted == MOVE_INVOLUTE_CW || i->wanted == MOVE_INVOLUTE_CCW) {
        return planar_set_involute(wanted, i->wanted_from, to, m->centre_mm, m->base_radius_mm,
                                   i->wanted == MOVE_INVOLUTE_CW);
    }
    if (i->wanted == MOVE_ARC_CW || i->wanted == MOVE_ARC_CCW) {
        planar_set_arc(wanted, i->wanted_from, to, m->centre_mm,
                       i->wanted == MOVE_ARC_CCW ? 1.0 : -1.0, m->turns);
        return true;
    }
    return planar_set_line(wanted, i->wanted_from, to);
}

static bool is_way(const struct offset_item *i)
{
    return i->kind >= OFFSET_CORNER && !i->left_out;
}

struct offset_item *contour_add(struct offset *o, enum offset_kind kind, const struct move *m)
{
    assert(o->count < OFFSET_ITEMS_MAX);
    struct offset_item *i = contour_item(o, o->count++);

    *i = (struct offset_item){.kind = kind, .move = *m};
    return i;
}

static void append(struct offset *o, const struct offset_item *piece)
{
    *contour_add(o, piece->kind, &piece->move) = *piece;
    o->ways += is_way(piece) ? 1 : 0;
}

void contour_drop_first(struct offset *o)
{
    o->ways -= is_way(contour_item(o, 0)) ? 1 : 0;
    o->first = (o->first + 1) % OFFSET_ITEMS_MAX;
    o->count--;
}

struct offset_item *contour_newest(struct offset *o)
{
    for (unsigned i = o->count; i > 0; i--) {
        if (is_way(contour_item(o, i - 1))) {
            return contour_item(o, i - 1);
        }
    }
    return NULL;
}

static void warn(struct offset *o, const struct offset_item *i)
{
    if (o->warnings < OFFSET_WARNINGS_MAX) {
        diagnostic_set(&o->warning[o->warnings++], TAKT_ERROR_OFFSET_LEFT_OUT, i->move.line, 0, "",
                       0, i->move.cutter_radius_mm);
    }
}

/* Forgets the pieces of way behind a place; commands among them stay. */
static void remove_behind(struct offset *o, unsigned place)
{
    unsigned kept = place + 1;

    for (unsigned i = place + 1; i < o->count; i++) {
        const struct offset_item *item = contour_item(o, i);

        if (item->kind == OFFSET_WAY) {
            warn(o, item);
        }
        o->ways -= is_way(item) ? 1 : 0;
        if (item->kind < OFFSET_CORNER) {
            *contour_item(o, kept++) = *item;
        }
    }
    o->count = kept;
}

static bool is_inside(double place_mm, const struct planar *way)
{
    return place_mm >= -PLACE_SLACK_MM && place_mm <= planar_length(way) + PLACE_SLACK_MM;
}

/* As it is, with places beyond the ends. */
static struct crossing crossing_at(const struct planar *k, const struct planar *e,
                                   const double point[2])
{
    return (struct crossing){
        .point = {point[0], point[1]},
        .end_mm = planar_place_near_to(k, point),
        .begin_mm = planar_place_near_from(e, point),
    };
}

static bool is_within(const struct planar *k, const struct planar *e, const struct crossing *c)
{
    return is_inside(c->end_mm, k) && is_inside(c->begin_mm, e);
}

/*
 * How far the crossing is from the common corner along both ways. In a cusp there are two at the same distance: the
 * one within both ways comes first.
 */
static double cut_mm(const struct planar *k, const struct planar *e, const struct crossing *c)
{
    const double cut = maths_abs(planar_length(k) - c->end_mm) + maths_abs(c->begin_mm);

    return is_within(k, e, c) ? cut * (1.0 - CUSP_RATIO) : cut;
}

/* All crossings, the nearest to the corner first. */
static unsigned sorted_crossings(const struct planar *k, const struct planar *e,
                                 struct crossing found[2])
{
    double points[2][2];
    const unsigned count = planar_cross(k, e, points);

    for (unsigned i = 0; i < count; i++) {
        found[i] = crossing_at(k, e, points[i]);
    }
    if (count == 2 && cut_mm(k, e, &found[1]) < cut_mm(k, e, &found[0])) {
        const struct crossing first = found[0];

        found[0] = found[1];
        found[1] = first;
    }
    return count;
}

/*
 * The crossings within both ways. Of neighbours only the one nearest to their common corner counts: another one belongs
 * to the other end of an arc.
 */
static unsigned find_crossings(const struct planar *k, const struct planar *e, bool neighbours,
                               struct crossing found[2])
{
    const unsigned all = sorted_crossings(k, e, found);
    unsigned count = 0;

    for (unsigned i = 0; i < all && !(neighbours && i == 1); i++) {
        if (is_within(k, e, &found[i])) {
            found[count] = found[i];
            found[count].end_mm = maths_min(found[i].end_mm, planar_length(k));
            found[count].begin_mm = maths_max(found[i].begin_mm, 0.0);
            count++;
        }
    }
    return count;
}

/* How far the tool would cut into an item's programmed way when it follows both. */
static double gouge_of(const struct offset_item *item, const struct planar *k,
                       const struct planar *e, double radius_mm)
{
    struct planar wanted;

    (void)contour_wanted(item, &wanted);
    return radius_mm - maths_min(planar_distance(k, &wanted), planar_distance(e, &wanted));
}

/* The way that is really gone: the first of a contour comes from where the tool is. */
static struct planar real_way(const struct offset_item *i)
{
    struct planar way = i->way;
    double from[2];

    if (i->entry && !way.arc) {
        nose_centre(&i->move, i->wanted_from, from);
        (void)planar_set_line(&way, from, i->way.to);
    }
    return way;
}

/* Both pieces as they are when they meet at a crossing. */
struct trial {
    struct offset_item k;
    struct planar e;
};

static struct trial try_crossing(struct offset *o, unsigned place, const struct offset_item *piece,
                                 const struct crossing *c)
{
    struct trial t = {.k = *contour_item(o, place), .e = piece->way};

    planar_end_at(&t.k.way, c->end_mm, c->point);
    planar_begin_at(&t.e, c->begin_mm, c->point);
    return t;
}

/* The tool's path turns to the tool's side in an inner corner; another crossing leads into the contour. */
static bool turns_inside(const struct trial *t, const struct move *m)
{
    double before[2];
    double behind[2];

    planar_tangent_to(&t->k.way, before);
    planar_tangent_from(&t->e, behind);
    const double turn = planar_turn(before, behind);

    return (m->cutter_side == CUTTER_LEFT ? turn : -turn) >= -TURN_SLACK;
}

/* How far the tool cuts into a programmed way on the corner before a place, and on the way before that. */
static double gouge_before(struct offset *o, unsigned place, const struct planar *wanted,
                           double radius_mm)
{
    double gouge_mm = 0.0;

    for (unsigned i = place; i > 0 && contour_item(o, i)->kind == OFFSET_CORNER; i--) {
        const struct offset_item *item = contour_item(o, i - 1);

        if (item->kind >= OFFSET_CORNER) {
            const struct planar way = real_way(item);

            gouge_mm = maths_max(gouge_mm, radius_mm - planar_distance(&way, wanted));
        }
    }
    return gouge_mm;
}

/*
 * What the tool would cut away of everything from place on when the piece there and the new one meet at the crossing;
 * nothing to worry about when they are neighbours.
 */
static double gouge_behind(struct offset *o, unsigned place, const struct offset_item *piece,
                           const struct trial *t)
{
    const struct planar k = real_way(&t->k);
    struct planar before;
    struct planar behind;
    const double radius_mm = piece->move.cutter_radius_mm;
    bool between = false;
    double gouge_mm = 0.0;

    for (unsigned i = place + 1; i < o->count; i++) {
        const struct offset_item *item = contour_item(o, i);

        between = between || item->kind >= OFFSET_CORNER;
        if (item->kind == OFFSET_WAY) {
            gouge_mm = maths_max(gouge_mm, gouge_of(item, &k, &t->e, radius_mm));
            gouge_mm = item->across ? radius_mm : gouge_mm;
        }
    }
    if (between) {
        (void)contour_wanted(&t->k, &before);
        (void)contour_wanted(piece, &behind);
        gouge_mm = maths_max(gouge_mm, radius_mm - planar_distance(&t->e, &before));
        gouge_mm = maths_max(gouge_mm, radius_mm - planar_distance(&k, &behind));
        gouge_mm = maths_max(gouge_mm, gouge_before(o, place, &behind, radius_mm));
    }
    return gouge_mm;
}

/* Begins or goes on with a gap. The first way in it tells how far the tool is in the way. */
static void leave_out(struct offset *o, const struct offset_item *piece)
{
    struct offset_item left = *piece;
    struct offset_item *newest = contour_newest(o);
    struct planar wanted;

    if (piece->kind != OFFSET_WAY) {
        return;
    }
    if (!o->gap) {
        (void)contour_wanted(piece, &wanted);
        o->gap = true;
        o->gouge_line = piece->move.line;
        o->gouge_mm = newest == NULL ? 0.0
                                     : piece->move.cutter_radius_mm -
                                           planar_distance_point(&wanted, newest->way.to);
    }
    left.left_out = true;
    append(o, &left);
}

static bool join_at(struct offset *o, unsigned place, const struct offset_item *piece,
                    bool neighbours)
{
    struct offset_item *k = contour_item(o, place);
    struct offset_item joined = *piece;
    struct crossing found[2];
    const unsigned count = is_way(k) ? find_crossings(&k->way, &piece->way, neighbours, found) : 0;

    for (unsigned i = 0; i < count; i++) {
        const struct trial t = try_crossing(o, place, piece, &found[i]);

        if (turns_inside(&t, &piece->move) &&
            gouge_behind(o, place, piece, &t) <= OFFSET_GOUGE_MM) {
            k->way = t.k.way;
            joined.way = t.e;
            remove_behind(o, place);
            append(o, &joined);
            o->gap = false;
            return true;
        }
    }
    return false;
}

/* at_corner: the piece begins where the contour's last one ends, in an inner corner. */
static void join(struct offset *o, const struct offset_item *piece, bool at_corner)
{
    const struct offset_item *newest = o->gap ? NULL : contour_newest(o);

    for (unsigned i = o->count; i > 0; i--) {
        if (join_at(o, i - 1, piece, at_corner && contour_item(o, i - 1) == newest)) {
            return;
        }
    }
    leave_out(o, piece);
}

void contour_continue(struct offset *o, const struct offset_item *piece)
{
    if (o->gap) {
        join(o, piece, false);
    } else {
        append(o, piece);
    }
}

void contour_continue_inside(struct offset *o, const struct offset_item *piece)
{
    join(o, piece, true);
}

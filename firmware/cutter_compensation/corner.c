/*
 * Corners. With the directions t before and u behind a corner V, and the tool at the distance d to
 * the left:
 *
 *     angle = atan2(t x u, t . u)       > 0: the path turns left, so with d > 0 this is an inner corner
 *
 * Around an outer corner the tool's centre goes from V + d n(t) to V + d n(u), n the normal to the
 * left, on a circle about V, or along tangents to this circle: then the tips stand off by
 * d / cos(angle / 2 k), k = 1, or 2 for turns of more than 90 degrees.
 */
#include "cutter_compensation/corner.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

#define TIPS_MAX 2

struct corner {
    double vertex[2];
    double before[2]; /* direction, length 1 */
    double angle_rad;
    double left_mm;
    bool thin; /* an inner corner that may be passed as an outer one */
};

static bool is_inner(double angle_rad, double left_mm)
{
    return angle_rad * left_mm > 0.0;
}

/*
 * Where a way returns along itself the directions alone do not tell which side the tool is on: of
 * the two ways, seen from the corner, the one behind it is to the left of the one before when
 * curvature before + curvature behind > 0. Then the path has turned right. Both must say "outer";
 * if the directions differ by rounding alone, the curvatures decide.
 */
static bool cusp_is_inner(double curvature, double left_mm, double angle_rad)
{
    const double off_rad = MATHS_PI - maths_abs(angle_rad);

    if (curvature == 0.0) {
        return off_rad > COMPENSATION_CUSP_SURE_RAD && is_inner(angle_rad, left_mm);
    }
    return curvature * left_mm < 0.0 ||
           (off_rad > COMPENSATION_CUSP_SURE_RAD && is_inner(angle_rad, left_mm));
}

/* The same corner, passed on the other side. */
static double other_way(double angle_rad)
{
    return angle_rad > 0.0 ? angle_rad - MATHS_TWO_PI : angle_rad + MATHS_TWO_PI;
}

/*
 * Directions that say inner beside curvatures that say outer: the ways enclose a lens, and then
 * cross. A tool of the radius r that goes around their corner cuts into it, at the place x from
 * there, by
 *
 *     x off - x^2 (curvature + 1 / r) / 2 <= off^2 / (2 (curvature + 1 / r))
 */
static bool is_thin(double curvature, double left_mm, double angle_rad)
{
    const double off_rad = MATHS_PI - maths_abs(angle_rad);
    const double depth_mm =
        off_rad * off_rad / (2.0 * (maths_abs(curvature) + 1.0 / maths_abs(left_mm)));

    return curvature * left_mm > 0.0 && depth_mm <= COMPENSATION_ROUNDING_MM;
}

static void turn_cusp(const struct cutter_compensation *o, const struct planar *next,
                      struct corner *c)
{
    const double curvature = takt_planar_curvature_to(&o->last) + takt_planar_curvature_from(next);
    const bool inner = cusp_is_inner(curvature, c->left_mm, c->angle_rad);

    c->thin = inner && !o->gap && is_thin(curvature, c->left_mm, c->angle_rad);
    if (inner != is_inner(c->angle_rad, c->left_mm)) {
        c->angle_rad = other_way(c->angle_rad);
    }
}

static struct corner corner_between(const struct cutter_compensation *o,
                                    const struct compensation_item *next, double left_mm)
{
    struct corner c = {.left_mm = left_mm};
    struct planar wanted;
    double behind[2];

    (void)takt_contour_wanted(next, &wanted);
    memcpy(c.vertex, wanted.from, sizeof(c.vertex));
    takt_planar_tangent_to(&o->last, c.before);
    takt_planar_tangent_from(&wanted, behind);
    c.angle_rad = takt_maths_atan2(planar_turn(c.before, behind), planar_dot(c.before, behind));
    if (maths_abs(c.angle_rad) > MATHS_PI - COMPENSATION_CUSP_RAD) {
        turn_cusp(o, &wanted, &c);
    }
    return c;
}

/*
 * The point beside the vertex, at a distance to the left of the way before it turned by an angle.
 */
static void point_beside(const struct corner *c, double angle_rad, double left_mm, double point[2])
{
    double sine;
    double cosine;

    takt_maths_sincos(angle_rad, &sine, &cosine);
    point[0] = c->vertex[0] - left_mm * (c->before[1] * cosine + c->before[0] * sine);
    point[1] = c->vertex[1] + left_mm * (c->before[0] * cosine - c->before[1] * sine);
}

/* How far the tip of a sharp corner is from the circle: |d| (1 / cos(angle / 2) - 1) */
static double tip_mm(const struct corner *c)
{
    TAKT_ASSERT(maths_abs(c->angle_rad) < MATHS_PI);
    return maths_abs(c->left_mm) * (1.0 / takt_maths_cos(0.5 * c->angle_rad) - 1.0);
}

static bool is_blunt(const struct corner *c)
{
    return maths_abs(c->angle_rad) < MATHS_HALF_PI && tip_mm(c) < COMPENSATION_BLUNT_MM;
}

/*
 * Where two ways cross beside a blunt corner, into point, which holds the corner's middle; ways
 * that only touch leave it there. A circle is crossed twice. With its programmed radius R, that of
 * the tool's way r = R +- d and the corner's angle a, seen from where the circle is parallel to the
 * other way, of a line:
 *
 *     crossings   +- a sqrt(R r)
 *     middle      a (R + r) / 2
 *
 * So the nearer one is at most a d / 2 from the middle. At the other one the tool would cut the
 * circle off.
 */
static void cross_beside(const struct planar *k, const struct planar *e, const struct corner *c,
                         double point[2])
{
    const double middle[2] = {point[0], point[1]};
    double nearest_mm = 2.0 * maths_abs(c->left_mm * c->angle_rad) + COMPENSATION_BLUNT_MM;
    double points[2][2];
    const unsigned count = takt_planar_cross(k, e, points);

    for (unsigned i = 0; i < count; i++) {
        const double distance_mm = takt_planar_between(points[i], middle);

        if (distance_mm < nearest_mm) {
            nearest_mm = distance_mm;
            memcpy(point, points[i], sizeof(points[i]));
        }
    }
}

/* Does the corner's one point stand off so little that no arc about the vertex is needed? */
static bool is_near_vertex(const struct corner *c, const double point[2])
{
    return is_inner(c->angle_rad, c->left_mm) ||
           takt_planar_between(point, c->vertex) - maths_abs(c->left_mm) < COMPENSATION_BLUNT_MM;
}

/*
 * A corner so blunt that one point serves both ways. False when there is not enough of one of them,
 * or when the point is too far out, as it can be beside a small circle.
 */
static bool turn_blunt(struct cutter_compensation *o, struct compensation_piece *next,
                       const struct corner *c)
{
    struct compensation_live *k = takt_contour_newest(o);
    struct planar *way = &next->live.way;
    double point[2];

    if (o->gap || k == NULL) {
        return false;
    }
    point_beside(c, 0.5 * c->angle_rad, c->left_mm, point);
    cross_beside(&k->way, way, c, point);
    const double end_mm = takt_planar_place_near_to(&k->way, point);
    const double begin_mm = takt_planar_place_near_from(way, point);

    if (end_mm <= 0.0 || begin_mm >= takt_planar_length(way) || !is_near_vertex(c, point)) {
        return false;
    }
    takt_planar_end_at(&k->way, end_mm, point);
    takt_planar_begin_at(way, begin_mm, point);
    takt_contour_continue(o, next);
    return true;
}

/*
 * A corner is part of the move behind it, but the axis across the plane stays, and the programmed
 * way is the one before.
 */
static struct compensation_piece corner_piece(const struct cutter_compensation *o,
                                              const struct compensation_piece *next)
{
    struct compensation_piece piece = {.item = next->item, .live.motion = next->live.motion};
    double turned[AXIS_COUNT];

    takt_contour_turned(o->pattern.plane, &o->wanted_at, turned);
    piece.live.motion.across[0] = turned[2];
    piece.item.kind = COMPENSATION_CORNER;
    if (piece.item.move != MOVE_RAPID) {
        piece.item.move = MOVE_FEED;
    }
    piece.item.across = false;
    piece.item.programmed = o->last_way.programmed;
    piece.item.turns = o->last_way.turns;
    piece.item.wanted = o->last_way.wanted;
    return piece;
}

static void turn_round(struct cutter_compensation *o, struct compensation_piece *piece,
                       const struct corner *c)
{
    double from[2];
    double to[2];

    point_beside(c, 0.0, c->left_mm, from);
    point_beside(c, c->angle_rad, c->left_mm, to);
    takt_planar_set_arc(&piece->live.way, from, to, c->vertex, c->angle_rad > 0.0 ? 1.0 : -1.0, 1);
    piece->live.way.sweep_rad = maths_abs(c->angle_rad);
    piece->item.move = c->angle_rad > 0.0 ? MOVE_ARC_CCW : MOVE_ARC_CW;
    takt_contour_continue(o, piece);
}

static void turn_sharp(struct cutter_compensation *o, struct compensation_piece *piece,
                       const struct corner *c)
{
    const unsigned tips = maths_abs(c->angle_rad) > MATHS_HALF_PI * (1.0 + 1e-9) ? TIPS_MAX : 1;
    const double half_rad = 0.5 * c->angle_rad / tips;
    const double tip_left_mm = c->left_mm / takt_maths_cos(half_rad);
    double from[2];
    double to[2];

    point_beside(c, 0.0, c->left_mm, from);
    for (unsigned i = 0; i <= tips; i++) {
        if (i < tips) {
            point_beside(c, (2 * i + 1) * half_rad, tip_left_mm, to);
        } else {
            point_beside(c, c->angle_rad, c->left_mm, to);
        }
        if (takt_planar_set_line(&piece->live.way, from, to)) {
            takt_contour_continue(o, piece);
        }
        memcpy(from, to, sizeof(from));
    }
}

/*
 * A rapid has no feed for an arc and nothing to cut: it goes around corners in lines. Behind a gap
 * tips are not tried: one may stand out of what is swallowed while the circle does not.
 */
static void turn_outside(struct cutter_compensation *o, const struct compensation_piece *next,
                         const struct corner *c)
{
    struct compensation_piece piece = corner_piece(o, next);
    const bool rapid = piece.item.move == MOVE_RAPID;

    if (!o->gap && (o->sharp_corners || rapid)) {
        turn_sharp(o, &piece, c);
    } else if (!rapid) {
        turn_round(o, &piece, c);
    }
}

void takt_corner_turn(struct cutter_compensation *o, struct compensation_piece *next,
                      double left_mm)
{
    struct corner c = corner_between(o, &next->item, left_mm);

    TAKT_ASSERT(left_mm != 0.0);
    if (is_blunt(&c) && turn_blunt(o, next, &c)) {
        return;
    }
    if (is_inner(c.angle_rad, left_mm)) {
        if (takt_contour_meet_inside(o, next)) {
            return;
        }
        if (!c.thin) {
            takt_contour_leave_out(o, next);
            return;
        }
        c.angle_rad = other_way(c.angle_rad);
    }
    if (c.angle_rad != 0.0) {
        turn_outside(o, next, &c);
    }
    takt_contour_continue(o, next);
}

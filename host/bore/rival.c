/*
 * Joined arcs about p poles (p = 2: half circles, p = 4: quarter circles). The radius grows by
 * a = R / (n p) from arc to arc. Arc k, k = 1 ... n p - 1, turns from the angle 2 pi k / p to 2 pi
 * (k + 1) / p about c_k; for the next one to go on in the same direction its pole is on the line
 * through the junction and c_k:
 *
 *     radius_k = k a,     c_0 = 0,     c_{k+1} = c_k - a (cos alpha, sin alpha),   alpha = 2 pi (k + 1) / p
 *
 * So the poles go around a regular polygon, and arc n p, the circle, is about the centre of the
 * hole again.
 *
 * Archimedes' spiral: rho = a theta, a = R / (2 pi n), theta from 0 to 2 pi n; it meets the circle
 * at an angle.
 */
#include "bore/rival.h"

#include "base/maths.h"
#include "bore/approximate.h"
#include "bore/spiral.h"

static void joined_arcs(struct bore_path *p, double radius_mm, unsigned turns, unsigned poles)
{
    double a = radius_mm / (turns * poles);
    double centre[2] = {0, 0};

    for (unsigned k = 0; k < turns * poles && !p->failed; k++) {
        double angle = MATHS_TWO_PI * ((k + 1) % poles) / poles;
        double u[2], to[2];

        takt_maths_sincos(angle, &u[1], &u[0]);
        for (unsigned i = 0; i < 2; i++)
            to[i] = centre[i] + k * a * u[i];
        if (k > 0)
            bore_path_arc(p, to, centre);
        for (unsigned i = 0; i < 2; i++)
            centre[i] -= a * u[i];
    }
}

/* context: a; direction (cos - theta sin, sin + theta cos) / sqrt(1 + theta^2) */
static void archimedes_at(const void *context, double theta, double point_mm[2],
                          double direction[2])
{
    const double *a = context;
    double root = maths_sqrt(1 + theta * theta);
    double sine, cosine;

    takt_maths_sincos(theta, &sine, &cosine);
    point_mm[0] = *a * theta * cosine;
    point_mm[1] = *a * theta * sine;
    direction[0] = (cosine - theta * sine) / root;
    direction[1] = (sine + theta * cosine) / root;
}

static void involute(struct bore_path *p, double radius_mm, unsigned turns)
{
    struct bore_piece piece = {.kind = BORE_INVOLUTE};
    struct bore_spiral s;

    bore_spiral_set(&s, radius_mm, turns);
    piece.base_mm = s.base_mm;
    bore_spiral_point(&s, MATHS_TWO_PI * s.turns, piece.to_mm);
    bore_spiral_base_centre(&s, piece.centre_mm);
    bore_path_add(p, &piece);
}

static void helix(struct bore_path *p, double radius_mm, double down_mm)
{
    double to[2] = {0, -radius_mm};
    double centre[2] = {0, -0.5 * radius_mm};

    bore_path_arc(p, to, centre);
    bore_path_helix(p, down_mm);
}

const char *bore_rival_name(enum bore_rival rival)
{
    static const char *const names[BORE_RIVALS] = {"involute", "semicircles, 2 poles",
                                                   "quarter circles, 4 poles", "Archimedean spiral",
                                                   "helix"};

    return names[rival];
}

void bore_rival_path(enum bore_rival rival, double radius_mm, unsigned turns, double tolerance_mm,
                     double down_mm, struct bore_path *p)
{
    double a = radius_mm / (MATHS_TWO_PI * turns);
    struct bore_curve archimedes = {&a, archimedes_at};
    double origin[2] = {0, 0};

    bore_path_begin(p, origin);
    switch (rival) {
    case BORE_RIVAL_INVOLUTE:
        involute(p, radius_mm, turns);
        break;
    case BORE_RIVAL_TWO_POLES:
        joined_arcs(p, radius_mm, turns, 2);
        break;
    case BORE_RIVAL_FOUR_POLES:
        joined_arcs(p, radius_mm, turns, 4);
        break;
    case BORE_RIVAL_ARCHIMEDES:
        bore_approximate_arcs(p, &archimedes, 0, MATHS_TWO_PI * turns, tolerance_mm);
        break;
    case BORE_RIVAL_HELIX:
        helix(p, radius_mm, down_mm);
        break;
    case BORE_RIVALS:
        break;
    }
    bore_path_arc(p, bore_path_start(p, p->count), origin);
}

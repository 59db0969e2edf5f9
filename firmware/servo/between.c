/*
 * Targets x0 x1 x2 x3, one a cycle. From x1 to x2 with the velocities and accelerations of central
 * differences at both,
 *
 *     v1 = (x2 - x0) / 2,  a1 = x2 - 2 x1 + x0,     v2 = (x3 - x1) / 2,  a2 = x3 - 2 x2 + x1
 *
 * there is one polynomial of fifth degree. Its neighbours have the same there: position, velocity
 * and acceleration are continuous, and a parabola stays one. x3 has to be known, so the drive is a
 * cycle late.
 */
#include "servo/between.h"

#include "base/assert.h"
#include "base/maths.h"

static void begin(struct between *between, double at_mm)
{
    for (unsigned i = 0; i < 4; i++)
        between->target_mm[i] = at_mm;
    between->is_known = true;
}

void takt_between_take(struct between *between, double at_mm, double target_mm,
                       double piece[BETWEEN_COEFFICIENTS])
{
    double *x = between->target_mm;
    if (!between->is_known || x[2] != at_mm)
        begin(between, at_mm);
    for (unsigned i = 0; i < 3; i++)
        x[i] = x[i + 1];
    x[3] = target_mm;
    double v1 = (x[2] - x[0]) / 2;
    double v2 = (x[3] - x[1]) / 2;
    double a1 = x[2] - 2 * x[1] + x[0];
    double a2 = x[3] - 2 * x[2] + x[1];
    double way = x[2] - x[1];
    piece[0] = x[1];
    piece[1] = v1;
    piece[2] = a1 / 2;
    piece[3] = 10 * way - 6 * v1 - 4 * v2 - 1.5 * a1 + 0.5 * a2;
    piece[4] = -15 * way + 8 * v1 + 7 * v2 + 1.5 * a1 - a2;
    piece[5] = 6 * way - 3 * v1 - 3 * v2 - 0.5 * a1 + 0.5 * a2;
}

void takt_between_at(const double piece[BETWEEN_COEFFICIENTS], double u, double place[3])
{
    TAKT_ASSERT(u >= 0.0 && u <= 1.0);
    place[0] = place[1] = place[2] = 0;
    for (unsigned i = BETWEEN_COEFFICIENTS; i > 0; i--) {
        place[2] = place[2] * u + 2 * place[1];
        place[1] = place[1] * u + place[0];
        place[0] = place[0] * u + piece[i - 1];
    }
}

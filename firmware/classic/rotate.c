#include "classic/rotate.h"

#include "base/maths.h"

void takt_rotate_begin(struct rotate *r, double a, double b, double quantum_rad)
{
    *r = (struct rotate){.a = a, .b = b, .quantum_rad = quantum_rad};
}

double takt_rotate_step(struct rotate *r, double angle_rad)
{
    double step = angle_rad;

    r->wanted_rad += angle_rad;
    if (r->quantum_rad > 0.0) {
        step = r->quantum_rad * takt_maths_round((r->wanted_rad - r->turned_rad) / r->quantum_rad);
    }
    const double shrink = 1.0 - 0.5 * step * step;
    const double a = r->a * shrink - r->b * step;

    r->b = r->b * shrink + r->a * step;
    r->a = a;
    r->turned_rad += step;
    return step;
}

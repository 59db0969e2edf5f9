#include "shape/zv.h"

#include "base/assert.h"
#include "base/maths.h"

double takt_zv_period(const struct shape_mode *mode, double cycle_s)
{
    TAKT_ASSERT(mode->hz > 0.0 && mode->damping >= 0.0 && mode->damping < 1.0 && cycle_s > 0.0);
    return 1.0 / (mode->hz * cycle_s * maths_sqrt(1.0 - mode->damping * mode->damping));
}

/*
 * Free, the mode goes on by z = r exp(j theta) in a cycle, r = exp(-damping w tau), theta = w_d
 * tau. What impulses at 0, d and d + 1 leave of it is w_0 + w_d z^-d + w_(d+1) z^-(d+1). With
 * d = floor(pi/theta), so that half a turn lies between d and d + 1 cycles, the three have weights
 * of one sign with which this is 0, real part and imaginary part:
 *
 *     w_0 = sin theta      w_d = -r^d sin (d + 1) theta      w_(d+1) = r^(d+1) sin d theta
 */
void takt_zv_train(const struct shape_mode *mode, double cycle_s, struct train *t)
{
    const double w = 2.0 * MATHS_PI * mode->hz;
    const double theta = 2.0 * MATHS_PI / takt_zv_period(mode, cycle_s);
    const double d = takt_maths_floor(MATHS_PI / theta);
    const double decay = mode->damping * w * cycle_s;

    takt_train_set_none(t);
    takt_train_add(t, 0.0, takt_maths_sin(theta));
    takt_train_add(t, d, -takt_maths_exp(-decay * d) * takt_maths_sin((d + 1.0) * theta));
    takt_train_add(t, d + 1.0, takt_maths_exp(-decay * (d + 1.0)) * takt_maths_sin(d * theta));
    takt_train_normalise(t);
}

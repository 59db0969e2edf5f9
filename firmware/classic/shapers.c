#include "classic/shapers.h"

#include "base/assert.h"
#include "base/maths.h"

/* What EI leaves of a swing at the mode's own frequency. */
#define EI_LEFT 0.05

/* What is left of a swing after n periods: exp(-2 pi damping n / sqrt(1 - damping^2)). */
static double left_after(const struct shape_mode *mode, double periods)
{
    TAKT_ASSERT(mode->damping >= 0.0 && mode->damping < 1.0);
    return takt_maths_exp(-2.0 * MATHS_PI * periods * mode->damping /
                          maths_sqrt(1.0 - mode->damping * mode->damping));
}

/*
 * Impulses at 0, n and 2 n periods; an undamped mode has the first, the second, and the first
 * again.
 */
static void set_three(struct train *t, const struct shape_mode *mode, double cycle_s, double n,
                      double first, double second)
{
    const double cycles = n * takt_zv_period(mode, cycle_s);
    const double k = left_after(mode, n);

    TAKT_ASSERT(cycle_s > 0.0 && n > 0.0);
    takt_train_set_none(t);
    takt_train_add(t, 0.0, first);
    takt_train_add(t, cycles, second * k);
    takt_train_add(t, 2.0 * cycles, first * k * k);
    takt_train_normalise(t);
}

/* 1 - 1/sqrt 2, sqrt 2 - 1, 1 - 1/sqrt 2 at 0, 3/8 and 3/4 of a period. */
void takt_shapers_mzv(const struct shape_mode *mode, double cycle_s, struct train *t)
{
    set_three(t, mode, cycle_s, 0.375, 1.0 - maths_sqrt(0.5), maths_sqrt(2.0) - 1.0);
}

/*
 * (1 + V)/4, (1 - V)/2, (1 + V)/4 at 0, 1/2 and 1 of a period (Singhose, Seering and Singer 1990).
 */
void takt_shapers_ei(const struct shape_mode *mode, double cycle_s, struct train *t)
{
    set_three(t, mode, cycle_s, 0.5, 0.25 * (1.0 + EI_LEFT), 0.5 * (1.0 - EI_LEFT));
}

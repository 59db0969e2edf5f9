/*
 * In the place of everything else here, in a build without it. No machine that asks for more gets
 * this far: takt_machine_check.
 */
#include "base/assert.h"
#include "classic/classic.h"
#include "classic/interpolator.h"
#include "classic/product.h"

bool takt_classic_is_there(void)
{
    return false;
}

void takt_interpolator_init(struct interpolator *i, const struct interpolator_config *config)
{
    i->is_absent = true;
    (void)config;
}

void takt_interpolator_restart(struct interpolator *i)
{
    (void)i;
}

double takt_interpolator_unit_mm(double increment_mm, double range_mm, unsigned word_bits)
{
    (void)range_mm;
    (void)word_bits;
    return increment_mm;
}

void takt_interpolator_cycle(struct interpolator *i, const struct curve *curve, uint32_t block,
                             bool landed, struct point *cmd)
{
    (void)i;
    (void)curve;
    (void)block;
    (void)landed;
    (void)cmd;
}

const struct interpolator_errors *takt_interpolator_get_errors(const struct interpolator *i)
{
    static const struct interpolator_errors none;

    (void)i;
    return &none;
}

void takt_product_init(struct product *p, const struct product_config *config)
{
    p->is_absent = true;
    (void)config;
}

void takt_product_cycle(struct product *p, struct motion *m, const struct motion_operator *wanted,
                        struct cycle_record *record)
{
    (void)p;
    (void)m;
    (void)wanted;
    (void)record;
    TAKT_ASSERT(false); /* no motion is handed over */
}

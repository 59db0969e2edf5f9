/* In the place of everything else here, in a build without it. No machine that asks for more gets this far: machine_check.
 */
#include "classic/classic.h"
#include "classic/interpolator.h"
#include "classic/product.h"

#include <assert.h>
#include <string.h>

bool classic_is_there(void)
{
    return false;
}

void interpolator_init(struct interpolator *i, const struct interpolator_config *config)
{
    memset(i, 0, sizeof(*i));
    i->config = *config;
}

void interpolator_cycle(struct interpolator *i, const struct curve *curve, uint32_t block,
                        bool landed, struct point *cmd)
{
    (void)i;
    (void)curve;
    (void)block;
    (void)landed;
    (void)cmd;
}

const struct interpolator_errors *interpolator_get_errors(const struct interpolator *i)
{
    return &i->errors;
}

void product_init(struct product *p, const struct product_config *config)
{
    memset(p, 0, sizeof(*p));
    p->config = *config;
}

void product_cycle(struct product *p, struct motion *m, const struct motion_operator *wanted,
                   struct cycle_record *record)
{
    (void)p;
    (void)m;
    (void)wanted;
    (void)record;
    assert(false); /* no motion is handed over */
}

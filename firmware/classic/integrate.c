#include "classic/integrate.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Towards zero, as a word drops what is behind its last bit. */
static int64_t truncated(double units)
{
    return (int64_t)(units < 0.0 ? takt_maths_ceil(units) : takt_maths_floor(units));
}

void takt_integrate_begin(struct integrate *i, double unit_mm, const struct point *start,
                          const struct point *end, double length_mm)
{
    TAKT_ASSERT(unit_mm > 0.0 && length_mm > 0.0);
    memset(i, 0, sizeof(*i));
    i->unit_mm = unit_mm;
    for (int n = 0; n < AXIS_COUNT; n++) {
        const double way = end->at[n] - start->at[n];

        i->ratio[n] = way / length_mm;
        i->end[n] = (int64_t)takt_maths_round(way / unit_mm);
    }
}

void takt_integrate_accelerate(struct integrate *i, double change_mm)
{
    for (int n = 0; n < AXIS_COUNT; n++) {
        i->velocity[n] += truncated(i->ratio[n] * change_mm / i->unit_mm);
    }
    i->velocity_loss_ulp += 1.0;
}

void takt_integrate_set_velocity(struct integrate *i, double way_mm)
{
    for (int n = 0; n < AXIS_COUNT; n++) {
        i->velocity[n] = truncated(i->ratio[n] * way_mm / i->unit_mm);
    }
    i->velocity_loss_ulp = 1.0;
}

void takt_integrate_aim(struct integrate *i, double cycles)
{
    for (int n = 0; n < AXIS_COUNT; n++) {
        i->velocity[n] = truncated((double)(i->end[n] - i->position[n]) / cycles);
    }
    i->velocity_loss_ulp = 1.0;
}

void takt_integrate_advance(struct integrate *i)
{
    for (int n = 0; n < AXIS_COUNT; n++) {
        i->position[n] += i->velocity[n];
    }
    i->loss_ulp += i->velocity_loss_ulp;
}

void takt_integrate_land(struct integrate *i)
{
    memcpy(i->position, i->end, sizeof(i->position));
    i->loss_ulp = 0.0;
}

void takt_integrate_get_way(const struct integrate *i, struct point *way)
{
    for (int n = 0; n < AXIS_COUNT; n++) {
        way->at[n] = (double)i->position[n] * i->unit_mm;
    }
}

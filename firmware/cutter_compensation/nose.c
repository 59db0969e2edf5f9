#include "cutter_compensation/nose.h"

#include "base/assert.h"

/* Z and X, the axes of G18. */
static const int8_t lead[CUTTER_ORIENTATION_MAX + 1][2] = {
    [1] = {1, -1}, [2] = {-1, -1}, [3] = {-1, 1}, [4] = {1, 1},
    [5] = {1, 0},  [6] = {0, -1},  [7] = {-1, 0}, [8] = {0, 1},
};

void takt_nose_lead(const struct move *m, double lead_mm[2])
{
    TAKT_ASSERT(m->cutter_orientation < sizeof lead / sizeof lead[0]);
    for (unsigned i = 0; i < 2; i++) {
        lead_mm[i] = m->cutter_radius_mm * lead[m->cutter_orientation][i];
    }
}

void takt_nose_centre(const struct move *m, const double led[2], double centre[2])
{
    double lead_mm[2];

    takt_nose_lead(m, lead_mm);
    for (unsigned i = 0; i < 2; i++) {
        centre[i] = led[i] - lead_mm[i];
    }
}

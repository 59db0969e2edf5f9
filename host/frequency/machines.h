/*
 * The machines that seed 000 names: feed limit, acceleration in parts of g, and a jerk that none of
 * them exceeds. Of one of them it gives no limits: they are 0.
 */
#ifndef TAKT_FREQUENCY_MACHINES_H
#define TAKT_FREQUENCY_MACHINES_H

#include "accuracy/cycle_frequency.h"

#include <stdbool.h>
#include <stddef.h>

#define STANDARD_GRAVITY_MM_S2 9806.65

struct known_machine {
    const char *name;
    double feed_max_mm_min;
    double gravities_low, gravities; /* from, to; the highest counts */
    double jerk_m_s3;
};

extern const struct known_machine known_machines[];
extern const size_t known_machines_count;

/* Whatever the case of the letters; NULL: it is not one of them. */
const struct known_machine *known_machine_find(const char *name);

bool known_machine_has_limits(const struct known_machine *machine);

/* Only machines that have them. */
struct cycle_limits known_machine_limits(const struct known_machine *machine);

#endif

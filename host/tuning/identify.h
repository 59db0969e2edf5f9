/*
 * What a motor moves, from a test: inertia, friction, weight, and how late its torque comes.
 */
#ifndef TAKT_HOST_TUNING_IDENTIFY_H
#define TAKT_HOST_TUNING_IDENTIFY_H

#include "tuning/record.h"

/* At the motor's shaft. */
struct tuning_plant {
    double travel_per_rad; /* of the axis, mm or rad */
    double inertia_kg_m2;
    double inertia_deviation_kg_m2; /* standard deviation */
    double viscous_nm_s_per_rad;
    double dry_nm;
    double weight_nm; /* torque that holds it */
    double delay_s;   /* from a cycle's beginning until the motor has its torque */
    double left;  /* root mean square of the second differences that is not explained, mm or rad */
    double swing; /* of themselves */
};

/* False: the record is no answer of an inertia, or there is not enough of it, or of memory. */
bool tuning_identify(const struct tuning_record *record, double travel_per_rad,
                     struct tuning_plant *plant);

#endif

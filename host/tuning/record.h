/*
 * What a motor did in a test: what it was told in each cycle, and where its axis was.
 */
#ifndef TAKT_HOST_TUNING_RECORD_H
#define TAKT_HOST_TUNING_RECORD_H

#include <stdbool.h>
#include <stddef.h>

/* All zero but cycle_s and step: empty. */
struct tuning_record {
    double cycle_s;
    double step; /* of the position: what cannot be told apart */
    size_t count;
    /*
     * from its beginning to its end: torque Nm of a test, or a command in the unit of the position
     */
    double *input;
    double *position; /* at its beginning; mm, rotary: rad */
    size_t room;
    bool failed; /* out of memory */
};

void tuning_record_add(struct tuning_record *record, double input, double position);
void tuning_record_free(struct tuning_record *record);

#endif

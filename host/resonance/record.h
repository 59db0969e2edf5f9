/*
 * What has been measured of an axis, cycle by cycle: where its drive was, and what an accelerometer
 * at the tool said.
 */
#ifndef TAKT_HOST_RESONANCE_RECORD_H
#define TAKT_HOST_RESONANCE_RECORD_H

#include <stdbool.h>
#include <stddef.h>

/* All zero at first. */
struct resonance_record {
    double cycle_s;
    double *foot_mm, *tool_mm_s2; /* owned */
    size_t count, capacity;
    bool failed; /* out of memory */
};

void resonance_record_add(struct resonance_record *record, double foot_mm, double tool_mm_s2);
void resonance_record_free(struct resonance_record *record);

#endif

/*
 * Gains as a drive has them: object 2020, whole numbers of its units.
 */
#ifndef TAKT_HOST_TUNING_LOOP_OBJECT_H
#define TAKT_HOST_TUNING_LOOP_OBJECT_H

#include "tuning/gains.h"

#include <stdint.h>

#define LOOP_OBJECT  0x2020
#define LOOP_NUMBERS 6 /* sub-indices 1 ... */

struct loop_number {
    const char *key; /* of the machine file, and of JSON */
    double per_unit; /* what is 1 of the object, of 1 of the gain */
    unsigned bytes;
    unsigned long field; /* in struct tuning_gains */
};

extern const struct loop_number loop_number[LOOP_NUMBERS];

/* Number i of the object. */
uint32_t loop_object_of(const struct tuning_gains *gains, unsigned i);
void loop_object_take(struct tuning_gains *gains, unsigned i, uint32_t value);

#endif

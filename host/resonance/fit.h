/*
 * Modes of an axis from what has been measured: how many there are, frequency, damping and part of
 * each, and how sure that is.
 */
#ifndef TAKT_HOST_RESONANCE_FIT_H
#define TAKT_HOST_RESONANCE_FIT_H

#include "resonance/record.h"
#include "vibration/vibration.h"

/* A number, and its standard deviation by the noise that is left. */
struct resonance_number {
    double value, deviation;
};

struct resonance_mode {
    struct resonance_number hz, damping, part;
};

struct resonance_fit {
    unsigned modes; /* from the lowest frequency */
    struct resonance_mode mode[VIBRATION_MODES];
    double left_mm_s2; /* rms of what they do not explain */
};

/* False: out of memory, or nothing has been measured. */
bool resonance_fit(const struct resonance_record *record, struct resonance_fit *fit);

#endif

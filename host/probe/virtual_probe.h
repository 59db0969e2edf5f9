/*
 * What a virtual machine meets: solids that its probe touches, and inputs that change with time.
 *
 *     struct virtual_probe probe;
 *     struct virtual_probe_error error;
 *     if (!virtual_probe_read(&probe, text, length, &error)) ... "FILE:LINE:COLUMN: error: TEXT" ...
 *     ... every cycle: virtual_probe_set_inputs(&probe, time_s, &position, &inputs);
 *
 * README.md has the format of the text.
 */
#ifndef TAKT_PROBE_VIRTUAL_PROBE_H
#define TAKT_PROBE_VIRTUAL_PROBE_H

#include "base/point.h"
#include "hal/inputs.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define VIRTUAL_PROBE_SOLIDS_MAX     64
#define VIRTUAL_PROBE_CHANGES_MAX    256
#define VIRTUAL_PROBE_ERROR_TEXT_MAX 127

/*
 * Everything between low and high, mm and rad; with a radius what is so near to the centre, which
 * is low, or a hole.
 */
struct virtual_probe_solid {
    double low[AXIS_COUNT], high[AXIS_COUNT];
    double radius_mm; /* 0: a box */
    bool is_hole; /* with a radius: all that is farther from the centre in X and Y, up to low Z */
};

/*
 * How the part on which the solids are stands: as they are told, turned about a point (about X
 * first, then Y, then Z) and displaced; and all of it turned with a table about an axis through
 * that point.
 */
struct virtual_probe_part {
    bool is_displaced;
    double offset_mm[AXIS_LINEAR_COUNT];
    double rotation[AXIS_LINEAR_COUNT][AXIS_LINEAR_COUNT];
    double pivot_mm[AXIS_LINEAR_COUNT];
    enum axis table; /* A, B or C; AXIS_COUNT: none */
};

/* An input that has a value from a time on. */
struct virtual_probe_change {
    double time_s;
    bool analogue;
    unsigned channel;
    double value;
};

struct virtual_probe {
    struct virtual_probe_part part;
    unsigned solids, changes;
    struct virtual_probe_solid solid[VIRTUAL_PROBE_SOLIDS_MAX];
    struct virtual_probe_change change[VIRTUAL_PROBE_CHANGES_MAX]; /* in the order of their time */
};

struct virtual_probe_error {
    uint32_t line, column; /* from 1 */
    char text[VIRTUAL_PROBE_ERROR_TEXT_MAX + 1];
};

/* False: *error says where and why. */
bool virtual_probe_read(struct virtual_probe *probe, const char *text, size_t length,
                        struct virtual_probe_error *error);

/* Lets the part stand turned by so much about X, Y, Z; the rest of *part is the caller's. */
void virtual_probe_place(struct virtual_probe_part *part,
                         const double turned_rad[AXIS_LINEAR_COUNT]);

/* Is the point inside a solid, or on it? Machine coordinates, mm and rad. */
bool virtual_probe_touches(const struct virtual_probe *probe, const struct point *at);

/* Sets the probe's contact and the inputs of a cycle; time_s since the drives are enabled. */
void virtual_probe_set_inputs(const struct virtual_probe *probe, double time_s,
                              const struct point *at, struct inputs *inputs);

#endif

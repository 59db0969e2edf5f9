/*
 * What a layer of correction is. Private to this room; correction.h is for others.
 */
#ifndef TAKT_CORRECTION_LAYER_H
#define TAKT_CORRECTION_LAYER_H

#include "correction/correction.h"

/*
 * The sum of all layers. Single precision is enough for what is at most a millimetre; a displaced
 * part is not.
 */
struct correction_sum {
    float fine[AXIS_COUNT];
    double *coarse;   /* by axis: begins with what is corrected, and fine comes on top */
    unsigned outside; /* bit i: axis i is beyond the end of a table */
};

struct correction_layer {
    const char *name; /* as machine files and panels say it */
    /* Prepares its notes, which are all 0. False: there is nothing this layer would correct. */
    bool (*begin)(const struct correction *c, struct layer_notes *notes);
    /* Once per cycle, before the sum, whether the layer is on or off. NULL: it follows nothing. */
    void (*follow)(struct correction *c, struct layer_notes *notes);
    /* Once per cycle before it fades in, until it returns true. NULL: it is ready at once. */
    bool (*prepare)(struct correction *c);
    /* Adds weight (0 ... 1) times its correction. */
    void (*add)(struct correction *c, struct layer_notes *notes, double weight,
                struct correction_sum *sum);
    /* Adds what it takes of the axes at full weight. */
    void (*need)(const struct correction *c, const struct layer_notes *notes,
                 const struct motion_bound *most, struct need *need);
};

/* Index among the axes of one of the four coordinates; AXIS_COUNT: the machine has no such axis. */
unsigned takt_correction_axis_of(const struct correction *c, unsigned coordinate);

#endif

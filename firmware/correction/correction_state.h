/*
 * Inside correction: public only so that the caller can own the memory. Read correction.h instead.
 */
#include "correction/correction.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_CORRECTION_CORRECTION_STATE_H
#define TAKT_CORRECTION_CORRECTION_STATE_H

#include "correction/fade.h"
#include "correction/grid_patch.h"
#include "correction/layers.h"
#include "correction/tables.h"

#define LAYER_NUMBERS      12
#define LAYER_COEFFICIENTS 16

/* What a layer remembers, as it likes. */
struct layer_notes {
    struct fade fade[AXIS_COUNT];
    double number[LAYER_NUMBERS];
    float coefficient[LAYER_COEFFICIENTS];
    bool started; /* the first cycle has been */
};

/* A set-up of the part, made ready to be followed. */
struct setup {
    double number[CORRECTION_SETUP_VALUES];
    double less_one[AXIS_LINEAR_COUNT][AXIS_LINEAR_COUNT]; /* R - I */
};

/* Tools whose wear is counted at the same time; the longest unused one makes room. */
#define CORRECTION_TOOLS_MAX 16

struct correction_wear {
    uint32_t tool;
    uint32_t used; /* count of tools used until then; 0: free */
    double length_mm, time_s;
};

struct correction {
    struct correction_settings settings;
    unsigned axes;     /* bit i set: the machine has axis i */
    unsigned axes_end; /* the axes from this one on are not there */
    double cycle_s;
    struct fade_pace layer_pace, reversal_pace;
    const struct correction_tables *tables;     /* NULL: none */
    const struct correction_tables *pending;    /* NULL: none; to replace tables */
    double setup_told[CORRECTION_SETUP_VALUES]; /* by the program, so far: the background's */
    struct setup setup_next;                    /* to replace the one in force */
    volatile bool setup_waits; /* it does, and is the control cycle's; else the background's */
    struct need reserved;
    struct motion_bound most; /* what has been reserved is for this motion */
    bool is_reserved;

    unsigned present;         /* layers that have something to correct */
    unsigned followers;       /* those of them that have something to follow */
    unsigned off;             /* by machine file or operator */
    unsigned program_off;     /* by the program */
    unsigned fading, running; /* layers whose weight moves; is not 0 */
    struct fade weight[CORRECTION_LAYERS_COUNT];
    struct layer_notes notes[CORRECTION_LAYERS_COUNT];
    struct grid_patches patches; /* of the volume table */

    /* What layers may depend on. */
    const struct point *at; /* commanded, this cycle */
    const struct move *move;
    double rise_k[AXIS_COUNT];
    struct correction_wear wear[CORRECTION_TOOLS_MAX];
    uint32_t tools_used;

    unsigned outside; /* axes that have been beyond the end of a table */
};

#endif

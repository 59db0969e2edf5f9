/*
 * The turning cycles G70, G71 and G72 over a profile: one step after the other, in work coordinates
 * of X and Z.
 *
 *        stock                      levels: every I from where the tool is, down to the profile
 *   <------------- level 0
 *   \<------------ level 1          G71.1 and G72.1 leave out pockets, what lies behind a rise;
 *    \__<--------- level 2          G71.2 and G72.2 cut them alone
 *
 * Roughing goes down the falling way of the profile to the next level, along it to where the
 * profile rises, off at 45 degrees by R, and back at rapid. At the lowest level it follows the
 * rise, to the next pocket or to the end.
 */
#ifndef TAKT_PROGRAM_TURNING_H
#define TAKT_PROGRAM_TURNING_H

#include "program/profile.h"

enum turning_kind { TURNING_ROUGH, TURNING_NO_POCKETS, TURNING_POCKETS, TURNING_FINISH };

/* One motion in the plane; u is Z, v is X. */
struct turning_move {
    bool rapid;
    bool arc, left;
    struct profile_point end, centre;
};

enum turning_stage {
    TURNING_DOWN,  /* along the profile to the next level, and off along it */
    TURNING_SKIP,  /* down to where the first pocket may begin */
    TURNING_UP,    /* along the profile until it falls */
    TURNING_RISES, /* along all that rises */
    TURNING_DRAW,  /* along the whole profile */
    TURNING_DONE
};

struct turning_words {
    double distance_mm; /* D */
    double last_mm;     /* G70: E */
    double step_mm;     /* I */
    double retract_mm;  /* R */
    uint32_t passes;    /* G70: P */
    uint8_t kind;       /* enum turning_kind */
    bool facing;        /* G72: levels are of Z */
};

struct turning {
    /* set by the caller */
    struct profile
        profile; /* from where the tool is; takt_turning_open turns it as profile.h says */
    struct turning_words words;

    struct profile_path path;
    struct turning_move move[5]; /* made and not yet fetched */
    uint8_t moves, fetched;
    uint8_t stage;
    bool turned, mirror_u, mirror_v;
    unsigned piece; /* of the path: arcs are two, down and up */
    double level_mm, top_mm;
    bool in_pocket;
    struct profile_point at;
    uint32_t pass;
};

enum turning_result { TURNING_GOOD, TURNING_NOT_MONOTONE, TURNING_CORNER, TURNING_SWALLOWED };

/* False: not possible so, *why. */
enum turning_result takt_turning_open(struct turning *t);

/* Goes back to the first move of an opened one. */
void takt_turning_begin(struct turning *t);

/* False: that was the last one. */
bool takt_turning_next(struct turning *t, struct turning_move *move);

#endif

/*
 * How the units of a machine stand on one another: from the tool down to the bed, and from the bed
 * up to the part.
 *
 * As ISO 10791 writes it, w C X b Y Z t is a machine whose table C stands on X and carries the part
 * (w), while Z, which stands on Y, carries the tool (t); b is the bed. At most one unit turns. It
 * is the one that bears the part.
 */
#ifndef TAKT_BASE_UNIT_CHAIN_H
#define TAKT_BASE_UNIT_CHAIN_H

#include <stdint.h>

#define UNIT_CHAIN_MAX 4

struct unit_chain {
    uint8_t units;                /* 0: not known */
    uint8_t tool_units;           /* the first of them carry the tool, the others the part */
    uint8_t axis[UNIT_CHAIN_MAX]; /* enum axis of each unit, from the tool to the part */
};

#endif

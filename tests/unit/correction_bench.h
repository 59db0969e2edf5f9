/* A correction at rest, and what it comes to somewhere. */
#ifndef TAKT_TESTS_CORRECTION_BENCH_H
#define TAKT_TESTS_CORRECTION_BENCH_H

#include "base/maths.h"
#include "correction/correction.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define CYCLE_S 0.001

static struct correction c;
static struct correction_settings settings;
static struct correction_tables tables, other_tables;
static struct move move;
static const struct point origin = {{0}};

void setUp(void)
{
    takt_correction_settings_set_default(&settings);
    memset(&tables, 0, sizeof tables);
    memset(&other_tables, 0, sizeof other_tables);
    memset(&move, 0, sizeof move);
    move.kind = MOVE_FEED;
}

void tearDown(void)
{
}

static inline void begin(const struct correction_tables *with)
{
    takt_correction_init(&c, &settings, 0x27, CYCLE_S, with, &origin); /* X Y Z C */
}

/* Stands at a point until everything has faded. */
static inline struct point settle(double x, double y, double z, double turn)
{
    const struct point at = {{x, y, z, 0, 0, turn}};
    struct point set = at;

    for (int i = 0; i < 6000; i++)
        takt_correction_cycle(&c, &at, &move, &set);
    for (int i = 0; i < AXIS_COUNT; i++)
        set.at[i] -= at.at[i];
    return set;
}

#endif

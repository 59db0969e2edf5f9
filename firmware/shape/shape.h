/*
 * Setpoints of all axes, so shaped that the modes between motors and tool are at rest when the
 * motors are, and that the tool is on the way it was sent on. Behind correction: what comes out is
 * what drives get.
 *
 * Each axis has a train of impulses (train.h) that meets its modes. All axes are delayed by the
 * same time, so that none runs ahead of another. See README.md for the formulas.
 */
#ifndef TAKT_SHAPE_SHAPE_H
#define TAKT_SHAPE_SHAPE_H

#include "base/point.h"
#include "plan/limits.h"
#include "shape/train.h"
#include "shape/zv.h"

#include <stdbool.h>
#include <stdint.h>

/* Modes of an axis. */
#define SHAPE_MODES 2

/* A train reaches over fewer cycles than this. A power of two. */
#define SHAPE_CYCLES_MAX 1024

struct shape_config {
    /* The train that a mode asks for, such as takt_zv_train. Its weights are not below 0. */
    void (*train)(const struct shape_mode *mode, double cycle_s, struct train *t);
    bool keeps_way; /* and the tool neither cuts bends nor swings out of them */
    double cycle_s;
    struct shape_mode mode[AXIS_LINEAR_COUNT][SHAPE_MODES];
};

struct shape {
    struct train train[AXIS_COUNT];
    double cycle_s;
    uint32_t cycles; /* of the longest train */
    uint32_t still;  /* cycles since what comes in has changed */
    uint32_t newest; /* place of the last input */
    uint32_t known;  /* inputs since the start; before it: start */
    struct point start;
    struct point input[SHAPE_CYCLES_MAX]; /* input n at n modulo SHAPE_CYCLES_MAX */
};

/* The axes stand at 0. NULL: good; else why these modes cannot be shaped in this cycle. */
const char *takt_shape_init(struct shape *s, const struct shape_config *config);

/* The axes stand here, and have always stood. */
void takt_shape_restart(struct shape *s, const struct point *at);

/* The next setpoint goes in, and what is sent instead of it comes out, in its place. */
void takt_shape_cycle(struct shape *s, struct point *set);

/* Does what is sent stand, if what comes in goes on to stand? */
bool takt_shape_is_settled(const struct shape *s);

/* What came in last. */
const struct point *takt_shape_input(const struct shape *s);

/* Takes from the planner's limits what impulses of negative weight add to what they are given. */
void takt_shape_leave(const struct shape *s, struct plan_limits *limits);

#endif

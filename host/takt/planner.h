/*
 * Planning without moving: the program through the same window that the controller uses.
 */
#ifndef TAKT_HOST_PLANNER_H
#define TAKT_HOST_PLANNER_H

#include "plan/segment.h"
#include "takt/command.h"
#include "takt/session.h"

#include <stdint.h>

struct planner_totals {
    uint32_t motions; /* that have a length */
    uint32_t stops;   /* their ends at rest */
    uint64_t cycles;
    double length_mm; /* of motions of X Y Z */
};

/* Plans the whole program and calls take for every segment, in order. STATUS_DONE, STATUS_ENVIRONMENT after a message,
 * STATUS_INTERRUPTED. The program has been checked. */
enum command_status planner_walk(const struct session *s,
                                 void (*take)(void *context, const struct segment *segment),
                                 void *context, struct planner_totals *totals);

#endif

/*
 * The controller: a part program in, setpoints to drives out. The only room that knows all others.
 *
 * Two callers: the control cycle calls controller_cycle once per cycle (an interrupt on a target), the background
 * calls controller_background as often as it likes. On the host one loop calls both:
 *
 *     controller_init(&c, &config);
 *     while (controller_get_state(&c) < CONTROLLER_COMPLETED) {
 *         controller_background(&c);
 *         controller_cycle(&c, &inputs);
 *         ... move the world by one cycle ...
 *     }
 *
 * The setpoints do not depend on how often the background is called, as long as it is called often enough.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_H
#define TAKT_CONTROLLER_CONTROLLER_H

#include "base/error.h"
#include "controller/machine.h"
#include "drive/drives.h"
#include "hal/can.h"
#include "hal/inputs.h"
#include "hal/outputs.h"
#include "motion/cycle_record.h"
#include "plan/segment.h"
#include "program/program.h"

#include <stdbool.h>
#include <stdint.h>

struct controller_config {
    const struct machine *machine;  /* copied */
    struct source source;           /* text of the program; its context stays the caller's */
    struct can_port can;            /* the drives' bus */
    const struct tool_table *tools; /* NULL: empty. Must outlive the controller */
    struct parameters *parameters;  /* never NULL; read and written. Must outlive the controller */
    bool exact_path;                /* every G64 is treated as G61 */
    bool block_delete;              /* skip lines that begin with '/' */
    uint32_t from_line;             /* start in the middle, at this line; 0: at the beginning */
};

enum controller_state {
    CONTROLLER_STARTING, /* drives are being enabled; no program cycle yet */
    CONTROLLER_RUNNING,  /* a program cycle each call */
    CONTROLLER_COMPLETED,
    CONTROLLER_FAULTED /* see controller_get_fault */
};

#include "controller/controller_state.h"

void controller_init(struct controller *c, const struct controller_config *config);
void controller_background(struct controller *c);
/* One control cycle with what is known of the world at its start. */
void controller_cycle(struct controller *c, const struct inputs *inputs);

enum controller_state controller_get_state(const struct controller *c);
/* What went wrong; meaningful in CONTROLLER_FAULTED. */
const struct diagnostic *controller_get_fault(const struct controller *c);
/*
 * What the last cycle did. NULL if it was no program cycle (drives starting, or after the end). The program cycles
 * are numbered 0, 1, 2, ... without gaps.
 */
const struct cycle_record *controller_get_record(const struct controller *c);
/* The machine's outputs as the last cycle left them. Valid until the next cycle. */
const struct outputs *controller_get_outputs(const struct controller *c);
/* The segment the last program cycle executed; NULL as above. Valid until the next cycle. */
const struct segment *controller_get_segment(const struct controller *c);

/* The planner's limits that follow from a machine: what controller_init itself uses. */
void controller_plan_limits(const struct machine *machine, struct plan_limits *limits);

/* The program configuration that follows from a machine: what controller_init itself uses. */
void controller_program_config(const struct controller_config *config,
                               struct program_config *program);

#endif

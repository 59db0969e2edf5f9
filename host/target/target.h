/*
 * A run whose controller is on another processor: QEMU, started with an image (hal/semihosting),
 * talked to cycle by cycle.
 *
 *     target_begin_cycle    inputs and received frames go out; the image works
 *     ... the controller of this process does the same cycle ...
 *     target_end_cycle      what the image did comes back, and is compared with it, bit for bit
 *
 * The frames that go on to the drives are the image's. The controller of this process hangs on
 * target_get_port.
 */
#ifndef TAKT_TARGET_TARGET_H
#define TAKT_TARGET_TARGET_H

#include "controller/controller.h"
#include "hal/can.h"
#include "remote/remote.h"
#include "target/process.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/types.h>

#define TARGET_PROBLEM_MAX 255

/* A table of corrections as correction/table_store.h writes it. */
struct target_table {
    bool is_volume;
    size_t size;
    uint8_t *bytes;
};

#define TARGET_TABLES_MAX (AXIS_COUNT + 1)

struct target_config {
    const char *name;    /* m4f, m7, rv64 */
    const char *image;   /* path of the ELF file */
    struct can_port bus; /* of the drives */
    const struct machine *machine;
    const struct tool_table *tools;
    const struct parameters *parameters;
    struct source program; /* read once, from its beginning, by target_open */
    FILE *plan;            /* the program planned ahead, a regular file; NULL: none */
    unsigned tables;
    const struct target_table *table;
    bool exact_path, block_delete;
    uint32_t from_line;
};

/* What the image's cycles cost: by QEMU's count, instructions. */
struct target_cost {
    uint64_t cycles; /* with the axes in motion */
    uint64_t sum, max;
    uint64_t background_sum;
    uint32_t blocks;
};

/* Private, but for name, cost and differences. */
struct target {
    const char *name;
    struct process process;
    struct can_port bus;
    struct remote_inputs given;
    struct remote_outputs done;
    uint32_t taken;     /* frames given that the controller here has had */
    uint32_t own_count; /* frames it has sent in this cycle */
    struct classical_frame own[REMOTE_FRAMES_MAX];
    uint64_t differences;      /* cycles */
    uint64_t first_difference; /* cycle since power-on */
    uint64_t cycles;
    struct target_cost cost;
    char problem[TARGET_PROBLEM_MAX + 1];
};

/* Is there a target of that name? */
bool target_is_known(const char *name);

/*
 * Starts QEMU and hands over machine, program and tables. It must not be moved once opened. False:
 * target->problem says why; target_close is due in either case.
 */
bool target_open(struct target *target, const struct target_config *config);
void target_close(struct target *target);

/* The bus of the controller in this process. */
struct can_port target_get_port(struct target *target);

/*
 * rise_k: AXIS_COUNT temperatures as takt_correction_set_rise takes them. False: target->problem.
 */
bool target_begin_cycle(struct target *target, const struct inputs *inputs, const double *rise_k);

/* controller: of this process, after the same cycle. False: target->problem. */
bool target_end_cycle(struct target *target, const struct controller *controller);

/* What the image did in the last cycle; NULL: no cycle of the program. */
const struct cycle_record *target_get_record(const struct target *target);

#endif

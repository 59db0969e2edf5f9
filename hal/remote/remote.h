/*
 * A controller in another processor, cycle by cycle: what a run on the desk and an image say to
 * each other.
 *
 *     desk   setup, then for every cycle: inputs, frames received   ─→
 *     image                                ←─ frames sent, record, state, cost
 *
 * Structs travel as they lie in memory: both sides are little-endian and lay out numbers of fixed
 * width alike, which the sizes below hold them to; the first message compares what may differ
 * between versions.
 */
#ifndef TAKT_REMOTE_REMOTE_H
#define TAKT_REMOTE_REMOTE_H

#include "controller/controller.h"
#include "hal/classical_frame.h"
#include "hal/inputs.h"
#include "motion/cycle_record.h"

#include <stdint.h>
#include <string.h>

#define REMOTE_MAGIC 0x344D5254U /* "TRM4" */

/* In one cycle and direction: a boot sends one SDO a drive at a time, and drives answer in kind. */
#define REMOTE_FRAMES_MAX 64

/* Bytes of a stored table, correction/table_store.h: more than the largest. */
#define REMOTE_TABLE_MAX 131072

/* Sent first by the image: what it was built with. */
struct remote_hello {
    uint32_t magic;
    uint32_t machine_size; /* struct machine */
    uint32_t tool_size;    /* struct tool */
};

/*
 * Then the desk: this, the machine, the parameters, the tools, and of each table its kind and size
 * (struct remote_table) and its bytes.
 */
struct remote_setup {
    uint32_t magic;
    uint32_t parameters; /* number of them */
    uint32_t tools;      /* number of them */
    uint32_t tables;     /* number of stored tables that follow */
    uint32_t from_line;  /* of struct controller_config, as the others */
    uint8_t exact_path;
    uint8_t block_delete;
    uint8_t unused[2];
};

/* Only those that are not 0. */
struct remote_parameter {
    uint32_t number;
    uint32_t unused;
    double value;
};

struct remote_table {
    uint32_t is_volume; /* 0: over one axis */
    uint32_t size;      /* bytes that follow */
};

/* What the image makes of the setup: 0, or an error of base/error.h; then it ends. */
struct remote_ready {
    int32_t error;
    uint32_t clock_hz; /* of the costs below; 0: they are not measured */
};

/* The desk, every cycle. */
struct remote_inputs {
    uint32_t go_on; /* 0: the image ends */
    uint32_t frames;
    struct inputs inputs;
    double rise_k[AXIS_COUNT]; /* for the thermal layer of the correction */
    struct classical_frame frame[REMOTE_FRAMES_MAX];
};

/* The image answers, after background and cycle. */
struct remote_outputs {
    uint32_t state; /* enum controller_state */
    uint32_t frames;
    uint32_t refused;  /* frames that found no room */
    int32_t fault;     /* code of the fault; 0: none */
    uint32_t cycle_ns; /* takt_controller_cycle took, by the clock of the image */
    uint32_t background_ns;
    uint32_t blocks;     /* that the background has put on the path so far */
    uint32_t has_record; /* the record is of this cycle */
    struct cycle_record record;
    struct classical_frame frame[REMOTE_FRAMES_MAX];
};

_Static_assert(sizeof(struct inputs) == 96, "as on every side");
_Static_assert(sizeof(struct cycle_record) == 200, "as on every side");

#endif

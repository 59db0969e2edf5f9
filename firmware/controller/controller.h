/*
 * The controller: a part program in, setpoints to drives out. The only room that knows all others.
 *
 * Two callers: the control cycle calls takt_controller_cycle once per cycle (an interrupt on a
 * target), the background calls takt_controller_background as often as it likes. On the host one
 * loop calls both:
 *
 *     takt_controller_init(&c, &config);
 *     while (takt_controller_get_state(&c) < CONTROLLER_COMPLETED) {
 *         takt_controller_background(&c);
 *         takt_controller_cycle(&c, &inputs);
 *         ... move the world by one cycle ...
 *     }
 *
 * The setpoints do not depend on how often the background is called, as long as it is called often
 * enough.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_H
#define TAKT_CONTROLLER_CONTROLLER_H

#include "accuracy/cycle_frequency.h"
#include "base/error.h"
#include "controller/controller_reader.h"
#include "correction/correction.h"
#include "drive/drives.h"
#include "hal/can.h"
#include "hal/inputs.h"
#include "hal/outputs.h"
#include "hal/step.h"
#include "machine/machine.h"
#include "motion/cycle_record.h"
#include "plan/block.h"
#include "program/program.h"
#include "replay/intake.h"

#include <stdbool.h>
#include <stdint.h>

struct controller_config {
    const struct machine *machine;    /* copied */
    struct controller_reader *reader; /* never NULL; its alone. Must outlive the controller */
    struct source source;             /* text of the program; its context stays the caller's */
    struct can_buses can;             /* of the drives and I/O nodes */
    /*
     * that drives are set up by: of MACHINE_NODES_MAX drives, the axes' and then the gantries'
     * second ones, without bytes where there is none. Must outlive the controller; NULL: no drive's
     */
    const struct concise_dcf *dcf;
    struct step_port step;          /* pulses; not used by a machine without step drives */
    const struct tool_table *tools; /* NULL: empty. Must outlive the controller */
    struct parameters *parameters;  /* never NULL; read and written. Must outlive the controller */
    const struct correction_tables *correction; /* NULL: no tables; see takt_correction_init */
#ifndef SHAPE_IS_ABSENT
    struct shape *
        shape; /* of the machine's modes; its alone. NULL: setpoints go to the drives as they are */
#endif
    const struct replay_source *compiled; /* of the same program: replayed. NULL: planned here */
    const struct program_modes *modes;    /* the program goes on with; NULL: those it begins with */
    void (*say)(void *listener, const struct program *p); /* as of struct program_config */
    /*
     * Hears of every line that is wrong. True: it is left out and the text goes on. NULL: it ends
     * the program.
     */
    bool (*refuse)(void *listener, const struct diagnostic *why);
    void *listener;     /* of both */
    bool exact_path;    /* every G64 is treated as G61 */
    bool block_delete;  /* skip lines that begin with '/' */
    bool keeps_outputs; /* the end of the program leaves spindle and coolant as they are */
    uint32_t from_line; /* start in the middle, at this line; 0: at the beginning */
};

enum controller_state {
    CONTROLLER_STARTING, /* drives are being enabled; no program cycle yet */
    CONTROLLER_RUNNING,  /* a program cycle each call, from the next one on */
    CONTROLLER_STOPPING, /* after a fault of a drive: the drives brake; no program cycle any more */
    CONTROLLER_COMPLETED,
    CONTROLLER_FAULTED /* see takt_controller_get_fault */
};

#include "controller/controller_state.h"

void takt_controller_init(struct controller *c, const struct controller_config *config);
void takt_controller_background(struct controller *c);
/* One control cycle with what is known of the world at its start. */
void takt_controller_cycle(struct controller *c, const struct inputs *inputs);

enum controller_state takt_controller_get_state(const struct controller *c);
/* What went wrong; meaningful in CONTROLLER_FAULTED. */
const struct diagnostic *takt_controller_get_fault(const struct controller *c);
/* The drives as the controller knows them, to be looked at. */
const struct drives *takt_controller_get_drives(const struct controller *c);
/*
 * What the last cycle did. NULL if it was no program cycle (drives starting, or after the end). The
 * program cycles are numbered 0, 1, 2, ... without gaps.
 */
const struct cycle_record *takt_controller_get_record(const struct controller *c);
/* Where the axes are by what the drives have reported last. */
void takt_controller_get_actual(const struct controller *c, struct point *actual);
/* How many questions of the program (G38, M66) have been answered, and the last answer. */
uint32_t takt_controller_get_answers(const struct controller *c, struct program_answer *last);
/*
 * The axes rest because the text of the program, which is still coming, has not come in time; they
 * go on by themselves.
 */
bool takt_controller_is_starved(const struct controller *c);
/* What is there of a text that comes slowly is driven now. */
void takt_controller_begin(struct controller *c);
/* Flood, or else mist. */
void takt_controller_set_coolant(struct controller *c, bool flood, bool on);
/*
 * Exchanges with the background that it was too late for: the axes then stop at the end of the
 * known path.
 */
uint64_t takt_controller_get_late(const struct controller *c);
/* The machine's outputs as the last cycle left them. Valid until the next cycle. */
const struct outputs *takt_controller_get_outputs(const struct controller *c);
/* The block the last program cycle executed; NULL as above. Valid until the next cycle. */
const struct block *takt_controller_get_block(const struct controller *c);

/*
 * The frequency that circles in the planes of a machine's linear axes need, and what governs it; 0
 * Hz without two such axes. limits: of the plane that needs most; may be NULL.
 */
void takt_controller_cycle_need(const struct machine *machine, struct cycle_need *need,
                                struct cycle_limits *limits);

/*
 * Compares the machine's control cycle with the frequency at which the fastest circle its linear
 * axes can drive keeps the chord error of one increment. False: it is slower, and the planner
 * limits the feed of curves instead; *warning says so.
 */
bool takt_controller_cycle_is_enough(const struct machine *machine, struct diagnostic *warning);

/*
 * What the controller has to say about its machine at the start: TAKT_OK, or CYCLE_SLOW.
 */
const struct diagnostic *takt_controller_get_warning(const struct controller *c);

/* The machine's interpolator: what takt_controller_init itself uses. */
void takt_controller_interpolator_config(const struct machine *machine,
                                         struct interpolator_config *config);

/* What the machine's interpolator erred by so far; all 0 for the exact one. */
const struct interpolator_errors *
takt_controller_get_interpolator_errors(const struct controller *c);

/* The planner's limits that follow from a machine: what takt_controller_init itself uses. */
void takt_controller_plan_limits(const struct machine *machine, struct plan_limits *limits);

/*
 * Takes from the limits what correction needs of the axes: what takt_controller_init itself uses.
 */
void takt_controller_reserve_correction(struct correction *correction,
                                        const struct machine *machine, struct plan_limits *limits);

/*
 * Position-error correction, to switch layers, tell temperatures and load tables between two
 * cycles.
 */
struct correction *takt_controller_get_correction(struct controller *c);

/*
 * The drives that follow from a machine, which must outlive them: what takt_controller_init itself
 * uses.
 */
void takt_controller_drives_config(const struct machine *machine, const struct concise_dcf *dcf,
                                   struct drives_config *config);

/* The program configuration that follows from a machine: what takt_controller_init itself uses. */
void takt_controller_program_config(const struct controller_config *config,
                                    struct program_config *program);

#endif

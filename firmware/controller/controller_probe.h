/*
 * What a program asks of the world, and waits for: where a probe answers (G38), what an input says
 * (M66); for G10 L13, that the axes rest.
 *
 *     background                              control cycle
 *       program gives out the move
 *       takt_controller_probe_ask     ──────────→    takt_controller_probe_rest    where drives have touch probes: they are armed
 *       takt_controller_probe_begin   ←──────────
 *       the move goes onto the path  ──────→    takt_controller_probe_watch   the move is executed; true: brake now
 *       program says PROGRAM_WAIT               ...
 *                                               takt_controller_probe_rest    nothing moves any more; true: answered
 *       takt_controller_probe_take    ←──────────
 *       takt_cutter_compensation_answer, and on from where the axes rest
 *
 * Nobody else is asked meanwhile: the program reads nothing until it is answered. struct
 * controller_probe passes from the background to the cycle by ask and back when it is answered;
 * nobody touches it out of turn.
 */
#ifndef TAKT_CONTROLLER_CONTROLLER_PROBE_H
#define TAKT_CONTROLLER_CONTROLLER_PROBE_H

#include "base/error.h"
#include "drive/drives.h"
#include "hal/inputs.h"
#include "program/program.h"

#include <stdbool.h>
#include <stdint.h>

enum controller_probe_state {
    PROBE_IDLE, /* nothing has been asked */
    /* the move is not on the path yet: the axes come to rest, the drives' touch probes are armed */
    PROBE_HELD,
    PROBE_ARMED,   /* they are: the background puts it there */
    PROBE_ASKED,   /* the move is executed, or comes to rest, or waits */
    PROBE_ANSWERED /* answer and error hold */
};

struct controller_probe {
    enum controller_probe_state state;
    struct move move;
    bool latches;          /* the drives' touch probes have been armed */
    bool reads;            /* they are being read */
    bool begun;            /* the move has been looked at */
    bool level_before;     /* of the input */
    uint64_t cycles_left;  /* until the input's time is over */
    enum takt_error error; /* TAKT_OK: none */
    struct program_answer answer;
    uint32_t answers; /* taken so far, by the background, and the last of them */
    struct program_answer taken;
};

/*
 * A move has come from the program: remembers it when it asks for something. latches: drives have
 * touch probes. False: it is not to go onto the path before takt_controller_probe_begin says so.
 */
bool takt_controller_probe_ask(struct controller_probe *q, const struct move *move, double cycle_s,
                               bool latches);

/* True, once: touch probes are armed; the move goes onto the path now. */
bool takt_controller_probe_begin(struct controller_probe *q);

/* Is there something to watch, and to answer? */
static inline bool controller_probe_is_asked(const struct controller_probe *q)
{
    return q->state == PROBE_ASKED || q->state == PROBE_HELD;
}

/* Where the axes are, by their drives. */
struct controller_place {
    struct point reported;
    struct point
        actual; /* the same in the program's coordinates: without what correction has added */
};

/*
 * In each cycle that executes a motion. True, once: the motion is to brake at once and to end where
 * it comes to rest.
 */
bool takt_controller_probe_watch(struct controller_probe *q, const struct move *executed,
                                 const struct inputs *inputs, const struct controller_place *at);

/*
 * In each cycle in which all that has been read is done and the program waits. rest: where the axes
 * have been sent to last. True: answered.
 */
bool takt_controller_probe_rest(struct controller_probe *q, const struct inputs *inputs,
                                struct drives *drives, const struct point *rest,
                                const struct controller_place *at);

/* An answer to a move of this kind waits to be taken? */
static inline bool controller_probe_has_rest_for(const struct controller_probe *q,
                                                 enum move_kind kind)
{
    return q->state == PROBE_ANSWERED && q->move.kind == kind;
}

/*
 * The answer that waits to be taken, and TAKT_OK or the error that ends the program; false: there
 * is none.
 */
bool takt_controller_probe_take(struct controller_probe *q, struct program_answer *answer,
                                struct diagnostic *error);

#endif

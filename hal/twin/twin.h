/*
 * A drive in another processor, call by call: what takt and an image of a drive say to each other.
 *
 *     takt    order: a frame, a cycle, an edge of the probe    ─→
 *     image                                       ←─ ask: a frame is sent, the motor has this torque, ...
 *     takt    reply: what became of it                         ─→
 *     image                                       ←─ ask TWIN_DONE: the order is carried out
 *
 * Structs travel as they lie in memory, as in remote/remote.h.
 */
#ifndef TAKT_TWIN_TWIN_H
#define TAKT_TWIN_TWIN_H

#include "canopen/pdo.h"
#include "hal/classical_frame.h"
#include "hal/motor.h"
#include "servo/servo.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define TWIN_MAGIC 0x31445254U /* "TRD1" */

/* Bytes of a drive's own data sheet, object 1021: more than the largest. */
#define TWIN_EDS_MAX 131072

/* Sent first by the image: what it was built with. */
struct twin_hello {
    uint32_t magic;
    uint32_t config_size; /* TWIN_CONFIG_SIZE */
    uint32_t sense_size;  /* struct motor_sense */
};

/*
 * takt answers with this, and with struct servo_config up to its dictionary, which is the own one.
 */
#define TWIN_CONFIG_SIZE offsetof(struct servo_config, dictionary)

struct twin_setup {
    uint32_t magic;
    uint32_t has_target;
    struct pdo target;
};

enum twin_order_kind {
    TWIN_END,       /* the image ends */
    TWIN_BOOT,      /* takt_servo_boot */
    TWIN_FRAME,     /* takt_servo_on_frame_at */
    TWIN_STEP,      /* takt_servo_step: a, ns */
    TWIN_TOUCH,     /* takt_servo_touch: a, ratio */
    TWIN_LOOK,      /* takt_servo_loop_look */
    TWIN_FAIL,      /* takt_servo_fail: a code, b register */
    TWIN_EMERGENCY, /* takt_servo_send_emergency: the same */
    TWIN_REBOOT,    /* takt_servo_reboot */
    TWIN_WRITE,     /* takt_servo_write_object: a object, b value */
    TWIN_MEDDLE,    /* takt_servo_meddle: from now on the image asks */
    TWIN_EDS        /* takt_servo_set_eds: a bytes follow */
};

struct twin_order {
    uint32_t kind;
    uint32_t a, b;
    struct classical_frame frame;
    uint64_t time_ns;
    double ratio;
};

enum twin_ask_kind {
    TWIN_DONE,
    TWIN_SEND,       /* a frame */
    TWIN_TURN,       /* x torque, y time */
    TWIN_SENSE,      /* a cycle_ns */
    TWIN_HOLDS_BACK, /* a enum servo_frame */
    TWIN_ABORTS_SDO, /* a object */
    TWIN_OVERRIDES,  /* a index, b sub-index */
    TWIN_ASK_KINDS
};

struct twin_ask {
    uint32_t kind;
    uint32_t a, b;
    struct classical_frame frame;
    double x, y;
};

struct twin_reply {
    uint32_t yes;
    uint32_t value;
    double encoder_mm;
    struct motor_sense sense;
};

_Static_assert(sizeof(struct twin_order) == 40, "as on every side");
_Static_assert(sizeof(struct twin_ask) == 40, "as on every side");
_Static_assert(sizeof(struct motor_sense) == 96, "as on every side");
_Static_assert(sizeof(struct twin_reply) == 112, "as on every side");

#endif

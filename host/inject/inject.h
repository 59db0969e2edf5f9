/*
 * Scripted faults as data: what is to go wrong on the bus and in the drives, and when.
 *
 *     struct inject script;
 *     struct inject_error error;
 *     if (!inject_read(&script, text, length, &error)) ... "FILE:LINE:COLUMN: error: TEXT" ...
 *     ... every cycle: clock.now_ns = ...;  if (inject_is_in_force(&script.fault[i], &clock)) ...
 *
 * This room reads scripts and tells the time. What a fault does is done by whoever can do it:
 * faults of the bus by the bus, faults of a drive by that drive.
 */
#ifndef TAKT_INJECT_INJECT_H
#define TAKT_INJECT_INJECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define INJECT_FAULTS_MAX     64
#define INJECT_ERROR_TEXT_MAX 255

/* A node of a bus, as one number. */
#define INJECT_ADDRESS(bus, node) ((uint16_t)((bus) << 8 | (node)))

#define INJECT_CONTROLLER 0      /* as a node: the controller */
#define INJECT_ANY_NODE   0xFF   /* node of a bus fault: not given */
#define INJECT_ANY_ID     0xFFFF /* id: not given */
#define INJECT_ALWAYS     UINT64_MAX
#define INJECT_ALL        UINT32_MAX

enum inject_kind {
    /* For the bus: what happens to frames that match id (and the sending node), or to a node. */
    INJECT_DROP,          /* nobody receives them */
    INJECT_CORRUPT,       /* destroyed on the wire: error frame, then the sender repeats */
    INJECT_DUPLICATE,     /* received twice */
    INJECT_DELAY,         /* sent later, by_ns */
    INJECT_ERROR_PASSIVE, /* node: its error counters reach 128 */
    INJECT_BUS_OFF,       /* node: off the bus for for_ns, or for good */
    INJECT_CUT,           /* node: neither hears nor is heard */
    /* For a drive. */
    INJECT_EMCY,         /* error code: emergency, fault reaction, fault */
    INJECT_WARN,         /* code: emergency only, the drive goes on */
    INJECT_MUTE,         /* what: these frames are not sent */
    INJECT_HANG,         /* the node neither sends nor takes frames; its motor does as last told */
    INJECT_REBOOT,       /* the node starts anew: boot-up, pre-operational, torque off */
    INJECT_FREEZE,       /* object: shows the value it had when the fault began */
    INJECT_REPORT,       /* object: shows value */
    INJECT_SDO_ABORT,    /* object: SDO requests for it are aborted with code */
    INJECT_JAM,          /* the axis does not move any more */
    INJECT_WEAK,         /* ratio: the part of its torque the motor still has */
    INJECT_ENCODER_JUMP, /* by_mm: the encoder reads this much more from now on */
    INJECT_KINDS
};

/* What INJECT_MUTE keeps back. */
enum inject_mute {
    INJECT_MUTE_ALL,
    INJECT_MUTE_HEARTBEAT,
    INJECT_MUTE_TPDO,
    INJECT_MUTE_SDO,
    INJECT_MUTE_EMCY
};

/* What times count from: the power-on of everything, or the moment all drives are enabled first. */
enum inject_anchor { INJECT_POWER, INJECT_ENABLED };

/* Values a kind has no use for are at their default. */
struct inject_fault {
    uint32_t line; /* of the script, from 1 */
    enum inject_kind kind;
    enum inject_anchor anchor;
    uint64_t after_ns; /* begins this long after the anchor */
    uint64_t for_ns;   /* lasts this long; INJECT_ALWAYS: for good. 0 for what happens once */

    uint8_t bus;     /* that fails, or that the drive is on */
    uint8_t node;    /* 1 ... 127, INJECT_CONTROLLER, INJECT_ANY_NODE */
    uint16_t id;     /* CAN identifier, INJECT_ANY_ID */
    uint32_t skip;   /* matching frames that pass unharmed first */
    uint32_t frames; /* matching frames that are hit then; INJECT_ALL */
    double ratio; /* bus: probability that a matching frame is hit, 0 ... 1; weak: part of torque */
    uint32_t seed;          /* of the dice for ratio */
    uint64_t by_ns;         /* of a delay */
    double by_mm;           /* of an encoder's jump */
    uint16_t index;         /* of an object */
    uint8_t sub;            /* of an object */
    uint32_t value;         /* of an object */
    uint32_t code;          /* EMCY error code (16 bits) or SDO abort code */
    uint8_t error_register; /* of an emergency; 0: as the code suggests */
    enum inject_mute what;
};

struct inject {
    unsigned count;
    struct inject_fault fault[INJECT_FAULTS_MAX]; /* in the order of the script */
};

struct inject_error {
    uint32_t line, column; /* from 1 */
    char text[INJECT_ERROR_TEXT_MAX + 1];
};

/* The time faults are told by; kept by whoever keeps the time. */
struct inject_clock {
    uint64_t now_ns;     /* since power-on */
    uint64_t enabled_ns; /* when all drives were enabled first; INJECT_ALWAYS: not yet */
};

/*
 * Reads a script. False: *error says what is wrong and where; *script holds what stands before it.
 */
bool inject_read(struct inject *script, const char *text, size_t length,
                 struct inject_error *error);

/* True from the fault's beginning to its end; what happens once, from its beginning on. */
bool inject_is_in_force(const struct inject_fault *fault, const struct inject_clock *clock);

/* True: something for the bus to do; false: for a drive. */
bool inject_is_of_bus(enum inject_kind kind);

/* As a script names it: "drop", "emcy". */
const char *inject_name(enum inject_kind kind);

/* Writes the manual of the format: what `takt help inject` prints. */
void inject_write_help(FILE *stream);

#endif

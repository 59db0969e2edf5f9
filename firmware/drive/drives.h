/*
 * The CiA 402 drives of a machine as seen from the controller: setpoints in, positions and states
 * out, CANopen frames through a CAN port.
 *
 * Once a cycle, in this order:
 *     takt_drives_receive   everything that has come since the last cycle
 *     takt_drives_sync      SYNC: the drives latch the targets sent last cycle and sample their positions
 *     takt_drives_send      what the state asks for: requests, controlwords, the targets of this cycle
 *
 *     STARTING --all enabled and homed--> ENABLED --fault--> STOPPING --at rest, or too late--> BRAKING --> FAULTED
 *         +------------------- fault -----------+----- fault that cuts setpoints off ------------^
 */
#ifndef TAKT_DRIVE_DRIVES_H
#define TAKT_DRIVE_DRIVES_H

#include "base/error.h"
#include "base/point.h"
#include "canopen/concise_dcf.h"
#include "drive/io_wiring.h"
#include "drive/rates.h"
#include "hal/can.h"
#include "hal/inputs.h"
#include "hal/outputs.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Cycles from a setpoint's being sent to the report of the position the drive had when it should
 * have reached it. Sent in cycle k, latched at SYNC k + 1, interpolated to until SYNC k + 2, where
 * the position is sampled; that report is received by takt_drives_receive in cycle k + 3.
 */
#define DRIVES_LATENCY_CYCLES 3

/* Object 1018 of a drive. 0: whatever it is. */
struct drives_identity {
    uint32_t vendor, product, revision, serial;
};

/*
 * How a drive finds its zero (CiA 402, homing mode). For a rotary axis read rad where the name says
 * mm.
 */
struct drives_homing {
    uint8_t order; /* axes of order 1 first, all of an order at once; 0: this axis is not homed */
    int8_t method; /* object 6098 */
    double velocity_mm_s;      /* 6099:01, towards the switch; > 0 */
    double zero_mm_s;          /* 6099:02, towards the zero mark; > 0 */
    double acceleration_mm_s2; /* 609A; > 0 */
    double offset_mm;          /* position of the axis at its home */
    bool offset_is_position;   /* 607C is that position; else, as CiA 402 has it, minus it */
    uint32_t timeout_cycles;   /* DRIVE_HOMING_SLOW beyond */
};

struct drives_config_axis {
    enum axis axis;
    uint8_t node;        /* CANopen node id, 1 ... 127, each once on a bus */
    uint8_t bus;         /* that it is on, 0 ... CAN_BUSES_MAX - 1 */
    bool keeps_settings; /* it has been set up with its maker's tool: it is only looked at */
    const struct concise_dcf *
        dcf; /* it is set up by this, see drives_dcf.c. Must outlive the drives; NULL: by nothing */
    /* position units of the drive per mm or rad; < 0: it turns the other way */
    double increments_per_mm;
    double travel_per_turn_mm;     /* of its motor, to check increments_per_mm by; 0: not checked */
    double following_error_max_mm; /* alarm beyond; 0: not watched */
    struct drives_identity identity;
    struct drives_homing homing;
    /* of 60FF and 6099, and accelerations per mm/s2; 0: increments_per_mm */
    double velocity_units_per_mm_s;
    double max_acceleration_mm_s2; /* of its setpoints */
};

/* Two drives of one axis: indices of struct drives_config.axis. */
struct drives_gantry {
    uint8_t first, second;
    double skew_max_mm; /* alarm beyond; > 0 */
};
#define DRIVES_GANTRIES_MAX AXIS_LINEAR_COUNT

struct drives_config {
    unsigned count; /* drives, 0 ... AXIS_COUNT; none: enabled at once */
    struct drives_config_axis axis[AXIS_COUNT];
    unsigned gantry_count;
    struct drives_gantry gantry[DRIVES_GANTRIES_MAX];
    unsigned io_count;              /* I/O nodes beside them, 0 ... IO_NODES_MAX */
    const struct io_wiring *wiring; /* of these. Must outlive the drives */
    bool homed;      /* all axes have been homed since power-on: they are not homed again */
    struct point at; /* where each axis was known to be last, until it reports; 0 if it never was */
    uint32_t cycle_us;
    struct drives_rates rates;  /* of every bus */
    double position_gain_per_s; /* of drives that follow by velocity: drives_velocity.c; > 0 */
    /* drives tell their error codes by emergencies alone, which takes less of the bus */
    bool no_error_pdo;
    uint8_t controller_node;      /* our own node id, for the heartbeat; none of the drives' */
    uint16_t heartbeat_ms;        /* period, of the drives and our own; 0: no heartbeats */
    uint32_t boot_timeout_cycles; /* that a drive takes to boot at most; it is reset twice */
    /* all drives must be enabled within, once they have been told everything */
    uint32_t start_timeout_cycles;
    uint32_t answer_timeout_cycles; /* a drive silent for longer is lost: DRIVE_SILENT */
    /* for an answer to a request, which is repeated DRIVES_SDO_REPEATS times */
    uint32_t sdo_timeout_cycles;
    /* how long STOPPING may last; 0: there is none, drives brake at once */
    uint32_t stop_timeout_cycles;
    /* how long BRAKING may last; then the drives count as faulted anyway */
    uint32_t brake_timeout_cycles;
};

#define DRIVES_SDO_REPEATS 2

/* A drive that hears no heartbeat for this many periods takes its partner for lost; so do we. */
#define DRIVES_HEARTBEATS_LOST 3

enum drives_state {
    DRIVES_STARTING, /* boot, check, configure, enable, home: drives hold where they stand */
    DRIVES_ENABLED,  /* setpoints are followed */
    DRIVES_STOPPING, /* a fault, but setpoints are still followed: bring them to rest on the path */
    DRIVES_BRAKING,  /* every drive brakes by itself (quick stop); setpoints are ignored */
    DRIVES_FAULTED   /* at rest, as far as can be known */
};

/*
 * What the start has done without, since a drive would not have it: bits of
 * takt_drives_get_given_up. A drive that already is as it should be has nothing given up, even
 * where it refuses to be told.
 */
enum drives_given_up {
    /* its target does not share a frame with that of another drive: no dummy mapping */
    DRIVES_NO_PAIR,
    DRIVES_NO_MAPPING,    /* its PDOs are taken as they are */
    DRIVES_NO_SILENCE,    /* it sends PDOs that nobody wants */
    DRIVES_NO_ONE_REPORT, /* statusword and position come in a PDO each */
    DRIVES_NO_CSP,        /* it follows targets in interpolated position mode */
    DRIVES_NO_MODES, /* it does not tell its modes (6502): cyclic synchronous position is tried */
    DRIVES_NO_MODE_PDO,     /* its mode (6060) is told by SDO */
    DRIVES_NO_CONTROL_PDO,  /* its controlword (6040) is told by SDO */
    DRIVES_NO_MODE_DISPLAY, /* it does not tell its mode (6061) */
    DRIVES_NO_SYNC_TARGET,  /* its target acts when it comes, not with SYNC */
    DRIVES_NO_ERROR_PDO,    /* it tells no error code (603F) beside its emergencies */
    DRIVES_NO_EVENT_TIMER,  /* it tells that code when it changes, and never again */
    DRIVES_NO_HEARTBEAT,    /* it sends none that is known (1017): its status alone is watched */
    DRIVES_NO_WATCH,        /* it does not watch our heartbeat (1016) */
    DRIVES_NO_SYNC_PERIOD,  /* it does not know the period of SYNC (1006), and may not miss it */
    DRIVES_NO_PERIOD,       /* it does not know the time between targets (60C2) */
    DRIVES_NO_STOP_OPTION,  /* it stops as it likes (6007, 605A, 605E) */
    DRIVES_NO_HOMING_SPEED, /* it homes as fast as it likes (6099, 609A) */
    DRIVES_NO_TOUCH_PROBE,  /* it latches no position (60B8): a probing move has that of a cycle */
    /* it does not tell its scaling (6092, 608F): increments_per_mm is believed */
    DRIVES_NO_SCALING,
    /* it has no heartbeat (1017), and is asked for its state instead (100C, 100D) */
    DRIVES_GUARDED,
    DRIVES_NO_POSITION, /* it follows velocities: the position loop is ours */
    DRIVES_NO_RAMPS,    /* its ramps to a velocity (6083, 6084) are as they are set up */
    DRIVES_NO_TYPE,     /* its type (1000) is not that of a drive: it is taken for one */
    /* its reports come by a timer, not by SYNC: they are up to a cycle older */
    DRIVES_NO_SYNC_REPORT,
    DRIVES_GIVEN_UP_COUNT
};

#include "drive/drives_state.h"

void takt_drives_init(struct drives *d, const struct drives_config *config);
/* port: of every bus on which there is something, by its index. */
void takt_drives_receive(struct drives *d, const struct can_port *port);
void takt_drives_sync(struct drives *d, const struct can_port *port);
/*
 * setpoint: of every axis, mm or rad. Followed in DRIVES_ENABLED and DRIVES_STOPPING. In
 * DRIVES_STOPPING the caller lets it come to rest, on the path and within the limits; once it has
 * rested the drives are switched off.
 */
void takt_drives_send(struct drives *d, const struct can_port *port, const struct point *setpoint);

/* There are I/O nodes. */
static inline bool drives_have_io(const struct drives *d)
{
    return d->io_count > 0;
}
/*
 * After takt_drives_send: the outputs of the I/O nodes, when they have changed, and now and then.
 */
void takt_drives_send_outputs(struct drives *d, const struct can_port *port,
                              const struct outputs *outputs);
/* Sets the inputs that I/O nodes are wired to, as they were reported last. The others stay. */
void takt_drives_add_inputs(const struct drives *d, struct inputs *inputs);
/* An input of another kind. False: none is wired to it. */
bool takt_drives_find_input(const struct drives *d, enum io_bit kind, bool *is_high);

static inline enum drives_state drives_get_state(const struct drives *d)
{
    return d->state;
}
/*
 * Last reported actual position of every axis, mm or rad, before the first as configured; 0 for
 * axes without a drive.
 */
static inline void drives_get_actual(const struct drives *d, struct point *actual)
{
    *actual = d->actual;
}
/*
 * The touch probes of the drives, which latch where they are when the probe touches, or (falls)
 * ceases to. In DRIVES_ENABLED, while the axes rest: arm before the probing move, read after it,
 * each until it is no longer busy. takt_drives_get_latched: axes whose drives have latched take
 * their place in *at, mm or rad; the others stay.
 */
bool takt_drives_have_probe(const struct drives *d);
void takt_drives_arm_probe(struct drives *d, bool falls);
void takt_drives_read_probe(struct drives *d);
static inline bool drives_probe_is_busy(const struct drives *d)
{
    return d->probing & (DRIVES_PROBE_ARMS | DRIVES_PROBE_READS) && d->state == DRIVES_ENABLED;
}
/* They have been armed: in some cycles there was a request by SDO. */
bool takt_drives_have_probed(const struct drives *d);
void takt_drives_get_latched(const struct drives *d, struct point *at);

/* All axes that are to be homed have been: what the next configuration may say. */
bool takt_drives_are_homed(const struct drives *d);

/*
 * Bits 1 << enum drives_given_up of an axis; 0 too for axes without a drive. Complete once the
 * drives are enabled.
 */
uint32_t takt_drives_get_given_up(const struct drives *d, enum axis axis);
/* Bits that any axis has: all axes' together. */
uint32_t takt_drives_get_all_given_up(const struct drives *d);

/*
 * Last statusword (object 6041) of every axis; 0 for axes without a drive, or before it has
 * reported.
 */
void takt_drives_get_statuswords(const struct drives *d, uint16_t statusword[AXIS_COUNT]);

/*
 * Every drive brakes by itself, from the next takt_drives_send on, DRIVES_BRAKING; with this error,
 * unless there has been one before.
 */
void takt_drives_stop_at_once(struct drives *d, enum takt_error reason);
/* The same for a fault that is not of these drives. */
void takt_drives_stop_for(struct drives *d, const struct diagnostic *fault);

/*
 * The caller brings the setpoint to rest on the path, DRIVES_STOPPING, and then every drive brakes;
 * with this error, unless there has been one before. Drives that do not follow setpoints yet brake
 * at once.
 */
void takt_drives_stop_on_path(struct drives *d, enum takt_error reason);
/*
 * An axis that has no drive of these is still on its way: in DRIVES_STOPPING, before
 * takt_drives_send.
 */
static inline void drives_await_rest(struct drives *d)
{
    d->rest_cycles = 0;
}
/*
 * In DRIVES_FAULTED, between two cycles: drives become "switched on", where there is no torque,
 * instead of staying "switch on disabled". One drive a call; there is one.
 */
void takt_drives_switch_on_at_rest(struct drives *d, const struct can_port *port);

/* What went wrong; meaningful from DRIVES_STOPPING on. */
const struct diagnostic *takt_drives_get_fault(const struct drives *d);

/*
 * Data lengths, in bytes, of the frames a cycle puts on the bus at most while nothing is wrong:
 * SYNC, the targets, a status per drive, and of the frames that are sent now and then a TPDO2 and a
 * heartbeat, since nodes send theirs in different cycles. Returns their number. count: drives, 1
 * ... AXIS_COUNT; group: drives to a frame of targets; has_errors: with that TPDO2.
 */
#define DRIVES_CYCLE_FRAMES_MAX (3 + AXIS_COUNT + (AXIS_COUNT + 1) / 2)
unsigned takt_drives_cycle_frames(unsigned count, unsigned group, bool has_errors,
                                  uint8_t length[DRIVES_CYCLE_FRAMES_MAX]);

/*
 * The PDOs of a bus as the start has found them: a frame of each drive's status, position and
 * target, of targets in groups one; of what I/O nodes hear and say; and of the drives' error codes,
 * of which one comes in a cycle. Returns their number.
 */
enum drives_pdo_kind {
    DRIVES_PDO_REPORT,
    DRIVES_PDO_TARGET,
    DRIVES_PDO_INPUTS,
    DRIVES_PDO_OUTPUTS,
    DRIVES_PDO_ERROR
};
struct drives_pdo {
    uint16_t id;
    uint8_t length; /* bytes at most */
    enum drives_pdo_kind kind;
};
#define DRIVES_CYCLE_PDOS_MAX (4 * AXIS_COUNT + 3 * IO_NODES_MAX)
unsigned takt_drives_get_pdos(const struct drives *d, unsigned bus,
                              struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX]);

/*
 * There are nodes on this bus that are asked for their state: of some cycles that takes a frame and
 * its answer.
 */
bool takt_drives_are_guarding(const struct drives *d, unsigned bus);

/* What a frame of this identifier tells in every cycle on its bus. */
enum drives_report {
    DRIVES_REPORTS_STATUS = 1,
    DRIVES_REPORTS_POSITION = 2,
    DRIVES_REPORTS_ALL = 3
};
unsigned takt_drives_get_report(const struct drives *d, unsigned bus, uint16_t id);

/* What a cycle takes of a bus, in bits of the nominal rate. */
struct drives_load {
    uint32_t bits;          /* of all frames of a cycle, each with worst-case stuffing */
    uint32_t capacity_bits; /* of a cycle */
    double percent;
};

/*
 * The same for the PDOs that the start has found: of the last start, complete once the drives are
 * enabled.
 */
void takt_drives_get_load(const struct drives *d, unsigned bus, struct drives_load *load);

/* True: the bus carries the cycle, with targets in groups. count: drives. */
bool takt_drives_predict_load(unsigned count, const struct drives_rates *rates, uint32_t cycle_us,
                              struct drives_load *load);

/*
 * Heartbeats of nodes in a cycle, rounded up. Each sends its own by its own clock: on the average
 * no more come, and where one does for all, they do not meet as a rule.
 */
uint32_t takt_drives_beats(uint32_t nodes, uint32_t heartbeat_ms, uint32_t cycle_us);

/*
 * What is on a bus: drives, and of all I/O nodes those that are on it, with as many inputs and
 * outputs as are wired.
 */
struct drives_traffic {
    unsigned count; /* drives on it */
    unsigned bus;
    uint32_t heartbeat_ms; /* 0: none */
    const struct io_wiring *wiring;
    unsigned io_count;
    struct drives_rates rates;
    bool no_error_pdo;
};

/* The same for that. */
bool takt_drives_predict_whole_load(const struct drives_traffic *traffic, uint32_t cycle_us,
                                    struct drives_load *load);

/* BUS_OVERLOAD, with the figures and the bus if it is not the first, in words for *fault. */
void takt_drives_set_overload(const struct drives_load *load, unsigned bus,
                              struct diagnostic *fault);

#endif

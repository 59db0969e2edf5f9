/*
 * Memory of the drives: only for sizeof. Nobody outside this room reads or writes a field.
 */
#include "drive/drives.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_DRIVE_DRIVES_STATE_H
#define TAKT_DRIVE_DRIVES_STATE_H

#include "canopen/node.h"
#include "canopen/pdo.h"
#include "canopen/sdo_client.h"
#include "drive/io_wiring.h"
#include "drive/rates.h"

/*
 * Setpoints remembered until the position they led to is reported; a power of two above
 * DRIVES_LATENCY_CYCLES.
 */
#define DRIVES_HISTORY 4

/* What happens in DRIVES_STARTING, in this order. */
enum drives_phase {
    DRIVES_BOOT,      /* nodes are reset; each says that it has booted */
    DRIVES_CONFIGURE, /* each is checked and configured over SDO */
    DRIVES_IO,        /* so are the I/O nodes; then they are started, and their inputs come */
    DRIVES_START,     /* nodes become operational, one a cycle: that staggers their event timers */
    DRIVES_ENABLE,    /* statuswords lead to "operation enabled" */
    /* each shows the mode it is to be in: homing, or that in which targets are followed */
    DRIVES_SELECT,
    DRIVES_HOME,   /* the axes of one order look for their home */
    DRIVES_FOLLOW, /* drives in interpolated position mode begin to follow */
    DRIVES_SQUARE  /* the second drive of a gantry comes to where the first one is */
};

/* What a drive is configured by, in this order; then the next drive. */
enum drives_part { DRIVES_ASK, DRIVES_DCF, DRIVES_SET, DRIVES_MAP, DRIVES_PARTS };

/* A frame to a drive, as one of its RPDOs takes it. */
#define DRIVES_NOWHERE 0xFF
struct drives_frame {
    uint16_t cob_id;
    uint8_t length;                /* 0: there is no such frame */
    uint8_t control, mode, target; /* byte it begins at; DRIVES_NOWHERE: it is not in the frame */
    bool is_mixed;                 /* there is more in it than a target */
    uint8_t data[CAN_DATA_MAX];    /* whatever else is in it, as the drive had it */
};

/* The PDO that is being configured. */
struct drives_mapping {
    uint8_t pass; /* which one, see drives_map.c */
    uint8_t step;
    uint8_t entry;     /* that is being told or read */
    bool is_taken : 1; /* the drive has taken everything so far */
    bool is_timed : 1; /* a TPDO: its event timer is a cycle at most */
    uint32_t id;       /* 1400:01 ff. as the drive has it */
    struct pdo pdo;    /* as it is told, then as the drive has it */
};

/* What is done with the frame of a target once it has been written. */
enum drives_sends {
    DRIVES_SENDS,      /* it is sent */
    DRIVES_WAITS,      /* the next drive's is in it, too */
    DRIVES_SENDS_MIXED /* there is more in it */
};

/* A node that is asked for its state, since it has no heartbeat. */
struct drives_guard {
    bool is_on;
    uint8_t toggle; /* NMT_TOGGLE as it came last */
};

struct drives_axis {
    struct drives_config_axis config;
    /* TPDO with statusword and position in the plain form, drives_receive.c; as status_id */
    uint16_t report_id;
    uint8_t sends; /* enum drives_sends */
    bool reset_pending;
    bool hold_pending;  /* it is to be pre-operational */
    bool booted;        /* its boot-up message has come */
    bool started;       /* NMT start has been sent */
    bool heard;         /* a TPDO1 has come since it was started */
    bool is_latched;    /* its touch probe has; where stands in struct drives.read */
    uint32_t reported;  /* cycle of the last TPDO1 */
    uint32_t heartbeat; /* and of the last heartbeat */
    uint16_t statusword;
    int32_t actual_inc;
    double actual_mm;   /* the same */
    uint16_t emcy_code; /* last emergency; 0: none, or all gone */

    uint8_t mode;         /* that the drive is to be in */
    uint16_t command;     /* controlword beside what the state asks for: CIA402_START_HOMING or 0 */
    uint16_t controlword; /* last sent */
    int32_t target_inc;   /* or velocity, where it follows that */
    double lag_mm;        /* following error of the last report before a fault */
    bool lost;            /* after a fault: its setpoints lead nowhere */
    bool homed;
    uint16_t attained_cycles; /* the statusword has shown that homing is done for so long */
    int32_t braking_inc;      /* where it was when its rest was looked at last, or squaring began */
    uint32_t rest_cycles;

    /* What the start has found. */
    struct drives_frame control_frame; /* with the controlword */
    struct drives_frame target_frame;  /* with the target */
    uint16_t status_id,
        position_id;   /* TPDOs with statusword and position; NODE_FUNCTION_MASK: none yet */
    uint16_t error_id; /* TPDO that begins with the error code; likewise */
    uint8_t status_end, position_end; /* byte behind them */
    bool beats_by_status;             /* it has no heartbeat: its status counts for one */
    struct drives_guard guard;
    uint8_t place;       /* among the drives of its bus, which makes the groups */
    bool is_paired;      /* its target shares a frame with those of its group */
    uint8_t follow_mode; /* in which it follows targets */
    uint8_t told_mode;   /* by SDO */
    uint16_t modes;      /* object 6502 */
    uint16_t bits;       /* of its frames in a cycle, at worst */
    uint32_t given_up;   /* bits: enum drives_given_up */
};

/* An I/O node, as the start has found it and as it is. */
struct drives_io {
    uint32_t reported;                        /* cycle of its last inputs */
    uint32_t heartbeat;                       /* and of its last heartbeat */
    uint16_t inverted, stop_bits, limit_bits; /* of its inputs */
    uint16_t levels;                          /* of its inputs, inverted ones as they are meant */
    uint16_t low_limits; /* limit inputs that were low when they were looked at last */
    uint16_t sent;       /* levels of its outputs on the wire */
    uint8_t input_bytes; /* of its TPDO1; 0: none of them is wired */
    uint8_t output_bytes;
    uint8_t analogues; /* analogue outputs of its RPDO2; 0: none is wired */
    bool reset_pending;
    bool booted;
    bool started;
    bool heard;   /* its inputs have come since it was started */
    bool by_sync; /* they come in every cycle */
    bool is_mute; /* it has no heartbeat */
    struct drives_guard guard;
};

/* Bits of struct drives.probing, beside those of drives_probe.c. */
#define DRIVES_PROBE_ARMS  1
#define DRIVES_PROBE_READS 2

struct drives {
    unsigned count;
    uint8_t node[AXIS_COUNT];
    uint32_t cycle_us;
    uint8_t controller_node;
    uint16_t heartbeat_ms;
    uint32_t heartbeat_cycles;         /* period */
    uint32_t heartbeat_age_max_cycles; /* without one from a drive */
    uint32_t boot_timeout_cycles;
    uint32_t start_timeout_cycles;
    uint32_t answer_timeout_cycles;
    uint32_t sdo_timeout_cycles;
    uint32_t stop_timeout_cycles;
    uint32_t brake_timeout_cycles;
    struct drives_axis axis[AXIS_COUNT];
    struct point actual; /* the actual_mm of all axes; 0 for axes without a drive */
    double sent_mm[DRIVES_HISTORY][AXIS_COUNT]; /* setpoints of cycle k at [k % DRIVES_HISTORY] */
    /* By bus and node: index into axis; AXIS_COUNT: not ours; above: I/O nodes. */
    uint8_t axis_of_node[CAN_BUSES_MAX][NODE_MAX + 1];
    uint8_t bus_count;             /* up to the last bus with a node; at least 1 */
    uint8_t on_bus[CAN_BUSES_MAX]; /* drives */
    uint8_t io_count;
    uint8_t gantry_count;
    struct drives_gantry gantry[DRIVES_GANTRIES_MAX];
    const struct io_wiring *wiring; /* of the I/O nodes */
    struct drives_io io[IO_NODES_MAX];
    uint32_t io_cycles; /* since all outputs were sent */

    enum drives_state state;
    uint32_t cycle;                      /* counts takt_drives_send; wraps */
    uint32_t beat_cycles[CAN_BUSES_MAX]; /* since our last heartbeat */

    enum drives_phase phase;
    uint32_t phase_cycles; /* spent in the phase */
    struct drives_rates rates;
    uint8_t group;      /* drives to a frame of targets */
    uint8_t frame_max;  /* bytes of the longest frame */
    uint8_t at_axis;    /* that is being configured or asked */
    uint8_t at_part;    /* of its configuration, enum drives_part */
    uint8_t at_step;    /* of that part */
    uint8_t repeats;    /* of the request under way */
    uint8_t restarts;   /* configurations begun again, since a drive had booted */
    uint8_t tells;      /* objects told by SDO in this phase */
    bool is_looking;    /* what could not be written is read */
    bool is_stale;      /* the request under way is of a configuration that has been begun again */
    bool no_error_pdo;  /* of drives, as it is wanted */
    bool is_telling;    /* a controlword or a mode is being written */
    bool homed;         /* no axis is left to be homed */
    bool steers;        /* some follow velocities */
    bool guards;        /* nodes that have been started are guarded */
    uint8_t probing;    /* bits, drives_probe.c */
    uint8_t progress;   /* steps of all drives to "operation enabled", at most so far */
    uint8_t home_order; /* axes of this order are being homed; 0: not yet */
    uint32_t read
        [AXIS_COUNT]; /* objects of the drive that is being configured: its period, or its scaling;
                             in operation what each drive has latched */
    struct drives_mapping mapping;
    struct {
        uint32_t at; /* place in its concise configuration */
        bool writes; /* it is written, since the drive had something else */
    } dcf;
    struct sdo_client sdo;
    uint8_t sdo_bus; /* of the node that is asked */

    struct diagnostic fault;
    unsigned fault_axis;  /* index into axis of what the fault is about */
    uint32_t stop_cycles; /* spent in DRIVES_STOPPING or DRIVES_BRAKING */
    uint32_t rest_cycles; /* setpoints have not changed for */
    double position_gain_per_s;
};

#endif

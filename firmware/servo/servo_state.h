/*
 * Memory of a drive: only for sizeof, and for the sources of this room.
 */
#include "servo/servo.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_SERVO_SERVO_STATE_H
#define TAKT_SERVO_SERVO_STATE_H

#define SERVO_EMCY_QUEUE 8
#define DRIVE_NO_ID      0xFFFF

/*
 * A PDO as it is worked with; made from the objects whenever they change. What every cycle looks at
 * comes first.
 */
struct drive_pdo {
    bool is_valid;
    uint16_t cob_id;
    uint8_t transmission;
    uint8_t count, length;
    uint8_t touches;      /* RPDO: enum of servo_private.h */
    uint8_t groups;       /* TPDO: what must be computed first */
    uint8_t events;       /* TPDO: whose change sends it */
    bool is_due;          /* TPDO: an event has happened */
    bool waits_for_start; /* TPDO: until SYNC's counter has its start value */
    uint8_t syncs;        /* TPDO: since it was sent */
    uint64_t event_ns;    /* TPDO: when its event timer runs out */
    uint64_t inhibit_ns;  /* TPDO: not sent before */
    uint8_t bytes[DRIVE_PDO_MAPPED_MAX];
    void *field[DRIVE_PDO_MAPPED_MAX];                  /* its value, where there is one */
    const struct object_row *row[DRIVE_PDO_MAPPED_MAX]; /* NULL: a dummy */
    struct can_frame held;
};

/* Profile position. */
struct drive_setpoints {
    bool is_acknowledged;
    bool has_next; /* one more target waits for the active one to be reached */
    int64_t next_inc;
    int64_t active_inc;
    uint64_t in_window_ns; /* how long the position has been within its window */
    bool is_reached;
};

/* Layer setting services. */
struct drive_lss {
    uint8_t node,
        /* from the next reset of the communication on, and of the node; LSS_NO_NODE: none */
        stored;
    bool is_nameless;                     /* it has no node id: it hears and says nothing else */
    bool configures;                      /* state "configuration" */
    uint8_t matched, identified, scanned; /* parts of the identity so far */
};

/* The touch probes, 1 and 2, of one input. */
#define DRIVE_TOUCH_PROBES 2
struct drive_touch_probe {
    bool touches;      /* the input, 60FD bit 16 */
    double begin_mm;   /* what the encoder said at the beginning of the cycle */
    uint32_t pulses;   /* index pulses before it */
    uint16_t function; /* 60B8 as it was seen last */
};

enum drive_homing_phase {
    HOMING_IDLE,
    HOMING_SEARCH, /* towards the switch */
    HOMING_PASS,   /* out of it again, so that its edge is found from outside */
    HOMING_PUSH,   /* towards a hard stop */
    HOMING_EDGE,   /* slowly to its edge */
    HOMING_INDEX,  /* slowly to the next index pulse */
    HOMING_STOP,   /* the home position is known */
    HOMING_FAILED
};

struct drive_homing {
    enum drive_homing_phase phase;
    int8_t method; /* of the homing under way */
    bool is_homed;
    /* direction under way, of the drive; the other one after the first end of the axis */
    int8_t search;
    bool was_active;         /* the switch, in the cycle before */
    uint64_t push_ns;        /* that the motor has stood with all the torque it takes */
    uint32_t pulses;         /* that have been seen */
    int32_t index_direction; /* in which the awaited index pulse is passed, by the encoder */
    double encoder_mm;       /* what the encoder says at the home position */
};

/* Requests that wait for their time; a master sends one after the other. */
#define SERVO_REQUESTS 4

struct drive_requests {
    unsigned count;
    uint64_t due_ns; /* of the first */
    struct can_frame frame[SERVO_REQUESTS];
};

/* Who keeps what object 1010 stores; false: it could not. */
struct drive_keeper {
    bool (*keep)(void *context, const struct servo *drive);
    void *context;
};

struct servo {
    uint8_t number; /* the node id it was made with, by which it is known however it is called */
    uint32_t accepts[CAN_FILTER_WORDS]; /* frames that are looked at */
    struct servo_config config;
    struct can_port port;
    struct drive_observer observer;
    struct servo_meddler meddler;
    struct compensation compensation; /* between the motor and the loops */
    struct servo_loop loop;
    struct drive_objects objects;

    enum nmt_state nmt;
    enum cia402_state state;
    uint16_t controlword; /* the one before, for edges */
    uint64_t now_ns;      /* since it was switched on */
    uint64_t due_ns;      /* nothing that waits for a time happens before, but for sync_lost_ns */
    uint64_t heard_ns; /* when the frame that is being taken was on the bus; 0: that is not known */
    uint64_t sync_ns;  /* the same of the last SYNC */
    uint32_t clock_us; /* object 1013 less now_ns */
    struct time_stamp time; /* as TIME has told it, */
    uint64_t time_ns;       /* then */
    uint64_t boot_ns;       /* it boots then, and hears nothing before; 0: it has booted */
    struct drive_requests requests;
    const struct dictionary *dictionary;

    /* For the position loop, from the objects. */
    double increments_per_mm;
    double velocity_sign, torque_sign; /* by the motor's direction and object 607E */
    double torque_ratio;               /* wanted in profile torque, of the rated one */
    double origin_mm;                  /* what the encoder says at position 0 */
    double following_window_mm;        /* 0: not watched */
    double quick_stop_mm_s2;
    uint64_t interpolation_ns; /* object 60C2 */
    uint64_t following_ns;     /* how long the following error has been outside its window */

    /* Motion of the command. */
    double velocity_mm_s;          /* profile position, homing, halt */
    struct course_average average; /* profile position with limited jerk */
    struct between between;        /* with object 60C0 = -1 */
    double goal_mm;                /* cyclic and interpolated position */
    uint32_t steps;                /* cycles until the goal is to be reached */
    bool is_leaving;               /* slows down, then takes the state leaving_to */
    bool is_halted;
    bool is_stopped;   /* quick stop has come to rest and stays */
    bool interpolates; /* mode 7, by controlword bit 4 */
    bool is_limited;   /* the target is beyond object 607D */
    enum cia402_state leaving_to;
    struct drive_setpoints setpoints;
    struct drive_homing homing;
    struct drive_touch_probe probe;

    /* Of the PDOs below: what every frame and every SYNC asks. */
    uint16_t rpdo_id[DRIVE_PDO_COUNT]; /* DRIVE_NO_ID: it is not valid */
    uint8_t held;                      /* bit of an RPDO: its frame waits for SYNC */
    uint8_t synchronous;               /* bit of a TPDO: SYNC may send it */
    uint8_t remote;                    /* bit of a TPDO: a remote frame may ask for it */
    struct drive_pdo rpdo[DRIVE_PDO_COUNT], tpdo[DRIVE_PDO_COUNT];
    uint8_t watched;          /* objects whose change is an event: groups */
    uint16_t seen_statusword; /* for that */
    uint16_t seen_error_code;
    int8_t seen_mode;
    uint32_t seen_inputs;
    uint32_t seen_io; /* of an I/O node: its inputs, and above them its NMT state */

    /* Times at which something happens; UINT64_MAX: never. */
    uint64_t heartbeat_ns;
    uint64_t
        consumer_ns[DRIVE_CONSUMERS]; /* by then the next must have come; never before the first */
    uint64_t guard_lost_ns;           /* the same of a guarding master */
    uint64_t sync_lost_ns;
    uint64_t emcy_ns; /* the next emergency may be sent */

    uint8_t guard_toggle;         /* of the next answer to it */
    uint16_t communication_error; /* 8130, 8700: under way; 0: none */
    unsigned emcy_count;
    struct emcy emcy[SERVO_EMCY_QUEUE]; /* that wait for the inhibit time */

    struct sdo_server sdo;
    const char *eds;
    size_t eds_length;
    struct drive_lss lss;

    /*
     * What a reset brings back, of power-on or stored by object 1010; process values do not count.
     */
    struct drive_objects stored, initial;
    struct drive_keeper keeper;
};

#endif

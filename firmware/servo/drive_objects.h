/*
 * The values of a drive's object dictionary, as its own memory holds them. object_table.c says
 * which object is which field.
 *
 * Positions are in increments, velocities in increments/s, accelerations in increments/s2; what an
 * increment is, objects 6091 and 6092 say.
 */
#ifndef TAKT_SERVO_DRIVE_OBJECTS_H
#define TAKT_SERVO_DRIVE_OBJECTS_H

#include <stdint.h>

#define DRIVE_PDO_COUNT      4 /* RPDOs, and as many TPDOs */
#define DRIVE_PDO_MAPPED_MAX 8
#define DRIVE_HISTORY_MAX    8    /* object 1003 */
#define DRIVE_CONSUMERS      2    /* object 1016 */
#define DRIVE_LABEL_SIZE     32   /* object 2000, with its zero */
#define DRIVE_NOTES_SIZE     1024 /* object 2001 */
#define DRIVE_PITCH_POINTS   64   /* object 2011 */
/* Bytes of objects that only a data sheet has. */
#ifndef DRIVE_EXTRA_SIZE
#define DRIVE_EXTRA_SIZE 32768
#endif

struct drive_pdo_parameters {
    uint32_t cob_id; /* bit 31: not valid */
    uint8_t transmission;
    uint16_t inhibit_100us; /* TPDO */
    uint16_t event_ms;      /* TPDO */
    uint8_t sync_start;     /* TPDO: counter of the SYNC it begins with; 0: any */
};

struct drive_pdo_mapping {
    uint8_t count;
    uint32_t entry[DRIVE_PDO_MAPPED_MAX];
};

/* Objects 1000 to 1FFF that can be set; NMT's reset of the communication restores them. */
struct drive_communication {
    uint32_t sync_cob_id;                         /* 1005 */
    uint32_t sync_period_us;                      /* 1006 */
    uint32_t sync_window_us;                      /* 1007: targets that come later are none */
    uint32_t time_cob_id;                         /* 1012; bit 31: it is listened to */
    uint32_t emcy_cob_id;                         /* 1014 */
    uint16_t emcy_inhibit_100us;                  /* 1015 */
    uint16_t guard_ms;                            /* 100C */
    uint8_t life_factor;                          /* 100D: guard times; 0: it is not watched */
    uint32_t consumer_heartbeat[DRIVE_CONSUMERS]; /* 1016: node << 16 | ms */
    uint16_t producer_heartbeat_ms;               /* 1017 */
    uint8_t sync_overflow;                        /* 1019 */
    uint8_t error_behaviour;                      /* 1029:1 */
    struct drive_pdo_parameters rpdo[DRIVE_PDO_COUNT], tpdo[DRIVE_PDO_COUNT];
    struct drive_pdo_mapping rpdo_mapping[DRIVE_PDO_COUNT], tpdo_mapping[DRIVE_PDO_COUNT];
};

/* Objects 2000 to 6FFF that can be set; NMT's reset of the node restores them too. */
struct drive_settings {
    char label[DRIVE_LABEL_SIZE];         /* 2000 */
    uint32_t following_window;            /* 6065; FFFFFFFF: not watched */
    uint32_t position_window;             /* 6067; FFFFFFFF: always reached */
    int32_t home_offset;                  /* 607C */
    int32_t position_limit[2];            /* 607D */
    uint32_t max_profile_velocity;        /* 607F */
    uint32_t max_motor_speed_rpm;         /* 6080 */
    uint32_t profile_velocity;            /* 6081 */
    uint32_t end_velocity;                /* 6082: at a target behind which another one waits */
    uint32_t profile_acceleration;        /* 6083 */
    uint32_t profile_deceleration;        /* 6084 */
    uint32_t quick_stop_deceleration;     /* 6085 */
    uint32_t profile_jerk;                /* 60A4:1 */
    uint32_t torque_slope;                /* 6087: 0.1 % of the rated torque in a second */
    uint32_t max_acceleration;            /* 60C5 */
    uint32_t max_deceleration;            /* 60C6 */
    uint32_t gear_motor, gear_shaft;      /* 6091: turns of the motor, for turns of the shaft */
    uint32_t feed_increments, feed_shaft; /* 6092: increments in this many turns of the shaft */
    uint32_t homing_velocity[2];          /* 6099: towards the switch, away from it */
    uint32_t homing_acceleration;         /* 609A */
    uint32_t output_mask;                 /* 60FE:2 */
    uint16_t following_timeout_ms;        /* 6066 */
    uint16_t position_window_ms;          /* 6068 */
    int16_t abort_connection_option;      /* 6007 */
    int16_t quick_stop_option;            /* 605A */
    int16_t shutdown_option;              /* 605B */
    int16_t disable_option;               /* 605C */
    int16_t halt_option;                  /* 605D */
    int16_t fault_reaction_option;        /* 605E */
    int16_t motion_profile_type;          /* 6086 */
    int16_t torque_profile_type;          /* 6088 */
    uint16_t max_torque;                  /* 6072: 0.1 % of the rated torque */
    uint16_t velocity_window;             /* 606D */
    uint16_t velocity_window_ms;          /* 606E */
    uint16_t velocity_threshold;          /* 606F: slower than this it stands */
    uint8_t polarity;                     /* 607E: bit 7 position, 6 velocity, 5 torque */
    int16_t interpolation_submode;        /* 60C0 */
    uint8_t interpolation_period;         /* 60C2:1 */
    int8_t interpolation_index;           /* 60C2:2: the period is this power of ten of seconds */
    int8_t homing_method;                 /* 6098 */
    /* 2003: 0.1 % of the rated one; a motor that stands with it is at a hard stop */
    uint16_t homing_torque;
    uint8_t buffer_organisation;    /* 60C4:3 */
    uint16_t buffer_position;       /* 60C4:4 */
    uint8_t pitch_points;           /* 2010:1; 0: no error of pitch is taken back */
    int32_t pitch_first;            /* 2010:2: position of the first of them */
    uint32_t pitch_distance;        /* 2010:3: from each to the next */
    uint32_t backlash_nm;           /* 2010:4; of a rotary axis urad */
    uint32_t told_inertia;          /* 2020:1: g mm2, at the motor's shaft */
    uint32_t velocity_bandwidth;    /* 2020:2: mHz */
    uint32_t velocity_integral;     /* 2020:3: us */
    uint32_t position_gain;         /* 2020:4: thousandths of 1/s */
    uint16_t velocity_feed_forward; /* 2020:5: thousandths */
    uint16_t torque_feed_forward;   /* 2020:6: the same */
    int32_t pitch_nm
        [DRIVE_PITCH_POINTS]; /* 2011: what the axis is farther than its motor says; the same */
};

/* What changes by itself or from cycle to cycle; not stored. */
struct drive_process {
    uint16_t controlword;         /* 6040 */
    uint16_t statusword;          /* 6041 */
    int32_t target_position;      /* 607A */
    int32_t target_velocity;      /* 60FF */
    int32_t demand_velocity;      /* 606B */
    int16_t target_torque;        /* 6071 */
    int16_t demand_torque;        /* 6074 */
    int32_t actual_position;      /* 6064 */
    uint16_t error_code;          /* 603F */
    int8_t mode;                  /* 6060 */
    int8_t mode_display;          /* 6061 */
    int32_t following_error;      /* 60F4 */
    int32_t demand_position;      /* 6062 */
    int32_t actual_internal;      /* 6063: counts of the encoder */
    int32_t actual_velocity;      /* 606C */
    int16_t actual_torque;        /* 6077: 0.1 % of the rated torque */
    int16_t torque_offset;        /* 60B2 */
    int32_t position_offset;      /* 60B0 */
    int32_t velocity_offset;      /* 60B1 */
    int32_t interpolation_target; /* 60C1:1 */
    uint32_t digital_inputs;      /* 60FD */
    uint32_t digital_outputs;     /* 60FE:1 */
    uint16_t probe_function;      /* 60B8 */
    uint16_t probe_status;        /* 60B9 */
    int32_t probe_latched[4];     /* 60BA ... 60BD: touch probe 1, rising and falling, then 2 */
    uint8_t error_register;       /* 1001 */
    uint32_t manufacturer_status; /* 1002 */
    uint32_t high_resolution_us;  /* 1013 */
    uint32_t time_ms;             /* 2002:1 */
    uint16_t time_days;           /* 2002:2 */
    uint8_t history_count;        /* 1003:0 */
    uint32_t history[DRIVE_HISTORY_MAX]; /* 1003, the newest first */
    uint32_t store, restore;             /* 1010:1, 1011:1: read as 1, "can be done by command" */
    uint8_t buffer_clear;                /* 60C4:6 */
    uint32_t buffer_size;                /* 60C4:2 */
    uint16_t notes_length;               /* of 2001 */
    char notes[DRIVE_NOTES_SIZE];        /* 2001 */
};

/* What the drive is and never changes. */
struct drive_identity {
    uint32_t sdo_cob_id[2];  /* 1200 */
    uint32_t serial;         /* 1018:4 */
    uint32_t encoder_counts; /* 608F:1 */
};

struct drive_objects {
    struct drive_process process;
    struct drive_communication communication;
    struct drive_settings settings;
    struct drive_identity identity;
    uint8_t extra[DRIVE_EXTRA_SIZE];
};

#endif

/*
 * Inside the service: public only so that the caller can own the memory. Read service.h instead.
 */
#include "service/service.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_SERVICE_SERVICE_STATE_H
#define TAKT_SERVICE_SERVICE_STATE_H

#include "controller/controller.h"
#include "drive/drives.h"
#include "panel/snapshot.h"

/* Longest program the service writes itself: MDI lines, jogs, homing. */
#define SERVICE_TEXT_MAX PANEL_MDI_MAX

/*
 * What the panel sets and reads back, one line each: SETTING(register, field, type, at first), in
 * counts of the register. Orders and snapshots go by this table (orders.c, look.c).
 */
#define SERVICE_SETTINGS(SETTING)                                                                  \
    SETTING(FEED_OVERRIDE, feed_override, uint16_t, 1000)                                          \
    SETTING(RAPID_OVERRIDE, rapid_override, uint16_t, 1000)                                        \
    SETTING(SPINDLE_OVERRIDE, spindle_override, uint16_t, 1000)                                    \
    SETTING(MODE, mode, enum panel_mode, PANEL_MODE_PROGRAM)                                       \
    SETTING(JOG_AXIS, jog_axis, enum axis, AXIS_X)                                                 \
    SETTING(JOG_FEED, jog_feed_mm_min, uint16_t, 1000)                                             \
    SETTING(JOG_DISTANCE, jog_distance, int32_t, 0)                                                \
    SETTING(WORK_SYSTEM, work_system, unsigned, 1)                                                 \
    SETTING(TOOL_SELECT, tool_select, uint32_t, 0)                                                 \
    SETTING(WATCHDOG, watchdog_ms, uint32_t, 0)                                                    \
    SETTING(START_LINE, start_line, uint32_t, 0)

/* The same of coils. */
#define SERVICE_SWITCHES(SWITCH)                                                                   \
    SWITCH(SINGLE_BLOCK, single_block, bool, false)                                                \
    SWITCH(OPTIONAL_STOP, optional_stop, bool, false)                                              \
    SWITCH(BLOCK_DELETE, block_delete, bool, false)                                                \
    SWITCH(SPINDLE_STOP, spindle_stop, bool, false)

#define SERVICE_FIELD(id, field, type, initial) type field;

struct service_settings {
    SERVICE_SETTINGS(SERVICE_FIELD)
    SERVICE_SWITCHES(SERVICE_FIELD)
    unsigned corrections;                   /* bit i: layer i of the position correction is on */
    int32_t rise[AXIS_COUNT];               /* 0.001 K, of each axis since calibration */
    int32_t setup[CORRECTION_SETUP_VALUES]; /* of the part, to be taken: 0.0001 mm or degrees */
    unsigned setup_given;                   /* bit i: number i has been written since */
};

struct service {
    struct service_config config;
    struct tool_table tools;
    struct controller controller;
    struct service_settings settings;

    enum service_job job;
    enum panel_hold hold; /* why the feed is held; PANEL_HOLD_NONE: it is not */
    bool finds_home;      /* the drives look for their homes; then comes the way to zero */
    bool giving_up;       /* what runs is dropped as soon as it is at rest */
    bool takes_back;      /* the background takes back what has not been reached */
    uint32_t held_block;  /* at whose end a single block has been held; 0: none yet */
    bool resets_spindle;  /* its drive is to be reset */
    /* the background is at work: a cycle that interrupts it drops nothing it works on */
    volatile bool is_planning;
    bool has_starved;      /* the program that runs has had to wait for its text */
    bool emergency;        /* the button is in */
    bool jog_is_negative;  /* of a jog */
    bool jog_is_endless;   /* it ends when its coil is cleared */
    unsigned rest_cycles;  /* cycles in which no axis has been moved */
    bool tells_speed;      /* the spindle's drive has once said that it is at speed */
    bool has_stood;        /* the spindle has been stopped or lost in this hold */
    uint32_t stood_cycle;  /* the last one in which it was stopped */
    uint32_t quiet_cycles; /* since the panel in control was heard */

    enum panel_alarm alarm; /* latched until acknowledged */
    struct diagnostic alarm_text;
    bool failed; /* the controller is faulted: RESET leads on */

    struct point at;                          /* last setpoint, without correction */
    struct point sent[DRIVES_LATENCY_CYCLES]; /* setpoints of the last cycles, newest first */
    uint64_t digest;                          /* of the setpoints of this program */
    double limiter;                           /* of the last program cycle */
    struct inputs inputs;                     /* of the last cycle */
    struct service_health health;

    enum panel_outcome outcome; /* of the last program or line */
    enum panel_outcome ended;   /* of whatever has run last */
    uint16_t runs;
    uint32_t cycles;
    uint32_t program_size, program_crc; /* size 0: none */
    uint32_t cut_line; /* where the last program was cut short; 0: it came to its end */

    char text[SERVICE_TEXT_MAX]; /* of a program the service has written */
    size_t text_length;
    struct program_modes modes; /* that the last line has left */
    bool has_modes;             /* and the next one goes on with */
    struct source_text source_text;

    struct source lines;  /* of a console, while they run */
    bool streams;         /* they do */
    bool streams_to_end;  /* they come to an end, since nothing more comes */
    bool has_line;        /* one has been handed out, and the next not been asked for */
    uint32_t asked_cycle; /* since when the next line has been waited for */
    uint32_t begun_cycle;
};

#endif

/*
 * What a control cycle is told of the world: passed to takt_controller_cycle, never asked for. So a
 * run is repeated exactly by giving it the same inputs.
 */
#ifndef TAKT_HAL_INPUTS_H
#define TAKT_HAL_INPUTS_H

#include <stdbool.h>
#include <stdint.h>

/* Inputs that M66 can read: digital P0 ... 31, analogue E0 ... 3. */
#define INPUTS_DIGITAL_MAX  32
#define INPUTS_ANALOGUE_MAX 4

/* The spindle as measured at the start of the cycle. Positive: clockwise (M3). */
struct spindle_feedback {
    double angle_rev;    /* revolutions since power-on; falls when it turns counter-clockwise */
    double speed_rpm;    /* signed */
    double load_percent; /* of rated torque, >= 0 */
    bool at_speed;       /* within the drive's tolerance of the commanded speed */
    bool tripped;        /* the drive has switched off */
    bool silent;         /* the drive no longer answers: the other values are old */
};

struct inputs {
    double feed_override_percent;  /* %F, 0 ... 120 */
    double rapid_override_percent; /* 0 ... 100 */
    bool single_block;  /* every motion that can still be brought to rest at its end is */
    bool feed_hold;     /* come to rest on the path and stay, where the program lets it (M53) */
    bool feed_stop;     /* likewise, whatever the program says */
    bool program_stop;  /* nothing behind M0 is done in the cycle that passes it */
    bool optional_stop; /* nor behind M1 */
    bool probe_contact;
    uint32_t digital; /* bit i: input i */
    double analogue[INPUTS_ANALOGUE_MAX];
    struct spindle_feedback spindle;
};

/* An operator who touches nothing, and a spindle at rest. */
static inline struct inputs inputs_idle(void)
{
    return (struct inputs){.feed_override_percent = 100.0, .rapid_override_percent = 100.0};
}

#endif

/*
 * The virtual spindle: a motor behind a frequency converter, with inertia, friction, a limited
 * torque, an encoder, and the torque that cutting takes.
 *
 *     commanded speed -> ramp -> speed loop -> limited torque -> motor -> speed, angle -> encoder
 *                                                 ^ friction, cutting torque
 *
 * The same inputs give the same feedback, bit for bit.
 */
#ifndef TAKT_SPINDLE_VIRTUAL_SPINDLE_H
#define TAKT_SPINDLE_VIRTUAL_SPINDLE_H

#include "hal/inputs.h"

#include <stdbool.h>
#include <stdint.h>

struct virtual_spindle_config {
    double max_rpm;               /* the converter goes no faster; > 0 */
    double ramp_rpm_s;            /* of the commanded speed, up and down; > 0 */
    double inertia_kg_m2;         /* rotor, tool and what turns with them; > 0 */
    double friction_nm_s_per_rad; /* torque per angular velocity; >= 0 */
    double rated_torque_nm;       /* load is told in percent of it; > 0 */
    double torque_limit_percent;  /* the most the converter gives; 1 ... 1000 */
    double overload_percent;      /* trips above this load ... */
    double overload_s;            /* ... for this long; 0: at once */
    double at_speed_percent;      /* of the commanded speed: closer than this is at speed; > 0 */
    uint32_t encoder_counts_per_revolution; /* 0: no quantisation */
    double encoder_noise_counts;            /* the encoder is off by up to so much; >= 0 */
    double ripple_percent;        /* torque swings by this part of the rated torque; >= 0 */
    double ripple_per_revolution; /* so often; >= 0 */

    /* The cut: what milling takes off. Depth 0: the spindle turns in air. */
    double cut_width_mm; /* radial engagement; >= 0 */
    double cut_depth_mm; /* axial engagement, where no stock says it; >= 0 */
    /* specific cutting force of the material: steel 2000, aluminium 700; >= 0 */
    double cutting_force_n_per_mm2;
};

/* What made it switch off: the numbers a Delta VFD-B shows in register 2100. */
enum virtual_spindle_trip {
    VIRTUAL_SPINDLE_GOOD = 0,
    VIRTUAL_SPINDLE_OVERCURRENT = 1,
    VIRTUAL_SPINDLE_OVERHEAT = 3,
    VIRTUAL_SPINDLE_OVERLOAD = 5,
    VIRTUAL_SPINDLE_EXTERNAL = 8
};

struct virtual_spindle {
    struct virtual_spindle_config config;
    double ramp_rpm;    /* speed the ramp has reached */
    double integral_nm; /* of the speed loop */
    double speed_rad_s; /* of the motor */
    double angle_rev;   /* of the motor, since power-on */
    double torque_nm;   /* the motor gives now */
    double overload_s;  /* so long overloaded */
    uint64_t noise;     /* the encoder's, of the last reading */
    bool locked;        /* the rotor cannot turn */
    enum virtual_spindle_trip trip;
};

/* 2.2 kW at 24,000 rpm; see the README for the numbers. No cut. */
void virtual_spindle_set_default(struct virtual_spindle_config *config);

/* NULL: every field is in its range; else the name of the first that is not. */
const char *virtual_spindle_check(const struct virtual_spindle_config *config);

/* config has passed virtual_spindle_check. It stands still at angle 0. */
void virtual_spindle_init(struct virtual_spindle *s, const struct virtual_spindle_config *config);

/*
 * Torque that cutting takes at a feed along the path and a depth, N m, >= 0; 0 when the spindle
 * stands.
 */
double virtual_spindle_cut_nm(const struct virtual_spindle *s, double feed_mm_s, double depth_mm);

/*
 * The next dt_s seconds: dt_s > 0, a control cycle. commanded_rpm: signed, positive clockwise; 0:
 * stop. load_nm: torque against the motion, >= 0. Returns what the converter and the encoder report
 * at the end of them.
 */
struct spindle_feedback virtual_spindle_step(struct virtual_spindle *s, double dt_s,
                                             double commanded_rpm, double load_nm);

/*
 * A fault: the output is switched off, the rotor runs out. VIRTUAL_SPINDLE_GOOD acknowledges one.
 */
void virtual_spindle_set_trip(struct virtual_spindle *s, enum virtual_spindle_trip trip);

#endif

/*
 * The verifier of a run: looks at every setpoint that was sent and says whether the machine's
 * limits and the program's path were kept.
 *
 * It knows nothing of the planner's reasoning. It reads the part program again, in step with the
 * run, and compares setpoints with the curves it finds there: motions in exact path by the numbers
 * of the cycles, which must be right then; motions within a tolerance, and the length of the path,
 * by a place of its own (tube_verifier.h). Velocity, acceleration and jerk it takes by differences:
 *
 *     v_k = (x_k - x_{k-1}) / tau     a_k = (v_k - v_{k-1}) / tau     j_k = (a_k - a_{k-1}) / tau
 *
 * Before the first cycle every axis stands still. In lengths over several axes a
 * radian of a rotary axis counts as a millimetre.
 */
#ifndef TAKT_HOST_VERIFIER_H
#define TAKT_HOST_VERIFIER_H

#include "cutter_compensation/cutter_compensation.h"
#include "drive/drives.h"
#include "machine/machine.h"
#include "motion/cycle_record.h"
#include "plan/block.h"
#include "program/program.h"
#include "verifier/tube_verifier.h"
#include "vibration/vibration.h"

#include <stdbool.h>
#include <stdint.h>

/*
 * Limits are kept when the value is at most the limit times this: room for the rounding of
 * differences.
 */
#define VERIFIER_VELOCITY_RATIO     1.0001
#define VERIFIER_ACCELERATION_RATIO 1.0001
#define VERIFIER_JERK_RATIO         1.001

#define VERIFIER_LANDING_MAX_MM 1e-9
#define VERIFIER_PATH_MAX_MM    1e-6 /* beside the chord error */

/* What the verifier found. For a rotary axis read rad for mm. */
struct verifier_figures {
    uint64_t cycles;
    uint32_t blocks; /* motions begun */
    double path_length_mm;
    double velocity_mm_s[AXIS_COUNT]; /* largest, by magnitude, of the setpoints sent */
    double acceleration_mm_s2[AXIS_COUNT];
    double jerk_mm_s3[AXIS_COUNT];
    double following_error_mm[AXIS_COUNT];
    double path_error_mm;
    double chord_error_mm;
    double landing_error_mm;
    double junction_feed_step_mm_s;
    double smoothed_path_part; /* of motions within a tolerance: as a part of it */
    double smoothed_corner_part;
    double correction_mm; /* largest distance of X, Y, Z before and after correction */
    uint64_t digest;
};

/* The motion the verifier finds the run in. */
struct verifier_block {
    uint32_t number; /* from 1; 0: before the first */
    bool has_length;
    struct curve curve; /* when it has length */
    struct point end;
    double fraction; /* of the block, where the last setpoint was */
    bool probing;    /* it may end early: verifier_answer */
    /* into a hole the axes turn round with the spindle, so far above its end at most; 0: no hole */
    double turning_mm;
    bool
        rounded; /* a tolerance is programmed: the tube verifies it, whether it is a curve or not */
    bool landed; /* a cycle has ended it exactly */
    bool ending; /* its last piece is being executed */
    bool passed; /* then: it is to be left without a cycle at its end */
    double passed_mm; /* then: distance of the end of its evaluated path from its end */
};

/* One axis through time. */
struct verifier_axis {
    enum axis axis;
    double x, v, a; /* of the last cycle */
};

#define VERIFIER_HISTORY (DRIVES_LATENCY_CYCLES + 1)

struct verifier {
    struct program program; /* the verifier's own reading */
    struct cutter_compensation offset;
    struct tube_verifier tube;  /* with another one */
    bool rounds;                /* exact motions too are verified by the tube alone */
    struct vibration vibration; /* from setpoints to what the tube verifies; none: setpoints */
    /* the run executes motions that the program does not have, or not one after the other */
    bool strayed;
    bool program_ended;
    uint32_t read;         /* motions */
    struct point read_end; /* where the last one ends */
    struct verifier_block block;
    uint32_t told;  /* number of the last cycle's motion; less behind a probe of no length */
    double rate_hz; /* 1 / cycle time */
    unsigned axes;
    struct verifier_axis axis[AXIS_COUNT];
    struct point sent
        [VERIFIER_HISTORY]; /* setpoints of the last cycles, newest at cycles % VERIFIER_HISTORY */
    struct point cmd;       /* of the last cycle */
    bool step_inside;       /* from that cycle on one curve has been followed */
    double feed_mm_s;       /* of the last cycle, as distance between setpoints */
    unsigned junction_near; /* cycles from here on that a junction may show in */
    struct verifier_figures figures;
};

/*
 * program: as the run has it, but with parameters of the verifier's own; source: over the same
 * text. Both may go when the verifier has gone.
 */
void verifier_init(struct verifier *j, const struct machine *machine,
                   const struct program_config *program, const struct source *source);
/*
 * Behind it: the same once more for another reading. rounds: exact motions too may be rounded, as
 * the machine may round.
 */
void verifier_follow(struct verifier *j, const struct machine *machine,
                     const struct program_config *program, const struct source *source,
                     bool rounds);
/*
 * And then: the program has been planned ahead on a machine with these modes, so that the path is
 * not the setpoints' but the tool's, as the modes have it where the drives are at the setpoints.
 */
void verifier_follow_tool(struct verifier *j, const struct vibration_config *modes);
void verifier_free(struct verifier *j);

/* The next cycle, and the block that it executed. False: out of memory. */
bool verifier_add(struct verifier *j, const struct cycle_record *record, const struct block *block);

/*
 * What the program of the run has been told (G38, M66), before the first cycle behind that.
 * Everything read until then has been executed, but for the rest of a probing move.
 */
void verifier_answer(struct verifier *j, const struct program_answer *answer);

/* After the last cycle. completed: the program claims to have been executed to its end. */
void verifier_finish(struct verifier *j, bool completed);

/*
 * Motions with a length that the program has beyond those executed, or -1: it has fewer. 0 after a
 * complete run.
 */
int verifier_get_missing(const struct verifier *j);

#endif

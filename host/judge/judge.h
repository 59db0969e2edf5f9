/*
 * The judge of a run: looks at every setpoint that was sent and says whether the machine's limits and the program's
 * path were kept.
 *
 * It knows nothing of the planner's reasoning. It reads the part program again, in step with the run, and compares
 * setpoints with the curves it finds there: motions in exact path by the numbers of the cycles, which must be right then;
 * motions within a tolerance, and the length of the path, by a place of its own (tube_judge.h). Velocity, acceleration and
 * jerk it takes by differences:
 *
 *     v_k = (x_k - x_{k-1}) / tau     a_k = (v_k - v_{k-1}) / tau     j_k = (a_k - a_{k-1}) / tau
 *
 * Before the first cycle every axis stands still. In lengths over several axes a
 * radian of a rotary axis counts as a millimetre.
 */
#ifndef TAKT_HOST_JUDGE_H
#define TAKT_HOST_JUDGE_H

#include "drive/drives.h"
#include "judge/tube_judge.h"
#include "machine/machine.h"
#include "motion/cycle_record.h"
#include "offset/offset.h"
#include "plan/block.h"
#include "program/program.h"
#include "vibration/vibration.h"

#include <stdbool.h>
#include <stdint.h>

/* Limits are kept when the value is at most the limit times this: room for the rounding of differences. */
#define JUDGE_VELOCITY_RATIO     1.0001
#define JUDGE_ACCELERATION_RATIO 1.0001
#define JUDGE_JERK_RATIO         1.001

#define JUDGE_LANDING_MAX_MM 1e-9
#define JUDGE_PATH_MAX_MM    1e-6 /* beside the chord error */

/* What the judge found. For a rotary axis read rad for mm. */
struct judge_figures {
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
    double joint_feed_step_mm_s;
    double smoothed_path_part; /* of motions within a tolerance: as a part of it */
    double smoothed_corner_part;
    double correction_mm; /* largest distance between setpoint before and after correction */
    uint64_t digest;
};

/* The motion the judge finds the run in. */
struct judge_block {
    uint32_t number; /* from 1; 0: before the first */
    bool has_length;
    struct curve curve; /* when it has length */
    struct point end;
    double fraction; /* of the block, where the last setpoint was */
    bool probing;    /* it may end early: judge_answer */
    double
        turning_mm; /* into a hole the axes turn round with the spindle, so far above its end at most; 0: no hole */
    bool rounded; /* a tolerance is programmed: the tube judges it, whether it is a curve or not */
    bool landed;  /* a cycle has ended it exactly */
    bool ending;  /* its last piece is being executed */
    bool passed;  /* then: it is to be left without a cycle at its end */
    double passed_mm; /* then: distance of the end of its evaluated path from its end */
};

/* One axis through time. */
struct judge_axis {
    enum axis axis;
    double x, v, a; /* of the last cycle */
};

#define JUDGE_HISTORY (DRIVES_LATENCY_CYCLES + 1)

struct judge {
    struct program program; /* the judge's own reading */
    struct offset offset;
    struct tube_judge tube;     /* with another one */
    bool rounds;                /* exact motions too are judged by the tube alone */
    struct vibration vibration; /* from setpoints to what the tube judges; none: setpoints */
    bool
        strayed; /* the run executes motions that the program does not have, or not one after the other */
    bool program_ended;
    uint32_t read;         /* motions */
    struct point read_end; /* where the last one ends */
    struct judge_block block;
    double rate_hz; /* 1 / cycle time */
    unsigned axes;
    struct judge_axis axis[AXIS_COUNT];
    struct point
        sent[JUDGE_HISTORY]; /* setpoints of the last cycles, newest at cycles % JUDGE_HISTORY */
    struct point cmd;        /* of the last cycle */
    bool step_inside;        /* from that cycle on one curve has been followed */
    double feed_mm_s;        /* of the last cycle, as distance between setpoints */
    unsigned joint_near;     /* cycles from here on that a joint may show in */
    struct judge_figures figures;
};

/*
 * program: as the run has it, but with parameters of the judge's own; source: over the same text. Both may go when
 * the judge has gone.
 */
void judge_init(struct judge *j, const struct machine *machine,
                const struct program_config *program, const struct source *source);
/* Behind it: the same once more for another reading. rounds: exact motions too may be rounded, as the machine may round. */
void judge_follow(struct judge *j, const struct machine *machine,
                  const struct program_config *program, const struct source *source, bool rounds);
/*
 * And then: the program has been planned ahead on a machine with these modes, so that the path is not the setpoints' but the
 * tool's, as the modes have it where the drives are at the setpoints.
 */
void judge_follow_tool(struct judge *j, const struct vibration_config *modes);
void judge_free(struct judge *j);

/* The next cycle, and the block that it executed. False: out of memory. */
bool judge_add(struct judge *j, const struct cycle_record *record, const struct block *block);

/*
 * What the program of the run has been told (G38, M66), before the first cycle behind that. Everything read until then
 * has been executed, but for the rest of a probing move.
 */
void judge_answer(struct judge *j, const struct program_answer *answer);

/* After the last cycle. completed: the program claims to have been executed to its end. */
void judge_finish(struct judge *j, bool completed);

/* Motions with a length that the program has beyond those executed, or -1: it has fewer. 0 after a complete run. */
int judge_get_missing(const struct judge *j);

#endif

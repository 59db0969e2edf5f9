/*
 * Path, motion, lock and the virtual spindle together, without drives: for tests of threads. What
 * is thought to happen on a machine is verified here: the axes are at a setpoint BENCH_AHEAD cycles
 * after its cycle.
 */
#ifndef TAKT_TESTS_THREAD_BENCH_H
#define TAKT_TESTS_THREAD_BENCH_H

#include "base/maths.h"
#include "motion/handover.h"
#include "plan/path.h"
#include "spindle/virtual_spindle.h"
#include "sync/spindle_sync.h"

#define BENCH_AHEAD     2
#define BENCH_MOVES_MAX 64
#define BENCH_AXES      3

struct bench_verifier {
    double history[BENCH_AXES][4];       /* newest first */
    double velocity, acceleration, jerk; /* largest ratio to the limit so far */
};

struct bench {
    struct plan_limits limits;
    struct path path;
    struct motion motion;
    struct spindle_sync sync;
    struct spindle_sync_config spindle_sync_config;
    struct virtual_spindle_config spindle_config;
    struct virtual_spindle spindle;
    struct motion_operator operator;
    struct move move[BENCH_MOVES_MAX];
    unsigned moves, pushed;
    uint32_t look_ahead;
    double command_rpm;
    struct spindle_feedback feedback;
    struct cycle_record record;
    struct point point; /* of the last cycle with a record */
    enum motion_result result;
    enum spindle_sync_result locked;
    bool is_locked; /* the last cycle was */
    bool is_silent; /* the spindle's drive does not answer */
    double true_rev[BENCH_AHEAD +
                    1]; /* angles of this cycle and those after the setpoints still on their way */
    double sent_mm[BENCH_AHEAD + 1]; /* positions on the line, likewise */
    struct bench_verifier verifier;
    uint64_t cycles;
};

void bench_set_default(struct bench *b);
void bench_turn(struct bench *b, double rpm);
void bench_go(struct bench *b, enum move_kind kind, double x, double z, double pitch_mm);
void bench_tap(struct bench *b, double z, double pitch_mm, double ratio);

/* After limits, spindle and moves have been set. */
void bench_start(struct bench *b);

/* One control cycle and what the spindle does in it. False: the program is over, or has failed. */
bool bench_cycle(struct bench *b);
void bench_check_limits(const struct bench *b);

/*
 * How far the axes are off the thread now, mm: the setpoint of BENCH_AHEAD cycles ago against the
 * true angle. Meaningful in a thread of one block, BENCH_AHEAD cycles after its start.
 */
double bench_off_mm(const struct bench *b);

/* Has the lead-in been over BENCH_AHEAD cycles ago, and is the thread still followed? */
bool bench_is_on_thread(const struct bench *b);

#endif

/*
 * Random threads and taps on random machines: pitch, speed, axis limits, control cycle, encoder,
 * the spindle's ramp, inertia, torque ripple and noise. Whatever happens the setpoints keep every
 * axis's limits by differences, and what is not ended by an alarm ends where it should. With jerk
 * and acceleration to spare the axes are off the thread by no more than
 *
 *     pitch (BOUND alpha / w^2 + COUNTS / counts)      alpha the spindle's largest angular acceleration, w the bandwidth
 *
 * once they have caught up; all passes, whatever their speeds, begin at a whole revolution; a tap
 * comes back to its start exactly.
 *
 * test_threads NUMBER runs this many machines, test_threads NUMBER FIRST from that seed on.
 */
#include "property_arguments.h"
#include "support/thread_bench.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define MACHINES   300
#define CYCLES_MAX 400000

#define BOUND  4.0
#define COUNTS 3.0

/*
 * Parts of jerk and acceleration that following may need for the bound to hold. A step of the
 * spindle's acceleration comes out of the angle's filter, and of the follower, higher by a fifth
 * each: 1.2^2 0.69 = 1.
 */
#define JERK_PART         0.3
#define ACCELERATION_PART 0.69

#define PASSES 3

/* What was is forgotten in this many parts of the bandwidth. */
#define FORGETS 6.0

/* The lead-in is forgotten in this many. */
#define SETTLES 8.0

static struct bench bench;
static uint64_t random_state;
static unsigned machines = MACHINES;
static unsigned first_seed = 1;

struct result {
    double off_mm;       /* on the thread */
    double farthest_mm;  /* along it, in this pass, */
    double back_mm;      /* and the most that the axes went back from there */
    double recent;       /* acceleration of the spindle that the filters remember, rev/s2 */
    double acceleration; /* the largest of these */
    double rev[3];       /* its last angles */
    double time_s;       /* on the thread, in this pass */
    bool is_at_index;    /* every pass so far began at a whole revolution */
};

static struct result seen;
static unsigned completed, alarms, bounded;
static double closest; /* to the bound */

void setUp(void)
{
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(random_state >> 11) / 9007199254740992.0;
}

static double decades(double from, double to)
{
    return takt_maths_power(10.0, between(from, to));
}

static void random_machine(void)
{
    static const double cycles_s[] = {5e-4, 1e-3, 2e-3, 4e-3};
    static const uint32_t counts[] = {64, 400, 1024, 4096, 65536, 1000000};
    struct virtual_spindle_config *s = &bench.spindle_config;

    bench_set_default(&bench);
    bench.limits.cycle_s = cycles_s[(unsigned)between(0, 4)];
    bench.limits.profile = (enum ramp_profile)between(0, 3);
    for (int i = 0; i < BENCH_AXES; i++) {
        bench.limits.velocity_mm_s[i] = decades(1.3, 2.5);
        bench.limits.acceleration_mm_s2[i] = decades(2.5, 4.0);
        bench.limits.jerk_mm_s3[i] = decades(4.0, 6.0);
    }
    s->encoder_counts_per_revolution = counts[(unsigned)between(0, 6)];
    s->encoder_noise_counts = between(0, 1) < 0.3 ? between(0, 1.5) : 0.0;
    s->ramp_rpm_s = decades(2.0, 4.5);
    s->inertia_kg_m2 = decades(-4.0, -2.0);
    s->rated_torque_nm = s->inertia_kg_m2 * s->ramp_rpm_s * decades(-0.9, 0.5);
    s->ripple_percent = between(0, 1) < 0.5 ? between(0, 20) : 0.0;
    s->ripple_per_revolution = takt_maths_floor(between(1, 12));
    s->overload_percent = 1000.0;
}

/* A tap, or passes of one thread at different speeds. */
static void random_program(bool taps)
{
    const double pitch_mm = decades(-0.6, 0.6);
    const double slope = between(-0.3, 0.3);
    const double length_mm = pitch_mm * between(8, 40);

    bench_turn(&bench, 1.0);
    for (unsigned i = 0; i < (taps ? 1 : PASSES); i++) {
        bench_turn(&bench, decades(1.7, 3.2) * (taps && between(0, 1) < 0.5 ? -1.0 : 1.0));
        if (taps) {
            bench_tap(&bench, -length_mm, pitch_mm, between(1, 2));
            continue;
        }
        bench_go(&bench, MOVE_THREAD, slope * length_mm, -length_mm, pitch_mm);
        bench_go(&bench, MOVE_RAPID, 20.0, -length_mm, 0.0);
        bench_go(&bench, MOVE_RAPID, 20.0, 0.0, 0.0);
        bench_go(&bench, MOVE_RAPID, 0.0, 0.0, 0.0);
    }
    bench_start(&bench);
}

static double bandwidth(void)
{
    return -takt_maths_ln(1.0 - takt_maths_cbrt(bench.sync.angle.gain_acceleration)) /
           bench.limits.cycle_s;
}

/* Along a thread nobody goes back, from its very start on, if the spindle turns evenly. */
static void look_back(void)
{
    const double x_mm = bench.sync.follower.at.x_mm;

    if (!bench.is_locked || bench.sync.tap.phase != TAP_NONE ||
        bench.sync.phase != SPINDLE_SYNC_FOLLOWS) {
        seen.farthest_mm = 0.0;
        return;
    }
    seen.farthest_mm = maths_max(seen.farthest_mm, x_mm);
    seen.back_mm = maths_max(seen.back_mm, seen.farthest_mm - x_mm);
}

static void look(void)
{
    const double t = bench.limits.cycle_s;

    memmove(seen.rev + 1, seen.rev, 2 * sizeof(double));
    seen.rev[0] = bench.true_rev[0];
    const double a = (seen.rev[0] - 2.0 * seen.rev[1] + seen.rev[2]) / (t * t);

    seen.recent = maths_max(maths_abs(a), seen.recent * (1.0 - t * bandwidth() / FORGETS));
    if (bench.is_locked && bench.sync.phase == SPINDLE_SYNC_FOLLOWS) {
        seen.acceleration = maths_max(seen.acceleration, seen.recent);
    }
    look_back();
    seen.time_s = bench_is_on_thread(&bench) ? seen.time_s + t : 0.0;
    if (seen.time_s * bandwidth() > SETTLES) {
        const double zero = bench.sync.at.zero_rev;

        seen.off_mm = maths_max(seen.off_mm, maths_abs(bench_off_mm(&bench)));
        seen.is_at_index = seen.is_at_index && zero == takt_maths_round(zero);
    }
}

static void run(void)
{
    seen = (struct result){.is_at_index = true};
    while (bench_cycle(&bench)) {
        look();
        TEST_ASSERT_TRUE(bench.cycles < CYCLES_MAX);
    }
}

static void check_phase(const char *what)
{
    const double w = bandwidth();
    const double pitch_mm = bench.sync.at.pitch_mm;
    const double noise = COUNTS + bench.spindle_config.encoder_noise_counts;
    const double bound_mm =
        pitch_mm * (BOUND * seen.acceleration / (w * w) + noise / bench.spindle_sync_config.counts);

    if (pitch_mm * seen.acceleration * w > JERK_PART * bench.sync.chain.limits.jerk_mm_s3 ||
        pitch_mm * seen.acceleration >
            ACCELERATION_PART * bench.sync.chain.limits.acceleration_mm_s2) {
        return;
    }
    bounded++;
    closest = maths_max(closest, seen.off_mm / bound_mm);
    TEST_ASSERT_TRUE_MESSAGE(seen.off_mm <= bound_mm, what);
}

static void check_machine(unsigned seed, bool taps)
{
    char what[200];

    random_state = UINT64_C(0x9e3779b97f4a7c15) * seed;
    random_machine();
    random_program(taps);
    run();
    (void)snprintf(
        what, sizeof(what),
        "seed %u %s: v %.6f, a %.6f, j %.6f of the limits, off by %.6f mm, back by %.6f, alarm %d",
        seed, taps ? "tap" : "thread", bench.verifier.velocity, bench.verifier.acceleration,
        bench.verifier.jerk, seen.off_mm, seen.back_mm, (int)bench.sync.alarm.code);
    TEST_ASSERT_TRUE_MESSAGE(bench.verifier.velocity <= 1.0001, what);
    TEST_ASSERT_TRUE_MESSAGE(bench.verifier.acceleration <= 1.0001, what);
    TEST_ASSERT_TRUE_MESSAGE(bench.verifier.jerk <= 1.001, what);
    if (bench.sync.alarm.code != TAKT_OK) {
        TEST_ASSERT_EQUAL_MESSAGE(SPINDLE_SYNC_FAILED, bench.locked, what);
        alarms++;
        return;
    }
    TEST_ASSERT_EQUAL_MESSAGE(MOTION_DONE, bench.result, what);
    TEST_ASSERT_TRUE_MESSAGE(bench.point.at[AXIS_X] == 0.0 && bench.point.at[AXIS_Z] == 0.0, what);
    check_phase(what);
    TEST_ASSERT_TRUE_MESSAGE(seen.is_at_index, what);
    if (bench.spindle_config.ripple_percent == 0.0) {
        const double counts = 1.0 + bench.spindle_config.encoder_noise_counts;

        TEST_ASSERT_TRUE_MESSAGE(seen.back_mm <= counts * bench.sync.at.pitch_mm /
                                                     bench.spindle_sync_config.counts,
                                 what);
    }
    completed++;
}

static void test_threads_and_taps_keep_limits_and_phase_on_any_machine(void)
{
    for (unsigned seed = first_seed; seed < first_seed + machines; seed++) {
        check_machine(seed, seed % 2 == 0);
    }
    (void)printf("%u completed, %u of them judged by the bound (at most %.3f of it), %u alarms\n",
                 completed, bounded, closest, alarms);
    TEST_ASSERT_TRUE(machines < 100 || completed > machines / 4);
    TEST_ASSERT_TRUE(machines < 100 || bounded > machines / 10);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &machines, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_threads_and_taps_keep_limits_and_phase_on_any_machine);
    return UNITY_END();
}

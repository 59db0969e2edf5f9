/*
 * Feed holds on smoothed and exact paths, from any moment: on machines drawn by their dimensionless
 * numbers the axes come to rest within a time that their limits tell, and go on afterwards, and no
 * limit is broken.
 *
 * test_holds NUMBER runs this many programs instead of PROGRAMS, test_holds NUMBER FIRST from that
 * seed on. It prints how long the holds took, in parts of V/A + A/J.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

/* Programs in a run. */
#define PROGRAMS 100

#define MOVES_MAX 100

/* A program that takes longer stands still for ever. */
#define CYCLES_MAX 2000000

/*
 * Cycles looked at of a program at a feed far below what the axes can do, and the rounding of
 * setpoints.
 */
#define SLOW_CYCLES 20000
#define ROUNDING_MM 1e-10

/*
 * A hold takes up to HOLD_PARTS of V/A + A/J, and HOLD_CYCLES beside it; SLOW_OF_TEN_THOUSAND of
 * ten thousand holds may take more. Not counted are those of machines that stop in less than
 * HOLD_CYCLES_MIN: what rounds to cycles is most of them.
 */
#define HOLD_CYCLES_MIN      4.0
#define HOLD_PARTS           1.5
#define HOLD_CYCLES          10.0
#define SLOW_OF_TEN_THOUSAND 1

/* Tenths of V/A + A/J that holds are counted in. */
#define TENTHS_MAX 50

static struct path path;
static struct motion motion;
static unsigned programs = PROGRAMS;
static unsigned first_seed = 1;

struct run {
    struct chain chain;
    struct chain chance; /* of the operator */
    struct plan_limits limits;
    enum chain_family family;
    enum move_path path;
    double tolerance_mm;
    unsigned moves;
    unsigned pushed;
    double hold_cycles; /* V/A + A/J of the slowest axis */
    bool holds;
    bool moved;       /* the axes did when it began */
    uint64_t change;  /* cycle of the next hold, or in which the present one began */
    double feed_mm_s; /* of all motions; 0: their own */
    uint64_t cycles_max;
    struct point last; /* setpoint */
    double feed_part;  /* the highest feed that was gone along with, as a part of that */
    double longest;    /* in parts of that */
    unsigned held;
    struct chain_verifier verifier;
};

static struct run run;
static unsigned taken[TENTHS_MAX + 1];
static unsigned holds, slow;

void setUp(void)
{
}

void tearDown(void)
{
}

/* V J/A^2, tau J/A and P J^2/A^3 evenly on a logarithmic scale; axes up to three times apart. */
static void random_machine(struct run *r)
{
    struct plan_limits *l = &r->limits;
    const double v = chain_decades(&r->chain, 1.0, 2.7);
    const double braking = chain_decades(&r->chain, -0.5, 2.0); /* V J/A^2 */
    const double t = takt_maths_power(2.0, (double)(int)chain_between(&r->chain, -2, 3)) * 1e-3;
    const double rounding = chain_decades(&r->chain, -2.0, 0.5); /* tau J/A */

    l->axes = 7;
    l->cycle_s = t;
    l->chord_error_max_mm = 0.01;
    l->landing = LANDING_SPAN;
    l->profile = (enum ramp_profile)chain_between(&r->chain, 0, 3);
    for (int i = 0; i < CHAIN_AXES; i++) {
        const double part = chain_decades(&r->chain, -0.5, 0.0);

        l->velocity_mm_s[i] = v * part;
        l->acceleration_mm_s2[i] = v * part * rounding / (t * braking);
        l->jerk_mm_s3[i] = l->acceleration_mm_s2[i] * rounding / t;
        r->hold_cycles =
            maths_max(r->hold_cycles, (v * part / l->acceleration_mm_s2[i] + t / rounding) / t);
    }
}

static void set_up_run(struct run *r, unsigned seed, enum move_path mode)
{
    memset(r, 0, sizeof(*r));
    r->path = mode;
    r->chain.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    r->chance.seed = UINT64_C(0xd1b54a32d192ed03) * seed;
    random_machine(r);
    r->family = (enum chain_family)chain_between(&r->chain, 0, CHAIN_MIXED + 1);
    r->tolerance_mm = chain_decades(&r->chain, -3, -0.3);
    r->moves = (unsigned)chain_decades(&r->chain, 1, 2);
    r->change = 1 + (uint64_t)(r->hold_cycles * chain_decades(&r->chance, -1, 1));
    r->cycles_max = CYCLES_MAX;
}

/* Where the axes could be far too fast within a few cycles: so soon are the holds. */
static void set_up_slow_run(struct run *r, unsigned seed, enum move_path mode)
{
    double v = MATHS_INFINITY;

    set_up_run(r, seed, mode);
    for (int i = 0; i < CHAIN_AXES; i++) {
        v = maths_min(v, r->limits.velocity_mm_s[i]);
    }
    r->feed_mm_s = v * chain_decades(&r->chance, -4, -1);
    r->hold_cycles = 8.0;
    r->change = 1 + (uint64_t)chain_decades(&r->chance, 0, 2);
    r->cycles_max = SLOW_CYCLES;
}

static void push_next(struct run *r)
{
    struct move m;

    if (r->pushed < r->moves) {
        m = chain_next(&r->chain, r->family, r->pushed);
        m.path = r->path;
        m.tolerance_mm = r->tolerance_mm;
        if (r->feed_mm_s > 0.0) {
            m.kind = m.kind == MOVE_RAPID ? MOVE_FEED : m.kind;
            m.feed_mm_s = r->feed_mm_s;
        }
        r->pushed++;
    } else {
        memset(&m, 0, sizeof(m));
        m.kind = MOVE_END;
    }
    takt_path_push(&path, &m);
    if (m.kind == MOVE_END) {
        takt_path_finish(&path);
    }
}

static void plan(struct run *r)
{
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    takt_path_go_on(&path);
    while (!path.finished && takt_path_has_room(&path)) {
        push_next(r);
    }
    takt_motion_build(&motion);
}

static void count_hold(struct run *r)
{
    const double cycles = (double)(motion.cycles - r->change);
    const double parts = maths_max(0.0, cycles - HOLD_CYCLES) / r->hold_cycles;

    r->held++;
    if (r->hold_cycles < HOLD_CYCLES_MIN) {
        return;
    }
    r->longest = maths_max(r->longest, parts);
    holds++;
    slow += parts > HOLD_PARTS ? 1 : 0;
    taken[parts * 10.0 < TENTHS_MAX ? (unsigned)(parts * 10.0) : TENTHS_MAX]++;
}

/* Holds until the axes are at rest, and for a little while; then not, for a random time. */
static void follow(struct run *r)
{
    if (r->holds ? takt_motion_rests(&motion) && motion.cycles > r->change + 2
                 : motion.cycles >= r->change) {
        if (r->holds && r->moved) {
            count_hold(r);
        }
        r->moved = !takt_motion_rests(&motion);
        r->holds = !r->holds;
        r->change = motion.cycles;
        if (!r->holds) {
            r->change += 1 + (uint64_t)(r->hold_cycles * chain_decades(&r->chance, -1.5, 1));
        }
    }
}

/* No chord is longer than the curve between its ends. */
static void verify_feed(struct run *r, const struct point *cmd)
{
    double square = 0.0;

    for (int i = 0; i < CHAIN_AXES; i++) {
        square += (cmd->at[i] - r->last.at[i]) * (cmd->at[i] - r->last.at[i]);
    }
    if (r->feed_mm_s > 0.0) {
        r->feed_part = maths_max(r->feed_part, (maths_sqrt(square) - ROUNDING_MM) /
                                                   (r->feed_mm_s * r->limits.cycle_s));
    }
    r->last = *cmd;
}

static enum motion_result run_program(struct run *r)
{
    const struct point start = {{0}};
    struct motion_operator now = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    struct cycle_record record;
    enum motion_result result;

    takt_path_init(&path, &r->limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    do {
        plan(r);
        follow(r);
        now.hold = r->holds;
        result = takt_motion_cycle(&motion, &now, &record);
        if (result == MOTION_CYCLE) {
            chain_verifier_setpoint(&r->verifier, &r->limits, &record.cmd);
            verify_feed(r, &record.cmd);
        }
    } while ((result == MOTION_CYCLE || result == MOTION_NOT_YET) && motion.cycles < r->cycles_max);
    return result;
}

static void verify_holds(enum move_path mode)
{
    unsigned failed = 0;
    unsigned longest_seed = 0;
    double longest = 0.0;

    memset(taken, 0, sizeof taken);
    holds = slow = 0;
    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        set_up_run(&run, seed, mode);
        const enum motion_result result = run_program(&run);

        if (result != MOTION_DONE || run.verifier.velocity > 1.0001 ||
            run.verifier.acceleration > 1.0001 || run.verifier.jerk > 1.001) {
            failed++;
            printf("seed %u: %s in %llu cycles, %u holds, v %.5f a %.5f j %.5f\n", seed,
                   result == MOTION_DONE ? "done" : "not done", (unsigned long long)motion.cycles,
                   run.held, run.verifier.velocity, run.verifier.acceleration, run.verifier.jerk);
        }
        if (run.longest > longest) {
            longest = run.longest;
            longest_seed = seed;
        }
    }
    printf("%u programs, %u holds, in tenths of V/A + A/J:", programs, holds);
    for (unsigned i = 0; i <= TENTHS_MAX; i++) {
        printf(" %u", taken[i]);
    }
    printf("\n%u took more than %.1f of it and %.0f cycles, at most %.2f (seed %u)\n", slow,
           HOLD_PARTS, HOLD_CYCLES, longest, longest_seed);
    TEST_ASSERT_EQUAL_UINT(0, failed);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(holds * SLOW_OF_TEN_THOUSAND, 10000 * slow);
}

static void test_axes_come_to_rest_within_what_their_limits_tell_and_break_none(void)
{
    verify_holds(PATH_BLEND);
}

static void test_they_do_on_the_exact_path(void)
{
    verify_holds(PATH_EXACT);
}

static void verify_feeds(enum move_path mode)
{
    unsigned failed = 0;

    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        set_up_slow_run(&run, seed, mode);
        (void)run_program(&run);
        if (run.feed_part > 1.001 || run.verifier.acceleration > 1.0001 ||
            run.verifier.jerk > 1.001) {
            failed++;
            printf("seed %u: %u holds, %.5f of the feed, a %.5f j %.5f\n", seed, run.held,
                   run.feed_part, run.verifier.acceleration, run.verifier.jerk);
        }
    }
    TEST_ASSERT_EQUAL_UINT(0, failed);
}

/* Also where a hold begins while the axes speed up after another. */
static void test_no_programmed_feed_is_exceeded(void)
{
    verify_feeds(PATH_BLEND);
}

static void test_none_is_exceeded_on_the_exact_path(void)
{
    verify_feeds(PATH_EXACT);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_axes_come_to_rest_within_what_their_limits_tell_and_break_none);
    RUN_TEST(test_they_do_on_the_exact_path);
    RUN_TEST(test_no_programmed_feed_is_exceeded);
    RUN_TEST(test_none_is_exceeded_on_the_exact_path);
    return UNITY_END();
}

/*
 * Whatever the operator does: random programs on random machines with every profile, under random
 * schedules of feed override, rapid override and hold. The setpoints keep every axis's limits by
 * differences, landed ends are hit, the program is completed, and nothing stops that neither the
 * program nor the operator asked to.
 *
 * test_overrides NUMBER runs this many programs instead of PROGRAMS, test_overrides NUMBER FIRST
 * from that seed on, test_overrides NUMBER FIRST BLOCKS with this look-ahead instead of a random
 * one.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_schedule.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

/* Programs in each run of all tests. */
#define PROGRAMS 200

/* A program that takes longer stands still for ever. */
#define CYCLES_MAX 2000000

/* After this many cycles without hold everything that a hold has begun is over. */
#define HOLD_IS_OVER_CYCLES 1200

/*
 * With fewer blocks the trapezoidal reference may come to the end of what is known, and waits there
 * for more.
 */
#define LOOK_AHEAD_ENOUGH 8

static struct path path;
static struct motion motion;
static unsigned programs = PROGRAMS;
static unsigned first_seed = 1;
static uint32_t forced_look_ahead; /* 0: none */

struct run {
    struct chain chain;
    struct plan_limits limits;
    enum chain_family family;
    uint32_t look_ahead;
    bool proportional;
    unsigned moves;
    unsigned pushed;
    struct schedule schedule;
    struct chain_verifier verifier;
    double landing_mm;
    unsigned unplanned;
    uint64_t unplanned_cycle;
    bool rested;
};

static struct run run;

void setUp(void)
{
}

void tearDown(void)
{
}

static void random_machine(struct run *r)
{
    struct plan_limits *l = &r->limits;

    schedule_random_control(&r->chain, l);
    l->landing = chain_between(&r->chain, 0, 1) < 0.8 ? LANDING_SPAN : LANDING_BLOCK;
    schedule_random_axes(&r->chain, l);
}

static void push_next(struct run *r)
{
    struct move m;

    if (r->pushed < r->moves) {
        m = chain_next(&r->chain, r->family, r->pushed);
        r->pushed++;
        takt_path_push(&path, &m);
        return;
    }
    memset(&m, 0, sizeof(m));
    m.kind = MOVE_END;
    takt_path_push(&path, &m);
    takt_path_finish(&path);
}

static void plan(struct run *r)
{
    if (takt_motion_wanted(&motion) == NULL) {
        return;
    }
    while (!path.finished && takt_path_has_room(&path) &&
           takt_motion_ahead(&motion) < r->look_ahead) {
        push_next(r);
    }
    takt_motion_build(&motion);
}

static double distance(const struct point *a, const struct point *b)
{
    double most = 0.0;

    for (int i = 0; i < CHAIN_AXES; i++) {
        most = maths_max(most, maths_abs(a->at[i] - b->at[i]));
    }
    return most;
}

/* The axes have just come to rest where no block ends, and nothing has been held for long. */
static void verify_rest(struct run *r, const struct cycle_record *record)
{
    const bool rests = motion.reference.feed == 0.0 && motion.lag == 0.0;

    if (rests && !r->rested && !record->landed && r->look_ahead >= LOOK_AHEAD_ENOUGH &&
        r->schedule.free > HOLD_IS_OVER_CYCLES) {
        r->unplanned++;
        r->unplanned_cycle = record->cycle;
    }
    r->rested = rests;
}

static void verifier(struct run *r, const struct cycle_record *record)
{
    chain_verifier_setpoint(&r->verifier, &r->limits, &record->cmd);
    verify_rest(r, record);
    if (record->landed) {
        const double off_mm = distance(&record->cmd, &motion_block(&motion)->move.end);

        r->landing_mm = maths_max(r->landing_mm, off_mm);
    }
}

static void set_up_run(struct run *r, unsigned seed)
{
    static const uint32_t look_ahead[] = {256, 256, 64, 8, 2};

    memset(r, 0, sizeof(*r));
    r->chain.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    random_machine(r);
    r->family = (enum chain_family)chain_between(&r->chain, 0, CHAIN_MIXED + 1);
    r->look_ahead = look_ahead[(unsigned)chain_between(&r->chain, 0, 5)];
    r->look_ahead = forced_look_ahead > 0 ? forced_look_ahead : r->look_ahead;
    r->proportional = chain_between(&r->chain, 0, 1) < 0.25;
    r->moves = (unsigned)chain_decades(&r->chain, 0.5, 2);
    r->schedule.now = (struct motion_operator){.feed_ratio = 1.0, .rapid_ratio = 1.0};
    r->schedule.target = 1.0;
}

static enum motion_result run_program(struct run *r)
{
    const struct point start = {{0}};
    struct cycle_record record;
    enum motion_result result;

    takt_path_init(&path, &r->limits, &start);
    takt_motion_init(&motion, &path, &start, r->proportional);
    do {
        schedule_follow(&r->schedule, &r->chain, motion.cycles);
        plan(r);
        result = takt_motion_cycle(&motion, &r->schedule.now, &record);
        if (result == MOTION_CYCLE) {
            verifier(r, &record);
        }
    } while (result == MOTION_CYCLE && motion.cycles < CYCLES_MAX);
    r->landing_mm = maths_max(r->landing_mm, distance(&r->chain.at, &record.cmd));
    return result;
}

static bool holds(const struct run *r, enum motion_result result)
{
    return result == MOTION_DONE && r->verifier.velocity <= 1.0001 &&
           r->verifier.acceleration <= 1.0001 && r->verifier.jerk <= 1.001 &&
           r->landing_mm <= 1e-9 && r->unplanned == 0;
}

/* Every program that fails is told; false: this one. */
static bool check_program(unsigned seed)
{
    set_up_run(&run, seed);
    const enum motion_result result = run_program(&run);

    if (holds(&run, result)) {
        return true;
    }
    printf(
        "seed %u, look-ahead %u: %s, v %.6f, a %.6f, j %.6f of the limits, ends missed by %.3g mm, "
        "%u unplanned stops, the last in cycle %llu\n",
        seed, (unsigned)run.look_ahead, result == MOTION_DONE ? "completed" : "not completed",
        run.verifier.velocity, run.verifier.acceleration, run.verifier.jerk, run.landing_mm,
        run.unplanned, (unsigned long long)run.unplanned_cycle);
    return false;
}

static void test_whatever_the_operator_does_the_limits_hold(void)
{
    unsigned failed = 0;
    unsigned long long blocks = 0;

    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        failed += check_program(seed) ? 0 : 1;
        blocks += run.moves;
    }
    printf("%u programs of %llu blocks, %u failed\n", programs, blocks, failed);
    TEST_ASSERT_EQUAL_UINT(0, failed);
}

static void check_pinned(unsigned seed, uint32_t look_ahead)
{
    const uint32_t forced = forced_look_ahead;

    forced_look_ahead = look_ahead;
    const bool held = check_program(seed);

    forced_look_ahead = forced;
    TEST_ASSERT_TRUE(held);
}

/* Found by longer runs of this test, each for another reason. */
static void test_rare_programs_keep_the_limits(void)
{
    check_pinned(5893, 8);   /* what came into view asked for more than had been promised */
    check_pinned(4898, 8);   /* and was refused until the trapezoidal reference stood */
    check_pinned(3322, 256); /* a higher override began a slow block's ceiling earlier */
    check_pinned(870,
                 256);   /* the override fell while the trapezoidal reference could not brake yet */
    check_pinned(28, 8); /* a span was begun with another window than the next ceiling's */
    check_pinned(221, 8);    /* and so, where it could no longer be rested before it */
    check_pinned(278, 256);  /* a junction's feed was lowered too late to come down to it */
    check_pinned(911, 8);    /* a lower override, and an acceleration that changes within a block */
    check_pinned(467, 1);    /* what had been come to was not known for that by the next ceiling */
    check_pinned(1153, 1);   /* too early in a block of less acceleration to stop in it */
    check_pinned(1951, 256); /* the last cycle of braking reaches far beyond where it had to end */
    check_pinned(8545,
                 8); /* less acceleration was come to too fast, under an override just raised */
    check_pinned(6805, 8);  /* what was known ended before the next ceiling came */
    check_pinned(14807, 8); /* and so, while a slow block could not be come to yet */
    check_pinned(2306128,
                 2); /* the next ceiling had less acceleration before what it was late for */
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    if (argc > 3) {
        forced_look_ahead = (uint32_t)strtoul(argv[3], NULL, 10);
    }
    UNITY_BEGIN();
    RUN_TEST(test_whatever_the_operator_does_the_limits_hold);
    RUN_TEST(test_rare_programs_keep_the_limits);
    return UNITY_END();
}

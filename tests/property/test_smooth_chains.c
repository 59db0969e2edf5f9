/*
 * Smoothed paths (G64 P), whatever the operator does: random programs on random machines under
 * random schedules of overrides and holds. The setpoints keep every axis's limits by differences,
 * are within the tolerance of the programmed path, pass every programmed corner within it, and end
 * in the programmed end. So they do with rotary axes, up to six in all, and beside motions on the
 * exact path whose every end is landed on.
 *
 * test_smooth_chains NUMBER runs this many programs instead of PROGRAMS, test_smooth_chains NUMBER
 * FIRST from that seed on.
 */
#include "chain_distance.h"
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_schedule.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

/* Programs in each run of all tests. */
#define PROGRAMS 12

#define MOVES_MAX 100

/* A program that takes longer stands still for ever. */
#define CYCLES_MAX 1000000

/* Moves around the present one that a setpoint may be beside. */
#define AROUND 40

static struct path path;
static struct motion motion;
static unsigned programs = PROGRAMS;
static unsigned first_seed = 1;

struct programmed {
    struct curve curve;
    bool has_length;
    bool exact;       /* not smoothed */
    bool landed;      /* a setpoint has fallen on its end */
    double corner_mm; /* least distance of its end from the setpoints' line */
};

struct run {
    struct chain chain;
    struct plan_limits limits;
    enum chain_family family;
    double tolerance_mm;
    double merge_mm;
    unsigned moves;
    unsigned pushed;
    struct point end;
    struct programmed move[MOVES_MAX];
    struct schedule schedule;
    bool exact;             /* the newest move is not smoothed */
    unsigned rotary;        /* bit i set: axis i turns */
    uint64_t single_cycles; /* between switches of single block; 0: there are none */
    bool rests;
    unsigned singles; /* times the axes have come to rest under single block alone */
    struct chain_verifier verifier;
    struct point last;
    double path_mm;
    uint64_t path_cycle;
    double corner_mm;
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
    l->landing = LANDING_SPAN;
    schedule_random_axes(&r->chain, l);
}

/* One to three rotary axes beside the linear ones: rad. */
static void random_rotary(struct run *r)
{
    struct plan_limits *l = &r->limits;

    r->rotary = (unsigned)chain_between(&r->chain, 1, 8) << AXIS_LINEAR_COUNT;
    l->axes |= r->rotary;
    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        l->velocity_mm_s[i] = chain_decades(&r->chain, -0.3, 1.0);
        l->acceleration_mm_s2[i] = chain_decades(&r->chain, 0.5, 2.2);
        l->jerk_mm_s3[i] = chain_decades(&r->chain, 2.0, 4.0);
    }
}

/* The rotary axes turn on the way, from nothing to a third of a turn; or, on some lines, alone. */
static void turn(struct run *r, const struct point *from, struct move *m)
{
    const bool is_line = m->kind == MOVE_RAPID || m->kind == MOVE_FEED;

    if (is_line && chain_between(&r->chain, 0, 1) < 0.1) {
        m->end = *from;
    }
    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        if ((r->rotary & 1U << i) != 0 && chain_between(&r->chain, 0, 1) < 0.7) {
            m->end.at[i] += chain_between(&r->chain, -1, 1) * chain_decades(&r->chain, -5, 0.3);
        }
    }
    r->chain.at = m->end;
}

/* The next move, kept to verify by. */
static struct move next_move(struct run *r)
{
    struct programmed *kept = &r->move[r->pushed];
    struct move m = chain_next(&r->chain, r->family, r->pushed);

    if (r->rotary != 0) {
        turn(r, &r->end, &m);
    }
    if (r->limits.landing == LANDING_BLOCK && chain_between(&r->chain, 0, 1) < 0.15) {
        r->exact = !r->exact;
    }
    kept->exact = r->exact;
    m.path = r->exact ? PATH_EXACT : PATH_BLEND;
    m.tolerance_mm = r->tolerance_mm;
    m.merge_mm = r->merge_mm;
    kept->has_length = takt_move_curve(&m, &r->end, &kept->curve);
    kept->corner_mm = MATHS_INFINITY;
    r->end = m.end;
    r->pushed++;
    return m;
}

static void push_next(struct run *r)
{
    struct move m;

    if (r->pushed < r->moves) {
        m = next_move(r);
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
    takt_path_go_on(&path);
    while (!path.finished && takt_path_has_room(&path)) {
        push_next(r);
    }
    takt_motion_build(&motion);
}

/* No place on a curve is farther from its start: its length, and what the rotary axes turn by. */
static double reach_of(const struct curve *c)
{
    double reach = c->rotary ? 0.0 : c->length_mm;

    for (int i = AXIS_LINEAR_COUNT; i < AXIS_COUNT; i++) {
        reach += chain_weight(i) * maths_abs(c->end.at[i] - c->start.at[i]);
    }
    return reach;
}

/* Lowers *least to the distance of p from the curve. */
static void verify_curve(const struct curve *c, const struct point *p, double *least)
{
    if (chain_distance(p, &c->start) - reach_of(c) < *least) {
        *least = maths_min(*least, chain_distance_from(c, p));
    }
}

static void verify_corner(struct programmed *m, const struct point *from, const struct point *to)
{
    if (chain_distance(to, &m->curve.end) - chain_distance(from, to) < m->corner_mm) {
        m->corner_mm = maths_min(m->corner_mm, chain_corner_distance(&m->curve.end, from, to));
    }
}

/* Its own motion first: what is farther away is not looked at. */
static void verify_place(struct run *r, const struct cycle_record *record)
{
    const unsigned first = record->block > AROUND ? record->block - AROUND : 0;
    const unsigned last = record->block + AROUND < r->pushed ? record->block + AROUND : r->pushed;
    const unsigned own = record->block > 0 ? record->block - 1 : 0;
    double least = MATHS_INFINITY;

    if (own < last && r->move[own].has_length) {
        verify_curve(&r->move[own].curve, &record->cmd, &least);
    }
    for (unsigned i = first; i < last; i++) {
        struct programmed *m = &r->move[i];

        if (m->has_length && i != own) {
            verify_curve(&m->curve, &record->cmd, &least);
        }
        if (m->has_length) {
            verify_corner(m, &r->last, &record->cmd);
        }
    }
    if (least < MATHS_INFINITY && least > r->path_mm) {
        r->path_mm = least;
        r->path_cycle = record->cycle;
    }
    r->last = record->cmd;
}

static void verify_landing(struct run *r, const struct cycle_record *record)
{
    if (record->landed && record->block > 0) {
        struct programmed *m = &r->move[record->block - 1];

        m->landed = m->landed || chain_distance(&record->cmd, &m->curve.end) == 0.0;
    }
}

static void count_rests(struct run *r)
{
    const bool rests =
        takt_motion_rests(&motion) && r->schedule.now.single_block && r->schedule.free > 0;

    r->singles += rests && !r->rests ? 1 : 0;
    r->rests = rests;
}

static void set_up_run(struct run *r, unsigned seed)
{
    memset(r, 0, sizeof(*r));
    r->chain.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    random_machine(r);
    r->family = (enum chain_family)chain_between(&r->chain, 0, CHAIN_MIXED + 1);
    r->tolerance_mm = chain_decades(&r->chain, -3, -1);
    r->merge_mm = chain_between(&r->chain, 0, 1) < 0.5 ? 0.0 : r->tolerance_mm;
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
    takt_motion_init(&motion, &path, &start, false);
    do {
        plan(r);
        schedule_follow(&r->schedule, &r->chain, motion.cycles);
        r->schedule.now.single_block =
            r->single_cycles > 0 && motion.cycles / r->single_cycles % 2 == 1;
        result = takt_motion_cycle(&motion, &r->schedule.now, &record);
        if (result == MOTION_CYCLE) {
            chain_verifier_setpoint(&r->verifier, &r->limits, &record.cmd);
            verify_place(r, &record);
            verify_landing(r, &record);
            count_rests(r);
        }
    } while ((result == MOTION_CYCLE || result == MOTION_NOT_YET) && motion.cycles < CYCLES_MAX);
    for (unsigned i = 0; i < r->pushed; i++) {
        if (r->move[i].has_length) {
            r->corner_mm = maths_max(r->corner_mm, r->move[i].corner_mm);
        }
    }
    return result;
}

static void check_run(const struct run *r, enum motion_result result, unsigned seed)
{
    char message[240];

    (void)snprintf(
        message, sizeof(message),
        "seed %u family %d law %d moves %u cycle %g s P %g: %llu cycles, v %.5f a %.5f j %.5f, "
        "path %.4f P at %llu, corner %.4f P",
        seed, (int)r->family, (int)r->limits.profile, r->moves, r->limits.cycle_s, r->tolerance_mm,
        (unsigned long long)motion.cycles, r->verifier.velocity, r->verifier.acceleration,
        r->verifier.jerk, r->path_mm / r->tolerance_mm, (unsigned long long)r->path_cycle,
        r->corner_mm / r->tolerance_mm);
    TEST_ASSERT_EQUAL_INT_MESSAGE(MOTION_DONE, result, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.velocity <= 1.0001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.acceleration <= 1.0001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->verifier.jerk <= 1.001, message);
    TEST_ASSERT_TRUE_MESSAGE(r->path_mm <= r->tolerance_mm, message);
    TEST_ASSERT_TRUE_MESSAGE(r->corner_mm <= r->tolerance_mm, message);
    TEST_ASSERT_TRUE_MESSAGE(chain_distance(&r->last, &r->end) == 0.0, message);
}

static void test_smoothed_setpoints_keep_limits_and_tolerance_under_any_override(void)
{
    for (unsigned seed = first_seed; seed < first_seed + programs; seed++) {
        set_up_run(&run, seed);
        check_run(&run, run_program(&run), seed);
    }
}

static void test_single_block_switched_inside_chains_keeps_all_of_it(void)
{
    unsigned singles = 0;

    for (unsigned seed = first_seed; seed < first_seed + 2 * programs / 3; seed++) {
        set_up_run(&run, seed);
        run.single_cycles = 200 + 100 * (seed % 7);
        check_run(&run, run_program(&run), seed);
        singles += run.singles;
    }
    TEST_ASSERT_TRUE(singles > 0 || programs < 10);
}

static void test_rotary_axes_in_chains_keep_all_of_it(void)
{
    for (unsigned seed = first_seed; seed < first_seed + programs / 2; seed++) {
        set_up_run(&run, seed);
        random_rotary(&run);
        check_run(&run, run_program(&run), seed);
    }
}

static void test_exact_motions_between_chains_are_landed_on_block_by_block(void)
{
    unsigned landings = 0;

    for (unsigned seed = first_seed; seed < first_seed + programs / 2; seed++) {
        set_up_run(&run, seed);
        run.limits.landing = LANDING_BLOCK;
        check_run(&run, run_program(&run), seed);
        for (unsigned i = 0; i < run.pushed; i++) {
            const struct programmed *m = &run.move[i];

            if (m->exact && m->has_length) {
                TEST_ASSERT_TRUE(m->landed);
                landings++;
            }
        }
    }
    TEST_ASSERT_TRUE(landings >= programs / 2 || programs < 10);
}

static void test_chains_that_once_stood_for_ever_come_to_their_end(void)
{
    static const struct {
        unsigned seed;
        bool rotary;
    } chains[] = {
        {63, false},  /* a change of rate needed all of the jerk */
        {84, false},  /* corners that lay too close together to be passed held the curve back */
        {1100, true}, /* the slowest axis needed five windows to reach its velocity, */
        {3034, true}, /* or sixteen */
        {4021, true}, /* the nominal feed rose by accelerations that jerk could not bring about */
    };

    for (unsigned i = 0; i < sizeof(chains) / sizeof(chains[0]); i++) {
        set_up_run(&run, chains[i].seed);
        if (chains[i].rotary) {
            random_rotary(&run);
        }
        check_run(&run, run_program(&run), chains[i].seed);
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &programs, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_smoothed_setpoints_keep_limits_and_tolerance_under_any_override);
    RUN_TEST(test_single_block_switched_inside_chains_keeps_all_of_it);
    RUN_TEST(test_rotary_axes_in_chains_keep_all_of_it);
    RUN_TEST(test_exact_motions_between_chains_are_landed_on_block_by_block);
    RUN_TEST(test_chains_that_once_stood_for_ever_come_to_their_end);
    return UNITY_END();
}

/*
 * The planner's times against the least ones there are: single moves against the closed form,
 * chains of three moves against a slow search (support/optimum.h).
 *
 * test_three_moves NUMBER [FIRST [SHORTEST]] tries this many chains from a seed on, of moves from
 * SHORTEST mm to 100 mm, tells each that takes too long, and how near the planner comes. The
 * planner is known not to keep this for moves shorter than SHORTEST_MM: test_three_moves 400 1000
 * 0.01.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"
#include "support/optimum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

/* Chains, and single moves, in each run of all tests. */
#define CHAINS  6
#define SINGLES 2000

/* Lengths of the moves of chains in each run of all tests. */
#define SHORTEST_MM 10.0
#define LONGEST_MM  100.0

/* A chain that takes longer stands still for ever. */
#define CYCLES_MAX 2000000

/* How near the planner must come: so much of the least time, and a cycle for each landed end. */
#define NEAR_RATIO 1.02

static struct path path;
static struct motion motion;
static unsigned chains = CHAINS;
static unsigned first_seed = 1;
static double shortest_mm = SHORTEST_MM;

struct figures {
    unsigned number;
    unsigned slow;           /* beyond NEAR_RATIO */
    double ratio, ratio_max; /* of the time beyond a cycle for each landed end, to the least */
};

static struct figures figures;

void setUp(void)
{
}

void tearDown(void)
{
}

/* -- the planner -- */

struct result {
    double time_s;
    unsigned landed;
};

static void push_all(const struct move *move, unsigned count)
{
    struct move end;

    for (unsigned i = 0; i < count; i++) {
        takt_path_push(&path, &move[i]);
    }
    memset(&end, 0, sizeof(end));
    end.kind = MOVE_END;
    takt_path_push(&path, &end);
    takt_path_finish(&path);
}

static struct result run_moves(const struct plan_limits *limits, const struct move *move,
                               unsigned count)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    const struct point start = {{0}};
    struct cycle_record record;
    struct result r = {0.0, 0};
    enum motion_result cycle;

    takt_path_init(&path, limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    push_all(move, count);
    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_motion_build(&motion);
        }
        cycle = takt_motion_cycle(&motion, &as_programmed, &record);
        r.landed += cycle == MOTION_CYCLE && record.landed ? 1 : 0;
    } while (cycle == MOTION_CYCLE && motion.cycles < CYCLES_MAX);
    TEST_ASSERT_EQUAL(MOTION_DONE, cycle);
    r.time_s = (double)motion.cycles * limits->cycle_s;
    return r;
}

/* -- random moves -- */

static void random_machine(struct chain *c, struct plan_limits *l)
{
    memset(l, 0, sizeof(*l));
    l->axes = 7;
    l->cycle_s = chain_between(c, 0, 1) < 0.5 ? 1e-3 : 2.5e-4;
    l->chord_error_max_mm = 1e-3;
    l->profile = RAMP_PROFILE_JERK;
    l->landing = LANDING_SPAN;
    for (int i = 0; i < CHAIN_AXES; i++) {
        l->velocity_mm_s[i] = chain_between(c, 50, 200);
        l->acceleration_mm_s2[i] = chain_between(c, 500, 3000);
        l->jerk_mm_s3[i] = chain_between(c, 20000, 100000);
    }
}

/* A line from where the last one ended, in a direction, and the same along its path. */
static void random_line(struct chain *c, const struct plan_limits *l, const double direction[3],
                        double least_mm, struct move *move, struct optimum_move *along)
{
    const double length_mm = least_mm * chain_decades(c, 0, log10(LONGEST_MM / least_mm));

    memset(move, 0, sizeof(*move));
    move->kind = MOVE_FEED;
    move->feed_mm_s = chain_between(c, 5, 100);
    move->overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    move->turns = 1;
    *along = (struct optimum_move){length_mm, move->feed_mm_s, HUGE_VAL, HUGE_VAL, HUGE_VAL, 0.0};
    for (int i = 0; i < CHAIN_AXES; i++) {
        const double part = maths_abs(direction[i]);

        c->at.at[i] += direction[i] * length_mm;
        along->feed = fmin(along->feed, l->velocity_mm_s[i] / part);
        along->acceleration = fmin(along->acceleration, l->acceleration_mm_s2[i] / part);
        along->jerk = fmin(along->jerk, l->jerk_mm_s3[i] / part);
    }
    move->end = c->at;
}

static void random_direction(struct chain *c, double direction[3])
{
    double square = 0.0;

    for (int i = 0; i < CHAIN_AXES; i++) {
        direction[i] = chain_between(c, -1, 1);
        square += direction[i] * direction[i];
    }
    for (int i = 0; i < CHAIN_AXES; i++) {
        direction[i] /= maths_sqrt(square);
    }
}

static struct chain chain_of(unsigned seed)
{
    struct chain c;

    memset(&c, 0, sizeof(c));
    c.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    (void)chain_between(&c, 0, 1);
    return c;
}

/* -- claims -- */

static void test_a_single_move_takes_the_least_time_and_less_than_two_cycles(void)
{
    char what[120];

    for (unsigned seed = 1; seed <= SINGLES; seed++) {
        struct chain c = chain_of(seed);
        struct optimum_move along;
        struct plan_limits limits;
        struct move move;
        double direction[3];

        random_machine(&c, &limits);
        random_direction(&c, direction);
        random_line(&c, &limits, direction, 0.01, &move, &along);
        const double least_s = optimum_single(&along);
        const double more_cycles = (run_moves(&limits, &move, 1).time_s - least_s) / limits.cycle_s;

        (void)snprintf(what, sizeof(what), "seed %u: %.4f mm at %.2f mm/s, %.3f cycles more", seed,
                       along.length, along.feed, more_cycles);
        TEST_ASSERT_TRUE_MESSAGE(more_cycles > -1.0 && more_cycles < 2.0, what);
    }
}

/* In one direction throughout, or with corners, at which the axes stop. */
static void random_chain(struct chain *c, const struct plan_limits *limits,
                         struct move move[OPTIMUM_MOVES], struct optimum_move along[OPTIMUM_MOVES])
{
    double direction[3];

    random_direction(c, direction);
    for (int i = 0; i < OPTIMUM_MOVES; i++) {
        if (i > 0 && chain_between(c, 0, 1) < 0.2) {
            random_direction(c, direction);
            along[i - 1].junction_feed = 0.0;
        }
        random_line(c, limits, direction, shortest_mm, &move[i], &along[i]);
    }
}

static void note(unsigned seed, const struct optimum_move along[OPTIMUM_MOVES], double ratio)
{
    figures.number++;
    figures.ratio += ratio;
    figures.ratio_max = maths_max(figures.ratio_max, ratio);
    if (ratio > NEAR_RATIO) {
        figures.slow++;
        printf("seed %u: %.4f of the least time:", seed, ratio);
        for (int i = 0; i < OPTIMUM_MOVES; i++) {
            printf(" %.4f mm at %.1f mm/s%s", along[i].length, along[i].feed,
                   along[i].junction_feed > 0.0 ? "," : ", stop,");
        }
        printf(" %.0f mm/s2, %.0f mm/s3\n", along[0].acceleration, along[0].jerk);
    }
}

/* Nothing can be faster than the least time, but by what the search and the cycles leave open. */
static void check_chain(unsigned seed)
{
    struct chain c = chain_of(seed);
    struct optimum_move along[OPTIMUM_MOVES];
    struct move move[OPTIMUM_MOVES];
    struct plan_limits limits;

    random_machine(&c, &limits);
    random_chain(&c, &limits, move, along);
    const double least_s = optimum_chain(along);
    const struct result r = run_moves(&limits, move, OPTIMUM_MOVES);

    note(seed, along, (r.time_s - r.landed * limits.cycle_s) / least_s);
    TEST_ASSERT_TRUE(r.time_s >= 0.99 * least_s - limits.cycle_s);
}

static void test_three_moves_take_nearly_the_least_time(void)
{
    for (unsigned seed = first_seed; seed < first_seed + chains; seed++) {
        check_chain(seed);
    }
    printf("%u chains: %.4f of the least time in the mean, %.4f at most, %u beyond %.2f\n",
           figures.number, figures.ratio / figures.number, figures.ratio_max, figures.slow,
           NEAR_RATIO);
    TEST_ASSERT_EQUAL_UINT(0, figures.slow);
}

/* The reference itself: three equal parts of one move take as long as the whole. */
static void test_the_search_finds_what_is_known(void)
{
    const double lengths[] = {0.05, 1.0, 30.0};

    for (int i = 0; i < 3; i++) {
        struct optimum_move whole = {lengths[i], 80.0, 1000.0, 50000.0, HUGE_VAL, 0.0};
        struct optimum_move part = whole;

        part.length = whole.length / 3.0;
        const struct optimum_move parts[OPTIMUM_MOVES] = {part, part, part};
        const double least_s = optimum_single(&whole);

        TEST_ASSERT_DOUBLE_WITHIN(1e-4 * least_s, least_s, optimum_chain(parts));
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &chains, &first_seed);
    if (argc > 3) {
        shortest_mm = strtod(argv[3], NULL);
    }
    UNITY_BEGIN();
    RUN_TEST(test_a_single_move_takes_the_least_time_and_less_than_two_cycles);
    RUN_TEST(test_the_search_finds_what_is_known);
    RUN_TEST(test_three_moves_take_nearly_the_least_time);
    return UNITY_END();
}

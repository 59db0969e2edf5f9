/*
 * Junctions close together: a search for the worst chain of short blocks, lines and arcs, with
 * turns between them of any size. Each chain is changed a little again and again, and a change is
 * kept if the jerk comes nearer to its limit; whatever the search finds, setpoints keep the limits.
 *
 * test_crowded_junctions NUMBER [FIRST] searches from this many chains, from a seed on.
 */
#include "motion/motion.h"
#include "plan/path.h"
#include "property_arguments.h"
#include "random_chain.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

/* Chains that a search begins with in each run of all tests, and changes made to each. */
#define SEARCHES 12
#define CHANGES  150

#define BLOCKS 24

/* A chain that lasts longer stands still for ever. */
#define CYCLES_MAX 200000

struct piece {
    double cycles; /* that it lasts at its feed */
    double turn_rad;
    double feed_mm_s;
    double bend; /* turn of an arc; 0: a line */
};

struct search {
    struct chain random;
    struct plan_limits limits;
    struct piece piece[BLOCKS];
};

static struct path path;
static struct motion motion;
static struct search search;
static unsigned searches = SEARCHES;
static unsigned first_seed = 1;

void setUp(void)
{
}

void tearDown(void)
{
}

/* -- chains -- */

static double any_turn(struct chain *c)
{
    const double sign = chain_between(c, 0, 1) < 0.5 ? -1.0 : 1.0;

    return sign * chain_decades(c, -5, 0.4);
}

static struct piece any_piece(struct chain *c)
{
    struct piece p = {.cycles = chain_decades(c, -1, 1.3),
                      .turn_rad = any_turn(c),
                      .feed_mm_s = chain_between(c, 5, 100)};

    p.turn_rad *= chain_between(c, 0, 1) < 0.2 ? 0.0 : 1.0;
    p.bend = chain_between(c, 0, 1) < 0.2 ? 0.5 * any_turn(c) : 0.0;
    if (chain_between(c, 0, 1) < 0.1) {
        p.cycles = 100.0;
    }
    return p;
}

static void any_machine(struct chain *c, struct plan_limits *l)
{
    memset(l, 0, sizeof(*l));
    l->axes = 7;
    l->cycle_s = chain_between(c, 0, 1) < 0.5 ? 1e-3 : 2.5e-4;
    l->chord_error_max_mm = 1e-2;
    l->profile = RAMP_PROFILE_JERK;
    l->landing = LANDING_SPAN;
    for (int i = 0; i < CHAIN_AXES; i++) {
        l->velocity_mm_s[i] = 200.0;
        l->acceleration_mm_s2[i] = chain_decades(c, 2.5, 4);
        l->jerk_mm_s3[i] = chain_decades(c, 4, 6);
    }
}

/* The same chain with one piece scaled a little, or made anew. */
static void change(struct search *s)
{
    struct piece *p = &s->piece[(unsigned)chain_between(&s->random, 0, BLOCKS)];

    if (chain_between(&s->random, 0, 1) < 0.3) {
        *p = any_piece(&s->random);
        return;
    }
    p->cycles *= chain_between(&s->random, 0.8, 1.25);
    p->turn_rad *= chain_between(&s->random, 0.7, 1.4);
    p->bend *= chain_between(&s->random, 0.7, 1.4);
    p->feed_mm_s = maths_min(100.0, p->feed_mm_s * chain_between(&s->random, 0.8, 1.25));
}

/* A line, or an arc of the same length that turns by bend. */
static struct move move_of(struct chain *c, const struct piece *p, double cycle_s)
{
    const double length_mm = p->cycles * p->feed_mm_s * cycle_s;
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.feed_mm_s = p->feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    c->heading_rad += p->turn_rad;
    m.end = c->at;
    if (p->bend == 0.0) {
        m.end.at[AXIS_X] += length_mm * takt_maths_cos(c->heading_rad);
        m.end.at[AXIS_Y] += length_mm * takt_maths_sin(c->heading_rad);
    } else {
        const double radius = length_mm / p->bend; /* its sign is the side of the centre */
        const double end_rad = c->heading_rad + p->bend;

        m.kind = p->bend < 0.0 ? MOVE_ARC_CW : MOVE_ARC_CCW;
        m.centre_mm[0] = c->at.at[AXIS_X] - radius * takt_maths_sin(c->heading_rad);
        m.centre_mm[1] = c->at.at[AXIS_Y] + radius * takt_maths_cos(c->heading_rad);
        m.end.at[AXIS_X] = m.centre_mm[0] + radius * takt_maths_sin(end_rad);
        m.end.at[AXIS_Y] = m.centre_mm[1] - radius * takt_maths_cos(end_rad);
        c->heading_rad = end_rad;
    }
    c->at = m.end;
    return m;
}

/* -- the judgement -- */

static void push_all(const struct search *s)
{
    struct chain c;
    struct move m;

    memset(&c, 0, sizeof(c));
    for (unsigned i = 0; i < BLOCKS; i++) {
        m = move_of(&c, &s->piece[i], s->limits.cycle_s);
        takt_path_push(&path, &m);
    }
    memset(&m, 0, sizeof(m));
    m.kind = MOVE_END;
    takt_path_push(&path, &m);
    takt_path_finish(&path);
}

static struct chain_verifier verifier(const struct search *s)
{
    const struct motion_operator as_programmed = {.feed_ratio = 1.0, .rapid_ratio = 1.0};
    const struct point start = {{0}};
    struct chain_verifier seen;
    struct cycle_record record;
    enum motion_result result;

    memset(&seen, 0, sizeof(seen));
    takt_path_init(&path, &s->limits, &start);
    takt_motion_init(&motion, &path, &start, false);
    push_all(s);
    do {
        if (takt_motion_wanted(&motion) != NULL) {
            takt_motion_build(&motion);
        }
        result = takt_motion_cycle(&motion, &as_programmed, &record);
        if (result == MOTION_CYCLE) {
            chain_verifier_setpoint(&seen, &s->limits, &record.cmd);
        }
    } while (result == MOTION_CYCLE && motion.cycles < CYCLES_MAX);
    TEST_ASSERT_EQUAL(MOTION_DONE, result);
    return seen;
}

static double check(const struct search *s, unsigned seed, unsigned changes)
{
    const struct chain_verifier seen = verifier(s);
    char where[120];

    (void)snprintf(where, sizeof(where), "seed %u, change %u: acceleration %.6f, jerk %.6f", seed,
                   changes, seen.acceleration, seen.jerk);
    TEST_ASSERT_TRUE_MESSAGE(seen.velocity <= 1.0001, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.acceleration <= 1.0001, where);
    TEST_ASSERT_TRUE_MESSAGE(seen.jerk <= 1.001, where);
    return seen.jerk;
}

static double worst_of_search(unsigned seed)
{
    memset(&search, 0, sizeof(search));
    search.random.seed = UINT64_C(0x9e3779b97f4a7c15) * seed;
    any_machine(&search.random, &search.limits);
    for (unsigned i = 0; i < BLOCKS; i++) {
        search.piece[i] = any_piece(&search.random);
    }
    double worst = check(&search, seed, 0);

    for (unsigned changes = 1; changes <= CHANGES; changes++) {
        struct search changed = search;

        change(&changed);
        const double jerk = check(&changed, seed, changes);

        search.random = changed.random;
        if (jerk >= worst) {
            worst = jerk;
            search = changed;
        }
    }
    return worst;
}

static void test_no_chain_of_short_blocks_exceeds_the_limits(void)
{
    double worst = 0.0;

    for (unsigned seed = first_seed; seed < first_seed + searches; seed++) {
        worst = maths_max(worst, worst_of_search(seed));
    }
    printf("%u searches: at most %.6f of the jerk limit\n", searches, worst);
    TEST_ASSERT_TRUE(worst > 0.9);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &searches, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_no_chain_of_short_blocks_exceeds_the_limits);
    return UNITY_END();
}

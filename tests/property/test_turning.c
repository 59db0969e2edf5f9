/*
 * The turning cycles on random profiles of lines and arcs: wherever a cycle goes, at feed or at
 * rapid, it stays at least its distance above the profile, and finishing keeps exactly that
 * distance. Roughing cuts no deeper than a level at once.
 *
 * test_turning NUMBER FIRST: this many profiles, the first of this seed.
 */
#include "base/maths.h"
#include "program/turning.h"
#include "property_arguments.h"
#include "random_chain.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define PROFILES  400
#define LINES_MAX 9
#define SAMPLES   40
/* An offset corner that opens by less than this gets no arc but longer lines. */
#define GAP_MM 1e-2
/* Levels meet the profile within 1e-6 mm, which a shallow slope makes more. */
#define NEAR_MM 1e-5
/*
 * Centres with four decimals lie aside by half of the last, along each axis; radii that differ by
 * it mean 1.5 of it at most.
 */
#define DECIMALS_MM 1e-4
#define ROUNDED_MM  (2.0 * DECIMALS_MM)

static unsigned profiles = PROFILES;
static unsigned first_seed = 1;

void setUp(void)
{
}

void tearDown(void)
{
}

/* -- profiles -- */

/*
 * An arc over the chord that neither turns back in u nor bulges past its centre. False: there is
 * none of this radius.
 */
static bool make_arc(struct profile_segment *s, double radius_ratio, bool left)
{
    const double u = s->end.u - s->start.u;
    const double v = s->end.v - s->start.v;
    const double half = 0.5 * maths_sqrt(u * u + v * v);
    const double r = half * radius_ratio;
    const double away = maths_sqrt(r * r - half * half) / (2.0 * half) * (left ? 1.0 : -1.0);

    s->centre.u = 0.5 * (s->start.u + s->end.u) - away * v;
    s->centre.v = 0.5 * (s->start.v + s->end.v) + away * u;
    const double side = left ? 1.0 : -1.0;

    if (side * (s->start.v - s->centre.v) < 0.0 || side * (s->end.v - s->centre.v) < 0.0) {
        return false;
    }
    s->kind = PROFILE_ARC;
    s->left = left;
    return true;
}

/* From above and before the profile along falling u; it ends in a wall up to where it begins. */
static void random_profile(struct chain *c, struct profile *p)
{
    struct profile_point at = {chain_between(c, 0.5, 3.0), 12.0};
    const unsigned lines = 2U + (unsigned)(chain_between(c, 0.0, 1.0) * (LINES_MAX - 2));

    p->count = 0;
    p->segment[p->count++] = (struct profile_segment){.start = at, .end = {0.0, 3.0}};
    p->segment[p->count++] = (struct profile_segment){.start = {0.0, 3.0}, .end = {-0.5, 3.0}};
    at = p->segment[1].end;
    for (unsigned i = 0; i < lines; i++) {
        const double shape = chain_between(c, 0.0, 1.0);
        struct profile_segment s = {.start = at, .end = at};

        s.end.u -= shape < 0.2 ? 0.0 : chain_between(c, 0.2, 5.0);
        s.end.v = shape >= 0.2 && shape < 0.4 ? at.v : chain_between(c, 0.5, 8.0);
        if (shape > 0.7) {
            (void)make_arc(&s, chain_between(c, 1.02, 3.0), shape > 0.85);
        }
        p->segment[p->count++] = s;
        at = s.end;
    }
    p->segment[p->count++] = (struct profile_segment){.start = at, .end = {at.u, 12.0}};
}

/* -- distances, without the code under test -- */

static double hypotenuse(double u, double v)
{
    return maths_sqrt(u * u + v * v);
}

static double distance_to_end(const struct profile_point *q, const struct profile_point *end)
{
    return hypotenuse(q->u - end->u, q->v - end->v);
}

static double distance_to_line(const struct profile_point *q, const struct profile_segment *s)
{
    const double u = s->end.u - s->start.u;
    const double v = s->end.v - s->start.v;
    const double t = maths_clamp(
        ((q->u - s->start.u) * u + (q->v - s->start.v) * v) / (u * u + v * v), 0.0, 1.0);

    return hypotenuse(q->u - s->start.u - t * u, q->v - s->start.v - t * v);
}

/*
 * Arcs of profiles are above their centre if they turn left, below if right, and from start.u down
 * to end.u.
 */
static double distance_to_arc(const struct profile_point *q, const struct profile_segment *s)
{
    const double r = distance_to_end(&s->start, &s->centre);
    const double away = distance_to_end(q, &s->centre);
    const double foot_u = s->centre.u + (q->u - s->centre.u) / away * r;
    const bool side = s->left ? q->v >= s->centre.v : q->v <= s->centre.v;

    if (side && foot_u <= s->start.u && foot_u >= s->end.u) {
        return maths_abs(away - r);
    }
    return maths_min(distance_to_end(q, &s->start), distance_to_end(q, &s->end));
}

/* From the whole profile behind the way to it. */
static double distance_to_profile(const struct profile_point *q, const struct profile *p)
{
    double least = 1e9;

    for (unsigned i = 1; i < p->count; i++) {
        const struct profile_segment *s = &p->segment[i];

        least = maths_min(least,
                          s->kind == PROFILE_ARC ? distance_to_arc(q, s) : distance_to_line(q, s));
    }
    return least;
}

/* A place on a move, at the share f of it. */
static struct profile_point place(const struct profile_point *from, const struct turning_move *m,
                                  double f)
{
    const double u = m->end.u - from->u;
    const double v = m->end.v - from->v;

    if (!m->arc) {
        return (struct profile_point){from->u + f * u, from->v + f * v};
    }
    const double begin = takt_maths_atan2(from->v - m->centre.v, from->u - m->centre.u);
    double turn = takt_maths_atan2(m->end.v - m->centre.v, m->end.u - m->centre.u) - begin;
    double sine;
    double cosine;

    if (m->left && turn < 0.0) {
        turn += MATHS_TWO_PI;
    } else if (!m->left && turn > 0.0) {
        turn -= MATHS_TWO_PI;
    }
    takt_maths_sincos(begin + f * turn, &sine, &cosine);
    const double r = distance_to_end(from, &m->centre);

    return (struct profile_point){m->centre.u + r * cosine, m->centre.v + r * sine};
}

/* -- the laws -- */

struct seen {
    double nearest, farthest; /* of moves at feed behind the first */
    unsigned moves;
};

static struct seen follow(struct turning *t, const struct profile *p)
{
    struct seen seen = {1e9, 0.0, 0};
    struct profile_point at = p->segment[0].start;
    struct turning_move m;

    while (takt_turning_next(t, &m)) {
        for (unsigned i = 0; i <= SAMPLES; i++) {
            const struct profile_point q = place(&at, &m, (double)i / SAMPLES);
            const double d = distance_to_profile(&q, p);

            seen.nearest = maths_min(seen.nearest, d);
            if (!m.rapid) {
                seen.farthest = maths_max(seen.farthest, d);
            }
        }
        at = m.end;
        if (seen.moves++ > 100000) {
            return seen;
        }
    }
    return seen;
}

static double round_decimals(double value)
{
    return takt_maths_floor(value / DECIMALS_MM + 0.5) * DECIMALS_MM;
}

/* As a program has it: the radii of an arc differ at its ends. */
static void round_centres(struct profile *p)
{
    for (unsigned i = 0; i < p->count; i++) {
        p->segment[i].centre.u = round_decimals(p->segment[i].centre.u);
        p->segment[i].centre.v = round_decimals(p->segment[i].centre.v);
    }
}

static void try_profile(uint64_t seed, enum turning_kind kind, bool rounded)
{
    const double near = NEAR_MM + (rounded ? ROUNDED_MM : 0.0);
    struct chain c = {.seed = seed};
    static struct turning t;
    struct profile p;
    char text[160];

    memset(&t, 0, sizeof(t));
    random_profile(&c, &p);
    t.profile = p;
    if (rounded) {
        round_centres(&t.profile);
    }
    t.words.kind = (uint8_t)kind;
    t.words.distance_mm = chain_decades(&c, -1.5, 0.4);
    t.words.last_mm = t.words.distance_mm;
    t.words.step_mm = chain_between(&c, 0.3, 4.0);
    t.words.retract_mm = chain_between(&c, 0.0, 1.0);
    t.words.passes = 1;
    const enum turning_result result = takt_turning_open(&t);

    if (result != TURNING_GOOD) {
        return;
    }
    const struct seen seen = follow(&t, &p);

    (void)snprintf(text, sizeof(text),
                   "seed %u kind %u D %g: nearest %.9g, farthest %.9g, %u moves", (unsigned)seed,
                   (unsigned)kind, t.words.distance_mm, seen.nearest, seen.farthest, seen.moves);
    TEST_ASSERT_TRUE_MESSAGE(seen.moves < 100000, text);
    TEST_ASSERT_TRUE_MESSAGE(seen.nearest >= t.words.distance_mm - near, text);
    if (kind == TURNING_FINISH) {
        TEST_ASSERT_TRUE_MESSAGE(seen.farthest <= t.words.distance_mm + GAP_MM + near, text);
    }
}

static void test_no_move_is_nearer_to_the_profile_than_its_distance(void)
{
    for (unsigned i = 0; i < profiles; i++) {
        try_profile(first_seed + i, TURNING_ROUGH, false);
        try_profile(first_seed + i, TURNING_NO_POCKETS, false);
        try_profile(first_seed + i, TURNING_POCKETS, false);
    }
}

static void test_finishing_keeps_the_distance_everywhere(void)
{
    for (unsigned i = 0; i < profiles; i++) {
        try_profile(first_seed + i, TURNING_FINISH, false);
    }
}

static void test_arcs_with_four_decimals_are_followed_as_well(void)
{
    for (unsigned i = 0; i < profiles; i++) {
        try_profile(first_seed + i, TURNING_ROUGH, true);
        try_profile(first_seed + i, TURNING_FINISH, true);
    }
}

/*
 * Two quarters that meet where both are upright, with radii that differ by 0.0001 mm at their ends.
 */
static void test_roughing_goes_on_where_two_arcs_meet_upright(void)
{
    const struct profile p = {.count = 6,
                              .segment = {{.start = {1.0, 30.0}, .end = {0.0, 4.0}},
                                          {.start = {0.0, 4.0}, .end = {-1.206, 7.9068}},
                                          {.start = {-1.206, 7.9068},
                                           .end = {-2.808, 9.5087},
                                           .centre = {-1.206, 9.5087},
                                           .kind = PROFILE_ARC},
                                          {.start = {-2.808, 9.5087},
                                           .end = {-3.6326, 10.3334},
                                           .centre = {-3.6327, 9.5087},
                                           .kind = PROFILE_ARC,
                                           .left = true},
                                          {.start = {-3.6326, 10.3334}, .end = {-10.0, 12.0}},
                                          {.start = {-10.0, 12.0}, .end = {-10.0, 30.0}}}};
    static struct turning t;
    struct turning_move m;
    double deepest = 0.0;

    memset(&t, 0, sizeof(t));
    t.profile = p;
    t.words = (struct turning_words){.distance_mm = 0.13, .step_mm = 1.4, .kind = TURNING_ROUGH};
    TEST_ASSERT_EQUAL(TURNING_GOOD, takt_turning_open(&t));
    while (takt_turning_next(&t, &m)) {
        deepest = maths_min(deepest, m.end.u);
    }
    TEST_ASSERT_DOUBLE_WITHIN(NEAR_MM, -10.0 + t.words.distance_mm, deepest);
}

/*
 * What such profiles have: a last wall that dips below the way to the profile, a corner between two
 * corners that is hardly there, an arc that the distance swallows but for 0.5 um, an arc left over
 * behind a level, a wall of 1 um.
 */
static void test_profiles_with_little_room_keep_the_distance_too(void)
{
    static const uint64_t seeds[] = {14243, 7449, 115621, 118998, 121318, 125762};

    for (unsigned i = 0; i < sizeof(seeds) / sizeof(seeds[0]); i++) {
        try_profile(seeds[i], TURNING_ROUGH, false);
        try_profile(seeds[i], TURNING_FINISH, false);
    }
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &profiles, &first_seed);
    UNITY_BEGIN();
    RUN_TEST(test_no_move_is_nearer_to_the_profile_than_its_distance);
    RUN_TEST(test_finishing_keeps_the_distance_everywhere);
    RUN_TEST(test_arcs_with_four_decimals_are_followed_as_well);
    RUN_TEST(test_roughing_goes_on_where_two_arcs_meet_upright);
    RUN_TEST(test_profiles_with_little_room_keep_the_distance_too);
    return UNITY_END();
}

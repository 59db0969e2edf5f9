/*
 * Coming to rest at a place: on machines of any kind, from any state and over any way, the axes
 * need no more than the curve leaves them, stand exactly at the place, and are not much slower than
 * the bounds allow.
 */
#include "base/maths.h"
#include "random_rate.h"
#include "replay/halt.h"

#include <stdint.h>
#include <unity.h>

#define MACHINES 60
#define WAYS     60
#define CYCLES   200000
#define ROUNDING 1e-9
#define SLOWER   1.35
#define MORE     6.0

/* One after another rests, as in replay. */
static struct halt halt;

void setUp(void)
{
    halt = (struct halt){0};
    random_rate_seed = 1;
}

void tearDown(void)
{
}

/*
 * What the last cycles have led, verified by differences as setpoints are at a place where the axes
 * move evenly.
 */
struct differences {
    double way[4];
};

static double verified(struct differences *d, const struct plan_limits *l, double here)
{
    double most = 0.0;

    d->way[3] = d->way[2];
    d->way[2] = d->way[1];
    d->way[1] = d->way[0];
    d->way[0] = here;
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double bend = d->way[0] - 2.0 * d->way[1] + d->way[2];

        most = maths_max(most, maths_abs(bend) * l->velocity_mm_s[i] /
                                   (l->jerk_mm_s3[i] * l->cycle_s * l->cycle_s));
    }
    return most;
}

static void check(const struct rate *before, const struct rate *now, const struct plan_limits *l)
{
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        TEST_ASSERT_TRUE(random_rate_need(l, i, before, now) <= 1.0 + ROUNDING);
    }
}

/* Now and then another order, to stand among them. */
static double next_order(double to)
{
    if (random_rate_between(0.0, 1.0) < 0.99) {
        return to;
    }
    return random_rate_between(0.0, 1.0) < 0.3 ? 0.0 : random_rate_between(0.01, HALT_RATE);
}

/* Cycles to the place, or none. */
static int drive_so(struct rate *r, const struct plan_limits *limits, double to, double way,
                    struct differences *d, bool restless)
{
    for (int n = 1; n < CYCLES; n++) {
        const struct rate before = *r;
        to = restless ? next_order(to) : to;
        const double here = takt_halt_step(&halt, r, to, way);

        TEST_ASSERT_TRUE(here >= 0.0 && here <= way);
        TEST_ASSERT_TRUE(verified(d, limits, here) <= 1.0);
        way -= here;
        if (way == 0.0 && rate_rests(r)) {
            return n;
        }
        check(&before, r, limits);
    }
    return 0;
}

static int drive(struct rate *r, const struct plan_limits *limits, double to, double way,
                 struct differences *d)
{
    return drive_so(r, limits, to, way, d, false);
}

static void test_it_comes_to_rest_exactly_at_any_place_within_the_limits(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct differences d = {{0}};
        struct rate r;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        takt_rate_set(&r, 0.0);
        for (int k = 0; k < WAYS; k++) {
            const double way = takt_maths_power(10.0, random_rate_between(-6.0, 4.0));
            const double to = random_rate_between(0.05, HALT_RATE);

            TEST_ASSERT_TRUE(drive(&r, &limits, to, way, &d) > 0);
        }
    }
}

static void test_orders_on_the_way_change_nothing_of_where_it_comes_to_rest(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct differences d = {{0}};
        struct rate r;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        takt_rate_set(&r, 0.0);
        for (int k = 0; k < WAYS; k++) {
            const double way = takt_maths_power(10.0, random_rate_between(-4.0, 3.0));

            TEST_ASSERT_TRUE(drive_so(&r, &limits, HALT_RATE, way, &d, true) > 0);
        }
    }
}

/* Rest to rest over a short way takes (32 way / M)^(1/3) at least. */
static void test_a_short_way_takes_little_more_than_the_least_time(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct rate r;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        const double m =
            r.limits.room * (1.0 - RANDOM_RATE_KEPT * HALT_RATE * HALT_RATE * HALT_RATE);
        const double c = r.limits.change * (1.0 - RANDOM_RATE_KEPT * HALT_RATE * HALT_RATE);
        const double longest = 2.0 * c * c * c / (m * m); /* the change comes to its bound */

        for (int k = 0; k < WAYS; k++) {
            const double way = longest * takt_maths_power(10.0, random_rate_between(-6.0, 0.0));
            struct differences d = {{0}};

            takt_rate_set(&r, 0.0);
            const int cycles = drive(&r, &limits, HALT_RATE, way, &d);

            TEST_ASSERT_TRUE(cycles > 0);
            TEST_ASSERT_TRUE(cycles <= SLOWER * takt_maths_cbrt(32.0 * way / m) + MORE);
        }
    }
}

/* Orders of any kind until a place is just far enough to be braked for. */
static void test_from_any_state_the_way_it_says_is_enough(void)
{
    for (int machine = 0; machine < MACHINES; machine++) {
        const struct plan_limits limits = random_rate_machine();
        struct rate r;

        takt_rate_init(&r, &limits, RANDOM_RATE_KEPT);
        for (int k = 0; k < WAYS; k++) {
            struct differences d = {{0}};
            const double to = random_rate_between(0.0, HALT_RATE);
            const int cycles = (int)takt_maths_power(10.0, random_rate_between(0.0, 3.3));

            for (int i = 0; i < cycles || !takt_halt_is_possible(&r); i++) {
                verified(&d, &limits, takt_rate_step(&r, to));
            }
            TEST_ASSERT_TRUE(drive(&r, &limits, to, takt_halt_way(&r) * (1.0 + ROUNDING), &d) > 0);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_comes_to_rest_exactly_at_any_place_within_the_limits);
    RUN_TEST(test_orders_on_the_way_change_nothing_of_where_it_comes_to_rest);
    RUN_TEST(test_a_short_way_takes_little_more_than_the_least_time);
    RUN_TEST(test_from_any_state_the_way_it_says_is_enough);
    return UNITY_END();
}

/*
 * The trapezoidal reference alone, under ceilings made by hand: no path, no blocks.
 *
 * A ceiling is laid of stretches, each for the setpoint from one place to the next, as spans.md says: it begins for the
 * trapezoidal reference feed (N - 1)/2 and two cycles earlier, never before the one before it; a lower acceleration so much earlier by
 * the highest feed, whatever the override. Accelerations do not rise from one stretch to the next, so no stretch left behind
 * asks for less.
 */
#include "motion/reference.h"

#include "base/maths.h"
#include "motion/average.h"
#include "plan/path.h"
#include "plan/path_unit.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define WINDOW 20
#define BEHIND (0.5 * (WINDOW - 1.0) + CEILING_MARGIN_CYCLES)

/* s, mm/cycle, mm/cycle2: 100 mm/s and 1 m/s2 as ceilings keep it: of single precision, and not above. */
#define CYCLE_S 1e-3
#define FEED    0.1
#define A       0x1.0624dcp-10

/* The last change of feed to rest may be more than a by this part; positions are rounded to units. */
#define CHANGE_PART 3e-4

struct stretch {
    double length_mm;
    double feed;
    double a;
};

static struct reference reference;
static struct average average;
static struct ceiling ceilings[2];
static struct path paths[2]; /* each ceiling's: a block for each stretch */
static unsigned active;
static uint64_t setpoint;
static uint64_t cycles;

void setUp(void)
{
    takt_reference_init(&reference, RAMP_PROFILE_JERK, 0);
    takt_average_start(&average, RAMP_PROFILE_JERK, 1, 0, 0);
    active = 0;
    setpoint = 0;
    cycles = 0;
}

void tearDown(void)
{
}

/* -- ceilings -- */

static double square(double x)
{
    return x * x;
}

static float single_feed(double feed)
{
    return takt_maths_float_below(feed / CYCLE_S);
}

/* The block of a stretch, at the end of the ceiling's path. */
static void push_block(const struct ceiling *c, double feed, double from_mm, double end_mm)
{
    struct path *path = &paths[c - ceilings];

    path->ring.block[path->pushed] = (struct path_block){.start = path_units(from_mm),
                                                         .feed_program_mm_s = single_feed(feed),
                                                         .feed_limit_mm_s = single_feed(feed),
                                                         .cycles = WINDOW};
    path->pushed++;
    path->position = path_units(end_mm);
}

/* A piece up to a place, of a feed that the setpoint leaves with block leave - 1. */
static void append_piece(struct ceiling *c, double end_mm, float feed_mm_s, double a,
                         unsigned leave)
{
    c->end_mm[c->count] = end_mm;
    c->piece[c->count++] = (struct ceiling_piece){
        .feed_mm_s = feed_mm_s,
        .acceleration = takt_maths_float_below(a),
        .start = c->path->pushed & 0x1ffU,
        .leave = leave & 0x1ffU,
        .landing = CEILING_NONE,
        .opens = true,
    };
}

static void append(struct ceiling *c, const struct stretch *s, double ratio, double from_mm)
{
    const double feed = ratio * s->feed;
    const double end_mm = from_mm + s->length_mm;
    const double before_mm = c->count > 1 ? c->end_mm[c->count - 2] : 0.0;
    const double begin_mm = maths_max(before_mm, from_mm - feed * BEHIND);
    const double early_mm = maths_max(before_mm, from_mm - s->feed * BEHIND);
    const unsigned block = c->path->pushed;
    const struct ceiling_piece *last = c->count > 0 ? &c->piece[c->count - 1] : NULL;

    for (uint32_t k = c->count; k-- > 0 && c->end_mm[k] > begin_mm;) {
        c->end_mm[k] = begin_mm;
    }
    if (last != NULL && early_mm < begin_mm && s->a < (double)last->acceleration) {
        c->end_mm[c->count - 1] = early_mm;
        append_piece(c, begin_mm, last->feed_mm_s, s->a, last->leave);
    }
    append_piece(c, end_mm, single_feed(feed), s->a, block + 1);
    push_block(c, s->feed, from_mm, end_mm);
}

/* sqrt(min(c^2, u + 2 a L)) */
static float feed_before(const struct ceiling_piece *p, float feed_mm_s, float end_mm_s,
                         double length_mm)
{
    const double u = square((double)end_mm_s * CYCLE_S) + 2.0 * (double)p->acceleration * length_mm;

    return u < square((double)feed_mm_s * CYCLE_S) ? single_feed(maths_sqrt(u)) : feed_mm_s;
}

/* Backwards from rest, as the overrides are and at their highest. */
static void plan(struct ceiling *c)
{
    float feed_mm_s = 0.0F;
    float max_mm_s = 0.0F;

    for (uint32_t k = c->count; k-- > 0;) {
        struct ceiling_piece *p = &c->piece[k];
        const double length_mm = c->end_mm[k] - (k > 0 ? c->end_mm[k - 1] : 0.0);

        p->end_feed_mm_s = feed_mm_s;
        p->end_feed_max_mm_s = p->landed ? p->feed_mm_s : max_mm_s;
        feed_mm_s = feed_before(p, p->feed_mm_s, feed_mm_s, length_mm);
        max_mm_s = feed_before(p, takt_ceiling_top_feed(c, k), max_mm_s, length_mm);
    }
}

/* The stretches up to a stop at the end of the last, or without stops to the end of what is known. */
static void lay(struct ceiling *c, const struct stretch *s, unsigned count, double ratio,
                bool stops)
{
    double at_mm = 0.0;

    memset(c, 0, sizeof(*c));
    c->path = &paths[c - ceilings];
    paths[c - ceilings].pushed = 0;
    c->cycle_s = CYCLE_S;
    for (unsigned i = 0; i < count; i++) {
        append(c, &s[i], ratio, at_mm);
        at_mm += s[i].length_mm;
    }
    c->piece[c->count - 1].stop = stops;
    c->open_from = stops ? c->count : 0;
    c->complete = true;
    plan(c);
}

/* Takes a new ceiling as motion does: the one in use stays as it is until then. */
static void take(const struct stretch *s, unsigned count, double ratio, bool stops)
{
    active = 1 - active;
    lay(&ceilings[active], s, count, ratio, stops);
    takt_reference_set_ceiling(&reference, &ceilings[active]);
    while (reference_take(&reference)) {
    }
}

/* -- cycles -- */

static double at_mm(void)
{
    return path_mm(0, reference.at);
}

/* Where the setpoint is: the average of the trapezoidal reference. */
static void follow(void)
{
    takt_average_push(&average, reference.at);
    setpoint = reference.at - (uint64_t)average_lag(&average);
}

static void check_change(double before, double a_max)
{
    char message[120];
    const double change = maths_abs(reference.feed - before);

    (void)snprintf(message, sizeof(message), "cycle %llu at %.9f mm: %.9f after %.9f mm/cycle",
                   (unsigned long long)cycles, at_mm(), reference.feed, before);
    TEST_ASSERT_TRUE_MESSAGE(reference.feed >= 0.0, message);
    TEST_ASSERT_TRUE_MESSAGE(change <= a_max * (1.0 + CHANGE_PART), message);
}

/* One cycle; the feed changes by no more than a_max. */
static void step(bool hold, double a_max)
{
    struct reference_start start;
    const double before = reference.feed;

    if (takt_reference_step(&reference, setpoint, hold, &start)) {
        takt_average_start(&average, RAMP_PROFILE_JERK, reference.cycles, start.at, start.step);
    }
    follow();
    cycles++;
    check_change(before, a_max);
}

static double ceiling_here(void)
{
    return reference.here.piece < reference.here.ceiling->count
               ? ceiling_feed(reference.here.ceiling,
                              reference.here.ceiling->piece[reference.here.piece].feed_mm_s)
               : 0.0;
}

static void run_to_stop(double a_max, unsigned cycles_max)
{
    takt_reference_release(&reference);
    for (unsigned i = 0; i < cycles_max; i++) {
        step(false, a_max);
        if (reference.standing) {
            return;
        }
    }
    TEST_FAIL_MESSAGE("does not come to the stop");
}

/* -- claims -- */

static const struct stretch dip[] = {{20.0, FEED, A}, {5.0, 0.3 * FEED, A}, {20.0, FEED, A}};

static void test_it_is_never_above_the_ceiling_of_its_piece(void)
{
    take(dip, 3, 1.0, true);
    takt_reference_release(&reference);
    do {
        step(false, A);
        TEST_ASSERT_TRUE(reference.feed <= ceiling_here() * (1.0 + 1e-9) || reference.standing);
        TEST_ASSERT_TRUE(cycles < 2000);
    } while (!reference.standing);
}

/* What the average holds is never above the ceiling of the stretch that the setpoint is in. */
static void test_a_slow_stretch_binds_until_the_setpoint_has_left_it(void)
{
    take(dip, 3, 1.0, true);
    takt_reference_release(&reference);
    do {
        const uint64_t before = setpoint;

        step(false, A);
        if (path_mm(0, setpoint) > 20.0 && path_mm(0, before) < 25.0) {
            TEST_ASSERT_TRUE(path_mm(before, setpoint) <= 0.3 * FEED * (1.0 + 1e-9));
        }
    } while (!reference.standing);
}

/* Half an acceleration's cycles up, as many down, and the way between them at full feed. */
static void test_it_takes_the_shortest_time(void)
{
    const struct stretch way = {30.0, FEED, A};

    take(&way, 1, 1.0, true);
    run_to_stop(A, 1000);
    TEST_ASSERT_DOUBLE_WITHIN(2.0, 30.0 / FEED + FEED / A, (double)cycles);
}

static void test_it_keeps_its_feed_for_a_window_between_opposite_changes(void)
{
    unsigned sped_up = 2 * WINDOW;
    unsigned slowed_down = 2 * WINDOW;

    take(dip, 3, 1.0, true);
    takt_reference_release(&reference);
    do {
        const double before = reference.feed;

        step(false, A);
        const double change = reference.feed - before;

        TEST_ASSERT_TRUE(change <= 1e-12 || slowed_down >= WINDOW);
        TEST_ASSERT_TRUE(change >= -1e-12 || sped_up >= WINDOW);
        sped_up = change > 1e-12 ? 0 : sped_up + 1;
        slowed_down = change < -1e-12 ? 0 : slowed_down + 1;
    } while (!reference.standing);
}

static void test_it_stops_exactly_at_a_stop(void)
{
    for (unsigned i = 0; i < 200; i++) {
        const struct stretch way = {0.01 + 0.0371 * i, FEED, A};

        setUp();
        take(&way, 1, 1.0, true);
        run_to_stop(A, 1000);
        TEST_ASSERT_EQUAL_UINT64(path_units(way.length_mm), reference.at);
        TEST_ASSERT_TRUE(reference.feed == 0.0);
    }
}

static void test_it_leaves_a_stop_only_when_released(void)
{
    const struct stretch way = {1.0, FEED, A};

    take(&way, 1, 1.0, true);
    for (unsigned i = 0; i < 100; i++) {
        step(false, A);
    }
    TEST_ASSERT_TRUE(reference.at == 0 && reference.standing);
    run_to_stop(A, 1000);
    TEST_ASSERT_EQUAL_UINT64(path_units(1.0), reference.at);
}

static void test_it_rests_in_a_hold_and_goes_on_after_it(void)
{
    for (unsigned held = 1; held < 400; held += 7) {
        setUp();
        take(dip, 3, 1.0, true);
        takt_reference_release(&reference);
        while (cycles < held) {
            step(false, A);
        }
        for (unsigned i = 0; i < FEED / A + 2 * WINDOW; i++) {
            step(true, A);
        }
        TEST_ASSERT_TRUE(reference.feed == 0.0);
        const uint64_t at = reference.at;

        step(true, A);
        TEST_ASSERT_EQUAL_UINT64(at, reference.at);
        run_to_stop(A, 2000);
        TEST_ASSERT_EQUAL_UINT64(path_units(45.0), reference.at);
    }
}

static void test_it_brakes_at_once_and_fully_for_a_lower_override(void)
{
    const struct stretch way = {100.0, FEED, A};

    take(&way, 1, 1.0, true);
    takt_reference_release(&reference);
    while (cycles < 200) {
        step(false, A);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, FEED, reference.feed);
    take(&way, 1, 0.25, true);
    for (unsigned i = 1; i <= 75; i++) {
        step(false, A);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, FEED - i * A, reference.feed);
    }
    for (unsigned i = 0; i < 100; i++) {
        step(false, A);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.25 * FEED, reference.feed);
    }
}

static void test_it_speeds_up_for_a_higher_override(void)
{
    const struct stretch way = {100.0, FEED, A};

    take(&way, 1, 0.25, true);
    takt_reference_release(&reference);
    while (cycles < 100) {
        step(false, A);
    }
    take(&way, 1, 1.0, true);
    for (unsigned i = 1; i <= 75; i++) {
        step(false, A);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.25 * FEED + i * A, reference.feed);
    }
    step(false, A);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, FEED, reference.feed);
}

/*
 * A higher ceiling lets a stretch begin earlier, but not its lower acceleration. At whatever cycle the ceiling changes, the
 * trapezoidal reference comes to rest exactly at the stop, and changes its feed by no more than the stretch that it is in allows.
 */
static void run_with_change(const struct stretch *way, double ratio, unsigned change)
{
    setUp();
    take(way, 2, ratio, true);
    takt_reference_release(&reference);
    do {
        step(false, A);
    } while (cycles < change && !reference.standing);
    take(way, 2, 1.0, true);
    while (!reference.standing) {
        step(false, (double)reference.here.ceiling->piece[reference.here.piece].acceleration);
        TEST_ASSERT_TRUE(reference.at <= path_units(9.0));
    }
    TEST_ASSERT_EQUAL_UINT64(path_units(9.0), reference.at);
}

static void test_less_acceleration_is_enough_whenever_the_override_rises(void)
{
    for (unsigned tenths = 5; tenths < 10; tenths++) {
        const struct stretch way[] = {{6.0, FEED, A}, {3.0, FEED, 0.1 * tenths * A}};

        for (unsigned change = 60; change < 260; change++) {
            run_with_change(way, 0.5, change);
            run_with_change(way, 0.7, change);
            run_with_change(way, 0.9, change);
        }
    }
}

/* -- the end of what is known -- */

/* A feed too high for the little that comes into view is lowered, but while something comes it is never rest. */
static void test_it_does_not_rest_while_the_path_goes_on(void)
{
    const double comes_mm[] = {1.0, 0.1, 0.01, 0.001};

    for (unsigned k = 0; k < 4; k++) {
        struct stretch way = {5.0, FEED, A};

        setUp();
        take(&way, 1, 1.0, false);
        takt_reference_release(&reference);
        step(false, A);
        for (unsigned i = 0; i < 400; i++) {
            for (unsigned n = 0; n < 16; n++) {
                step(false, A);
                TEST_ASSERT_TRUE(reference.feed > 0.0);
            }
            way.length_mm += comes_mm[k];
            take(&way, 1, 1.0, false);
        }
        TEST_ASSERT_DOUBLE_WITHIN(2.0 + 40.0 * comes_mm[k], way.length_mm, at_mm());
    }
}

static void test_it_rests_exactly_at_the_end_of_what_is_known_and_goes_on_from_there(void)
{
    struct stretch way = {5.0, FEED, A};

    take(&way, 1, 1.0, false);
    takt_reference_release(&reference);
    for (unsigned i = 0; i < 600; i++) {
        step(false, A);
    }
    TEST_ASSERT_EQUAL_UINT64(path_units(5.0), reference.at);
    TEST_ASSERT_TRUE(reference.feed == 0.0 && !reference.standing);
    way.length_mm = 9.0;
    take(&way, 1, 1.0, true);
    run_to_stop(A, 1000);
    TEST_ASSERT_EQUAL_UINT64(path_units(9.0), reference.at);
}

/* -- landing -- */

/* A junction that is landed on at feed, with the room before it that it needs, and a span behind it. */
static void lay_junction(struct ceiling *c, double feed)
{
    const struct stretch after = {10.0, FEED, A};
    const double room_mm = feed * (0.5 * (WINDOW + 1.0) + 8.0);

    lay(c, &after, 1, 1.0, false);
    c->piece[1] = c->piece[0];
    c->end_mm[0] = 10.0 - room_mm;
    c->piece[1].feed_mm_s = single_feed(feed);
    c->piece[1].start = c->piece[0].leave;
    c->piece[1].landed = true;
    c->count = 2;
    append(c, &after, 1.0, 10.0);
    c->end_mm[1] = 10.0;
    c->piece[2].stop = true;
    c->open_from = c->count;
    plan(c);
    for (unsigned k = 0; k < 2; k++) {
        c->piece[k].landing = 1;
    }
}

static void test_the_setpoint_falls_on_a_landed_junction_in_motion(void)
{
    for (unsigned i = 1; i < 20; i++) {
        struct reference_start start;

        setUp();
        lay_junction(&ceilings[0], 0.004 * i);
        takt_reference_set_ceiling(&reference, &ceilings[0]);
        TEST_ASSERT_FALSE(reference_take(&reference));
        takt_reference_release(&reference);
        step(false, A);
        while (!takt_reference_step(&reference, setpoint, false, &start)) {
            TEST_ASSERT_TRUE(reference.feed > 0.0);
            follow();
        }
        TEST_ASSERT_INT64_WITHIN(2, (int64_t)path_units(10.0), (int64_t)setpoint);
        TEST_ASSERT_TRUE(start.step > 0);
        TEST_ASSERT_TRUE((double)start.step / PATH_UNITS_PER_MM <= 0.004 * i * (1.0 + 1e-9));
    }
}

static void test_a_landed_junction_is_rested_at_in_a_hold_close_to_it(void)
{
    lay_junction(&ceilings[0], 0.05);
    takt_reference_set_ceiling(&reference, &ceilings[0]);
    (void)reference_take(&reference);
    takt_reference_release(&reference);
    while (at_mm() < 4.0) {
        step(false, A);
    }
    for (unsigned i = 0; i < 400; i++) {
        step(true, A);
    }
    TEST_ASSERT_TRUE(reference.feed == 0.0 && reference.at <= path_units(10.0));
    run_to_stop(A, 2000);
    TEST_ASSERT_EQUAL_UINT64(path_units(20.0), reference.at);
}

/* -- whatever comes -- */

static uint64_t random_state;

static double between(double low, double high)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(random_state >> 11) / 9007199254740992.0;
}

#define STRETCHES 30

/* Overrides and holds at random, every 16 cycles, over stretches of any length and feed. */
static void run_random(uint64_t seed)
{
    struct stretch way[STRETCHES];
    double end_mm = 0.0;

    random_state = seed;
    setUp();
    for (unsigned i = 0; i < STRETCHES; i++) {
        way[i] =
            (struct stretch){takt_maths_power(10.0, between(-3, 1)), FEED * between(0.05, 1.0), A};
        end_mm += way[i].length_mm;
    }
    take(way, STRETCHES, 1.0, true);
    takt_reference_release(&reference);
    step(false, A);
    do {
        const double ratio = between(0.1, 1.0);
        const bool hold = between(0, 1) < 0.1;

        for (unsigned i = 0; i < 16; i++) {
            step(hold, A);
        }
        take(way, STRETCHES, ratio, true);
        TEST_ASSERT_TRUE_MESSAGE(cycles < 400000, "does not come to the stop");
    } while (!reference.standing);
    TEST_ASSERT_EQUAL_UINT64(takt_ceiling_leave(&ceilings[active], STRETCHES - 1), reference.at);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, end_mm, at_mm());
}

static void test_whatever_ceilings_come_it_never_stands_still_for_good(void)
{
    for (uint64_t seed = 1; seed <= 300; seed++) {
        run_random(seed);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_is_never_above_the_ceiling_of_its_piece);
    RUN_TEST(test_a_slow_stretch_binds_until_the_setpoint_has_left_it);
    RUN_TEST(test_it_takes_the_shortest_time);
    RUN_TEST(test_it_keeps_its_feed_for_a_window_between_opposite_changes);
    RUN_TEST(test_it_stops_exactly_at_a_stop);
    RUN_TEST(test_it_leaves_a_stop_only_when_released);
    RUN_TEST(test_it_rests_in_a_hold_and_goes_on_after_it);
    RUN_TEST(test_it_brakes_at_once_and_fully_for_a_lower_override);
    RUN_TEST(test_it_speeds_up_for_a_higher_override);
    RUN_TEST(test_less_acceleration_is_enough_whenever_the_override_rises);
    RUN_TEST(test_it_does_not_rest_while_the_path_goes_on);
    RUN_TEST(test_it_rests_exactly_at_the_end_of_what_is_known_and_goes_on_from_there);
    RUN_TEST(test_the_setpoint_falls_on_a_landed_junction_in_motion);
    RUN_TEST(test_a_landed_junction_is_rested_at_in_a_hold_close_to_it);
    RUN_TEST(test_whatever_ceilings_come_it_never_stands_still_for_good);
    return UNITY_END();
}

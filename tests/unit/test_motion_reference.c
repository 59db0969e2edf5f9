/*
 * The trapezoidal reference alone, under ceilings made by hand: no path, no blocks.
 *
 * A ceiling is laid of stretches, each for the setpoint from one place to the next, as spans.md
 * says: it begins for the trapezoidal reference feed (N - 1)/2 and two cycles earlier, never before
 * the one before it; a lower acceleration so much earlier by the highest feed, whatever the
 * override. Accelerations do not rise from one stretch to the next, so no stretch left behind asks
 * for less.
 */
#include "reference_bench.h"

static double ceiling_here(void)
{
    return reference.here.piece < reference.here.ceiling->count
               ? ceiling_feed(reference.here.ceiling,
                              reference.here.ceiling->piece[reference.here.piece].feed_mm_s)
               : 0.0;
}

/* -- claims -- */

static void test_it_is_never_above_the_ceiling_of_its_piece(void)
{
    take(dip, 3, 1.0, true);
    takt_reference_release(&reference);
    do {
        step(false, A);
        TEST_ASSERT_TRUE(reference.feed <= ceiling_here() * (1.0 + 1e-9) ||
                         reference_stands(&reference));
        TEST_ASSERT_TRUE(cycles < 2000);
    } while (!reference_stands(&reference));
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
    } while (!reference_stands(&reference));
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
    } while (!reference_stands(&reference));
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
    TEST_ASSERT_TRUE(reference.at == 0 && reference_stands(&reference));
    run_to_stop(A, 1000);
    TEST_ASSERT_EQUAL_UINT64(path_units(1.0), reference.at);
}

/* -- the end of what is known -- */

/*
 * A feed too high for the little that comes into view is lowered, but while something comes it is
 * never rest.
 */
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
    TEST_ASSERT_TRUE(reference.feed == 0.0 && !reference_stands(&reference));
    way.length_mm = 9.0;
    take(&way, 1, 1.0, true);
    run_to_stop(A, 1000);
    TEST_ASSERT_EQUAL_UINT64(path_units(9.0), reference.at);
}

/* -- landing -- */

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
    } while (!reference_stands(&reference));
    TEST_ASSERT_EQUAL_UINT64(path_ceiling_leave(&ceilings[active], STRETCHES - 1), reference.at);
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
    RUN_TEST(test_it_does_not_rest_while_the_path_goes_on);
    RUN_TEST(test_it_rests_exactly_at_the_end_of_what_is_known_and_goes_on_from_there);
    RUN_TEST(test_the_setpoint_falls_on_a_landed_junction_in_motion);
    RUN_TEST(test_whatever_ceilings_come_it_never_stands_still_for_good);
    return UNITY_END();
}

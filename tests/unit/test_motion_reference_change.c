/* The trapezoidal reference when the operator changes something: override and hold. */
#include "reference_bench.h"

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
 * A higher ceiling lets a stretch begin earlier, but not its lower acceleration. At whatever cycle
 * the ceiling changes, the trapezoidal reference comes to rest exactly at the stop, and changes its
 * feed by no more than the stretch that it is in allows.
 */
static void run_with_change(const struct stretch *way, double ratio, unsigned change)
{
    setUp();
    take(way, 2, ratio, true);
    takt_reference_release(&reference);
    do {
        step(false, A);
    } while (cycles < change && !reference_stands(&reference));
    take(way, 2, 1.0, true);
    while (!reference_stands(&reference)) {
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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_rests_in_a_hold_and_goes_on_after_it);
    RUN_TEST(test_it_brakes_at_once_and_fully_for_a_lower_override);
    RUN_TEST(test_it_speeds_up_for_a_higher_override);
    RUN_TEST(test_less_acceleration_is_enough_whenever_the_override_rises);
    RUN_TEST(test_a_landed_junction_is_rested_at_in_a_hold_close_to_it);
    return UNITY_END();
}

/* The feed ceiling that is made of blocks. */
#include "plan/ceiling.h"

#include "base/maths.h"
#include "plan/path.h"
#include "plan/path_unit.h"

#include <string.h>
#include <unity.h>

static const struct plan_limits limits = {
    7,    {100, 100, 100},   {1000, 1000, 1000}, {50000, 50000, 50000}, 1e-3,
    1e-3, RAMP_PROFILE_JERK, LANDING_SPAN};

static struct path path;
static struct ceiling ceiling;
static struct ceiling_request request;

void setUp(void)
{
    const struct point start = {{0}};

    takt_path_init(&path, &limits, &start);
    request = (struct ceiling_request){
        .span = UINT64_MAX, .cycles = 1, .feed_ratio = 1.0, .rapid_ratio = 1.0};
}

void tearDown(void)
{
}

static void push(enum move_kind kind, double x, double feed_mm_s)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = kind;
    m.feed_mm_s = feed_mm_s;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    m.end.at[AXIS_X] = x;
    takt_path_push(&path, &m);
}

static void build(void)
{
    takt_path_finish(&path);
    takt_ceiling_build(&ceiling, &path, &request);
}

static void test_blocks_of_one_feed_make_one_piece(void)
{
    for (int i = 1; i <= 100; i++) {
        push(MOVE_FEED, 0.1 * i, 50.0);
    }
    build();
    TEST_ASSERT_EQUAL(1, ceiling.count);
    TEST_ASSERT_EQUAL_INT(CEILING_STOPS, ceiling.piece[0].end);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, ceiling.end_mm[0]);
    TEST_ASSERT_TRUE(ceiling.piece[0].feed_mm_s == 50.0F);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.05, ceiling_feed(&ceiling, ceiling.piece[0].feed_mm_s));
}

static double random_part(uint32_t *state)
{
    *state = *state * 1664525U + 1013904223U;
    return (double)(*state >> 8) / 16777216.0;
}

/*
 * Lines to and fro in a fan of 6 degrees, 1e-3 to 1 mm long, each at a feed of its own: pieces,
 * junctions and stops of all sorts.
 */
static void push_crooked_way(uint32_t seed, int blocks)
{
    struct move m;

    memset(&m, 0, sizeof(m));
    m.kind = MOVE_FEED;
    m.overrides = OVERRIDE_FEED | OVERRIDE_HOLD;
    m.turns = 1;
    for (int i = 0; i < blocks; i++) {
        const double part = random_part(&seed);
        const double length_mm = part * part * part + 1e-3;

        m.feed_mm_s = 10.0 + 90.0 * random_part(&seed);
        m.end.at[AXIS_X] += length_mm;
        m.end.at[AXIS_Y] += 0.1 * length_mm * (random_part(&seed) - 0.5);
        takt_path_push(&path, &m);
    }
}

/*
 * Going back from the end: how far from its origin a ceiling asks for the same as another, bit by
 * bit.
 */
static double equal_from_mm(const struct ceiling *a, const struct ceiling *b)
{
    const double shift_mm = path_mm(b->origin, a->origin);
    uint32_t i = a->count;
    uint32_t j = b->count;

    while (i > 0 && j > 0 && a->end_mm[i - 1] + shift_mm == b->end_mm[j - 1] &&
           a->piece[i - 1].feed_mm_s == b->piece[j - 1].feed_mm_s &&
           a->piece[i - 1].end_feed_mm_s == b->piece[j - 1].end_feed_mm_s) {
        i--;
        j--;
    }
    return i > 0 ? a->end_mm[i - 1] : 0.0;
}

/*
 * A stream has passed other blocks than the same text in a file when a ceiling is made: it must not
 * show in a single bit, but for the first 11.5 cycles' way at 100 mm/s and what begins there.
 */
static void test_what_a_ceiling_asks_for_does_not_depend_on_the_block_it_is_counted_from(void)
{
    static struct ceiling later;
    const struct point start = {{0}};

    for (uint32_t seed = 1; seed <= 100; seed++) {
        takt_path_init(&path, &limits, &start);
        push_crooked_way(seed, 60);
        request.first = 0;
        build();
        request.first = 10;
        request.reference = path_at(&path, 10)->start;
        takt_ceiling_build(&later, &path, &request);
        TEST_ASSERT_TRUE(later.origin > ceiling.origin);
        TEST_ASSERT_TRUE(equal_from_mm(&later, &ceiling) < 2.5);
    }
}

/*
 * N = A/J = 20 cycles: the setpoint is (20 - 1)/2 cycles behind, and two of margin. The feed may be
 * up to 1.2 times that.
 */
static void test_a_slower_block_begins_earlier_by_half_the_window(void)
{
    push(MOVE_FEED, 50.0, 100.0);
    push(MOVE_FEED, 100.0, 40.0);
    build();
    TEST_ASSERT_EQUAL(3, ceiling.count);
    TEST_ASSERT_EQUAL(20, takt_ceiling_cycles(&ceiling, 0));
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50.0 - 0.048 * 11.5, ceiling.end_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 50.0 - 0.04 * 11.5, ceiling.end_mm[1]);
    TEST_ASSERT_TRUE(ceiling.piece[1].feed_mm_s == 100.0F);
    TEST_ASSERT_EQUAL_UINT64(path_units(50.0), takt_ceiling_start(&ceiling, 1));
    TEST_ASSERT_EQUAL_UINT64(path_units(50.0), path_ceiling_leave(&ceiling, 1));
}

/* u = min(c^2, u_next + 2 a L), from rest at the end backwards. */
static void test_feed_squared_falls_linearly_towards_a_stop(void)
{
    push(MOVE_FEED, 50.0, 100.0);
    push(MOVE_FEED, 50.5, 99.0);
    build();
    TEST_ASSERT_EQUAL(2, ceiling.count);
    TEST_ASSERT_TRUE(ceiling.piece[1].end_feed_mm_s == 0.0F);
    const double length = ceiling.end_mm[1] - ceiling.end_mm[0];
    const double a = (double)ceiling.piece[1].acceleration;
    const double feed_squared = maths_min(0.099 * 0.099, 2.0 * a * length);
    const double feed = ceiling_feed(&ceiling, ceiling.piece[0].end_feed_mm_s);

    TEST_ASSERT_TRUE(feed * feed <= feed_squared);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6 * feed_squared, feed_squared, feed * feed);
}

/*
 * Where a lower acceleration counts from is the same under every override: by the highest feed, 1.2
 * times the programmed.
 */
static void test_no_override_changes_the_acceleration_anywhere(void)
{
    push(MOVE_FEED, 50.0, 80.0);
    push(MOVE_FEED, 100.0, 40.0);
    build();
    path.ring.block[1].a_mm_s2 = 900.0F;
    for (int i = 1; i <= 12; i++) {
        request.feed_ratio = i / 10.0;
        takt_ceiling_build(&ceiling, &path, &request);
        uint32_t k = 0;

        while (ceiling.piece[k + 1].acceleration == ceiling.piece[0].acceleration) {
            k++;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 50.0 - 0.048 * 11.5, ceiling.end_mm[k]);
        TEST_ASSERT_EQUAL_UINT64(path_units(50.0), takt_ceiling_start(&ceiling, k + 1));
    }
}

/*
 * Else it could not be obeyed when it is raised: where the slow block begins for its highest feed
 * had been passed too fast.
 */
static void test_no_override_leaves_the_way_to_be_faster_than_the_highest_one_does(void)
{
    push(MOVE_FEED, 50.0, 80.0);
    push(MOVE_FEED, 50.01, 0.5);
    push(MOVE_FEED, 100.0, 80.0);
    takt_path_finish(&path);
    for (int i = 1; i <= 24; i++) {
        request.feed_ratio = i / 20.0;
        takt_ceiling_build(&ceiling, &path, &request);
        for (uint32_t k = 0; k < ceiling.count; k++) {
            TEST_ASSERT_TRUE(ceiling.piece[k].end_feed_mm_s <= ceiling.piece[k].end_feed_max_mm_s);
        }
    }
}

static void test_the_override_scales_the_programmed_feed_alone(void)
{
    push(MOVE_FEED, 50.0, 80.0);
    build();
    path.ring.block[0].feed_limit_mm_s = 50.0F; /* by geometry */
    request.feed_ratio = 0.75;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 50.0, takt_ceiling_block_feed(&path, 0, &request));
    request.feed_ratio = 0.5;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 40.0, takt_ceiling_block_feed(&path, 0, &request));
    request.proportional = true;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 25.0, takt_ceiling_block_feed(&path, 0, &request));
}

static void test_a_move_without_override_keeps_its_feed(void)
{
    push(MOVE_FEED, 50.0, 80.0);
    build();
    path.ring.block[0].may_feed = 0;
    request.feed_ratio = 0.5;
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 80.0, takt_ceiling_block_feed(&path, 0, &request));
}

static void test_a_rapid_obeys_the_rapid_override(void)
{
    push(MOVE_RAPID, 50.0, 0.0);
    request.rapid_ratio = 0.25;
    request.feed_ratio = 0.5;
    build();
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 25.0, takt_ceiling_block_feed(&path, 0, &request));
    TEST_ASSERT_EQUAL(CEILING_RAPID | CEILING_HOLD, takt_ceiling_overrides(&ceiling, 0));
}

/*
 * A short span needs no longer window than cbrt(L / 2J) = cbrt(0.001 mm / 100,000 mm/s3) = 2.15 ms.
 */
static void test_a_short_span_has_a_short_window(void)
{
    push(MOVE_FEED, 0.001, 80.0);
    push(MOVE_DWELL, 0.0, 0.0);
    push(MOVE_FEED, 50.0, 80.0);
    build();
    TEST_ASSERT_EQUAL(3, takt_ceiling_cycles(&ceiling, 0));
    TEST_ASSERT_EQUAL(20, takt_ceiling_cycles(&ceiling, 1));
}

/* However it is rounded, or the trapezoidal reference would brake where nothing asks for it. */
static void test_a_piece_of_constant_feed_ends_with_exactly_that_feed(void)
{
    push(MOVE_FEED, 20.0, 100.0 / 3.0);
    push(MOVE_FEED, 40.0, 100.0 / 3.0);
    push(MOVE_FEED, 60.0, 100.0 / 3.0);
    build();
    path.ring.block[1].may_hold = 0; /* so that it is a piece for itself */
    takt_ceiling_build(&ceiling, &path, &request);
    TEST_ASSERT_EQUAL(3, ceiling.count);
    for (uint32_t k = 0; k < 2; k++) {
        TEST_ASSERT_TRUE(ceiling.piece[k].feed_mm_s == takt_maths_float_below(100.0 / 3.0));
        TEST_ASSERT_TRUE(ceiling.piece[k].end_feed_mm_s == ceiling.piece[k].feed_mm_s);
    }
}

/*
 * Its blocks may have been overwritten: it has been left at the start of the oldest one that is
 * kept at the latest.
 */
static void test_what_has_been_left_long_ago_was_left_where_the_oldest_block_starts(void)
{
    push(MOVE_FEED, 20.0, 50.0);
    push(MOVE_FEED, 40.0, 60.0);
    push(MOVE_FEED, 60.0, 70.0);
    build();
    TEST_ASSERT_EQUAL_UINT64(path_units(20.0), path_ceiling_leave(&ceiling, 0));
    TEST_ASSERT_EQUAL_UINT64(path_units(20.0), takt_ceiling_start(&ceiling, 1));
    path.kept = 2;
    TEST_ASSERT_EQUAL_UINT64(path_units(40.0), path_ceiling_leave(&ceiling, 0));
    TEST_ASSERT_EQUAL_UINT64(path_units(40.0), takt_ceiling_start(&ceiling, 1));
    TEST_ASSERT_EQUAL_UINT64(path_units(60.0), path_ceiling_leave(&ceiling, 2));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_blocks_of_one_feed_make_one_piece);
    RUN_TEST(test_what_a_ceiling_asks_for_does_not_depend_on_the_block_it_is_counted_from);
    RUN_TEST(test_a_slower_block_begins_earlier_by_half_the_window);
    RUN_TEST(test_feed_squared_falls_linearly_towards_a_stop);
    RUN_TEST(test_no_override_changes_the_acceleration_anywhere);
    RUN_TEST(test_the_override_scales_the_programmed_feed_alone);
    RUN_TEST(test_a_move_without_override_keeps_its_feed);
    RUN_TEST(test_a_rapid_obeys_the_rapid_override);
    RUN_TEST(test_no_override_leaves_the_way_to_be_faster_than_the_highest_one_does);
    RUN_TEST(test_a_short_span_has_a_short_window);
    RUN_TEST(test_a_piece_of_constant_feed_ends_with_exactly_that_feed);
    RUN_TEST(test_what_has_been_left_long_ago_was_left_where_the_oldest_block_starts);
    return UNITY_END();
}

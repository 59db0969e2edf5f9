/*
 * The evaluation functions of seed 002, part A, by examples that can be followed by hand.
 */
#include "base/maths.h"
#include "step/evaluate_helix.h"
#include "unity.h"

#include <stdio.h>
#include <string.h>

static char walked[400]; /* the ticks: axes of each, with a sign for backwards */

void setUp(void)
{
}

void tearDown(void)
{
}

static void write_tick(const struct evaluate_tick *tick)
{
    size_t used = strlen(walked);

    if (used > 0)
        used += (size_t)snprintf(walked + used, sizeof walked - used, " ");
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (evaluate_has(tick->axes, i))
            used += (size_t)snprintf(walked + used, sizeof walked - used, "%s%c",
                                     evaluate_has(tick->direction, i) ? "-" : "", AXIS_LETTERS[i]);
    }
}

static const char *walk_line(enum evaluate_form form, int64_t x, int64_t y, int64_t z)
{
    const int64_t delta[AXIS_COUNT] = {x, y, z};
    struct evaluate_line line;
    struct evaluate_tick tick;

    walked[0] = '\0';
    takt_evaluate_line_begin(&line, form, delta);
    while (takt_evaluate_line_next(&line, &tick))
        write_tick(&tick);
    return walked;
}

static struct evaluate_arc_config arc_of(enum evaluate_form form, int64_t x0, int64_t y0,
                                         int64_t x1, int64_t y1, bool clockwise)
{
    return (struct evaluate_arc_config){
        .form = form, .start = {x0, y0}, .end = {x1, y1}, .clockwise = clockwise};
}

static const char *walk_arc(const struct evaluate_arc_config *config)
{
    struct evaluate_arc arc;
    struct evaluate_tick tick;

    walked[0] = '\0';
    takt_evaluate_arc_begin(&arc, config);
    while (takt_evaluate_arc_next(&arc, &tick))
        write_tick(&tick);
    return walked;
}

/* F = 5 y - 3 x: 0 both (2), no: x (-1), both (1), x (-2), both (0) */
static void test_an_improved_line_steps_its_leading_axis_at_every_tick(void)
{
    TEST_ASSERT_EQUAL_STRING("XY X XY X XY", walk_line(EVALUATE_IMPROVED, 5, 3, 0));
    TEST_ASSERT_EQUAL_STRING("-XY Y -XY Y -XY", walk_line(EVALUATE_IMPROVED, -3, 5, 0));
}

/* F = 3 y - 2 x: 0 x (-2), y (1), x (-1), y (2), x (0) */
static void test_a_plain_line_steps_one_axis_at_a_tick(void)
{
    TEST_ASSERT_EQUAL_STRING("X Y X Y X", walk_line(EVALUATE_PLAIN, 3, 2, 0));
}

static void test_axes_without_increment_are_left_out(void)
{
    TEST_ASSERT_EQUAL_STRING("-Z -Z", walk_line(EVALUATE_IMPROVED, 0, 0, -2));
    TEST_ASSERT_EQUAL_STRING("-Z -Z", walk_line(EVALUATE_PLAIN, 0, 0, -2));
    TEST_ASSERT_EQUAL_STRING("", walk_line(EVALUATE_IMPROVED, 0, 0, 0));
}

/*
 * R = 5 from (0, 5), F: 0, x 1, both -5, x 0, x 7 at (4, 4), y leads: y 0, y -5, both 1, y 0 at (5,
 * 0)
 */
static void test_an_improved_quarter_circle_can_be_followed_by_hand(void)
{
    struct evaluate_arc_config arc = arc_of(EVALUATE_IMPROVED, 0, 5, 5, 0, true);

    TEST_ASSERT_EQUAL_STRING("X X-Y X X -Y -Y X-Y -Y", walk_arc(&arc));
}

static void test_counter_clockwise_exchanges_the_axes(void)
{
    struct evaluate_arc_config clockwise = arc_of(EVALUATE_IMPROVED, 0, 5, 5, 0, true);
    struct evaluate_arc_config counter = arc_of(EVALUATE_IMPROVED, 5, 0, 0, 5, false);
    char mirrored[sizeof walked];

    (void)walk_arc(&clockwise);
    memcpy(mirrored, walked, sizeof mirrored);
    for (char *c = mirrored; *c != '\0'; c++)
        *c = (char)(*c == 'X' ? 'Y' : *c == 'Y' ? 'X' : *c);
    (void)walk_arc(&counter);
    TEST_ASSERT_EQUAL_UINT(strlen(mirrored), strlen(walked));
    TEST_ASSERT_EQUAL_STRING("Y -XY Y Y -X -X -XY -X", walked);
}

/*
 * Quadrant renaming by geometry: one step from the beginning of each, clockwise and
 * counter-clockwise.
 */
static void test_every_quadrant_turns_the_right_way(void)
{
    static const struct {
        int64_t x, y;
        bool clockwise;
        const char *first; /* axis that leads there, and its sign */
    } starts[] = {{0, 9, true, "X"},   {9, 0, true, "-Y"},  {0, -9, true, "-X"},
                  {-9, 0, true, "Y"},  {0, 9, false, "-X"}, {-9, 0, false, "-Y"},
                  {0, -9, false, "X"}, {9, 0, false, "Y"}};

    for (unsigned i = 0; i < sizeof starts / sizeof starts[0]; i++) {
        struct evaluate_arc_config config = arc_of(EVALUATE_IMPROVED, starts[i].x, starts[i].y,
                                                   -starts[i].x, -starts[i].y, starts[i].clockwise);
        struct evaluate_arc arc;
        struct evaluate_tick tick;

        walked[0] = '\0';
        takt_evaluate_arc_begin(&arc, &config);
        TEST_ASSERT_TRUE(takt_evaluate_arc_next(&arc, &tick));
        write_tick(&tick);
        TEST_ASSERT_EQUAL_STRING(starts[i].first, walked);
    }
}

static unsigned count_ticks(const struct evaluate_arc_config *config)
{
    struct evaluate_arc arc;
    struct evaluate_tick tick;
    unsigned ticks = 0;

    takt_evaluate_arc_begin(&arc, config);
    while (takt_evaluate_arc_next(&arc, &tick))
        ticks++;
    return ticks;
}

/* A full circle has 8 octants of R / sqrt 2 leading steps; plain 8 R single steps. */
static void test_a_full_circle_takes_5_66_r_ticks_improved_and_8_r_plain(void)
{
    struct evaluate_arc_config improved = arc_of(EVALUATE_IMPROVED, 1000, 0, 1000, 0, false);
    struct evaluate_arc_config plain = arc_of(EVALUATE_PLAIN, 1000, 0, 1000, 0, false);

    improved.turns = plain.turns = 1;
    TEST_ASSERT_INT_WITHIN(8, 5657, (int)count_ticks(&improved));
    TEST_ASSERT_EQUAL_UINT(8000, count_ticks(&plain));
}

static void test_equal_ends_without_a_turn_do_nothing(void)
{
    struct evaluate_arc_config arc = arc_of(EVALUATE_IMPROVED, 7, -3, 7, -3, false);

    TEST_ASSERT_EQUAL_UINT(0, count_ticks(&arc));
}

/* f = (V/h) |a| / sqrt(sum d^2); plain (V/h) sum |d| / sqrt(sum d^2) */
static void test_the_rate_of_a_line_is_that_of_its_ticks(void)
{
    const int64_t delta[AXIS_COUNT] = {4, -3};
    struct evaluate_line line;

    takt_evaluate_line_begin(&line, EVALUATE_IMPROVED, delta);
    TEST_ASSERT_EQUAL_DOUBLE(0.8, takt_evaluate_line_rate(&line));
    takt_evaluate_line_begin(&line, EVALUATE_PLAIN, delta);
    TEST_ASSERT_EQUAL_DOUBLE(1.4, takt_evaluate_line_rate(&line));
}

/*
 * f0 = V max(|I|, |J|) / (h R): from V/h on an axis to V/(sqrt 2 h) at 45 degrees; plain V
 * (|I| + |J|) / (h R)
 */
static void test_the_rate_of_an_arc_follows_the_angle(void)
{
    struct evaluate_arc_config config = arc_of(EVALUATE_IMPROVED, 3, 4, -3, -4, true);
    struct evaluate_arc arc;

    takt_evaluate_arc_begin(&arc, &config);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.8, takt_evaluate_arc_rate(&arc));
    config.form = EVALUATE_PLAIN;
    takt_evaluate_arc_begin(&arc, &config);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1.4, takt_evaluate_arc_rate(&arc));
    config = arc_of(EVALUATE_IMPROVED, 10, 10, -10, -10, true);
    takt_evaluate_arc_begin(&arc, &config);
    TEST_ASSERT_DOUBLE_WITHIN(1e-15, maths_sqrt(0.5), takt_evaluate_arc_rate(&arc));
}

/*
 * A straight axis in proportion to the leading coordinate instead of the angle would be off by the
 * largest of sin(p) / sin(45) - p / 45 over an octant: 4.2 % of its rise there, 42 um at 8 mm
 * pitch.
 */
static void test_the_straight_axis_of_a_helix_follows_the_angle_and_not_the_coordinate(void)
{
    double largest = 0;

    for (unsigned n = 0; n <= 10000; n++) {
        const double part = 1e-4 * n;

        largest = maths_max(
            largest, takt_maths_sin(part * MATHS_PI / 4) / takt_maths_sin(MATHS_PI / 4) - part);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.0005, 0.042, largest);

    /*
     * A turn of R = 10 mm at 8 mm pitch in steps of 1 um: no lattice point is off by more than a
     * step.
     */
    struct evaluate_arc_config config = arc_of(EVALUATE_IMPROVED, 10000, 0, 10000, 0, false);
    const int64_t delta[AXIS_COUNT] = {0, 0, 8000};
    const unsigned plane[2] = {AXIS_X, AXIS_Y};
    struct evaluate_helix helix;
    struct evaluate_tick tick;
    double worst = 0;

    config.turns = 1;
    takt_evaluate_helix_begin(&helix, &config, plane, delta);
    while (takt_evaluate_helix_next(&helix, &tick))
        worst =
            maths_max(worst, maths_abs(8000.0 * takt_evaluate_arc_angle(&helix.arc) / MATHS_TWO_PI -
                                       (double)helix.done[AXIS_Z]));
    TEST_ASSERT_TRUE(worst <= 1.0);
}

static void test_a_steep_helix_steps_its_straight_axis_at_every_tick(void)
{
    struct evaluate_arc_config config = arc_of(EVALUATE_IMPROVED, 100, 0, 0, 100, false);
    const int64_t delta[AXIS_COUNT] = {0, 0, 0, -1000};
    const unsigned plane[2] = {AXIS_X, AXIS_Y};
    struct evaluate_helix helix;
    struct evaluate_tick tick;
    unsigned ticks = 0;

    takt_evaluate_helix_begin(&helix, &config, plane, delta);
    while (takt_evaluate_helix_next(&helix, &tick)) {
        TEST_ASSERT_EQUAL_UINT8(1U << AXIS_A, tick.axes & 1U << AXIS_A);
        TEST_ASSERT_EQUAL_UINT8(1U << AXIS_A, tick.direction & 1U << AXIS_A);
        ticks++;
    }
    TEST_ASSERT_EQUAL_UINT(1000, ticks);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_an_improved_line_steps_its_leading_axis_at_every_tick);
    RUN_TEST(test_a_plain_line_steps_one_axis_at_a_tick);
    RUN_TEST(test_axes_without_increment_are_left_out);
    RUN_TEST(test_an_improved_quarter_circle_can_be_followed_by_hand);
    RUN_TEST(test_counter_clockwise_exchanges_the_axes);
    RUN_TEST(test_every_quadrant_turns_the_right_way);
    RUN_TEST(test_a_full_circle_takes_5_66_r_ticks_improved_and_8_r_plain);
    RUN_TEST(test_equal_ends_without_a_turn_do_nothing);
    RUN_TEST(test_the_rate_of_a_line_is_that_of_its_ticks);
    RUN_TEST(test_the_rate_of_an_arc_follows_the_angle);
    RUN_TEST(test_the_straight_axis_of_a_helix_follows_the_angle_and_not_the_coordinate);
    RUN_TEST(test_a_steep_helix_steps_its_straight_axis_at_every_tick);
    return UNITY_END();
}

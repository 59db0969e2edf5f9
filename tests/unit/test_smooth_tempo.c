/*
 * How fast nominal time passes along a window: never beyond the limits it began within, and as fast
 * as they leave.
 */
#include "smooth/tempo.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

#define COUNT      60
#define INTERVAL_S 4e-3

static struct smooth_limits limits;
static struct route route;
static struct window window;
static struct tempo tempo;

void setUp(void)
{
}

void tearDown(void)
{
}

/* How fast the rate may change, 1/s. */
#define CHANGE_PER_S 0.5

/* One axis, along a line of 200 mm. */
static void set_machine(double velocity, double acceleration, double jerk)
{
    struct move move = {.kind = MOVE_FEED, .feed_mm_s = 1000.0, .tolerance_mm = 0.01};
    struct point end = {{200.0}};
    struct curve line;

    memset(&limits, 0, sizeof limits);
    limits.axes = 1;
    limits.cycle_s = 1e-3;
    limits.velocity_mm_s[AXIS_X] = velocity;
    limits.acceleration_mm_s2[AXIS_X] = acceleration;
    limits.jerk_mm_s3[AXIS_X] = jerk;
    takt_route_init(&route, &limits, 0.01);
    route.slots.change_per_s = (float)CHANGE_PER_S;
    route.slots.rounded_per_s2 = 0.0f;
    TEST_ASSERT_TRUE(takt_curve_set_line(&line, &(struct point){{0}}, &end));
    takt_route_push(&route, &move, 0, &line);
    takt_window_init(&window, &route, INTERVAL_S);
}

static void put(double x_mm)
{
    window.x[window.count][0] = (int32_t)takt_maths_round(x_mm / window.unit_mm[0]);
    window.element[window.count++] = 0;
}

/* At a feed that a cosine lowers by a part and brings back, once over the window. */
static void run_at(double feed_mm_s, double part)
{
    double x = 0.0;

    for (unsigned i = 0; i < COUNT; i++) {
        double sine, cosine;

        takt_maths_sincos(MATHS_TWO_PI * (double)i / (COUNT - 1), &sine, &cosine);
        put(x);
        x += INTERVAL_S * feed_mm_s * (1.0 - 0.5 * part * (1.0 - cosine));
    }
}

static double coordinate(unsigned i)
{
    return window.unit_mm[0] * (double)window.x[i][0];
}

/*
 * What the axis needs where a piece begins or ends, by the chain rule, and for a change of rate; in
 * parts of its limits.
 */
struct used {
    double velocity, acceleration, jerk;
};

static struct used used_at(unsigned piece, bool end)
{
    const double d = INTERVAL_S;
    const unsigned k = piece + (end ? 1 : 0);
    const float *e = tempo.rate_squared + piece;
    const double b = 0.5 * (double)(end ? e[1] + e[2] : e[0] + e[1]);
    const double slope = (double)(end ? e[2] - e[1] : e[1] - e[0]) / d;
    const double bow = (double)(e[2] - 2.0f * e[1] + e[0]) / (d * d);
    const double first = (coordinate(k + 2) - coordinate(k)) / (2.0 * d);
    const double second = (coordinate(k) - 2.0 * coordinate(k + 1) + coordinate(k + 2)) / (d * d);
    const double third = (coordinate(piece + 3) - 3.0 * coordinate(piece + 2) +
                          3.0 * coordinate(piece + 1) - coordinate(piece)) /
                         (d * d * d);
    const double a = 0.5 * first * slope + second * b;
    const double j = maths_sqrt(b) * (0.5 * first * bow + 1.5 * second * slope + third * b);

    const double v = first * maths_sqrt(b);

    return (struct used){v / limits.velocity_mm_s[AXIS_X],
                         (maths_abs(a) + CHANGE_PER_S * v) / limits.acceleration_mm_s2[AXIS_X],
                         (maths_abs(j) + 3.0 * CHANGE_PER_S * maths_abs(a)) /
                             limits.jerk_mm_s3[AXIS_X]};
}

/* The most of all pieces that are free. */
static struct used used_most(void)
{
    struct used most = {0};

    for (unsigned i = 1; i + 2 < tempo.pieces; i++) {
        for (int end = 0; end < 2; end++) {
            const struct used u = used_at(i, end != 0);

            most.velocity = maths_max(most.velocity, u.velocity);
            most.acceleration = maths_max(most.acceleration, u.acceleration);
            most.jerk = maths_max(most.jerk, u.jerk);
        }
    }
    return most;
}

/* Time of all pieces as they are timed now, in parts of what they take. */
static double time_of_all(void)
{
    double sum = 0.0;

    for (unsigned i = 0; i < tempo.pieces; i++) {
        float slope;

        sum += 1.0 /
               (double)maths_sqrt((double)takt_tempo_rate_squared(&tempo, (float)i + 1.5f, &slope));
    }
    return sum / tempo.pieces;
}

static void test_a_slow_straight_is_gone_faster_within_every_limit(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    run_at(40.0, 0.0);
    takt_tempo_find(&tempo, &window, &route);
    const struct used most = used_most();

    TEST_ASSERT_TRUE(time_of_all() < 0.8);
    TEST_ASSERT_TRUE(most.velocity <= 1.0);
    TEST_ASSERT_TRUE(most.acceleration <= 1.0);
    TEST_ASSERT_TRUE(most.jerk <= 1.0);
}

static void test_a_window_begins_and_ends_at_the_rate_that_its_neighbours_have(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    run_at(40.0, 0.0);
    takt_tempo_find(&tempo, &window, &route);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, tempo.rate_squared[0]);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, tempo.rate_squared[1]);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, tempo.rate_squared[tempo.pieces]);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, tempo.rate_squared[tempo.pieces + 1]);
}

/* No next window wants it slower there: the last piece goes at the rate that none may exceed. */
static void test_where_the_path_ends_the_highest_rate_is_kept_to_the_end(void)
{
    set_machine(100.0, 1000.0, 50000.0);
    run_at(40.0, 0.0);
    takt_tempo_find(&tempo, &window, &route);
    const double with_neighbour = time_of_all();

    window.at_end = true;
    takt_tempo_find(&tempo, &window, &route);
    TEST_ASSERT_TRUE(time_of_all() < 0.97 * with_neighbour);
    for (unsigned i = tempo.pieces - 1; i < tempo.pieces + 2; i++) {
        TEST_ASSERT_FLOAT_WITHIN(0.01f * RATE_SQUARED_MOST, RATE_SQUARED_MOST,
                                 tempo.rate_squared[i]);
    }
}

/* The curve brakes by 1.3 A; the way is hardly long enough to brake by less. */
static void test_what_is_exceeded_is_drawn_inside_and_nothing_else_goes_beyond(void)
{
    set_machine(100.0, 600.0, 50000.0);
    run_at(60.0, 0.99);
    memset(&tempo, 0, sizeof tempo);
    tempo.pieces = window.count - SMOOTH_FIXED;
    for (unsigned i = 0; i < tempo.pieces + 2; i++)
        tempo.rate_squared[i] = 1.0f;
    const struct used before = used_most();

    takt_tempo_find(&tempo, &window, &route);
    const struct used after = used_most();

    TEST_ASSERT_TRUE(before.acceleration > 1.25);
    TEST_ASSERT_TRUE(after.acceleration < 0.97 * before.acceleration);
    TEST_ASSERT_TRUE(after.jerk <= 1.0);
}

static void check_no_slower(double acceleration, double jerk)
{
    set_machine(100.0, acceleration, jerk);
    run_at(50.0, 0.5);
    takt_tempo_find(&tempo, &window, &route);
    const double before = time_of_all();

    set_machine(100.0, 2.0 * acceleration, jerk);
    run_at(50.0, 0.5);
    takt_tempo_find(&tempo, &window, &route);
    TEST_ASSERT_TRUE(time_of_all() <= 1.01 * before);
    set_machine(100.0, acceleration, 2.0 * jerk);
    run_at(50.0, 0.5);
    takt_tempo_find(&tempo, &window, &route);
    TEST_ASSERT_TRUE(time_of_all() <= 1.01 * before);
}

/* V J/A^2 from 0.06 to 60,000 */
static void test_a_higher_limit_is_never_slower(void)
{
    double a = 400.0;

    for (unsigned i = 0; i < 7; i++) {
        double j = 1e4;

        for (unsigned k = 0; k < 9; k++) {
            check_no_slower(a, j);
            j *= 2.3;
        }
        a *= 1.7;
    }
}

static void test_a_slower_stretch_is_slow_and_the_rest_as_it_was(void)
{
    float slope;

    set_machine(100.0, 1000.0, 50000.0);
    run_at(40.0, 0.0);
    takt_tempo_slow(&tempo, &window, 30, 8, 0.5f);
    TEST_ASSERT_EQUAL_FLOAT(0.25f, takt_tempo_rate_squared(&tempo, 31.5f, &slope));
    TEST_ASSERT_EQUAL_FLOAT(0.0f, slope);
    TEST_ASSERT_EQUAL_FLOAT(1.0f, takt_tempo_rate_squared(&tempo, 10.0f, &slope));
    TEST_ASSERT_EQUAL_FLOAT(1.0f, takt_tempo_rate_squared(&tempo, 50.0f, &slope));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_slow_straight_is_gone_faster_within_every_limit);
    RUN_TEST(test_a_window_begins_and_ends_at_the_rate_that_its_neighbours_have);
    RUN_TEST(test_where_the_path_ends_the_highest_rate_is_kept_to_the_end);
    RUN_TEST(test_what_is_exceeded_is_drawn_inside_and_nothing_else_goes_beyond);
    RUN_TEST(test_a_higher_limit_is_never_slower);
    RUN_TEST(test_a_slower_stretch_is_slow_and_the_rest_as_it_was);
    return UNITY_END();
}

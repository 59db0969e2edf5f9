/*
 * The interpolators of unit steps on random lines, arcs and helices: at every tick no axis is off
 * by more than a step (an arc not by more than a step radially), the end is exact, and the improved
 * form takes no more ticks than the leading axis has steps. Every shape is a fixed seed; a failure
 * names it.
 *
 * test_step_forms NUMBER tries this many of each shape instead of SHAPES.
 */
#include "base/maths.h"
#include "property_arguments.h"
#include "step/evaluate_helix.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define SHAPES 20000

/* Rounding of the reference, in steps. */
#define ROOM 1e-6

static unsigned shapes = SHAPES;
static uint64_t seed;
static char shape[200]; /* printed when a claim fails */

static struct {
    double line_off_ratio; /* of sqrt(n - 1) */
    double axis;
    double radial;
    double along;
    double ticks_over;
} worst;

void setUp(void)
{
    memset(&worst, 0, sizeof worst);
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static unsigned random_below(unsigned count)
{
    return (unsigned)random_between(0, count);
}

static int64_t random_steps(double decades)
{
    double size = takt_maths_power(10.0, random_between(-0.5, decades));

    return (int64_t)takt_maths_floor(random_between(0, 1) < 0.5 ? size : -size);
}

static void raise_to(double *largest, double value)
{
    *largest = maths_max(*largest, value);
}

static void take(int64_t at[AXIS_COUNT], const struct evaluate_tick *tick)
{
    TEST_ASSERT_EQUAL_UINT_MESSAGE(0, tick->direction & ~tick->axes & 0xFFU, shape);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (evaluate_has(tick->axes, i))
            at[i] += evaluate_has(tick->direction, i) ? -1 : 1;
    }
}

static bool is_one_axis(const struct evaluate_tick *tick)
{
    return (tick->axes & (tick->axes - 1U)) == 0U;
}

/* Lines */

static unsigned moving_axes(const int64_t delta[AXIS_COUNT])
{
    unsigned count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        count += delta[i] != 0 ? 1U : 0U;
    return count;
}

/*
 * Distance along each axis from where the line is when its leading coordinate is the lattice
 * point's.
 */
static void check_on_line(const int64_t at[AXIS_COUNT], const int64_t delta[AXIS_COUNT],
                          unsigned leading)
{
    double part = (double)at[leading] / (double)delta[leading];
    double squares = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double off = (double)at[i] - part * (double)delta[i];

        raise_to(&worst.axis, maths_abs(off));
        squares += off * off;
    }
    TEST_ASSERT_TRUE_MESSAGE(worst.axis <= 1.0 + ROOM, shape);
    raise_to(&worst.line_off_ratio,
             maths_sqrt(squares / maths_max(1.0, (double)moving_axes(delta) - 1.0)));
}

static void run_line(enum evaluate_form form, const int64_t delta[AXIS_COUNT])
{
    int64_t at[AXIS_COUNT] = {0};
    int64_t ticks = 0, longest = 0, sum = 0;
    struct evaluate_line line;
    struct evaluate_tick tick;

    takt_evaluate_line_begin(&line, form, delta);
    while (takt_evaluate_line_next(&line, &tick)) {
        ticks++;
        take(at, &tick);
        TEST_ASSERT_TRUE_MESSAGE(form == EVALUATE_IMPROVED || is_one_axis(&tick), shape);
        check_on_line(at, delta, line.leading);
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        TEST_ASSERT_EQUAL_INT64_MESSAGE(delta[i], at[i], shape);
        longest = evaluate_size(delta[i]) > longest ? evaluate_size(delta[i]) : longest;
        sum += evaluate_size(delta[i]);
    }
    TEST_ASSERT_EQUAL_INT64_MESSAGE(form == EVALUATE_IMPROVED ? longest : sum, ticks, shape);
}

static void test_no_axis_of_a_line_is_off_by_a_step_and_its_end_is_exact(void)
{
    for (unsigned n = 0; n < shapes; n++) {
        int64_t delta[AXIS_COUNT] = {0};
        unsigned axes = 1 + random_below(AXIS_COUNT);

        for (unsigned i = 0; i < axes; i++)
            delta[i] = random_steps(n % 100 == 0 ? 4.0 : 2.2);
        (void)snprintf(shape, sizeof shape, "line %u", n);
        run_line(n % 2 == 0 ? EVALUATE_IMPROVED : EVALUATE_PLAIN, delta);
    }
    TEST_ASSERT_TRUE(worst.line_off_ratio <= 1.0 + ROOM);
    (void)printf("lines: off by at most %.4f steps on an axis, %.4f of root n - 1 in space\n",
                 worst.axis, worst.line_off_ratio);
}

/* Arcs */

struct arc_case {
    struct evaluate_arc_config config;
    double radius;
    double start_rad, sweep_rad; /* signed */
};

static struct arc_case random_arc(unsigned n, double decades)
{
    struct arc_case c;
    double size = takt_maths_power(10.0, random_between(0.0, decades));
    double direction = random_between(-MATHS_PI, MATHS_PI);
    double sine, cosine;

    memset(&c, 0, sizeof c);
    takt_maths_sincos(direction, &sine, &cosine);
    c.config.start[0] = (int64_t)takt_maths_round(size * cosine);
    c.config.start[1] = (int64_t)takt_maths_round(size * sine);
    if (c.config.start[0] == 0 && c.config.start[1] == 0)
        c.config.start[0] = 1;
    c.radius = maths_sqrt(
        (double)(c.config.start[0] * c.config.start[0] + c.config.start[1] * c.config.start[1]));
    c.start_rad = takt_maths_atan2((double)c.config.start[1], (double)c.config.start[0]);
    c.config.clockwise = random_between(0, 1) < 0.5;
    c.config.form = n % 2 == 0 ? EVALUATE_IMPROVED : EVALUATE_PLAIN;
    c.config.turns = random_between(0, 1) < 0.1 ? 1 + random_below(2) : 0;
    return c;
}

/* The end: on the circle's nearest lattice point, one in ten at the start itself or on an axis. */
static void set_end(struct arc_case *c)
{
    double sweep = random_between(0, 1) < 0.1 ? 0.0 : random_between(0.0, MATHS_TWO_PI);
    double signed_sweep = c->config.clockwise ? -sweep : sweep;
    double sine, cosine;

    takt_maths_sincos(c->start_rad + signed_sweep, &sine, &cosine);
    c->config.end[0] = (int64_t)takt_maths_round(c->radius * cosine);
    c->config.end[1] = (int64_t)takt_maths_round(c->radius * sine);
    if (c->config.end[0] == 0 && c->config.end[1] == 0)
        memcpy(c->config.end, c->config.start, sizeof c->config.end);
    sweep = takt_maths_atan2((double)c->config.end[1], (double)c->config.end[0]) - c->start_rad;
    sweep = c->config.clockwise ? -sweep : sweep;
    sweep -= MATHS_TWO_PI * takt_maths_floor(sweep / MATHS_TWO_PI);
    if (memcmp(c->config.start, c->config.end, sizeof c->config.start) == 0)
        sweep = 0.0;
    sweep += MATHS_TWO_PI * (double)c->config.turns;
    c->sweep_rad = c->config.clockwise ? -sweep : sweep;
}

static void name_arc(const char *kind, unsigned n, const struct arc_case *c)
{
    (void)snprintf(shape, sizeof shape, "%s %u: (%lld, %lld) to (%lld, %lld) %s, turns %u", kind, n,
                   (long long)c->config.start[0], (long long)c->config.start[1],
                   (long long)c->config.end[0], (long long)c->config.end[1],
                   c->config.clockwise ? "clockwise" : "counter-clockwise", c->config.turns);
}

static void check_on_circle(const int64_t at[2], double radius)
{
    double off = maths_sqrt((double)(at[0] * at[0] + at[1] * at[1])) - radius;

    raise_to(&worst.radial, maths_abs(off));
    TEST_ASSERT_TRUE_MESSAGE(maths_abs(off) <= 1.0 + ROOM, shape);
}

/*
 * Steps of the coordinate that leads, from the beginning of the first octant to an angle: R sin in
 * odd, R (1 - cos) ...
 */
static double leading_way(double angle_rad)
{
    double eighths = takt_maths_floor(angle_rad / (0.25 * MATHS_PI));
    double rest = angle_rad - eighths * 0.25 * MATHS_PI;
    bool odd = takt_maths_floor(0.5 * eighths) * 2.0 != eighths;

    return eighths * maths_sqrt(0.5) +
           (odd ? maths_sqrt(0.5) - takt_maths_sin(0.25 * MATHS_PI - rest) : takt_maths_sin(rest));
}

/*
 * Ticks beyond what the leading coordinate of the true arc moves; a rounded junction between
 * octants may cost one.
 */
static void check_ticks(const struct arc_case *c, int64_t ticks)
{
    double start = c->start_rad * (c->config.clockwise ? -1.0 : 1.0) + MATHS_TWO_PI;
    double way = c->radius * (leading_way(start + maths_abs(c->sweep_rad)) - leading_way(start));
    double octants = takt_maths_floor(maths_abs(c->sweep_rad) / (0.25 * MATHS_PI)) + 1.0;

    raise_to(&worst.ticks_over, ((double)ticks - way) / (octants + 1.0));
    TEST_ASSERT_TRUE_MESSAGE((double)ticks <= way + octants + 1.0, shape);
}

static void run_arc(const struct arc_case *c)
{
    int64_t at[AXIS_COUNT] = {c->config.start[0], c->config.start[1]};
    struct evaluate_arc arc;
    struct evaluate_tick tick;
    int64_t ticks = 0;

    takt_evaluate_arc_begin(&arc, &c->config);
    while (takt_evaluate_arc_next(&arc, &tick)) {
        ticks++;
        take(at, &tick);
        TEST_ASSERT_TRUE_MESSAGE(c->config.form == EVALUATE_IMPROVED || is_one_axis(&tick), shape);
        check_on_circle(at, c->radius);
    }
    TEST_ASSERT_EQUAL_INT64_MESSAGE(c->config.end[0], at[0], shape);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(c->config.end[1], at[1], shape);
    if (c->config.form == EVALUATE_IMPROVED)
        check_ticks(c, ticks);
}

static void test_no_arc_leaves_its_circle_by_a_step_and_its_end_is_exact(void)
{
    for (unsigned n = 0; n < shapes; n++) {
        struct arc_case c = random_arc(n, n % 100 == 0 ? 4.0 : 2.2);

        set_end(&c);
        name_arc("arc", n, &c);
        run_arc(&c);
    }
    (void)printf(
        "arcs: radially off by at most %.4f steps, ticks over the true way %.4f an octant\n",
        worst.radial, worst.ticks_over);
}

/* Helices */

/* Angle turned by a lattice point since the start, the one nearest to the expected. */
static double turned(const struct arc_case *c, const int64_t at[AXIS_COUNT],
                     const unsigned plane[2], double expected)
{
    double angle = takt_maths_atan2((double)at[plane[1]], (double)at[plane[0]]) - c->start_rad;

    angle *= c->config.clockwise ? -1.0 : 1.0;
    return angle + MATHS_TWO_PI * takt_maths_round((expected - angle) / MATHS_TWO_PI);
}

/*
 * Largest deviation of all coordinates from the helix at the place given; the arc's along it, and
 * straight axes.
 */
static double off_at(const struct arc_case *c, const int64_t at[AXIS_COUNT],
                     const unsigned plane[2], const int64_t delta[AXIS_COUNT], double part)
{
    double sweep = maths_abs(c->sweep_rad);
    double off = c->radius * maths_abs(turned(c, at, plane, part * sweep) - part * sweep);

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (i != plane[0] && i != plane[1])
            off = maths_max(off, maths_abs((double)at[i] - part * (double)delta[i]));
    }
    return off;
}

/*
 * The place with the least deviation: the largest of functions that rise on both sides of their
 * zero has one lowest.
 */
static double lowest_off(const struct arc_case *c, const int64_t at[AXIS_COUNT],
                         const unsigned plane[2], const int64_t delta[AXIS_COUNT], double part)
{
    double room = 3.0 / (c->radius * maths_abs(c->sweep_rad));
    double low = part - room, high = part + room;

    for (unsigned i = 0; i < 40; i++) {
        double third = (high - low) / 3.0;

        if (off_at(c, at, plane, delta, low + third) < off_at(c, at, plane, delta, high - third))
            high -= third;
        else
            low += third;
    }
    return off_at(c, at, plane, delta, low);
}

/*
 * There is a place on the helix from which no coordinate is off by more than a step. The arc's own
 * angle often is one.
 */
static void check_on_helix(const struct arc_case *c, const int64_t at[AXIS_COUNT],
                           const unsigned plane[2], const int64_t delta[AXIS_COUNT], double *part)
{
    const int64_t in_plane[2] = {at[plane[0]], at[plane[1]]};
    double sweep = maths_abs(c->sweep_rad);
    double off;

    *part = turned(c, at, plane, *part * sweep) / sweep;
    off = off_at(c, at, plane, delta, *part);
    if (off > 0.8)
        off = lowest_off(c, at, plane, delta, *part);
    raise_to(&worst.along, off);
    TEST_ASSERT_TRUE_MESSAGE(off <= 1.0 + ROOM, shape);
    check_on_circle(in_plane, c->radius);
}

static void run_helix(const struct arc_case *c, const unsigned plane[2],
                      const int64_t delta[AXIS_COUNT])
{
    int64_t at[AXIS_COUNT] = {0};
    struct evaluate_helix h;
    struct evaluate_tick tick;
    double part = 0;

    at[plane[0]] = c->config.start[0];
    at[plane[1]] = c->config.start[1];
    takt_evaluate_helix_begin(&h, &c->config, plane, delta);
    while (takt_evaluate_helix_next(&h, &tick)) {
        take(at, &tick);
        TEST_ASSERT_TRUE_MESSAGE(c->config.form == EVALUATE_IMPROVED || is_one_axis(&tick), shape);
        TEST_ASSERT_TRUE_MESSAGE(c->config.form == EVALUATE_IMPROVED || is_one_axis(&tick), shape);
        check_on_helix(c, at, plane, delta, &part);
    }
    TEST_ASSERT_EQUAL_INT64_MESSAGE(c->config.end[0], at[plane[0]], shape);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(c->config.end[1], at[plane[1]], shape);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (i != plane[0] && i != plane[1])
            TEST_ASSERT_EQUAL_INT64_MESSAGE(delta[i], at[i], shape);
    }
}

static void test_no_axis_of_a_helix_is_off_by_more_than_a_step_and_its_end_is_exact(void)
{
    for (unsigned n = 0; n < shapes; n++) {
        double decades = n % 1000 == 0 ? 4.0 : 1.8;
        struct arc_case c = random_arc(n, decades);
        int64_t delta[AXIS_COUNT] = {0};
        unsigned plane[2] = {random_below(AXIS_COUNT), 0};

        plane[1] = (plane[0] + 1 + random_below(AXIS_COUNT - 1)) % AXIS_COUNT;
        do {
            set_end(&c);
        } while (c.sweep_rad == 0.0);
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            if (i != plane[0] && i != plane[1] && random_between(0, 1) < 0.6)
                delta[i] = random_steps(decades + 0.3);
        }
        name_arc("helix", n, &c);
        run_helix(&c, plane, delta);
    }
    (void)printf(
        "helices: radially off by at most %.4f steps, along them and on straight axes %.4f\n",
        worst.radial, worst.along);
}

int main(int argc, char **argv)
{
    read_number(argc, argv, &shapes);
    UNITY_BEGIN();
    RUN_TEST(test_no_axis_of_a_line_is_off_by_a_step_and_its_end_is_exact);
    RUN_TEST(test_no_arc_leaves_its_circle_by_a_step_and_its_end_is_exact);
    RUN_TEST(test_no_axis_of_a_helix_is_off_by_more_than_a_step_and_its_end_is_exact);
    return UNITY_END();
}

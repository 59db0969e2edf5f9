/*
 * Digital integration on random circles and lines: what it really errs by, beside the bounds that
 * seed 002 gives. Every case is a fixed seed; a failure names it.
 */
#include "accuracy/bounds.h"
#include "base/maths.h"
#include "classic/integrate_line.h"
#include "classic/interpolator.h"

#include <stdio.h>
#include <string.h>
#include <unity.h>

#define CASES   10000
#define CYCLE_S 1e-3
#define UNIT_MM (1e-3 / 16777216) /* 24 bits behind the increment */

static uint64_t seed;
static char shape[200]; /* printed when a claim fails */

void setUp(void)
{
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static double random_decades(double from, double to)
{
    return takt_maths_power(10.0, random_between(from, to));
}

/* Rotation */

struct circle {
    double radius_mm;
    double angle_rad; /* of a step, > 0 */
    double sweep_rad; /* signed */
    unsigned steps;
};

static struct circle random_circle(unsigned n)
{
    double acceleration = random_decades(1, 4);
    struct circle c = {.radius_mm = random_decades(-1, 3)};

    /*
     * V^2 / R = a, or slower: dphi = V dt / R; at least 1e-3, below which rounding is all there is
     */
    c.angle_rad = maths_sqrt(acceleration / c.radius_mm) * CYCLE_S * random_between(0.2, 1);
    c.angle_rad = maths_clamp(c.angle_rad, 1e-3, 0.2);
    c.sweep_rad = random_between(0.1, 2 * MATHS_TWO_PI) * (random_between(0, 1) < 0.5 ? -1 : 1);
    c.steps = (unsigned)takt_maths_ceil(maths_abs(c.sweep_rad) / c.angle_rad);
    c.angle_rad = maths_abs(c.sweep_rad) / (double)c.steps;
    (void)snprintf(shape, sizeof shape, "circle %u: R %g mm, %g rad a step, %g rad", n, c.radius_mm,
                   c.angle_rad, c.sweep_rad);
    return c;
}

struct rotation_errors {
    double along_mm, contour_mm; /* at the end, signed: ahead and outwards */
};

static struct rotation_errors rotate_round(const struct circle *c, double quantum_rad)
{
    double signed_angle = c->sweep_rad < 0 ? -c->angle_rad : c->angle_rad;
    double start = random_between(-MATHS_PI, MATHS_PI);
    struct rotation_errors errors;
    struct rotate r;
    double sine, cosine, ahead;

    takt_maths_sincos(start, &sine, &cosine);
    takt_rotate_begin(&r, c->radius_mm * cosine, c->radius_mm * sine, quantum_rad);
    for (unsigned i = 0; i < c->steps; i++)
        (void)takt_rotate_step(&r, signed_angle);
    ahead = takt_maths_atan2(r.b, r.a) - start - c->sweep_rad;
    ahead -= MATHS_TWO_PI * takt_maths_round(ahead / MATHS_TWO_PI);
    errors.along_mm = c->radius_mm * (c->sweep_rad < 0 ? -ahead : ahead);
    errors.contour_mm = maths_sqrt(r.a * r.a + r.b * r.b) - c->radius_mm;
    return errors;
}

/*
 * What rounding of doubles adds: an ulp of the radius a step, and of the angles that are compared.
 */
static double rounding_mm(const struct circle *c)
{
    return 2.3e-16 * c->radius_mm * ((double)c->steps + 20);
}

static void test_rotation_errs_by_less_than_its_bounds_along_and_across_the_circle(void)
{
    double along = 0, across = 0, page = 0;
    double least_along = 1, least_across = 1;

    for (unsigned n = 0; n < CASES; n++) {
        struct circle c = random_circle(n);
        struct rotation_errors errors = rotate_round(&c, 0);
        double room = rounding_mm(&c);
        double along_bound = takt_bounds_rotation_along_mm(c.radius_mm, c.angle_rad, c.sweep_rad);
        double across_bound = takt_bounds_rotation_growth_mm(c.radius_mm, c.angle_rad, c.sweep_rad);
        double across_page = c.radius_mm * (double)c.steps * c.angle_rad * c.angle_rad *
                             c.angle_rad * c.angle_rad / 8;

        TEST_ASSERT_TRUE_MESSAGE(errors.along_mm > 0 && errors.along_mm <= along_bound + room,
                                 shape);
        TEST_ASSERT_TRUE_MESSAGE(maths_abs(errors.contour_mm) <= across_bound + room, shape);
        along = maths_max(along, (errors.along_mm - room) / along_bound);
        across = maths_max(across, (errors.contour_mm - room) / across_bound);
        page = maths_max(page, (errors.contour_mm - room) / across_page);
        if (along_bound > 1000 * room)
            least_along = maths_min(least_along, errors.along_mm / along_bound);
        if (across_bound > 1000 * room)
            least_across = maths_min(least_across, errors.contour_mm / across_bound);
    }
    (void)printf(
        "rotation, %d arcs: along %.4f ... %.6f of N R dphi^3 / 6, across %.4f ... %.6f of the "
        "bound (%.6f of N R dphi^4 / 8)\n",
        CASES, least_along, along, least_across, across, page);
    /*
     * The page's figure for the growth is the first term of a series: over a turn it is exceeded,
     * by a little.
     */
    TEST_ASSERT_TRUE(page > 1.0 && page < 1.01);
}

static void test_a_turn_within_an_acceleration_errs_by_less_than_a_third_of_pi_a_dt_squared(void)
{
    for (unsigned n = 0; n < 38; n++) {
        double radius = 0.05 * takt_maths_power(1.3, n);
        double speed = maths_sqrt(1000.0 * radius);
        struct circle c = {radius, speed * CYCLE_S / radius, MATHS_TWO_PI, 0};

        c.steps = (unsigned)takt_maths_ceil(MATHS_TWO_PI / c.angle_rad);
        c.angle_rad = MATHS_TWO_PI / (double)c.steps;
        (void)snprintf(shape, sizeof shape, "R %g", radius);
        TEST_ASSERT_TRUE_MESSAGE(rotate_round(&c, 0).along_mm <=
                                     takt_bounds_rotation_turn_mm(1000.0, CYCLE_S) +
                                         rounding_mm(&c),
                                 shape);
    }
}

/* With angles of few bits the contour stays what it is; only the length of single steps changes. */
static void test_few_bits_of_the_angle_cost_evenness_and_no_contour(void)
{
    for (unsigned bits = 6; bits <= 8; bits++) {
        for (unsigned n = 0; n < 500; n++) {
            struct circle c = random_circle(n);
            /* The largest angle of the word is at least that of the step. */
            double quantum = c.angle_rad / (double)(1U << (bits - 1)) * random_between(0.5, 1);
            double fine =
                takt_bounds_rotation_growth_mm(c.radius_mm, c.angle_rad + quantum, c.sweep_rad);
            struct rotation_errors errors = rotate_round(&c, quantum);
            double room = rounding_mm(&c) + fine * quantum / maths_abs(c.sweep_rad);

            TEST_ASSERT_TRUE_MESSAGE(errors.contour_mm <= fine + room, shape);
            TEST_ASSERT_TRUE_MESSAGE(
                maths_abs(errors.along_mm) <=
                    takt_bounds_rotation_along_mm(c.radius_mm, c.angle_rad + quantum, c.sweep_rad) +
                        0.5 * c.radius_mm * quantum + rounding_mm(&c),
                shape);
        }
    }
}

/* Lines */

struct line_case {
    struct integrate_line_config config;
    struct point start, end;
};

static struct line_case random_line(unsigned n)
{
    struct line_case c = {.config = {.unit_mm = UNIT_MM}};
    double square = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        c.start.at[i] = random_between(-100, 100);
        c.end.at[i] = c.start.at[i] + random_between(-20, 20);
        square += (c.end.at[i] - c.start.at[i]) * (c.end.at[i] - c.start.at[i]);
    }
    c.config.length_mm = maths_sqrt(square);
    c.config.feed_mm = random_between(1, 100) * CYCLE_S;
    c.config.acceleration_mm = random_decades(2, 3.5) * CYCLE_S * CYCLE_S;
    c.config.start_mm = n % 3 == 0 ? 0 : random_between(0, 0.2) * c.config.feed_mm;
    c.config.end_shift = 3 + n % 3;
    c.config.end_mm = n % 2 == 0 ? 0 : random_between(0.2, 0.5) * c.config.feed_mm;
    (void)snprintf(shape, sizeof shape, "line %u: %g mm, feed %g, end %g, a %g", n,
                   c.config.length_mm, c.config.feed_mm, c.config.end_mm, c.config.acceleration_mm);
    return c;
}

/* Distance from the line of a way done, mm. */
static double off_line(const struct line_case *c, const struct point *way)
{
    double along = 0, square = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        along += way->at[i] * (c->end.at[i] - c->start.at[i]) / c->config.length_mm;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        double off = way->at[i] - along * (c->end.at[i] - c->start.at[i]) / c->config.length_mm;

        square += off * off;
    }
    return maths_sqrt(square);
}

static double length_of(const struct point *p)
{
    double square = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        square += p->at[i] * p->at[i];
    return maths_sqrt(square);
}

static struct {
    double off_ratio; /* of the truncation bound */
    double jump_mm;   /* beyond acceleration: change of way per cycle while the end rule acts */
    double slowest[INTERPOLATOR_END_SHIFT_MAX + 1]; /* way in an aimed cycle, of V_end, by k */
    double fastest;
    unsigned aimed;
} lines;

/*
 * While the end rule acts: V_end (N - 1) / N < V <= V_end, but for what truncation has taken from
 * each axis's way.
 */
static void check_aimed(const struct line_case *c, double way_mm, double loss_ulp)
{
    double ratio = way_mm / c->config.end_mm;
    double cycles = (double)(1U << c->config.end_shift);
    double room =
        maths_sqrt(AXIS_COUNT) * (loss_ulp + 40) * c->config.unit_mm / (cycles * c->config.end_mm);

    lines.slowest[c->config.end_shift] = maths_min(lines.slowest[c->config.end_shift], ratio);
    lines.fastest = maths_max(lines.fastest, ratio);
    TEST_ASSERT_TRUE_MESSAGE(ratio > (cycles - 1.0) / cycles - room && ratio <= 1 + room, shape);
}

static void run_line(const struct line_case *c)
{
    struct integrate_line line;
    struct point way, before = {{0}}, step;
    double feed = c->config.start_mm, loss_mm = 0;

    takt_integrate_line_begin(&line, &c->config, &c->start, &c->end);
    while (takt_integrate_line_cycle(&line)) {
        double bound = maths_sqrt(AXIS_COUNT) * (line.axes.loss_ulp + 1) * c->config.unit_mm;

        loss_mm = maths_max(loss_mm, bound);
        takt_integrate_get_way(&line.axes, &way);
        for (unsigned i = 0; i < AXIS_COUNT; i++)
            step.at[i] = way.at[i] - before.at[i];
        before = way;
        TEST_ASSERT_TRUE_MESSAGE(off_line(c, &way) <= bound, shape);
        lines.off_ratio = maths_max(lines.off_ratio, off_line(c, &way) / bound);
        if (line.phase == INTEGRATE_AIMED && line.aimed_cycles > 0)
            check_aimed(c, length_of(&step), line.axes.loss_ulp);
        lines.aimed += line.phase == INTEGRATE_AIMED ? 1 : 0;
        /* The last step also makes good what truncation has taken. */
        TEST_ASSERT_TRUE_MESSAGE(length_of(&step) <= c->config.feed_mm + loss_mm, shape);
        if (line.phase != INTEGRATE_LANDED)
            lines.jump_mm = maths_max(
                lines.jump_mm, maths_abs(length_of(&step) - feed) - c->config.acceleration_mm -
                                   c->config.end_mm / (double)(1U << c->config.end_shift));
        feed = length_of(&step);
    }
    TEST_ASSERT_EQUAL_MEMORY_MESSAGE(line.axes.end, line.axes.position, sizeof line.axes.end,
                                     shape);
}

static void test_lines_stay_straight_within_truncation_and_end_exactly_without_a_jump(void)
{
    for (unsigned k = 0; k <= INTERPOLATOR_END_SHIFT_MAX; k++)
        lines.slowest[k] = 1;
    for (unsigned n = 0; n < CASES; n++) {
        struct line_case c = random_line(n);

        run_line(&c);
    }
    (void)printf("integration, %d lines: off by at most %.3f of the truncation bound\n", CASES,
                 lines.off_ratio);
    for (unsigned k = 3; k <= 5; k++)
        (void)printf("k = %u: at the end %.4f ... %.4f of V_end (rule: %.4f ... 1)\n", k,
                     lines.slowest[k], lines.fastest, 1 - 1.0 / (double)(1U << k));
    TEST_ASSERT_TRUE(lines.aimed > 1000);
    TEST_ASSERT_TRUE(lines.jump_mm < 1e-4);
}

/*
 * Words with few bits, in which a cycle's acceleration or the feed itself is less than the last
 * one: every line still ends.
 */
static void test_lines_in_short_words_end_too(void)
{
    for (unsigned n = 0; n < 300; n++) {
        struct line_case c = random_line(n);
        struct integrate_line line;
        unsigned cycles = 0;

        c.config.unit_mm = random_decades(-5, 1);
        takt_integrate_line_begin(&line, &c.config, &c.start, &c.end);
        while (takt_integrate_line_cycle(&line) && cycles < 1000000)
            cycles++;
        TEST_ASSERT_TRUE_MESSAGE(cycles < 1000000, shape);
        TEST_ASSERT_EQUAL_MEMORY_MESSAGE(line.axes.end, line.axes.position, sizeof line.axes.end,
                                         shape);
    }
}

/* The least power of two times the increment with which the range fits into a signed word. */
static void test_a_word_of_m_bits_counts_the_whole_range(void)
{
    for (unsigned n = 0; n < 2000; n++) {
        const double increment = random_decades(-9, 0), range = random_decades(-3, 6);
        const unsigned bits = INTERPOLATOR_WORD_BITS_MIN +
                              (unsigned)random_between(0, INTERPOLATOR_WORD_BITS_MAX -
                                                              INTERPOLATOR_WORD_BITS_MIN + 1);
        const double unit = takt_interpolator_unit_mm(increment, range, bits);
        const double most = takt_maths_power(2.0, (double)bits - 1.0);

        TEST_ASSERT_TRUE(range < unit * most * (1 + 1e-12));
        TEST_ASSERT_TRUE(range >= 0.5 * unit * most * (1 - 1e-12));
    }
    TEST_ASSERT_TRUE(takt_interpolator_unit_mm(1e-3, 1000, INTERPOLATOR_WORD_BITS) ==
                     0x1p-32 * 1e-3);
    TEST_ASSERT_TRUE(takt_interpolator_unit_mm(1e-3, 1000, 16) == 32e-3);
}

/*
 * The interpolators behind a planner's feed: an S-curve from rest to a feed and, one time in two,
 * back to rest.
 */

static double takt_s_curve(double part, bool stops)
{
    /* s = t^3 (10 - 15 t + 6 t^2) rests at both ends; its first half ends at full feed */
    double t = stops ? part : 0.5 * part;
    double s = t * t * t * (10 - 15 * t + 6 * t * t);

    return stops ? s : 2 * s;
}

static void run_behind_feed(struct interpolator *i, const struct curve *curve, uint32_t block,
                            bool stops)
{
    unsigned cycles = (unsigned)takt_maths_ceil(curve->length_mm * 40);

    for (unsigned k = 1; k <= cycles; k++) {
        double part = takt_s_curve((double)k / (double)cycles, stops);
        struct point cmd;
        bool landed = k == cycles;

        if (landed)
            cmd = curve->end;
        else
            takt_curve_point(curve, part * curve->length_mm, &cmd);
        takt_interpolator_cycle(i, curve, block, landed, &cmd);
        TEST_ASSERT_TRUE_MESSAGE(!landed || point_is_same(&cmd, &curve->end), shape);
    }
}

static bool random_curve(struct curve *curve, enum interpolator_kind kind)
{
    struct point start, end;
    double centre[2] = {random_between(-20, 20), random_between(-20, 20)};
    double sine, cosine;
    double radius = random_decades(-0.5, 1);

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        start.at[i] = random_between(-20, 20);
        end.at[i] = start.at[i] + random_between(-5, 5);
    }
    if (kind == INTERPOLATOR_INTEGRATE)
        return takt_curve_set_line(curve, &start, &end);
    takt_maths_sincos(random_between(0, MATHS_TWO_PI), &sine, &cosine);
    start.at[AXIS_X] = end.at[AXIS_X] = centre[0] + radius * cosine;
    start.at[AXIS_Y] = end.at[AXIS_Y] = centre[1] + radius * sine;
    return takt_curve_set_arc(curve, &start, &end, PLANE_XY, centre, random_between(0, 1) < 0.5, 1);
}

static void check_behind_feed(enum interpolator_kind kind, const char *name)
{
    const struct interpolator_config config = {
        .kind = kind, .end_shift = INTEGRATE_END_SHIFT, .unit_mm = 0x1p-32 * 1e-3};
    double along = 0, contour = 0;

    for (unsigned n = 0; n < 300; n++) {
        struct interpolator i;
        const struct interpolator_errors *errors;
        struct curve curve;

        (void)snprintf(shape, sizeof shape, "%s %u", name, n);
        TEST_ASSERT_TRUE_MESSAGE(random_curve(&curve, kind), shape);
        takt_interpolator_init(&i, &config);
        run_behind_feed(&i, &curve, 1, n % 2 == 0);
        errors = takt_interpolator_get_errors(&i);
        TEST_ASSERT_TRUE_MESSAGE(errors->along_bound_mm > 0, shape);
        TEST_ASSERT_TRUE_MESSAGE(errors->along_mm <= errors->along_bound_mm * 1.0001 + 1e-12,
                                 shape);
        TEST_ASSERT_TRUE_MESSAGE(errors->contour_mm <= errors->contour_bound_mm + 1e-12, shape);
        along = maths_max(along, errors->along_mm / errors->along_bound_mm);
        contour = maths_max(contour, errors->contour_mm);
    }
    (void)printf("%s behind an S-curve: %.4f of the bound along, contour %.2g mm\n", name, along,
                 contour);
}

static void test_integrate_behind_a_planned_feed_errs_by_less_than_its_bound(void)
{
    check_behind_feed(INTERPOLATOR_INTEGRATE, "integrate");
}

static void test_rotate_behind_a_planned_feed_errs_by_less_than_its_bound(void)
{
    check_behind_feed(INTERPOLATOR_ROTATE, "rotate");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_rotation_errs_by_less_than_its_bounds_along_and_across_the_circle);
    RUN_TEST(test_a_turn_within_an_acceleration_errs_by_less_than_a_third_of_pi_a_dt_squared);
    RUN_TEST(test_few_bits_of_the_angle_cost_evenness_and_no_contour);
    RUN_TEST(test_lines_stay_straight_within_truncation_and_end_exactly_without_a_jump);
    RUN_TEST(test_lines_in_short_words_end_too);
    RUN_TEST(test_a_word_of_m_bits_counts_the_whole_range);
    RUN_TEST(test_integrate_behind_a_planned_feed_errs_by_less_than_its_bound);
    RUN_TEST(test_rotate_behind_a_planned_feed_errs_by_less_than_its_bound);
    return UNITY_END();
}

/*
 * Compensated involutes verified by geometry: random contours of a line, an involute and a line,
 * the tool on either side. Every point of the tool's path must be at the tool's radius from the
 * programmed path and nowhere nearer. The nearest point of the programmed involute is looked for
 * along it, step by step: no formula of the room offset is used.
 */
#include "cutter_compensation/cutter_compensation.h"

#include "base/maths.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unity.h>

#define CONTOURS 600
#define TEXT_MAX 2048
#define EXACT_MM 1e-9
/* A blunt outer corner, which has one point instead of an arc, stands off by so much more. */
#define BLUNT_MM (COMPENSATION_BLUNT_MM + EXACT_MM)
#define SAMPLES  60
/* Steps along the programmed involute in search of the nearest point. */
#define STEPS 500

/* The programmed path: from a point along a line, then the involute, then a line to a point. */
struct contour {
    double begin[2], end[2];
    double r, from_rad, to_rad, turned_rad, hand; /* of the involute, about the origin */
    double radius;                                /* of the tool */
    bool left;
};

static struct contour contour;
static char text[TEXT_MAX];
static uint64_t seed;

static struct program program;
static struct parameters parameters;
static struct cutter_compensation offset;
static struct source_text source_text;

void setUp(void)
{
}

void tearDown(void)
{
}

static double random_between(double low, double high)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

static void takt_involute_point(double phi, double p[2])
{
    const double t = contour.turned_rad + contour.hand * phi;

    p[0] = contour.r * (cos(t) + contour.hand * phi * sin(t));
    p[1] = contour.r * (sin(t) - contour.hand * phi * cos(t));
}

/* From the point of the involute at phi, turned by a corner from its direction, so far. */
static void beyond(double phi, double corner_rad, double length, double p[2])
{
    const double t = contour.turned_rad + contour.hand * phi + corner_rad;

    takt_involute_point(phi, p);
    p[0] += length * cos(t);
    p[1] += length * sin(t);
}

static void make_contour(uint64_t contour_seed)
{
    seed = contour_seed;
    contour.r = random_between(1.0, 6.0);
    contour.hand = random_between(0, 1) < 0.5 ? 1.0 : -1.0;
    contour.turned_rad = random_between(-3.0, 3.0);
    contour.radius = random_between(0.2, 2.0);
    contour.left = random_between(0, 1) < 0.5;
    const double low = random_between(0.0, 4.0);
    const double high = low + random_between(0.3, 2.5);
    const bool outward = random_between(0, 1) < 0.5;
    const double way = outward ? 1.0 : -1.0;

    contour.from_rad = outward ? low : high;
    contour.to_rad = outward ? high : low;
    beyond(contour.from_rad, random_between(-0.8, 0.8), -way * 12.0, contour.begin);
    beyond(contour.to_rad, random_between(-0.8, 0.8), way * 12.0, contour.end);
}

static void write_program(void)
{
    const bool outward = contour.to_rad > contour.from_rad;
    const bool clockwise = outward == (contour.hand < 0.0);
    double a[2], b[2], entry[2];
    int length;

    takt_involute_point(contour.from_rad, a);
    takt_involute_point(contour.to_rad, b);
    for (unsigned i = 0; i < 2; i++) {
        entry[i] = contour.begin[i] + (contour.begin[i] - a[i]) / 2.0;
    }
    length =
        snprintf(text, sizeof text,
                 "G21 G17 F1000\nG0 X%.13f Y%.13f\nG4%d.1 D%.13f\nG1 X%.13f Y%.13f\nX%.13f Y%.13f\n"
                 "G%d.2 X%.13f Y%.13f I%.13f J%.13f R%.13f\nG1 X%.13f Y%.13f\nM2\n",
                 entry[0], entry[1], contour.left ? 1 : 2, 2.0 * contour.radius, contour.begin[0],
                 contour.begin[1], a[0], a[1], clockwise ? 2 : 3, b[0], b[1], -a[0], -a[1],
                 contour.r, contour.end[0], contour.end[1]);
    TEST_ASSERT_TRUE(length > 0 && (size_t)length < sizeof text);
}

static void open_program(void)
{
    struct program_config config = {.axes = 7U, .parameters = &parameters};
    struct source source;

    for (unsigned i = 0; i < 3; i++) {
        config.travel_min[i] = -1e6;
        config.travel_max[i] = 1e6;
    }
    takt_parameters_clear(&parameters);
    takt_source_open_text(&source, &source_text, text, strlen(text));
    takt_program_open(&program, &config, &source);
    takt_cutter_compensation_open(&offset, &config);
}

static double line_distance(const double a[2], const double b[2], const double q[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    const double f = fmin(1.0, fmax(0.0, ((q[0] - a[0]) * d[0] + (q[1] - a[1]) * d[1]) /
                                             (d[0] * d[0] + d[1] * d[1])));

    return hypot(q[0] - a[0] - f * d[0], q[1] - a[1] - f * d[1]);
}

static double distance_at(double phi, const double q[2])
{
    double p[2];

    takt_involute_point(phi, p);
    return hypot(q[0] - p[0], q[1] - p[1]);
}

/* The best of STEPS places, and then the golden section around it. */
static double involute_distance(const double q[2])
{
    const double step = (contour.to_rad - contour.from_rad) / STEPS;
    int best = 0;

    for (int i = 1; i <= STEPS; i++) {
        if (distance_at(contour.from_rad + i * step, q) <
            distance_at(contour.from_rad + best * step, q)) {
            best = i;
        }
    }
    double low = contour.from_rad + fmax(0, best - 1) * step;
    double high = contour.from_rad + fmin(STEPS, best + 1) * step;

    for (int i = 0; i < 60; i++) {
        const double a = high - 0.61803398874989485 * (high - low);
        const double b = low + 0.61803398874989485 * (high - low);

        if (distance_at(a, q) < distance_at(b, q)) {
            high = b;
        } else {
            low = a;
        }
    }
    return fmin(distance_at(0.5 * (low + high), q),
                fmin(distance_at(contour.from_rad, q), distance_at(contour.to_rad, q)));
}

static double wanted_distance(const double q[2])
{
    double a[2], b[2];

    takt_involute_point(contour.from_rad, a);
    takt_involute_point(contour.to_rad, b);
    return fmin(involute_distance(q),
                fmin(line_distance(contour.begin, a, q), line_distance(b, contour.end, q)));
}

static struct {
    double nearest, farthest; /* of the tool's path from the programmed one, beside the radius */
    unsigned involutes;
} seen;

static void verify_move(const struct move *m, const struct point *start)
{
    struct curve c;

    if (!takt_move_curve(m, start, &c)) {
        return;
    }
    seen.involutes += move_is_involute(m) ? 1 : 0;
    for (int i = 0; i <= SAMPLES; i++) {
        struct point p;

        takt_curve_point(&c, c.length_mm * i / SAMPLES, &p);
        const double off = wanted_distance((double[2]){p.at[0], p.at[1]}) - contour.radius;

        seen.nearest = fmin(seen.nearest, off);
        seen.farthest = fmax(seen.farthest, off);
    }
}

/* False: the contour is refused. */
static bool run_contour(void)
{
    struct diagnostic d;
    struct point at = {{0}};
    struct move m;
    enum program_result result;
    unsigned motions = 0;

    memset(&seen, 0, sizeof seen);
    open_program();
    while ((result = takt_cutter_compensation_next(&offset, &program, &m, &d)) == PROGRAM_MOVE) {
        if (!move_is_motion(&m)) {
            continue;
        }
        if (++motions > 2) { /* the rapid, and the way from it */
            verify_move(&m, &at);
        }
        at = m.end;
    }
    if (result == PROGRAM_ERROR) {
        TEST_ASSERT_TRUE(d.code == TAKT_ERROR_OFFSET_ARC_SMALL ||
                         d.code == TAKT_ERROR_OFFSET_GOUGE);
    }
    return result != PROGRAM_ERROR;
}

static void test_the_tool_stays_at_its_radius(void)
{
    unsigned refused = 0;
    unsigned followed = 0;

    for (unsigned i = 1; i <= CONTOURS; i++) {
        char where[3000];

        make_contour(i);
        write_program();
        if (!run_contour()) {
            refused++;
            continue;
        }
        followed += seen.involutes > 0 ? 1 : 0;
        (void)snprintf(where, sizeof where, "contour %u: %g nearer, %g farther\n%s", i,
                       -seen.nearest, seen.farthest, text);
        TEST_ASSERT_TRUE_MESSAGE(seen.nearest >= -EXACT_MM, where);
        TEST_ASSERT_TRUE_MESSAGE(seen.farthest <= BLUNT_MM, where);
    }
    (void)printf("%u of %d contours refused, %u with an involute\n", refused, CONTOURS, followed);
    TEST_ASSERT_TRUE(followed > CONTOURS / 2);
}

/*
 * Inside, where the involute is sharper than the tool, there is no way: an arc is not left out
 * either.
 */
static void test_a_tool_larger_than_the_radius_of_curvature_is_refused(void)
{
    unsigned refused = 0;

    for (unsigned i = 1; i <= CONTOURS; i++) {
        make_contour(i);
        const double sharpest = contour.r * fmin(contour.from_rad, contour.to_rad);
        const bool outward = contour.to_rad > contour.from_rad;
        const bool inside = contour.left == (outward == (contour.hand > 0.0));

        write_program();
        if (inside && sharpest <= contour.radius) {
            TEST_ASSERT_FALSE(run_contour());
            refused++;
        }
    }
    TEST_ASSERT_TRUE(refused > 20);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_tool_stays_at_its_radius);
    RUN_TEST(test_a_tool_larger_than_the_radius_of_curvature_is_refused);
    return UNITY_END();
}

/*
 * Errors of units, composed: random machines of three chains. Verified by a model of its own: rigid
 * bodies with whole rotation matrices, multiplied from the bed to the tool and from the bed to the
 * part.
 */
#include "base/maths.h"
#include "correction/correction.h"
#include "unity.h"

#include <math.h>
#include <string.h>

#define POINTS  10000
#define KNOTS   37
#define CYCLE_S 0.001

static const double travel_mm[AXIS_COUNT] = {220, 160, 180, MATHS_PI, MATHS_PI, MATHS_PI};

/* The units as written from the tool to the part. */
static const struct unit_chain chains[] = {
    {.units = 3, .tool_units = 3, .axis = {AXIS_Z, AXIS_Y, AXIS_X}},
    {.units = 4, .tool_units = 1, .axis = {AXIS_Y, AXIS_Z, AXIS_X, AXIS_B}},
    {.units = 4, .tool_units = 2, .axis = {AXIS_Z, AXIS_Y, AXIS_X, AXIS_C}},
};

#define CHAINS (sizeof chains / sizeof chains[0])

/* e(x) = linear x + bow x x + sine sin(k x + phase), x in travels */
struct error_curve {
    double linear, bow, sine, wave, phase;
};

static struct error_curve curves[UNIT_CHAIN_MAX][6];
static struct geometry geometry;
static struct correction_tables tables;
static struct correction_settings settings;
static struct correction c;
static struct table table;
static struct move move;
static struct diagnostic wrong;
static uint64_t state;

void setUp(void)
{
    takt_geometry_init(&geometry);
    memset(&tables, 0, sizeof tables);
    memset(&move, 0, sizeof move);
    takt_correction_settings_set_default(&settings);
    move.kind = MOVE_FEED;
    tables.geometry = &geometry;
    state = UINT64_C(0x9E3779B97F4A7C15);
}

void tearDown(void)
{
}

static double between(double low, double high)
{
    state ^= state >> 12;
    state ^= state << 25;
    state ^= state >> 27;
    return low + (high - low) * (double)((state * UINT64_C(0x2545F4914F6CDD1D)) >> 11) * 0x1p-53;
}

/* Its size on a log scale: 0.1 to 20, either sign. */
static double any_size(void)
{
    return (between(0, 1) < 0.5 ? -1 : 1) * 0.1 * pow(200, between(0, 1));
}

static double value_of(const struct error_curve *e, unsigned axis, double x)
{
    const double s = x / travel_mm[axis];

    return e->linear * s + e->bow * s * s + e->sine * sin(e->wave * s + e->phase);
}

static void make_unit(unsigned unit, unsigned axis)
{
    memset(&table, 0, sizeof table);
    table.errors = true;
    table.inputs = 1;
    table.input[0] = (uint8_t)axis;
    table.outputs = 6;
    table.knots[0] = KNOTS;
    for (unsigned i = 0; i < 6; i++) {
        table.output[i] = (struct table_output){(uint8_t)i, TABLE_BOTH};
        curves[unit][i] =
            (struct error_curve){any_size(), any_size(), any_size(), between(1, 6), between(0, 6)};
    }
    for (unsigned k = 0; k < KNOTS; k++) {
        const double x = travel_mm[axis] * (2.0 * k / (KNOTS - 1) - 1.0);

        table.knot_mm[0][k] = x;
        for (unsigned i = 0; i < 6; i++)
            table.value_mm[6 * k + i] =
                (float)(value_of(&curves[unit][i], axis, x) * (i < 3 ? 1e-3 : 1e-6));
    }
    TEST_ASSERT_TRUE(takt_geometry_add(&geometry, &table, &wrong));
}

static void make_machine(const struct unit_chain *chain)
{
    takt_geometry_init(&geometry);
    geometry.chain = *chain;
    for (unsigned i = 0; i < 3; i++) {
        geometry.tool_mm[i] = between(-100, 100);
        geometry.centre_mm[i] = between(-100, 100);
        geometry.squareness_rad[i] = 1e-6 * 4 * any_size();
    }
    for (unsigned u = 0; u < chain->units; u++)
        make_unit(u, chain->axis[u]);
    takt_correction_init(&c, &settings, 0x3F, CYCLE_S, &tables, &(struct point){{0}});
    for (int i = 0; i < 6000; i++) {
        const struct point at = {{0}};
        struct point set;

        takt_correction_cycle(&c, &at, &move, &set);
    }
}

/* ---- the model: p -> m p + t ---- */

struct body {
    double m[3][3], t[3];
};

static struct body times(const struct body *a, const struct body *b)
{
    struct body r = *a;

    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            r.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
        r.t[i] = a->t[i] + a->m[i][0] * b->t[0] + a->m[i][1] * b->t[1] + a->m[i][2] * b->t[2];
    }
    return r;
}

static struct body at_rest(void)
{
    return (struct body){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
}

static struct body shifted(double x, double y, double z)
{
    struct body b = at_rest();

    b.t[0] = x;
    b.t[1] = y;
    b.t[2] = z;
    return b;
}

static struct body turned(int about, double angle)
{
    const int j = (about + 1) % 3, k = (about + 2) % 3;
    struct body b = at_rest();

    b.m[j][j] = b.m[k][k] = cos(angle);
    b.m[j][k] = -sin(angle);
    b.m[k][j] = sin(angle);
    return b;
}

static struct body small(const double e[6])
{
    const struct body s = shifted(e[0], e[1], e[2]), x = turned(0, e[3]), y = turned(1, e[4]),
                      z = turned(2, e[5]);
    const struct body sx = times(&s, &x), yz = times(&y, &z);

    return times(&sx, &yz);
}

/* Where the guide of a leaning axis leads. */
static struct body led(unsigned axis, double x, const double squareness[3])
{
    return shifted(axis == AXIS_X   ? x
                   : axis == AXIS_Y ? -squareness[0] * x
                                    : squareness[1] * x,
                   axis == AXIS_Y   ? x
                   : axis == AXIS_Z ? -squareness[2] * x
                                    : 0,
                   axis == AXIS_Z ? x : 0);
}

/* The pose of a unit on what it stands on. perfect: without errors. */
static struct body pose(unsigned u, double x, bool perfect)
{
    const unsigned axis = geometry.chain.axis[u];
    const double square[3] = {perfect ? 0 : geometry.squareness_rad[0],
                              perfect ? 0 : geometry.squareness_rad[1],
                              perfect ? 0 : geometry.squareness_rad[2]};
    double e[6];

    for (unsigned i = 0; i < 6; i++)
        e[i] = perfect ? 0 : value_of(&curves[u][i], axis, x) * (i < 3 ? 1e-3 : 1e-6);
    if (axis < AXIS_LINEAR_COUNT) {
        const struct body way = led(axis, u < geometry.chain.tool_units ? x : -x, square);
        const struct body off = small(e);

        return times(&way, &off);
    }
    const double *q = geometry.centre_mm, *l = geometry.tool_mm;
    const struct body to = shifted(q[0] + l[0], q[1] + l[1], q[2] + l[2]);
    const struct body back = shifted(-q[0] - l[0], -q[1] - l[1], -q[2] - l[2]);
    const double own = e[axis];

    e[axis] = 0;
    const struct body off = small(e), turn = turned((int)axis - 3, x + own);
    const struct body a = times(&to, &off), b = times(&turn, &back);

    return times(&a, &b);
}

/* The tool's point on the part. */
static void tool_on_part(const struct point *set, bool perfect, double p[3])
{
    struct body tool = at_rest(), part = at_rest();

    for (unsigned u = geometry.chain.tool_units; u-- > 0;) {
        const struct body b = pose(u, set->at[geometry.chain.axis[u]], perfect);

        tool = times(&tool, &b);
    }
    for (unsigned u = geometry.chain.tool_units; u < geometry.chain.units; u++) {
        const struct body b = pose(u, set->at[geometry.chain.axis[u]], perfect);

        part = times(&part, &b);
    }
    const struct body tip = shifted(geometry.tool_mm[0], geometry.tool_mm[1], geometry.tool_mm[2]);
    const struct body end = times(&tool, &tip);

    for (int i = 0; i < 3; i++)
        p[i] = part.m[0][i] * (end.t[0] - part.t[0]) + part.m[1][i] * (end.t[1] - part.t[1]) +
               part.m[2][i] * (end.t[2] - part.t[2]);
}

static double distance_um(const struct point *cmd, const struct point *set)
{
    double is[3], wanted[3];

    tool_on_part(cmd, true, wanted);
    tool_on_part(set, false, is);
    return 1e3 * sqrt((is[0] - wanted[0]) * (is[0] - wanted[0]) +
                      (is[1] - wanted[1]) * (is[1] - wanted[1]) +
                      (is[2] - wanted[2]) * (is[2] - wanted[2]));
}

static struct point any_point(void)
{
    struct point at = {{0}};

    for (unsigned u = 0; u < geometry.chain.units; u++) {
        const unsigned axis = geometry.chain.axis[u];

        at.at[axis] = between(-travel_mm[axis], travel_mm[axis]);
    }
    return at;
}

/* ---- the claims ---- */

static void test_random_machines_are_corrected_within_a_micrometre_at_10000_points(void)
{
    for (unsigned m = 0; m < CHAINS; m++) {
        double before = 0, after = 0;

        make_machine(&chains[m]);
        for (int i = 0; i < POINTS; i++) {
            const struct point at = any_point();
            struct point set;

            takt_correction_cycle(&c, &at, &move, &set);
            before = fmax(before, distance_um(&at, &at));
            after = fmax(after, distance_um(&at, &set));
        }
        printf("chain %u: um off uncorrected %.2f, corrected %.4f\n", m, before, after);
        TEST_ASSERT_TRUE(before > 30);
        TEST_ASSERT_TRUE(after < 1);
    }
}

static void test_the_turning_unit_is_turned_back_by_its_own_axis(void)
{
    make_machine(&chains[1]);
    for (int i = 0; i < 100; i++) {
        const struct point at = any_point();
        struct point set;

        takt_correction_cycle(&c, &at, &move, &set);
        TEST_ASSERT_DOUBLE_WITHIN(1e-8, -1e-6 * value_of(&curves[3][4], AXIS_B, at.at[AXIS_B]),
                                  set.at[AXIS_B] - at.at[AXIS_B]);
    }
}

/* Sines of every axis: their derivatives are known, and so is what they may make of K. */
static void test_corrections_take_no_more_of_the_axes_than_was_reserved_for_them(void)
{
    for (unsigned m = 0; m < CHAINS; m++) {
        struct motion_bound most = {{0}, {0}, {0}, {0}};
        double rate[AXIS_COUNT], k[4][AXIS_COUNT] = {{0}};
        struct need need;

        make_machine(&chains[m]);
        for (unsigned i = 0; i < AXIS_COUNT; i++) {
            rate[i] = between(1, 4);
            most.farthest_mm[i] = travel_mm[i];
            most.velocity_mm_s[i] = travel_mm[i] * rate[i];
            most.acceleration_mm_s2[i] = most.velocity_mm_s[i] * rate[i];
            most.jerk_mm_s3[i] = most.acceleration_mm_s2[i] * rate[i];
        }
        takt_correction_get_need(&c, &most, &need);
        for (int n = 0; n < 20000; n++) {
            struct point at, set;

            for (unsigned i = 0; i < AXIS_COUNT; i++)
                at.at[i] = 0.999 * travel_mm[i] * sin(rate[i] * n * CYCLE_S + i);
            takt_correction_cycle(&c, &at, &move, &set);
            memmove(k[1], k[0], 3 * sizeof k[0]);
            for (unsigned i = 0; i < AXIS_COUNT; i++)
                k[0][i] = set.at[i] - at.at[i];
            for (unsigned i = 0; i < AXIS_COUNT && n >= 3; i++) {
                const double first = k[0][i] - k[1][i];
                const double second = first - (k[1][i] - k[2][i]);
                const double third = second - (k[1][i] - 2 * k[2][i] + k[3][i]);

                TEST_ASSERT_TRUE(fabs(first) <= need.velocity_mm_s[i] * CYCLE_S);
                TEST_ASSERT_TRUE(fabs(second) <= need.acceleration_mm_s2[i] * CYCLE_S * CYCLE_S);
                TEST_ASSERT_TRUE(fabs(third) <= need.jerk_mm_s3[i] * CYCLE_S * CYCLE_S * CYCLE_S);
            }
        }
    }
}

static void test_a_table_of_corrections_or_of_a_foreign_axis_is_no_unit(void)
{
    make_machine(&chains[0]);
    table.input[0] = AXIS_C;
    TEST_ASSERT_FALSE(takt_geometry_add(&geometry, &table, &wrong));
    TEST_ASSERT_EQUAL_INT(TAKT_ERROR_TABLE_UNIT, wrong.code);
    table.input[0] = AXIS_X;
    table.errors = false;
    TEST_ASSERT_FALSE(takt_geometry_add(&geometry, &table, &wrong));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_random_machines_are_corrected_within_a_micrometre_at_10000_points);
    RUN_TEST(test_the_turning_unit_is_turned_back_by_its_own_axis);
    RUN_TEST(test_corrections_take_no_more_of_the_axes_than_was_reserved_for_them);
    RUN_TEST(test_a_table_of_corrections_or_of_a_foreign_axis_is_no_unit);
    return UNITY_END();
}

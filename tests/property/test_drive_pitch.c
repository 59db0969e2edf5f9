/*
 * Random tables of a drive's error of pitch (firmware/servo/pitch.h), against a reference of its
 * own: the spline's four coefficients a piece, as one dense system of equations in long double.
 *
 *     test_drive_pitch [NUMBER [FIRST]]
 */
#include "property_arguments.h"
#include "servo/pitch.h"
#include "unity.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define UNKNOWNS_MAX (4 * (DRIVE_PITCH_POINTS - 1))
#define SAMPLES      40 /* of a piece */

static unsigned number = 60, first = 1;
static uint64_t state;
static long double matrix[UNKNOWNS_MAX][UNKNOWNS_MAX + 1];

void setUp(void)
{
}

void tearDown(void)
{
}

/* SplitMix64; 0 ... 1. */
static double any(void)
{
    uint64_t z = state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/*
 * A table of any size and shape, both directions of counting; the steepest are steeper than is
 * allowed.
 */
static void make_any(struct pitch *pitch)
{
    memset(pitch, 0, sizeof *pitch);
    double step_mm = exp(any() * 8 - 3), most_mm = step_mm * exp(any() * 10 - 12);
    pitch->points = 2 + (unsigned)(any() * (DRIVE_PITCH_POINTS - 1));
    pitch->first_mm = (any() - 0.5) * 1000;
    pitch->steps_per_mm = (any() < 0.5 ? -1 : 1) / step_mm;
    for (unsigned i = 0; i < pitch->points; i++)
        pitch->value_mm[i] = (any() - 0.5) * most_mm;
}

/* ---- The reference ---- */

/* The derivative of the powers of s at 0 or 1, times sign, of a piece. */
static void add_powers(long double *row, unsigned piece, unsigned order, unsigned s, int sign)
{
    for (unsigned k = order; k < 4; k++) {
        long double factor = s == 1 || k == order ? sign : 0;
        for (unsigned i = 0; i < order; i++)
            factor *= k - i;
        row[4 * piece + k] += factor;
    }
}

static void solve(unsigned n)
{
    for (unsigned k = 0; k < n; k++) {
        unsigned best = k;
        for (unsigned i = k + 1; i < n; i++)
            best = fabsl(matrix[i][k]) > fabsl(matrix[best][k]) ? i : best;
        for (unsigned j = k; j <= n; j++) {
            long double held = matrix[k][j];
            matrix[k][j] = matrix[best][j];
            matrix[best][j] = held;
        }
        for (unsigned i = 0; i < n; i++) {
            if (i == k || matrix[i][k] == 0)
                continue;
            long double times = matrix[i][k] / matrix[k][k];
            for (unsigned j = k; j <= n; j++)
                matrix[i][j] -= times * matrix[k][j];
        }
    }
}

/*
 * Values at both ends; slope, bend, and beside the ends of the table the third derivative agree
 * where pieces meet.
 */
static void make_reference(const struct pitch *pitch)
{
    const unsigned pieces = pitch->points - 1, n = 4 * pieces;
    unsigned row = 0;
    memset(matrix, 0, sizeof matrix);
    for (unsigned i = 0; i < pieces; i++) {
        matrix[row][n] = (long double)pitch->value_mm[i];
        add_powers(matrix[row++], i, 0, 0, 1);
        matrix[row][n] = (long double)pitch->value_mm[i + 1];
        add_powers(matrix[row++], i, 0, 1, 1);
        for (unsigned order = 1; i > 0 && order <= 2; order++) {
            add_powers(matrix[row], i - 1, order, 1, 1);
            add_powers(matrix[row++], i, order, 0, -1);
        }
    }
    if (pieces >= 3) {
        add_powers(matrix[row], 0, 3, 1, 1);
        add_powers(matrix[row++], 1, 3, 0, -1);
        add_powers(matrix[row], pieces - 2, 3, 1, 1);
        add_powers(matrix[row++], pieces - 1, 3, 0, -1);
    } else { /* a parabola, a straight line */
        add_powers(matrix[row++], 0, 3, 0, 1);
        add_powers(matrix[row++], pieces - 1, pieces == 1 ? 2 : 3, 0, 1);
    }
    TEST_ASSERT_EQUAL_UINT(n, row);
    solve(n);
}

static long double coefficient(unsigned pieces, unsigned piece, unsigned power)
{
    size_t i = (size_t)4 * piece + power, right = (size_t)4 * pieces;
    return matrix[i][right] / matrix[i][i];
}

/* At steps from the first point; beyond the ends by the way of edge.h, as its page has it. */
static double reference_at(const struct pitch *pitch, double at)
{
    const unsigned pieces = pitch->points - 1;
    double beyond = at < 0 ? at : at > pieces ? at - pieces : 0, q = fabs(beyond);
    double end = at < 0 ? 0 : pieces;
    if (beyond != 0)
        at = q < 1 ? end + beyond * pow(1 - q, 3) * (1 + 3 * q) : end;
    double whole = fmin(fmax(floor(at), 0), pieces - 1);
    long double value = 0;
    for (unsigned k = 4; k-- > 0;)
        value = value * (long double)(at - whole) + coefficient(pieces, (unsigned)whole, k);
    return (double)value;
}

/* ---- The claims ---- */

static double motor_mm_at(const struct pitch *pitch, double at)
{
    return pitch->first_mm + at / pitch->steps_per_mm;
}

/* The steepest between neighbouring samples, from two steps before the table to two behind it. */
static double compare(const struct pitch *pitch, unsigned seed)
{
    double steepest = 0, before_mm = 0, biggest_mm = 0;
    for (unsigned i = 0; i < pitch->points; i++)
        biggest_mm = fmax(biggest_mm, fabs(pitch->value_mm[i]));
    for (unsigned i = 0; i <= SAMPLES * (pitch->points + 3); i++) {
        double at = (double)i / SAMPLES - 2, y_mm = motor_mm_at(pitch, at);
        double got_mm = takt_pitch_at(pitch, y_mm), wanted_mm = reference_at(pitch, at);
        if (!(fabs(got_mm - wanted_mm) <= 1e-12 * (1 + biggest_mm + fabs(y_mm))))
            (void)printf("seed %u: %.17g instead of %.17g at %g steps\n", seed, got_mm, wanted_mm,
                         at);
        TEST_ASSERT_TRUE(fabs(got_mm - wanted_mm) <= 1e-12 * (1 + biggest_mm + fabs(y_mm)));
        if (i > 0)
            steepest =
                fmax(steepest, fabs(got_mm - before_mm) * SAMPLES * fabs(pitch->steps_per_mm));
        before_mm = got_mm;
    }
    return steepest;
}

/* A target's way: the place of the motor for it, and what is said of that. */
static void go_round(const struct pitch *pitch)
{
    for (unsigned i = 0; i < 200; i++) {
        double target_mm = motor_mm_at(pitch, (any() * 1.4 - 0.2) * pitch->points);
        double motor_mm = takt_pitch_get_motor_mm(pitch, target_mm);
        double actual_mm = motor_mm + takt_pitch_at(pitch, motor_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-15 * (1 + 4 * fabs(target_mm)), target_mm, actual_mm);
    }
}

static void test_any_table_is_the_spline_of_its_points_is_monotone_and_has_its_inverse(void)
{
    unsigned taken = 0, refused = 0;
    for (unsigned seed = first; seed < first + number; seed++) {
        struct pitch pitch, before;
        state = seed;
        make_any(&pitch);
        before = pitch;
        if (takt_pitch_make(&pitch)) {
            taken++;
            make_reference(&pitch);
            TEST_ASSERT_TRUE(compare(&pitch, seed) <= PITCH_STEEPEST_RATIO);
            go_round(&pitch);
        } else {
            refused++;
            TEST_ASSERT_EQUAL_UINT(0, pitch.points);
            TEST_ASSERT_TRUE(takt_pitch_at(&pitch, before.first_mm) == 0);
            pitch.points = before.points;
            make_reference(&pitch);
            TEST_ASSERT_TRUE(compare(&pitch, seed) > PITCH_STEEPEST_RATIO / 4);
        }
    }
    (void)printf("%u tables, %u more are too steep\n", taken, refused);
    TEST_ASSERT_TRUE(taken > number / 3);
}

int main(int argc, char **argv)
{
    read_number_and_first(argc, argv, &number, &first);
    UNITY_BEGIN();
    RUN_TEST(test_any_table_is_the_spline_of_its_points_is_monotone_and_has_its_inverse);
    return UNITY_END();
}

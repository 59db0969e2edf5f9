/*
 * A smoothed curve goes on along its path, and so do the numbers of motions that its pieces say
 * they belong to.
 */
#include "smooth/smooth.h"

#include "base/maths.h"

#include <string.h>
#include <unity.h>

/* A circle of 25.4 mm as 10,000 chords whose ends have four decimals of an inch. */
#define RADIUS_MM 25.4
#define CHORDS    10000
#define DECIMAL   0.00254

static const struct smooth_limits mill = {
    .axes = 7,
    .velocity_mm_s = {100.0, 100.0, 100.0},
    .acceleration_mm_s2 = {1000.0, 1000.0, 1000.0},
    .jerk_mm_s3 = {50000.0, 50000.0, 50000.0},
    .chord_error_max_mm = 1e-3,
    .cycle_s = 1e-3,
    .windows = 1.0,
};

static struct smooth smooth;
static union smooth_scratch scratch;
static uint32_t number; /* of the last piece */
static unsigned backward;
static double farthest_mm; /* the curve has come along the circle, */
static double back_mm;     /* and gone back from there at most */

void setUp(void)
{
    takt_smooth_init(&smooth, &mill);
    number = 0;
    backward = 0;
    farthest_mm = 0;
    back_mm = 0;
}

void tearDown(void)
{
}

static struct point end_of_chord(uint32_t chord)
{
    const double angle = MATHS_TWO_PI * (double)chord / CHORDS;
    struct point p = {{0}};
    double sine, cosine;

    takt_maths_sincos(angle, &sine, &cosine);
    p.at[AXIS_X] = DECIMAL * takt_maths_round(RADIUS_MM * sine / DECIMAL);
    p.at[AXIS_Y] = DECIMAL * takt_maths_round(RADIUS_MM * cosine / DECIMAL);
    return p;
}

/* The end of the piece, by its angle: (c1 + 4 c2 + c3)/6. */
static void follow_circle(const struct smooth_piece *piece)
{
    const struct point *c = piece->control;
    const double x = (c[1].at[AXIS_X] + 4.0 * c[2].at[AXIS_X] + c[3].at[AXIS_X]) / 6.0;
    const double y = (c[1].at[AXIS_Y] + 4.0 * c[2].at[AXIS_Y] + c[3].at[AXIS_Y]) / 6.0;
    const double along_mm = RADIUS_MM * takt_maths_atan2(x, y);

    farthest_mm = maths_max(farthest_mm, along_mm);
    back_mm = maths_max(back_mm, farthest_mm - along_mm);
}

static void take_all(void)
{
    struct smooth_piece piece;
    struct curve curve;
    enum smooth_taken taken;

    while ((taken = takt_smooth_take(&smooth, &scratch, &piece, &curve)) != SMOOTH_NONE) {
        if (taken == SMOOTH_PIECE) {
            follow_circle(&piece);
        }
        backward += piece.number < number ? 1 : 0;
        number = piece.number;
    }
}

/* A line from start on; start goes along. */
static void run_line(struct point *start, struct point end, uint32_t of_motion, double tolerance_mm)
{
    struct move move = {.kind = MOVE_FEED,
                        .path = PATH_BLEND,
                        .feed_mm_s = 100.0,
                        .tolerance_mm = tolerance_mm,
                        .merge_mm = tolerance_mm,
                        .end = end};
    struct curve curve;

    if (!takt_curve_set_line(&curve, start, &end)) {
        return;
    }
    while (!takt_smooth_has_room(&smooth)) {
        take_all();
    }
    takt_smooth_push(&smooth, &move, of_motion, &curve);
    take_all();
    *start = end;
}

static void finish(void)
{
    takt_smooth_finish(&smooth);
    take_all();
}

/* Chords from first on, within so much. */
static void run_chords(uint32_t first, uint32_t last, double tolerance_mm)
{
    struct point start = end_of_chord(first - 1);

    for (uint32_t chord = first; chord <= last; chord++) {
        run_line(&start, end_of_chord(chord), chord, tolerance_mm);
    }
    finish();
}

/*
 * Near the lowest point some two hundred chords lie in one line: the curve comes to rest where the
 * route is full.
 */
static void test_numbers_of_motions_never_go_back_where_the_curve_rests_within_a_chain(void)
{
    run_chords(4301, 5200, 4e-4);
    TEST_ASSERT_EQUAL_UINT(0, backward);
    TEST_ASSERT_EQUAL_UINT32(5200, number);
}

static void test_numbers_of_motions_never_go_back_around_a_circle_of_chords(void)
{
    run_chords(1, 2500, 1e-2);
    TEST_ASSERT_EQUAL_UINT(0, backward);
    TEST_ASSERT_EQUAL_UINT32(2500, number);
}

/* Less than twice a tolerance to either side of where it may be. */
static void test_the_curve_never_goes_back_by_many_tolerances_however_small_they_are(void)
{
    run_chords(1, 1200, 4e-4);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, RADIUS_MM * MATHS_TWO_PI * 1200 / CHORDS, farthest_mm);
    TEST_ASSERT_TRUE(back_mm < 4 * 4e-4);
}

static void test_numbers_of_motions_never_go_back_where_the_path_turns_back(void)
{
    for (unsigned i = 0; i < 40; i++) {
        struct point start = {{0}};

        setUp();
        for (uint32_t k = 1; k <= 8; k++) {
            run_line(&start, (struct point){{k % 2 == 1 ? 5.0 + i : 0.0}}, k, 4e-4);
        }
        finish();
        TEST_ASSERT_EQUAL_UINT(0, backward);
        TEST_ASSERT_EQUAL_UINT32(8, number);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_numbers_of_motions_never_go_back_where_the_curve_rests_within_a_chain);
    RUN_TEST(test_numbers_of_motions_never_go_back_around_a_circle_of_chords);
    RUN_TEST(test_numbers_of_motions_never_go_back_where_the_path_turns_back);
    RUN_TEST(test_the_curve_never_goes_back_by_many_tolerances_however_small_they_are);
    return UNITY_END();
}

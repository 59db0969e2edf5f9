/*
 * Removal along spirals against what is known of them: turns of an involute and of joined half
 * circles are H apart along their common normals, of Archimedes' spiral H apart from the centre;
 * and against a picture whose points are counted.
 */
#include "bore/approximate.h"
#include "bore/removal.h"
#include "bore/spiral.h"

#include "base/maths.h"

#include "unity.h"

#include <stdlib.h>
#include <string.h>

#define CUTTER_MM 5.0
#define RADIUS_MM 10.0
#define TURNS     8
#define STEP_MM   (RADIUS_MM / TURNS)

static struct bore_track track;
static struct bore_removal removal;

void setUp(void)
{
    bore_track_begin(&track, "spiral", 1e-3);
}

void tearDown(void)
{
    bore_track_free(&track);
    bore_removal_free(&removal);
}

#define POINTS 40000

static void involute(void)
{
    struct bore_spiral s;

    bore_spiral_set(&s, RADIUS_MM, TURNS);
    for (unsigned i = 0; i <= POINTS; i++) {
        double point[2];

        bore_spiral_point(&s, MATHS_TWO_PI * TURNS * maths_sqrt((double)i / POINTS), point);
        TEST_ASSERT_TRUE(bore_track_add(&track, point[0], point[1], 0));
    }
}

/* rho = a theta, away from the beginning at even angles. */
static void archimedes(void)
{
    for (unsigned i = 0; i <= POINTS; i++) {
        double turn = TURNS * maths_sqrt((double)i / POINTS);
        double sine, cosine;

        takt_maths_sincos(MATHS_TWO_PI * turn, &sine, &cosine);
        TEST_ASSERT_TRUE(bore_track_add(&track, STEP_MM * turn * cosine, STEP_MM * turn * sine, 0));
    }
}

/* Half circles of radius k a about (0, 0) and (-a, 0) in turn, a = H / 2. */
static void half_circles(void)
{
    for (unsigned k = 1; k < 2 * TURNS; k++) {
        double radius = k * STEP_MM / 2;
        double centre = k % 2 == 1 ? STEP_MM / 2 : 0;

        for (unsigned i = 0; i < 2000; i++) {
            double sine, cosine;

            takt_maths_sincos(MATHS_PI * (k + i / 2000.0), &sine, &cosine);
            TEST_ASSERT_TRUE(bore_track_add(&track, centre + radius * cosine, radius * sine, 0));
        }
    }
}

static struct bore_evenness evenness(double first, double last)
{
    struct bore_evenness e;

    TEST_ASSERT_TRUE(bore_removal_make(&removal, &track, CUTTER_MM));
    bore_removal_evenness(&removal, first, last, &e);
    return e;
}

static void test_turns_of_an_involute_remove_the_step_everywhere(void)
{
    involute();
    struct bore_evenness e = evenness(1.25, TURNS - 0.5);

    TEST_ASSERT_DOUBLE_WITHIN(0.002 * STEP_MM, STEP_MM, e.layer_mm.least);
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * STEP_MM, STEP_MM, e.layer_mm.most);
}

/*
 * Where the turns are nearly circles: rings of thickness H at the outer side of a way of radius
 * rho: H (rho + c - H / 2) for each rho of way.
 */
static void test_chip_area_falls_as_the_radius_of_curvature_grows(void)
{
    involute();
    (void)evenness(1.25, TURNS);
    for (size_t i = 0; i < removal.count; i++) {
        const struct bore_window *w = &removal.window[i];
        double rho = STEP_MM * w->turn;

        if (w->turn > 5 && w->turn < TURNS - 0.5)
            TEST_ASSERT_DOUBLE_WITHIN(0.02 * STEP_MM,
                                      STEP_MM * (rho + CUTTER_MM - STEP_MM / 2) / rho,
                                      bore_window_width(w));
    }
}

static void test_turns_of_half_circles_remove_the_step_everywhere(void)
{
    half_circles();
    struct bore_evenness e = evenness(1.25, TURNS - 1);

    TEST_ASSERT_DOUBLE_WITHIN(0.002 * STEP_MM, STEP_MM, e.layer_mm.least);
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * STEP_MM, STEP_MM, e.layer_mm.most);
}

/* Square to the way it is H rho' / sqrt(rho^2 + a^2) or so, least at the first turns. */
static void test_turns_of_archimedes_remove_less_where_the_spiral_is_steep(void)
{
    archimedes();
    struct bore_evenness e = evenness(1.25, TURNS - 0.5);

    TEST_ASSERT_TRUE(e.layer_mm.least < 0.995 * STEP_MM);
    TEST_ASSERT_DOUBLE_WITHIN(0.002 * STEP_MM, STEP_MM, e.layer_mm.most);
}

/*
 * The edge before is nearly a circle of radius E = rho - H + c about the centre; the cutter's edge
 * cuts it where
 *     rho^2 + c^2 + 2 rho c cos(angle from the outer side) = E^2
 */
static void test_engaged_angle_of_a_late_turn(void)
{
    involute();
    struct bore_evenness e = evenness(TURNS - 0.6, TURNS - 0.5);
    double rho = RADIUS_MM - 0.55 * STEP_MM;
    double edge = rho - STEP_MM + CUTTER_MM;
    double cosine = (edge * edge - rho * rho - CUTTER_MM * CUTTER_MM) / (2 * rho * CUTTER_MM);
    double angle = takt_maths_atan2(maths_sqrt(1 - cosine * cosine), cosine);

    TEST_ASSERT_DOUBLE_WITHIN(0.02, angle, 0.5 * (e.engaged_rad.least + e.engaged_rad.most));
}

/* ---- a picture whose points are counted ---- */

#define SIDE     1000
#define MIDDLE   500
#define POINT_MM (2.2 * (RADIUS_MM + CUTTER_MM) / SIDE)

static unsigned char picture[SIDE][SIDE];

static double paint(const double at_mm[2])
{
    size_t fresh = 0;

    for (int y = 0; y < SIDE; y++) {
        double v = (y - MIDDLE) * POINT_MM - at_mm[1];

        if (v * v > CUTTER_MM * CUTTER_MM)
            continue;
        double half = maths_sqrt(CUTTER_MM * CUTTER_MM - v * v);
        int first = (int)((at_mm[0] - half) / POINT_MM) + MIDDLE;
        int last = (int)((at_mm[0] + half) / POINT_MM) + MIDDLE;

        for (int x = first; x <= last; x++) {
            fresh += picture[y][x] == 0;
            picture[y][x] = 1;
        }
    }
    return (double)fresh * POINT_MM * POINT_MM;
}

static void test_area_is_that_of_points_that_are_counted(void)
{
    const double centre[2] = {0, 0};
    double painted = 0, removed = 0;

    involute();
    TEST_ASSERT_TRUE(bore_removal_make(&removal, &track, CUTTER_MM));
    memset(picture, 0, sizeof picture);
    (void)paint(centre);
    for (size_t i = 0; i < track.count; i += 20)
        painted += paint(track.at_mm[i]);
    for (size_t i = 0; i < removal.count; i++)
        removed += removal.window[i].area_mm2;
    TEST_ASSERT_DOUBLE_WITHIN(0.003 * painted, painted, removed);
}

/* ---- a helix: a turn down and a turn around, a cutter of more than half the hole ---- */

#define HELIX_MM 4.0
#define DOWN_MM  2.0
#define AROUND   2000

static struct bore_removal level;

static void helix(void)
{
    for (unsigned i = 0; i <= 2 * AROUND; i++) {
        double angle = MATHS_TWO_PI * i / AROUND;
        double down = i < AROUND ? DOWN_MM * i / AROUND : DOWN_MM;
        double sine, cosine;

        takt_maths_sincos(angle, &sine, &cosine);
        TEST_ASSERT_TRUE(bore_track_add(&track, HELIX_MM * cosine, HELIX_MM * sine, -down));
    }
    TEST_ASSERT_TRUE(bore_removal_make_helix(&removal, &level, &track, CUTTER_MM, DOWN_MM, TURNS));
}

/* A turn takes a cylinder of radius R + c and of its depth: (R + c)^2 / 2 R by way and depth. */
static void test_a_helix_removes_the_hole_evenly(void)
{
    const double width = (HELIX_MM + CUTTER_MM) * (HELIX_MM + CUTTER_MM) / (2 * HELIX_MM);
    struct bore_evenness e;

    helix();
    bore_removal_evenness(&removal, 0, TURNS, &e);
    TEST_ASSERT_EQUAL_UINT(TURNS * BORE_WINDOWS_PER_TURN, removal.count);
    TEST_ASSERT_DOUBLE_WITHIN(0.005 * width, width, e.width_mm.least);
    TEST_ASSERT_DOUBLE_WITHIN(0.005 * width, width, e.width_mm.most);
    bore_removal_free(&level);
}

/*
 * What a level has left of the front half when the cutter stands at the angle a: points that no
 * disc from 0 to a has held.
 */
static double counted_engagement(double a)
{
    unsigned free_points = 0;

    for (unsigned i = 0; i < 1000; i++) {
        double to = a + MATHS_PI * (i + 0.5) / 1000; /* the way goes on to a + pi / 2 */
        double sine, cosine;
        bool held = false;

        takt_maths_sincos(a, &sine, &cosine);
        double x = HELIX_MM * cosine, y = HELIX_MM * sine;

        takt_maths_sincos(to, &sine, &cosine);
        x += CUTTER_MM * cosine;
        y += CUTTER_MM * sine;
        for (unsigned k = 0; k < 1000 && !held; k++) {
            takt_maths_sincos(a * k / 1000, &sine, &cosine);
            double dx = x - HELIX_MM * cosine, dy = y - HELIX_MM * sine;

            held = dx * dx + dy * dy < CUTTER_MM * CUTTER_MM * (1 - 1e-6);
        }
        free_points += !held;
    }
    return MATHS_PI * free_points / 1000;
}

static void test_the_engagement_of_a_level_falls_as_points_counted_say(void)
{
    struct bore_evenness e;
    double sum = 0;

    helix();
    for (size_t i = 2; i < BORE_WINDOWS_PER_TURN; i += 5)
        TEST_ASSERT_DOUBLE_WITHIN(
            0.05, counted_engagement(MATHS_TWO_PI * (double)i / BORE_WINDOWS_PER_TURN),
            level.window[i].engaged_rad);
    for (size_t i = 0; i < BORE_WINDOWS_PER_TURN; i++)
        sum += level.window[i].engaged_rad;
    bore_removal_evenness(&removal, 0, TURNS, &e);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, sum / BORE_WINDOWS_PER_TURN, e.engaged_rad.least);
    TEST_ASSERT_DOUBLE_WITHIN(0.01, sum / BORE_WINDOWS_PER_TURN, e.engaged_rad.most);
    bore_removal_free(&level);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_turns_of_an_involute_remove_the_step_everywhere);
    RUN_TEST(test_chip_area_falls_as_the_radius_of_curvature_grows);
    RUN_TEST(test_turns_of_half_circles_remove_the_step_everywhere);
    RUN_TEST(test_turns_of_archimedes_remove_less_where_the_spiral_is_steep);
    RUN_TEST(test_engaged_angle_of_a_late_turn);
    RUN_TEST(test_area_is_that_of_points_that_are_counted);
    RUN_TEST(test_a_helix_removes_the_hole_evenly);
    RUN_TEST(test_the_engagement_of_a_level_falls_as_points_counted_say);
    return UNITY_END();
}

/* Figures of a circular test, of turns made by formula. */
#define _GNU_SOURCE

#include "base/maths.h"
#include "circle/figures.h"
#include "circle/picture.h"

#include <stdlib.h>
#include <string.h>
#include <unity.h>

#define PLACES 3600

static struct circle_turn turn, other;

void setUp(void)
{
    turn = other = (struct circle_turn){.radius_mm = 50};
}

void tearDown(void)
{
    circle_turn_free(&turn);
    circle_turn_free(&other);
}

/* How far outside of the circle at an angle, in degrees. */
typedef double (*shape)(double degrees);

static void make(struct circle_turn *t, shape out_mm, double x_mm, double y_mm)
{
    for (unsigned k = 0; k < PLACES; k++) {
        const double degrees = 360.0 * k / PLACES;
        const double r = t->radius_mm + out_mm(degrees);
        double sine, cosine;

        takt_maths_sincos(degrees * MATHS_PI / 180, &sine, &cosine);
        circle_turn_add(t, (const double[]){x_mm + r * cosine, y_mm + r * sine});
    }
}

static struct circle_figures figures_of_one(void)
{
    const struct circle_turn *const list[] = {&turn};
    struct circle_figures f;

    circle_figures_of(list, 1, &f);
    return f;
}

static double nothing(double degrees)
{
    (void)degrees;
    return 0;
}

static double larger(double degrees)
{
    (void)degrees;
    return 0.002;
}

static double oval(double degrees)
{
    return 0.003 * takt_maths_cos(2 * degrees * MATHS_PI / 180);
}

/* Play of 4 um in X: the table is behind by half of it, to the right while X goes left. */
static double with_play(double degrees)
{
    return (degrees < 180 ? 0.002 : -0.002) * takt_maths_cos(degrees * MATHS_PI / 180);
}

static double spiked(double degrees)
{
    return degrees > 92 && degrees < 93 ? 0.01 : 0;
}

static void test_a_circle_has_no_deviation(void)
{
    make(&turn, nothing, 0, 0);
    const struct circle_figures f = figures_of_one();

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, f.deviation_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, f.most_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, f.radius_out_mm);
}

static void test_another_radius_is_no_deviation_of_form(void)
{
    make(&turn, larger, 0, 0);
    const struct circle_figures f = figures_of_one();

    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, f.deviation_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.002, f.most_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.002, f.least_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.002, f.radius_out_mm);
}

static void test_another_centre_is_found_and_no_deviation_of_form(void)
{
    make(&turn, nothing, 0.003, -0.004);
    const struct circle_figures f = figures_of_one();

    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.003, f.centre_mm[0]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.004, f.centre_mm[1]);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, f.deviation_mm); /* e^2/2R is left of an offset e */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.005, f.most_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, -0.005, f.least_mm);
}

static void test_an_oval_deviates_by_both_its_amplitudes(void)
{
    make(&turn, oval, 0, 0);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.006, figures_of_one().deviation_mm);
}

static void test_a_step_at_a_reversal_is_no_spike_and_a_spike_no_step(void)
{
    struct circle_figures f;

    make(&turn, with_play, 0, 0);
    f = figures_of_one();
    for (unsigned quadrant = 0; quadrant < CIRCLE_QUADRANTS; quadrant += 2) {
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.0039, f.reversal[quadrant].step_mm);
        TEST_ASSERT_DOUBLE_WITHIN(1e-5, 0.002, maths_abs(f.reversal[quadrant].spike_mm));
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, -0.004 * 0.2164, f.reversal[1].step_mm);
    circle_turn_free(&turn);
    make(&turn, spiked, 0, 0);
    f = figures_of_one();
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0.01, f.reversal[1].spike_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0, f.reversal[1].step_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-4, 0, f.reversal[0].spike_mm);
}

static void test_two_ways_together_hold_both(void)
{
    const struct circle_turn *const list[] = {&turn, &other};
    struct circle_figures f;

    make(&turn, nothing, 0, 0);
    make(&other, larger, 0, 0);
    circle_figures_of(list, 2, &f);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.002, f.deviation_mm);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0.001, f.radius_out_mm);
}

static void test_no_place_has_no_figures(void)
{
    const struct circle_figures f = figures_of_one();

    TEST_ASSERT_EQUAL_DOUBLE(0, f.deviation_mm);
    TEST_ASSERT_EQUAL_DOUBLE(0, f.most_mm);
}

/* Both turns are in it, and its numbers can be read. */
static void test_the_picture_shows_both_ways(void)
{
    struct circle_turn turns[CIRCLE_WAYS];
    struct circle_figures f[CIRCLE_WAYS + 1];
    const struct circle_turn *const list[] = {&turns[0], &turns[1]};
    const struct circle_picture picture = {
        .axis = {'X', 'Y'}, .radius_mm = 50, .feed_mm_min = 1000, .turn = turns, .figures = f};
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);

    make(&turn, oval, 0, 0);
    make(&other, larger, 0, 0);
    turns[0] = turn;
    turns[1] = other;
    circle_figures_of(&list[0], 1, &f[0]);
    circle_figures_of(&list[1], 1, &f[1]);
    circle_figures_of(list, 2, &f[2]);
    circle_picture_write(stream, &picture);
    TEST_ASSERT_EQUAL(0, fclose(stream));
    TEST_ASSERT_NOT_NULL(strstr(text, "G3: G 6.00 um, F max 3.00, F min -3.00"));
    TEST_ASSERT_NOT_NULL(strstr(text, "G2: G 0.00 um, F max 2.00, F min 2.00"));
    TEST_ASSERT_NOT_NULL(strstr(text, "1 um a division"));
    free(text);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_circle_has_no_deviation);
    RUN_TEST(test_another_radius_is_no_deviation_of_form);
    RUN_TEST(test_another_centre_is_found_and_no_deviation_of_form);
    RUN_TEST(test_an_oval_deviates_by_both_its_amplitudes);
    RUN_TEST(test_a_step_at_a_reversal_is_no_spike_and_a_spike_no_step);
    RUN_TEST(test_two_ways_together_hold_both);
    RUN_TEST(test_no_place_has_no_figures);
    RUN_TEST(test_the_picture_shows_both_ways);
    return UNITY_END();
}

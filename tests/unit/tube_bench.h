/* A program and setpoints along it, for the verifier of the tube. */
#ifndef TAKT_TESTS_TUBE_BENCH_H
#define TAKT_TESTS_TUBE_BENCH_H

#include "unity.h"
#include "verifier/tube_verifier.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Between two setpoints. */
#define STEP_MM 0.02

#define EXACT_MM 1e-3

static struct parameters parameters;
static struct source_text text;
static struct tube_verifier verifier;
static uint32_t motion; /* that is said to be executed */
static char program_text[400000];

void setUp(void)
{
    takt_parameters_clear(&parameters);
    memset(&verifier, 0, sizeof verifier);
    motion = UINT32_MAX / 2; /* none to be believed */
}

void tearDown(void)
{
    tube_verifier_free(&verifier);
}

static inline void begin_as(const char *program, bool waits)
{
    struct program_config config = {
        .axes = 0x3f, .parameters = &parameters, .waits = waits, .spindle_encoder = true};
    struct source source;

    for (int i = 0; i < AXIS_COUNT; i++) {
        config.travel_min[i] = -500;
        config.travel_max[i] = 500;
    }
    tube_verifier_free(&verifier);
    takt_source_open_text(&source, &text, program, strlen(program));
    tube_verifier_init(&verifier, &config, &source, EXACT_MM);
}

static inline void begin(const char *program)
{
    begin_as(program, false);
}

static inline void to_point(const struct point *p)
{
    TEST_ASSERT_TRUE(tube_verifier_add(&verifier, p, motion));
}

static inline void jump_to(double x, double y)
{
    to_point(&(struct point){{x, y}});
}

/* Setpoints straight on. */
static inline void go_to(double x, double y)
{
    const struct point from = verifier.has_next ? verifier.next : verifier.last;
    const double way_x = x - from.at[AXIS_X];
    const double way_y = y - from.at[AXIS_Y];
    const int steps = (int)ceil(hypot(way_x, way_y) / STEP_MM);

    for (int k = 1; k <= steps; k++)
        jump_to(from.at[AXIS_X] + way_x * k / steps, from.at[AXIS_Y] + way_y * k / steps);
}

/* Around a centre; from one angle to another, radians. */
static inline void go_around(double x, double y, double radius, double from, double to)
{
    const int steps = (int)ceil(fabs(to - from) * radius / STEP_MM);

    for (int k = 0; k <= steps; k++) {
        const double angle = from + (to - from) * k / steps;

        jump_to(x + radius * cos(angle), y + radius * sin(angle));
    }
}

static inline void finish_within(double path_part, double corner_part)
{
    tube_verifier_finish(&verifier);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, path_part, verifier.figures.path_part);
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, corner_part, verifier.figures.corner_part);
    TEST_ASSERT_EQUAL_DOUBLE(0, verifier.figures.beyond_mm);
}

static inline bool is_within(void)
{
    return verifier.figures.path_part <= 1 && verifier.figures.corner_part <= 1;
}

#endif

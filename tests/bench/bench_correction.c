/*
 * What position-error correction costs: nanoseconds a cycle, layer by layer, on a way through the
 * volume.
 */
#define _POSIX_C_SOURCE 200809L

#include "correction/correction.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define CYCLES  2000000
#define CYCLE_S 0.001

static struct table table;
static struct correction_tables volume, axes;
static struct correction correction;

static double now_s(void)
{
    struct timespec t;

    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void make_volume(void)
{
    static const uint16_t points[] = {9, 7, 6};
    static const double size_mm[] = {400, 300, 250};
    struct diagnostic wrong;

    table.inputs = table.outputs = 3;
    for (uint8_t i = 0; i < 3; i++) {
        table.input[i] = table.output[i].axis = i;
        table.knots[i] = points[i];
        for (unsigned k = 0; k < points[i]; k++)
            table.knot_mm[i][k] = size_mm[i] * k / (points[i] - 1);
    }
    for (uint32_t row = 0; row < takt_table_rows(&table); row++)
        for (unsigned o = 0; o < 3; o++)
            table.value_mm[3 * row + o] = (float)(0.02 * sin(0.7 * row + o));
    if (!takt_grid_set(&volume.volume, &table, &wrong))
        abort();
}

static void make_axis(uint8_t axis)
{
    struct diagnostic wrong;

    table.inputs = 1;
    table.outputs = 2;
    table.input[0] = axis;
    table.knots[0] = 17;
    table.output[0] = (struct table_output){axis, TABLE_UP};
    table.output[1] = (struct table_output){axis, TABLE_DOWN};
    for (size_t k = 0; k < 17; k++) {
        table.knot_mm[0][k] = 25.0 * (double)k;
        table.value_mm[2 * k] = 0.01F;
        table.value_mm[2 * k + 1] = -0.01F;
    }
    if (!takt_axis_tables_add(&axes.axes, &table, &wrong))
        abort();
}

/* There and back through the volume at a speed along all three axes. */
static struct point at(int cycle, double mm_s)
{
    const double u = 10 + fabs(fmod(mm_s * CYCLE_S * cycle, 460) - 230);

    return (struct point){{1.6 * u, 1.2 * u, u}};
}

static void measure(const char *name, const struct correction_settings *settings,
                    const struct correction_tables *with, double mm_s)
{
    const struct move move = {.kind = MOVE_FEED};
    struct point start = {{0}}, set = start;
    double sum = 0, began;

    takt_correction_init(&correction, settings, 7, CYCLE_S, with, &start);
    for (int i = 0; i < 5000; i++) {
        const struct point cmd = at(i, mm_s);

        takt_correction_cycle(&correction, &cmd, &move, &set);
    }
    began = now_s();
    for (int i = 0; i < CYCLES; i++) {
        const struct point cmd = at(i, mm_s);

        takt_correction_cycle(&correction, &cmd, &move, &set);
        sum += set.at[0];
    }
    printf("%-34s %6.1f mm/s  %6.1f ns a cycle%s\n", name, mm_s, 1e9 * (now_s() - began) / CYCLES,
           sum == 0.5 ? "." : "");
}

int main(void)
{
    struct correction_settings none, matrix;

    takt_correction_settings_set_default(&none);
    matrix = none;
    matrix.machine[0][0] = matrix.machine[1][0] = 1e-5;
    make_axis(AXIS_X);
    make_axis(AXIS_Y);
    make_axis(AXIS_Z);
    make_volume();
    measure("nothing", &none, NULL, 30);
    measure("matrix", &matrix, NULL, 30);
    measure("three axis tables, with backlash", &none, &axes, 30);
    measure("volume 9 x 7 x 6", &none, &volume, 10);
    measure("volume 9 x 7 x 6", &none, &volume, 30);
    measure("volume 9 x 7 x 6", &none, &volume, 60);
    measure("volume 9 x 7 x 6", &none, &volume, 300);
    return 0;
}

/*
 * A diagram of curves over two logarithmic axes, as SVG.
 */
#ifndef TAKT_FREQUENCY_CHART_H
#define TAKT_FREQUENCY_CHART_H

#include <stdbool.h>
#include <stdio.h>

/* A range of whole decades and parts of them: 0 < low < high. */
struct chart_range {
    double low, high;
};

struct chart {
    const char *title;
    const char *x_label, *y_label;
    struct chart_range x, y;
};

enum chart_line { CHART_THIN, CHART_BOLD, CHART_DASHED };

/* A curve: y(x), or both by a parameter. y or x of 0 or below, or not finite, is no point. */
struct chart_curve {
    const char *label;  /* NULL: none */
    bool is_first;      /* the label is at its beginning, else at its end */
    const char *colour; /* of SVG */
    enum chart_line line;
    /* Point at a part of the curve, 0 ... 1. */
    void (*at)(const void *context, double part, double *x, double *y);
    const void *context;
};

/* Frame, grid and labels; then any number of curves; then the end. */
void chart_begin(FILE *file, const struct chart *chart);
void chart_draw(FILE *file, const struct chart *chart, const struct chart_curve *curve);
void chart_end(FILE *file);

/* Where a part of a range is, by its logarithm. */
double chart_between(struct chart_range range, double part);

#endif

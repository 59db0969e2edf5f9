/*
 * Curves of records over time, as SVG.
 */
#ifndef TAKT_HOST_TUNING_PICTURE_H
#define TAKT_HOST_TUNING_PICTURE_H

#include "tuning/record.h"

#include <stdio.h>

enum picture_of { PICTURE_INPUT, PICTURE_POSITION, PICTURE_LAG /* input - position */ };

struct picture_curve {
    const char *label, *colour;
    const struct tuning_record *record;
    enum picture_of of;
    double from;  /* this is 0 */
    double times; /* a unit of the record is so much of the diagram */
};

/* All in one frame about all of them; y_label: what is shown and its unit. */
void picture_write(FILE *file, const char *title, const char *y_label,
                   const struct picture_curve *curve, unsigned curves);

#endif

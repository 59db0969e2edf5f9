/*
 * The three diagrams of seed 000, and all of them as one page.
 */
#ifndef TAKT_FREQUENCY_DIAGRAMS_H
#define TAKT_FREQUENCY_DIAGRAMS_H

#include "accuracy/cycle_frequency.h"

#include <stdio.h>

struct frequency_question {
    const char *machine; /* its name */
    struct cycle_limits limits;
    double tolerance_mm;
    double resolution_per_mm;
    double frequency_hz; /* of the controller; 0: not known */
};

enum frequency_diagram {
    /* over the control frequency, for circles of several radii at the highest feed */
    FREQUENCY_CHORD_ERROR,
    FREQUENCY_ALLOWED_FEED, /* over the radius, by feed limit, accelerations and jerks */
    FREQUENCY_NEEDED,       /* frequency over the feed, for radii, accelerations and jerks */
    FREQUENCY_DIAGRAMS
};

/* Short name, as in file names: chord-error, allowed-feed, needed-frequency. */
const char *frequency_diagram_name(enum frequency_diagram which);

void frequency_diagram_write(FILE *file, const struct frequency_question *question,
                             enum frequency_diagram which);

/* One HTML file with all three; it opens offline. */
void frequency_page_write(FILE *file, const struct frequency_question *question,
                          const struct cycle_need *need);

#endif

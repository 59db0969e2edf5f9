/* The answer in figures, on standard output. */
#ifndef TAKT_FREQUENCY_FIGURES_H
#define TAKT_FREQUENCY_FIGURES_H

#include "frequency/diagrams.h"

/* The machine, its limits and the tolerance. */
void frequency_print_question(const struct frequency_question *q);
/* What it needs, and what its own frequency is good for. */
void frequency_print_need(const struct frequency_question *q, const struct cycle_need *need);
/* Rows for radii: feed, frequency, and by which limit. */
void frequency_print_table(const struct frequency_question *q, const struct cycle_need *need);

#endif

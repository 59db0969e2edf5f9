/* What a circular test found: figures of each way and of both, their picture, and JSON. */
#ifndef TAKT_HOST_FINDINGS_CIRCLE_FINDINGS_H
#define TAKT_HOST_FINDINGS_CIRCLE_FINDINGS_H

#include "studies/circle_test.h"

#include <stdio.h>

struct circle_findings {
    struct circle_test test;
    struct circle_figures figures[CIRCLE_WAYS + 1]; /* of each way, and of both */
    enum axis axis[2];
};

/* Sets the figures; the test has been made. */
void circle_findings_take(struct circle_findings *found);

void circle_findings_print(const struct circle_findings *found);
void circle_findings_write_picture(FILE *file, const struct circle_findings *found);
void circle_findings_write_json(FILE *file, const struct circle_findings *found);

#endif

/*
 * Jobs and paths as part programs, in mm.
 */
#ifndef TAKT_BORE_WRITE_H
#define TAKT_BORE_WRITE_H

#include "bore/job.h"

#include <stdbool.h>
#include <stdio.h>

/*
 * The program of a checked job, the hole's centre at X 0 Y 0, the work's top at Z 0. False: memory
 * was short.
 */
bool bore_write_job(FILE *file, const struct bore_job *job);

/* A program of a path alone, from Z 0: at rest at its start, along it, end. */
void bore_write_path(FILE *file, const char *name, const struct bore_path *p, double feed_mm_min);

#endif

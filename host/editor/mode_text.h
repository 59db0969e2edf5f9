/*
 * The modes of a program as the codes and words that stand for them: G1 G17 G21 G40 … F600 S1000.
 */
#ifndef TAKT_HOST_MODE_TEXT_H
#define TAKT_HOST_MODE_TEXT_H

#include "program/program.h"

#define MODE_TEXT_MAX 512

/* Two lines: codes; then F, S, T and the work coordinates of the axes (bit i: axis i). */
void mode_text_write(const struct program *p, unsigned axes, char text[MODE_TEXT_MAX]);

#endif

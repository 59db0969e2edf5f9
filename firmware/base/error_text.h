/*
 * The texts of errors as they are stored: plain, or packed for images (hal/port/pack_texts.py).
 *
 * Packed bytes from ERROR_TEXT_PLAIN on stand for pairs of bytes, each of which may stand for a
 * pair again; all others are characters. A text ends with 0.
 */
#ifndef TAKT_BASE_ERROR_TEXT_H
#define TAKT_BASE_ERROR_TEXT_H

#include <stdint.h>

#define ERROR_TEXT_PLAIN 128

/* Pairs within pairs at most. */
#define ERROR_TEXT_DEPTH 16

extern const uint8_t takt_error_text_pairs[][2];

/* The text of error -1 - index. index: below TAKT_ERROR_TOTAL. */
const uint8_t *takt_error_text_find(unsigned index);

#endif

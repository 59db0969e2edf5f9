/*
 * Decimal text to double and back, without a C library, the same bits on every machine.
 */
#ifndef TAKT_BASE_DECIMAL_H
#define TAKT_BASE_DECIMAL_H

#include <stddef.h>
#include <stdint.h>

/*
 * Reads an unsigned decimal number, digits with at most one point ("12", "12.5", ".5", "12."), from
 * text[0 .. length). Returns the number of characters read, 0 when no digit stands there; *value is
 * the correctly rounded double for up to 19 significant digits (more digits are read and may round
 * by 1 ulp). Above the doubles *value is infinity, below the normal ones (2.2e-308) it is 0. Signs
 * and exponents are the caller's.
 */
size_t takt_decimal_read(const char *text, size_t length, double *value);

/* Room that takt_decimal_write needs at most. */
#define DECIMAL_TEXT_MAX 40

/*
 * Writes value with a fixed number of places (0 to 9), rounded half away from zero, sign only when
 * negative and not rounded to zero ("-0.000" never appears). The double is rounded once, by its
 * exact decimal value. Not a number and infinities are written as "nan", "inf", "-inf";
 * |value| >= 1e9 as "1.250e12" with the same number of places, good to 14 digits. Returns the
 * number of characters; no terminating zero. text must have room for DECIMAL_TEXT_MAX characters.
 */
size_t takt_decimal_write(char *text, double value, unsigned places);

#endif

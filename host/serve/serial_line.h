/*
 * A serial line, or a pty, in raw mode and without waiting.
 */
#ifndef TAKT_SERVE_SERIAL_LINE_H
#define TAKT_SERVE_SERIAL_LINE_H

#include <stdbool.h>
#include <stdint.h>

#define SERIAL_PATH_MAX 255

/* Bits a byte takes on the line: start, eight, parity or a second stop bit, stop. */
#define SERIAL_BITS 11

enum serial_parity { SERIAL_EVEN, SERIAL_ODD, SERIAL_NONE };

struct serial_settings {
    char path[SERIAL_PATH_MAX + 1];
    uint32_t bauds;
    enum serial_parity parity;
};

/*
 * "PATH", "PATH,9600" or "PATH,9600,none"; without them 19200 baud and even parity. False: it is
 * none of these.
 */
bool serial_settings_read(struct serial_settings *settings, const char *text);

/* 8 data bits, one stop bit (two without parity). -1: errno says why. */
int serial_line_open(const struct serial_settings *settings);

#endif

/*
 * SLCAN, the ASCII protocol of serial CAN adapters (Lawicel): lines that end in a carriage return.
 *
 *     t 123 2 AABB     data frame, 11-bit identifier      T 00000123 2 AABB   29-bit
 *     r 123 2          remote request                     R 00000123 2
 *     d b, D B         CAN FD without and with rate switch; the length is a DLC of one hex digit
 *
 * (without the spaces). Everything else a computer sends is a command to the adapter: S8 bit rate,
 * O open, C close.
 */
#ifndef TAKT_HOST_LINK_SLCAN_H
#define TAKT_HOST_LINK_SLCAN_H

#include "bus/wire_frame.h"

#include <stddef.h>

#define SLCAN_LINE_MAX (1 + 8 + 1 + 2 * WIRE_DATA_MAX + 1)

/*
 * Writes a frame as one line with its carriage return; returns the number of bytes. Not for error
 * messages.
 */
size_t slcan_write(char line[SLCAN_LINE_MAX], const struct wire_frame *frame);

/*
 * Reads one line without its end. A time stamp after the data is passed over. False: no frame, or a
 * wrong one.
 */
bool slcan_read(const char *line, size_t length, struct wire_frame *frame);

/* The digit of command S for a bit rate; 0: there is none. */
char slcan_bitrate_digit(uint32_t bitrate);

#endif

/*
 * Bytes of a serial line and the silences between them, from its interrupt to the background. One
 * writer, one reader, no lock: the writer owns all but taken. Clocks of the two, and of the
 * writer's interrupts, may differ by a little.
 */
#ifndef TAKT_PORT_LINE_RING_H
#define TAKT_PORT_LINE_RING_H

#include <stdbool.h>
#include <stdint.h>

/* A power of two: the longest frame of Modbus, and part of the next. */
#define LINE_RING_MAX 512

/* Private. */
struct line_ring {
    uint32_t gap_us;                  /* so long a pause is a silence */
    volatile uint32_t written, taken; /* bytes so far, wrapping */
    volatile uint32_t heard_us;       /* when the last one came, whether it found room or not */
    bool was_silent;                  /* before the next byte that finds room */
    volatile uint8_t byte[LINE_RING_MAX];
    volatile uint8_t after_silence[LINE_RING_MAX / 8]; /* a bit of each byte */
};

void takt_line_ring_open(struct line_ring *ring, uint32_t gap_us);

/* False: no room, the byte is lost. */
bool takt_line_ring_put(struct line_ring *ring, uint8_t byte, uint32_t now_us);

bool takt_line_ring_is_empty(const struct line_ring *ring);

/* The oldest byte of a ring that is not empty, and whether the line was silent before it. */
uint8_t takt_line_ring_take(struct line_ring *ring, bool *after_silence);

/* All has been taken, and the line is silent. */
bool takt_line_ring_is_silent(const struct line_ring *ring, uint32_t now_us);

#endif

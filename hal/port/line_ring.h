/*
 * Bytes of a serial line with the time each came at, from its interrupt to the background. One writer, one reader, no
 * lock: the writer owns written, the reader owns taken.
 */
#ifndef TAKT_PORT_LINE_RING_H
#define TAKT_PORT_LINE_RING_H

#include <stdbool.h>
#include <stdint.h>

/* A power of two: the longest frame of Modbus, and part of the next. */
#define LINE_RING_MAX 512

struct line_ring {
    volatile uint32_t written, taken; /* bytes so far, wrapping */
    volatile uint32_t entry[LINE_RING_MAX];
};

/* False: no room, the byte is lost. */
bool line_ring_put(struct line_ring *ring, uint8_t byte, uint32_t now_us);

bool line_ring_is_empty(const struct line_ring *ring);

/*
 * The oldest byte of a ring that is not empty, and the time it came at; now_us: at most 8 s later. A clock that runs a
 * little behind that of the interrupt does no harm: then the byte has come now.
 */
uint8_t line_ring_take(struct line_ring *ring, uint32_t now_us, uint32_t *came_us);

#endif

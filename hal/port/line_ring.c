#include "port/line_ring.h"

#include <string.h>

#define BITS 8U /* of a byte of after_silence */

void takt_line_ring_open(struct line_ring *ring, uint32_t gap_us)
{
    memset(ring, 0, sizeof *ring);
    ring->gap_us = gap_us;
    ring->was_silent = true;
}

static void mark(volatile uint8_t *bits, unsigned bit, bool set)
{
    if (set)
        *bits |= (uint8_t)(1U << bit);
    else
        *bits &= (uint8_t) ~(1U << bit);
}

/* A clock of several interrupts may step back by a little: no time has passed then. */
static bool has_been_silent(const struct line_ring *ring, uint32_t now_us)
{
    const uint32_t quiet_us = now_us - ring->heard_us;

    return quiet_us <= UINT32_MAX / 2U && quiet_us >= ring->gap_us;
}

bool takt_line_ring_put(struct line_ring *ring, uint8_t byte, uint32_t now_us)
{
    const uint32_t at = ring->written;
    const uint32_t place = at % LINE_RING_MAX;

    if (has_been_silent(ring, now_us))
        ring->was_silent = true;
    ring->heard_us = now_us;
    if (at - ring->taken == LINE_RING_MAX)
        return false;
    ring->byte[place] = byte;
    mark(&ring->after_silence[place / BITS], place % BITS, ring->was_silent);
    ring->was_silent = false;
    ring->written = at + 1;
    return true;
}

bool takt_line_ring_is_empty(const struct line_ring *ring)
{
    return ring->taken == ring->written;
}

uint8_t takt_line_ring_take(struct line_ring *ring, bool *after_silence)
{
    const uint32_t at = ring->taken;
    const uint32_t place = at % LINE_RING_MAX;
    const uint8_t byte = ring->byte[place];
    const unsigned bits = ring->after_silence[place / BITS];

    *after_silence = (bits >> place % BITS & 1U) != 0;
    ring->taken = at + 1;
    return byte;
}

bool takt_line_ring_is_silent(const struct line_ring *ring, uint32_t now_us)
{
    return takt_line_ring_is_empty(ring) && has_been_silent(ring, now_us);
}

#include "port/line_ring.h"

/* An entry: 24 bits of time above 8 bits of data. */
#define TIME_SHIFT 8
#define TIME_MASK  0xFFFFFFU

bool line_ring_put(struct line_ring *ring, uint8_t byte, uint32_t now_us)
{
    const uint32_t at = ring->written;

    if (at - ring->taken == LINE_RING_MAX)
        return false;
    ring->entry[at % LINE_RING_MAX] = now_us << TIME_SHIFT | byte;
    ring->written = at + 1;
    return true;
}

bool line_ring_is_empty(const struct line_ring *ring)
{
    return ring->taken == ring->written;
}

uint8_t line_ring_take(struct line_ring *ring, uint32_t now_us, uint32_t *came_us)
{
    const uint32_t at = ring->taken;
    const uint32_t entry = ring->entry[at % LINE_RING_MAX];

    const uint32_t age_us = (now_us - (entry >> TIME_SHIFT)) & TIME_MASK;

    *came_us = age_us > TIME_MASK / 2U ? now_us : now_us - age_us;
    ring->taken = at + 1;
    return (uint8_t)entry;
}

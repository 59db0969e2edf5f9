#include "stm32/log_ring.h"

#define LINE_END "\r\n"

static void put_text(struct log_ring *ring, const char *text)
{
    for (; *text != '\0'; text++)
        ring->byte[ring->written++ % LOG_RING_MAX] = (uint8_t)*text;
}

bool takt_log_ring_put(struct log_ring *ring, const char *line)
{
    const uint32_t room = LOG_RING_MAX - (ring->written - ring->taken);
    uint32_t length = sizeof LINE_END - 1;

    for (const char *c = line; *c != '\0'; c++)
        length++;
    if (length > room) {
        ring->left_out++;
        return false;
    }
    put_text(ring, line);
    put_text(ring, LINE_END);
    return true;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

size_t takt_log_ring_take(struct log_ring *ring, const uint8_t **bytes, size_t most)
{
    size_t at;

    ring->taken += ring->given;
    at = ring->taken % LOG_RING_MAX;
    ring->given = (uint32_t)least(least(ring->written - ring->taken, LOG_RING_MAX - at), most);
    *bytes = ring->byte + at;
    return ring->given;
}

#include "stm32f405/log_ring.h"

#define LINE_END "\r\n"

static void put_text(struct log_ring *ring, const char *text)
{
    for (; *text != '\0'; text++)
        ring->byte[ring->written++ % LOG_RING_MAX] = *text;
}

bool log_ring_put(struct log_ring *ring, const char *line)
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

size_t log_ring_take(struct log_ring *ring, uint8_t *bytes, size_t size)
{
    size_t count = 0;

    while (count < size && ring->taken != ring->written)
        bytes[count++] = (uint8_t)ring->byte[ring->taken++ % LOG_RING_MAX];
    return count;
}

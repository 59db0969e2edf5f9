#include "modbus/tcp.h"

#include "base/assert.h"

#include <string.h>

/* Where the length stands, and what it counts: unit and PDU. */
#define LENGTH_AT  4
#define LENGTH_END 6
#define LENGTH_MIN 2
#define LENGTH_MAX (1 + MODBUS_PDU_MAX)

void takt_modbus_tcp_init(struct modbus_tcp *tcp)
{
    tcp->length = 0;
}

/* Takes bytes until length are there. */
static bool fill(struct modbus_tcp *tcp, size_t length, const uint8_t **data, size_t *size)
{
    size_t missing = length - tcp->length;

    TAKT_ASSERT(length <= sizeof tcp->frame && tcp->length <= length);
    if (missing > *size)
        missing = *size;
    memcpy(tcp->frame + tcp->length, *data, missing);
    tcp->length += missing;
    *data += missing;
    *size -= missing;
    return tcp->length == length;
}

static bool header_is_good(const struct modbus_tcp *tcp)
{
    const uint16_t length = modbus_read16(tcp->frame + LENGTH_AT);

    return modbus_read16(tcp->frame + 2) == 0 && length >= LENGTH_MIN && length <= LENGTH_MAX;
}

static size_t answer(const struct modbus_tcp *tcp, const struct modbus_map *map, uint8_t *reply)
{
    const size_t length =
        takt_modbus_answer(map, tcp->frame + MODBUS_TCP_HEADER, tcp->length - MODBUS_TCP_HEADER,
                           reply + MODBUS_TCP_HEADER);

    TAKT_ASSERT(tcp->length >= MODBUS_TCP_HEADER && tcp->length <= sizeof tcp->frame);
    memcpy(reply, tcp->frame, MODBUS_TCP_HEADER);
    modbus_write16(reply + LENGTH_AT, (uint16_t)(length + 1));
    return MODBUS_TCP_HEADER + length;
}

enum modbus_tcp_result takt_modbus_tcp_take(struct modbus_tcp *tcp, const struct modbus_map *map,
                                            const uint8_t **data, size_t *size, uint8_t *reply,
                                            size_t *reply_length)
{
    if (tcp->length < LENGTH_END && !fill(tcp, LENGTH_END, data, size))
        return MODBUS_TCP_MORE;
    if (!header_is_good(tcp))
        return MODBUS_TCP_BROKEN;
    if (!fill(tcp, LENGTH_END + (size_t)modbus_read16(tcp->frame + LENGTH_AT), data, size))
        return MODBUS_TCP_MORE;
    *reply_length = answer(tcp, map, reply);
    tcp->length = 0;
    return MODBUS_TCP_REPLY;
}

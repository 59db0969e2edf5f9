#include "bus/wire_frame.h"

#include <string.h>

void wire_frame_from_can(struct wire_frame *wire, const struct can_frame *can, bool fd)
{
    const unsigned length = can_data_length(can);
    wire->id = can->id & CAN_ID_MASK;
    wire->flags = can_is_remote(can) ? WIRE_REMOTE : fd ? WIRE_KIND_FD : 0;
    wire->length = can_is_remote(can) ? can->length : wire_frame_fd_length(length);
    memcpy(wire->data, can->data, length);
    if (!can_is_remote(can))
        memset(wire->data + length, 0, wire->length - length);
}

bool wire_frame_to_can(const struct wire_frame *wire, struct can_frame *can)
{
    if ((wire->flags & (WIRE_EXTENDED | WIRE_ERROR)) != 0 || wire->id > CAN_ID_MASK ||
        wire->length > CAN_DATA_MAX)
        return false;
    can->id = (uint16_t)(wire->id | (wire->flags & WIRE_REMOTE ? CAN_REMOTE : 0));
    can->length = wire->length;
    memset(can->data, 0, sizeof can->data);
    memcpy(can->data, wire->data, can_data_length(can));
    return true;
}

/* Lengths of codes above CAN_CLASSIC_MAX. */
static const uint8_t long_lengths[] = {12, 16, 20, 24, 32, 48, WIRE_DATA_MAX};
#define LONG_LENGTHS (sizeof long_lengths - 1)

unsigned wire_frame_fd_code(unsigned length)
{
    unsigned i = 0;
    if (length <= CAN_CLASSIC_MAX)
        return length;
    while (i < LONG_LENGTHS && long_lengths[i] < length)
        i++;
    return CAN_CLASSIC_MAX + 1 + i;
}

uint8_t wire_frame_fd_length(unsigned bytes)
{
    unsigned code = wire_frame_fd_code(bytes);
    return (uint8_t)(code <= CAN_CLASSIC_MAX ? code : long_lengths[code - CAN_CLASSIC_MAX - 1]);
}

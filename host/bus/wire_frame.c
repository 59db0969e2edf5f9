#include "bus/wire_frame.h"

#include <string.h>

void wire_frame_from_can(struct wire_frame *wire, const struct can_frame *can)
{
    wire->id = can->id & CAN_ID_MASK;
    wire->flags = can_is_remote(can) ? WIRE_REMOTE : 0;
    wire->length = can->length;
    memcpy(wire->data, can->data, can_data_length(can));
}

bool wire_frame_to_can(const struct wire_frame *wire, struct can_frame *can)
{
    if ((wire->flags & ~WIRE_REMOTE) != 0 || wire->id > CAN_ID_MASK || wire->length > CAN_DATA_MAX)
        return false;
    can->id = (uint16_t)(wire->id | (wire->flags != 0 ? CAN_REMOTE : 0));
    can->length = wire->length;
    memset(can->data, 0, sizeof can->data);
    memcpy(can->data, wire->data, can_data_length(can));
    return true;
}

uint8_t wire_frame_fd_length(unsigned bytes)
{
    static const uint8_t lengths[] = {12, 16, 20, 24, 32, 48};
    if (bytes <= CAN_DATA_MAX)
        return (uint8_t)bytes;
    for (unsigned i = 0; i < sizeof lengths; i++)
        if (bytes <= lengths[i])
            return lengths[i];
    return WIRE_DATA_MAX;
}

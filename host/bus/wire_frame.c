#include "bus/wire_frame.h"

#include <string.h>

#define STANDARD_ID_MAX 0x7FFu

void wire_frame_from_can(struct wire_frame *wire, const struct can_frame *can)
{
    wire->id = can->id;
    wire->flags = 0;
    wire->length = can->length;
    memcpy(wire->data, can->data, can->length);
}

bool wire_frame_to_can(const struct wire_frame *wire, struct can_frame *can)
{
    if (wire->flags != 0 || wire->id > STANDARD_ID_MAX || wire->length > CAN_DATA_MAX)
        return false;
    can->id = (uint16_t)wire->id;
    can->length = wire->length;
    memcpy(can->data, wire->data, wire->length);
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

#include "canopen/sdo.h"
#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"

uint32_t takt_sdo_read_object(const struct can_frame *frame)
{
    return SDO_OBJECT(little_endian_read16(frame->data + 1), frame->data[3]);
}

void takt_sdo_write_initiate(struct can_frame *frame, uint16_t cob_id, uint8_t command,
                             uint32_t object, uint32_t value)
{
    frame->id = cob_id;
    frame->length = SDO_LENGTH;
    frame->data[0] = command;
    little_endian_write16(frame->data + 1, (uint16_t)(object >> 16));
    frame->data[3] = (uint8_t)(object >> 8);
    little_endian_write32(frame->data + 4, value);
}

void takt_sdo_write_abort(struct can_frame *frame, uint16_t function, uint8_t node, uint32_t object,
                          uint32_t code)
{
    TAKT_ASSERT(node >= NODE_MIN && node <= NODE_MAX);
    takt_sdo_write_initiate(frame, (uint16_t)(function + node), SDO_ABORT, object, code);
}

void takt_sdo_write_word(struct can_frame *frame, uint8_t node, uint32_t object, uint16_t value)
{
    const uint8_t command =
        SDO_REQUEST_DOWNLOAD | (SDO_EXPEDITED_MAX - 2) << 2 | SDO_EXPEDITED | SDO_SIZE_GIVEN;
    TAKT_ASSERT(node >= NODE_MIN && node <= NODE_MAX);
    takt_sdo_write_initiate(frame, (uint16_t)(SDO_REQUEST_FUNCTION + node), command, object, value);
}

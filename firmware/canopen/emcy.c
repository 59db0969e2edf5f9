#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"

#include <string.h>

#define EMCY_LENGTH 8

void emcy_write(struct can_frame *frame, const struct emcy *emcy)
{
    frame->id = (uint16_t)(EMCY_FUNCTION + emcy->node);
    frame->length = EMCY_LENGTH;
    little_endian_write16(frame->data, emcy->code);
    frame->data[2] = emcy->error_register;
    memcpy(frame->data + 3, emcy->vendor, sizeof emcy->vendor);
}

bool emcy_read(const struct can_frame *frame, struct emcy *emcy)
{
    emcy->node = node_id(frame->id);
    if (node_function(frame->id) != EMCY_FUNCTION || emcy->node == 0 ||
        frame->length != EMCY_LENGTH)
        return false;
    emcy->code = little_endian_read16(frame->data);
    emcy->error_register = frame->data[2];
    memcpy(emcy->vendor, frame->data + 3, sizeof emcy->vendor);
    return true;
}

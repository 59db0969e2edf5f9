#include "canopen/emcy.h"
#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"

#include <string.h>

#define EMCY_LENGTH 8

/* Below: 00xx, error reset or no error, whatever the lower byte is. */
#define EMCY_FIRST 0x0100

void takt_emcy_write(struct can_frame *frame, const struct emcy *emcy)
{
    TAKT_ASSERT(emcy->node >= NODE_MIN && emcy->node <= NODE_MAX);
    frame->id = (uint16_t)(EMCY_FUNCTION + emcy->node);
    frame->length = EMCY_LENGTH;
    little_endian_write16(frame->data, emcy->code);
    frame->data[2] = emcy->error_register;
    memcpy(frame->data + 3, emcy->vendor, sizeof emcy->vendor);
}

bool takt_emcy_read(const struct can_frame *frame, struct emcy *emcy)
{
    emcy->node = node_id(frame->id);
    if (node_function(frame->id) != EMCY_FUNCTION || emcy->node == 0 ||
        frame->length != EMCY_LENGTH)
        return false;
    emcy->code = little_endian_read16(frame->data);
    if (emcy->code < EMCY_FIRST)
        emcy->code = EMCY_NONE;
    emcy->error_register = frame->data[2];
    memcpy(emcy->vendor, frame->data + 3, sizeof emcy->vendor);
    return true;
}

/* Codes before their classes: the first row whose masked code agrees is the answer. */
static const struct {
    uint16_t code, mask;
    const char *text;
} meanings[] = {
    {0x0000, 0xFFFF, "no error"},
    {0x3210, 0xFFFF, "DC bus over-voltage"},
    {0x3220, 0xFFFF, "DC bus under-voltage"},
    {0x4210, 0xFFFF, "device too hot"},
    {0x4310, 0xFFFF, "drive too hot"},
    {0x6320, 0xFFFF, "invalid parameter"},
    {0x7121, 0xFFFF, "motor blocked"},
    {0x7305, 0xFFFF, "encoder"},
    {0x8110, 0xFFFF, "CAN overrun: frames lost"},
    {0x8120, 0xFFFF, "CAN error passive"},
    {0x8130, 0xFFFF, "heartbeat of the controller lost"},
    {0x8140, 0xFFFF, "recovered from bus-off"},
    {0x8210, 0xFFFF, "PDO too short"},
    {0x8220, 0xFFFF, "PDO too long"},
    {0x8250, 0xFFFF, "no RPDO in time"},
    {0x8611, 0xFFFF, "following error"},
    {0x8612, 0xFFFF, "reference limit"},
    {0x8700, 0xFFFF, "SYNC missing or at the wrong time"},
    {0x1000, 0xF000, "generic error"},
    {0x2300, 0xFF00, "current at the output"},
    {0x2000, 0xF000, "current"},
    {0x3100, 0xFF00, "mains voltage"},
    {0x3200, 0xFF00, "DC bus voltage"},
    {0x3000, 0xF000, "voltage"},
    {0x4000, 0xF000, "temperature"},
    {0x5000, 0xF000, "hardware of the drive"},
    {0x6000, 0xF000, "software of the drive"},
    {0x7100, 0xFF00, "power stage or motor"},
    {0x7300, 0xFF00, "sensor"},
    {0x7000, 0xF000, "additional module"},
    {0x8100, 0xFF00, "communication"},
    {0x8200, 0xFF00, "protocol error"},
    {0x8400, 0xFF00, "velocity controller"},
    {0x8500, 0xFF00, "position controller"},
    {0x8600, 0xFF00, "positioning controller"},
    {0x8000, 0xF000, "monitoring"},
    {0x9000, 0xF000, "external error"},
    {0xF000, 0xF000, "additional functions"},
};

const char *takt_emcy_text(uint16_t code)
{
    for (unsigned i = 0; i < sizeof meanings / sizeof meanings[0]; i++)
        if ((code & meanings[i].mask) == meanings[i].code)
            return meanings[i].text;
    return "made up by the manufacturer";
}

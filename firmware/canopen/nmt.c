#include "canopen/nmt.h"
#include "base/assert.h"
#include "canopen/node.h"

void takt_nmt_write_command(struct can_frame *frame, enum nmt_command command, uint8_t node)
{
    TAKT_ASSERT(node <= NODE_MAX);
    frame->id = NMT_COMMAND_COB_ID;
    frame->length = 2;
    frame->data[0] = (uint8_t)command;
    frame->data[1] = node;
}

static bool command_from_byte(uint8_t byte, enum nmt_command *command)
{
    switch (byte) {
    case NMT_START:
        *command = NMT_START;
        return true;
    case NMT_STOP:
        *command = NMT_STOP;
        return true;
    case NMT_ENTER_PREOPERATIONAL:
        *command = NMT_ENTER_PREOPERATIONAL;
        return true;
    case NMT_RESET_NODE:
        *command = NMT_RESET_NODE;
        return true;
    case NMT_RESET_COMMUNICATION:
        *command = NMT_RESET_COMMUNICATION;
        return true;
    default:
        return false;
    }
}

bool takt_nmt_read_command(const struct can_frame *frame, enum nmt_command *command, uint8_t *node)
{
    if (frame->id != NMT_COMMAND_COB_ID || frame->length != 2 || frame->data[1] > NODE_MAX)
        return false;
    *node = frame->data[1];
    return command_from_byte(frame->data[0], command);
}

void takt_nmt_write_heartbeat(struct can_frame *frame, uint8_t node, enum nmt_state state)
{
    TAKT_ASSERT(node <= NODE_MAX);
    frame->id = (uint16_t)(NMT_HEARTBEAT_FUNCTION + node);
    frame->length = 1;
    frame->data[0] = (uint8_t)state;
}

bool takt_nmt_read_heartbeat(const struct can_frame *frame, uint8_t *node, enum nmt_state *state)
{
    *node = node_id(frame->id);
    return node_function(frame->id) == NMT_HEARTBEAT_FUNCTION && *node != 0 &&
           nmt_read_state(frame, state);
}

void takt_nmt_write_guard(struct can_frame *frame, uint8_t node)
{
    TAKT_ASSERT(node >= NODE_MIN && node <= NODE_MAX);
    *frame = (struct can_frame){.id = (uint16_t)((CAN_REMOTE | NMT_HEARTBEAT_FUNCTION) + node),
                                .length = 1};
}

enum nmt_state takt_nmt_next_state(enum nmt_command command)
{
    switch (command) {
    case NMT_START:
        return NMT_OPERATIONAL;
    case NMT_STOP:
        return NMT_STOPPED;
    case NMT_ENTER_PREOPERATIONAL:
        return NMT_PREOPERATIONAL;
    case NMT_RESET_NODE:
    case NMT_RESET_COMMUNICATION:
        break;
    }
    return NMT_BOOTED;
}

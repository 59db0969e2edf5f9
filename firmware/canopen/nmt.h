/*
 * Network management (CiA 301, 7.2.8): the master's commands, the state of a node, and the
 * heartbeat by which a node tells it. A node that has booted says so by a heartbeat of state
 * NMT_BOOTED.
 */
#ifndef TAKT_CANOPEN_NMT_H
#define TAKT_CANOPEN_NMT_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define NMT_COMMAND_COB_ID     0x000
#define NMT_HEARTBEAT_FUNCTION 0x700 /* identifier: this plus the node id */

#define NMT_ALL_NODES 0 /* as the node of a command */

enum nmt_command {
    NMT_START = 0x01,
    NMT_STOP = 0x02,
    NMT_ENTER_PREOPERATIONAL = 0x80,
    NMT_RESET_NODE = 0x81,
    NMT_RESET_COMMUNICATION = 0x82
};

/* The values are those of the heartbeat frame. */
enum nmt_state {
    NMT_BOOTED = 0x00,
    NMT_STOPPED = 0x04,
    NMT_OPERATIONAL = 0x05,
    NMT_PREOPERATIONAL = 0x7F
};

/* node: 1 ... 127, or NMT_ALL_NODES. */
void takt_nmt_write_command(struct can_frame *frame, enum nmt_command command, uint8_t node);
/*
 * False: the frame is no NMT command (wrong identifier or length, or a command CiA 301 does not
 * know).
 */
bool takt_nmt_read_command(const struct can_frame *frame, enum nmt_command *command, uint8_t *node);

void takt_nmt_write_heartbeat(struct can_frame *frame, uint8_t node, enum nmt_state state);
/* False: the frame is no heartbeat. */
bool takt_nmt_read_heartbeat(const struct can_frame *frame, uint8_t *node, enum nmt_state *state);
/*
 * An answer to a guarding master is the same frame with this bit, which changes from each answer to
 * the next (7.2.8.3.2.1).
 */
#define NMT_TOGGLE 0x80u
/*
 * Reads a frame that has the identifier of a heartbeat. False: its length or its state is none that
 * CiA 301 knows.
 */
static inline bool nmt_read_state(const struct can_frame *frame, enum nmt_state *state)
{
    if (frame->length != 1)
        return false;
    *state = (enum nmt_state)(frame->data[0] & ~NMT_TOGGLE);
    return *state == NMT_OPERATIONAL || *state == NMT_PREOPERATIONAL || *state == NMT_STOPPED ||
           *state == NMT_BOOTED;
}

/*
 * Node guarding: the remote frame by which a master asks a node for its state, of whatever length.
 */
void takt_nmt_write_guard(struct can_frame *frame, uint8_t node);
static inline bool nmt_is_guard(const struct can_frame *frame, uint8_t node)
{
    return frame->id == (CAN_REMOTE | NMT_HEARTBEAT_FUNCTION) + node;
}

/*
 * State of a node after a command. Both resets lead to NMT_BOOTED, which the node leaves by itself.
 */
enum nmt_state takt_nmt_next_state(enum nmt_command command);

#endif

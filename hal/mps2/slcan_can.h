/*
 * A CAN controller made of a serial line with the Lawicel protocol: QEMU's MPS2 boards have none.
 * At the other end may be an adapter (`takt drives --bus slcan:pty:NAME`), which wants its channel
 * to be opened, or a computer (slcand, which makes an interface of the kernel of it), which passes
 * over what is no frame.
 *
 * The line is slower than a bus and has no clock, so this also knows when a cycle is over: once the
 * drives in step, those that have answered a SYNC, have answered the last one, and all of them
 * their SDO.
 */
#ifndef TAKT_MPS2_SLCAN_CAN_H
#define TAKT_MPS2_SLCAN_CAN_H

#include "hal/can.h"
#include "mps2/uart.h"

#include <stdbool.h>
#include <stdint.h>

#define SLCAN_CAN_LINE_MAX   32
#define SLCAN_CAN_FRAMES_MAX 128 /* received; a power of two */
#define SLCAN_CAN_NODES      128

struct slcan_can {
    struct uart *line;
    char text[SLCAN_CAN_LINE_MAX]; /* of the line being received */
    unsigned length;
    volatile uint32_t written, taken; /* frames received */
    struct can_frame frame[SLCAN_CAN_FRAMES_MAX];
    volatile uint8_t cycle; /* number of the last SYNC, 1 ... 255 and on from 1; 0: none yet */
    /*
     * of each node: the SYNC that it has answered last, 0: none; and whether an SDO waits for its
     * answer
     */
    volatile uint8_t answered[SLCAN_CAN_NODES];
    volatile bool asked[SLCAN_CAN_NODES];
    volatile bool lost; /* a frame found no room */
};

/* line carries it; its bytes go to takt_slcan_can_take. */
void takt_slcan_can_open(struct slcan_can *can, struct uart *line);

/*
 * Opens the channel of the adapter at the other end, if there is one. False: no frame has come yet,
 * so it may not have heard.
 */
bool takt_slcan_can_announce(struct slcan_can *can);

/* A byte has come: of struct uart. */
void takt_slcan_can_take(void *can, uint8_t byte);

struct can_port takt_slcan_can_get_port(struct slcan_can *can);

/* Has this node answered any SYNC? */
bool takt_slcan_can_is_in_step(const struct slcan_can *can, uint8_t node);
/* Has it answered all it has been asked: an SDO, and once it is in step the last SYNC? */
bool takt_slcan_can_has_answered(const struct slcan_can *can, uint8_t node);

/* A node is not waited for any more until it answers again. */
void takt_slcan_can_give_up(struct slcan_can *can, uint8_t node);

#endif

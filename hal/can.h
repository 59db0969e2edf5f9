/*
 * Contract of a CAN controller.
 *
 * Non-blocking on both sides. A port may be the embedded bus of the host, SocketCAN, a serial line or the
 * peripheral of a microcontroller; the firmware cannot tell.
 */
#ifndef TAKT_HAL_CAN_H
#define TAKT_HAL_CAN_H

#include <stdbool.h>
#include <stdint.h>

#define CAN_DATA_MAX 8

struct can_frame {
    uint16_t id;    /* 11 bits */
    uint8_t length; /* 0 ... CAN_DATA_MAX */
    uint8_t data[CAN_DATA_MAX];
};

struct can_port {
    /* Queues a frame for sending. False: no room; the frame is not sent and the caller decides what that means.
     * Must not wait. */
    bool (*send)(void *context, const struct can_frame *frame);
    /* Takes the oldest received frame. False: none. Must not wait. */
    bool (*receive)(void *context, struct can_frame *frame);
    void *context; /* owned by whoever made the port */
};

#endif

/*
 * A CAN frame of any kind, as adapters, sockets and logs know it. The firmware itself speaks data
 * frames with 11-bit identifiers, all of one kind, and remote ones (hal/can.h); everything else
 * passes by it.
 */
#ifndef TAKT_BUS_WIRE_FRAME_H
#define TAKT_BUS_WIRE_FRAME_H

#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define WIRE_DATA_MAX 64

enum wire_flag {
    WIRE_EXTENDED = 1,    /* 29-bit identifier */
    WIRE_REMOTE = 2,      /* remote request: length says how much is asked for, no data */
    WIRE_FD = 4,          /* CAN FD: up to 64 bytes */
    WIRE_RATE_SWITCH = 8, /* FD: data at the higher rate */
    WIRE_PASSIVE = 16,    /* FD: its sender is error passive */
    WIRE_ERROR = 32       /* no frame of a node: an error message of the interface (SocketCAN) */
};

struct wire_frame {
    uint32_t id;
    uint8_t flags;  /* of enum wire_flag */
    uint8_t length; /* bytes of data; FD: one of 0 ... 8, 12, 16, 20, 24, 32, 48, 64 */
    uint8_t data[WIRE_DATA_MAX];
};

/* What anybody who watches a bus is called with. time_ns: when the frame ended; see the bus. */
struct wire_listener {
    void (*on_frame)(void *context, const struct wire_frame *frame, uint64_t time_ns);
    void *context;
};

/*
 * A frame of a port that speaks CAN FD has these flags, and zeros up to a length that there is. A
 * remote frame never.
 */
#define WIRE_KIND_FD (WIRE_FD | WIRE_RATE_SWITCH)
void wire_frame_from_can(struct wire_frame *wire, const struct can_frame *can, bool fd);

/* False: the frame is none that the firmware knows. */
bool wire_frame_to_can(const struct wire_frame *wire, struct can_frame *can);

/* The least FD length that holds this many bytes; WIRE_DATA_MAX above it. */
uint8_t wire_frame_fd_length(unsigned bytes);
/* The code of such a length, 0 ... 15. */
unsigned wire_frame_fd_code(unsigned length);

#endif

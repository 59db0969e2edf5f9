/*
 * Contract of a CAN controller.
 *
 * Non-blocking on both sides. A port may be the embedded bus of the host, SocketCAN, a serial line
 * or the peripheral of a microcontroller; the firmware cannot tell.
 */
#ifndef TAKT_HAL_CAN_H
#define TAKT_HAL_CAN_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/*
 * Bytes of the longest frame: 64 with CAN FD. A build for a controller that has classical CAN alone
 * says 8, and has smaller queues.
 */
#ifndef CAN_DATA_MAX
#define CAN_DATA_MAX 64
#endif
#define CAN_CLASSIC_MAX 8

/* CAN buses of a machine at most. A build for a board with one controller says 1. */
#ifndef CAN_BUSES_MAX
#define CAN_BUSES_MAX 2
#endif

/*
 * Flag in an id: a remote frame, which asks for the frame of that identifier. It has no data; its
 * length is that of what it asks for. Whoever looks for an identifier by == never takes one for a
 * frame with data.
 */
#define CAN_REMOTE  0x8000U
#define CAN_ID_MASK 0x07FFU

struct can_frame {
    uint16_t id; /* 11 bits, and CAN_REMOTE */
    /* 0 ... CAN_CLASSIC_MAX; of a port that speaks CAN FD also 12, 16, 20, 24, 32, 48, 64 */
    uint8_t length;
    uint8_t data[CAN_DATA_MAX];
};

static inline bool can_is_remote(const struct can_frame *frame)
{
    return (frame->id & CAN_REMOTE) != 0;
}

/* Bytes of data on the wire. */
static inline unsigned can_data_length(const struct can_frame *frame)
{
    return can_is_remote(frame) ? 0 : frame->length;
}

/*
 * The same frame once more. What is behind its data means nothing, and of short frames, which
 * nearly all are, it is not copied.
 */
static inline void can_copy(struct can_frame *to, const struct can_frame *from)
{
    to->id = from->id;
    to->length = from->length;
    memcpy(to->data, from->data, CAN_CLASSIC_MAX);
    if (from->length > CAN_CLASSIC_MAX)
        memcpy(to->data + CAN_CLASSIC_MAX, from->data + CAN_CLASSIC_MAX,
               CAN_DATA_MAX - CAN_CLASSIC_MAX);
}

/* A filter: bit id says whether frames of this identifier, remote ones too, pass. */
#define CAN_FILTER_WORDS 64
static inline bool can_passes(const uint32_t filter[CAN_FILTER_WORDS], uint16_t id)
{
    return filter[id >> 5 & (CAN_FILTER_WORDS - 1)] >> (id & 31) & 1;
}

/* Who wins arbitration: the lower one. Of one identifier that is the frame with data. */
static inline unsigned can_rank(uint16_t id)
{
    return (id & CAN_ID_MASK) << 1 | ((id & CAN_REMOTE) != 0);
}

/*
 * All data frames of a port are of one kind: classical, or CAN FD with the data at the higher rate.
 * Remote frames are always classical.
 */
struct can_port {
    /*
     * Queues a frame for sending. False: no room; the frame is not sent and the caller decides what
     * that means. Must not wait.
     */
    bool (*send)(void *context, const struct can_frame *frame);
    /*
     * Takes the oldest received frame. False: none. Must not wait. A port of a master need not
     * receive remote frames.
     */
    bool (*receive)(void *context, struct can_frame *frame);
    void *context; /* owned by whoever made the port */
};

/*
 * The buses of a machine, by their index: 0 is can0, 1 is can1. Ports of buses on which the machine
 * has no node are not called and may be zeros. A frame goes to the port of its bus alone, and
 * nothing is said of an order between buses.
 */
struct can_buses {
    struct can_port port[CAN_BUSES_MAX];
};

static inline struct can_buses can_single(struct can_port port)
{
    return (struct can_buses){.port = {port}};
}

#endif

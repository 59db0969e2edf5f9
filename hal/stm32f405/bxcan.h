/*
 * The chip's CAN controller behind hal/can.h.
 *
 *     bxcan_send  ->  queue, by priority, the same identifier in order  ->  3 mailboxes  ->  bus
 *     bus  ->  filters  ->  FIFO of 3  ->  ring  ->  bxcan_receive
 *
 * What the hardware alone would not do:
 * - Two frames of one identifier are never in mailboxes at once: those send equal identifiers in the order of the
 *   mailboxes, not of the calls.
 * - A frame that is more urgent than all three in the mailboxes has the least urgent of them taken back and queued
 *   again, so that it waits for one frame on the bus at most (no inversion of priorities).
 * - After bus-off what was to be sent is dropped, being old, and the bus is joined again; until then bxcan_send
 *   refuses.
 *
 * No call waits for the bus. bxcan_open waits for the controller, with an end.
 */
#ifndef TAKT_STM32F405_BXCAN_H
#define TAKT_STM32F405_BXCAN_H

#include "hal/can.h"

#define BXCAN_MAILBOXES    3
#define BXCAN_QUEUE_MAX    32
#define BXCAN_RECEIVED_MAX 64 /* a power of two; one place stays free */
#define BXCAN_NODES_MAX    28

enum bxcan_state {
    BXCAN_ABSENT,  /* the controller does not answer: nothing is sent or received */
    BXCAN_WAITING, /* the bus is not idle yet: no transceiver, a short, or it is held dominant */
    BXCAN_ON,
    BXCAN_BUS_OFF,  /* thrown out by its errors; the controller is being started again */
    BXCAN_REJOINING /* hears 128 times 11 recessive bits before it may send again */
};

struct bxcan_config {
    uint32_t base;       /* BXCAN_CAN1 */
    uint32_t clock_hz;   /* of APB1 */
    uint32_t bitrate;    /* bit/s */
    unsigned nodes;      /* 0: every frame with an 11-bit identifier is received */
    const uint8_t *node; /* else: those whose lowest 7 bits are one of these node ids */
};

/* Since bxcan_open; they wrap. */
struct bxcan_counts {
    uint32_t sent, received;
    uint32_t taken_back; /* mailboxes emptied for something more urgent */
    uint32_t dropped;    /* to be sent when the bus was lost */
    uint32_t overruns;   /* times the controller's FIFO was full */
    uint32_t lost;       /* received, and no room in the ring */
    uint32_t bus_offs;
    uint32_t
        error[8]; /* by the last error code: 1 stuff, 2 form, 3 no acknowledge, 4 5 bit, 6 CRC */
};

/* Private. */
struct bxcan {
    uint32_t base;
    volatile enum bxcan_state state;
    struct can_frame queue[BXCAN_QUEUE_MAX]; /* to be sent, the first first */
    unsigned queued;
    struct can_frame mailbox[BXCAN_MAILBOXES];
    bool is_full[BXCAN_MAILBOXES];
    bool is_wanted_back[BXCAN_MAILBOXES];
    struct can_frame received[BXCAN_RECEIVED_MAX];
    volatile unsigned first, behind; /* of the ring */
    struct bxcan_counts counts;
};

/*
 * Bit rate and filters; then joins the bus, which may take until later (BXCAN_WAITING). False: the bit rate is not
 * possible, there are more than BXCAN_NODES_MAX nodes, or the controller does not answer; its state is BXCAN_ABSENT then.
 */
bool bxcan_open(struct bxcan *can, const struct bxcan_config *config);

/* For hal/can.h. The bxcan must not be moved afterwards. */
struct can_port bxcan_get_port(struct bxcan *can);

/* From the interrupts of mailboxes and of the receive FIFO. */
void bxcan_interrupt_sent(struct bxcan *can);
void bxcan_interrupt_received(struct bxcan *can);

/* Once every control cycle: watches for bus-off and leads back. */
void bxcan_poll(struct bxcan *can);

enum bxcan_state bxcan_get_state(const struct bxcan *can);
const struct bxcan_counts *bxcan_get_counts(const struct bxcan *can);

/* The controller's own error counters: to 96 healthy, from 128 passive, sending beyond 255 is bus-off. */
void bxcan_get_errors(const struct bxcan *can, unsigned *sending, unsigned *receiving);

/*
 * The bit timing register for a rate: sampled as near to 7/8 of a bit as can be. 0: no division of the clock gives the
 * rate exactly.
 */
uint32_t bxcan_timing(uint32_t clock_hz, uint32_t bitrate);

#endif

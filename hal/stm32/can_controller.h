/*
 * The chip's CAN controller behind hal/can.h.
 *
 *     send  ->  queue, by priority, the same identifier in order  ->  3 mailboxes  ->  bus
 *     bus  ->  filters  ->  the controller's FIFO  ->  ring  ->  receive
 *
 * What the hardware alone would not do:
 * - Two frames of one identifier are never in mailboxes at once: those send equal identifiers in
 *   the order of the mailboxes, not of the calls.
 * - A frame that is more urgent than all three in the mailboxes has the least urgent of them taken
 *   back and queued again, so that it waits for one frame on the bus at most (no inversion of
 *   priorities).
 * - After bus-off what was to be sent is dropped, being old, and the bus is joined again; until
 *   then send refuses.
 *
 * No call waits for the bus. takt_can_controller_open waits for the controller, with an end.
 */
#ifndef TAKT_STM32_CAN_CONTROLLER_H
#define TAKT_STM32_CAN_CONTROLLER_H

#include "hal/can.h"
#include "stm32/can_hardware.h"

#define CAN_QUEUE_MAX    32
#define CAN_RECEIVED_MAX 64 /* a power of two; one place stays free */

enum can_state {
    CAN_ABSENT,  /* the controller does not answer: nothing is sent or received */
    CAN_WAITING, /* the bus is not idle yet: no transceiver, a short, or it is held dominant */
    CAN_ON,
    CAN_BUS_OFF,  /* thrown out by its errors; the controller is being started again */
    CAN_REJOINING /* hears 128 times 11 recessive bits before it may send again */
};

/* Since takt_can_controller_open; they wrap. */
struct can_counts {
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
struct can_controller {
    volatile enum can_state state;
    struct can_frame queue[CAN_QUEUE_MAX]; /* to be sent, the first first */
    unsigned queued;
    struct can_frame mailbox[CAN_MAILBOXES];
    bool is_full[CAN_MAILBOXES];
    bool is_wanted_back[CAN_MAILBOXES];
    struct can_frame received[CAN_RECEIVED_MAX];
    volatile unsigned first, behind; /* of the ring */
    struct can_counts counts;
};

/*
 * Rates and filters; then joins the bus, which may take until later (CAN_WAITING). False: a rate is
 * not possible, there are more than CAN_NODES_MAX nodes, or the controller does not answer; its
 * state is CAN_ABSENT then.
 */
bool takt_can_controller_open(struct can_controller *can, const struct can_config *config);

/* For hal/can.h. The controller must not be moved afterwards. */
struct can_port takt_can_controller_get_port(struct can_controller *can);

/* From the interrupts of mailboxes and of the receive FIFO. */
void takt_can_controller_interrupt_sent(struct can_controller *can);
void takt_can_controller_interrupt_received(struct can_controller *can);

/* Once every control cycle: watches for bus-off and leads back. */
void takt_can_controller_poll(struct can_controller *can);

enum can_state takt_can_controller_get_state(const struct can_controller *can);
const struct can_counts *takt_can_controller_get_counts(const struct can_controller *can);

#endif

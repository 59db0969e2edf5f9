/*
 * A CAN controller (bxCAN in can_model.c, FDCAN in fdcan_model.c) and the bus behind it. The test
 * says when the bus is free for a frame and what the other nodes send.
 */
#ifndef TAKT_TESTS_CAN_MODEL_H
#define TAKT_TESTS_CAN_MODEL_H

#include "hal/can.h"

/* Set after chip_model_reset. */
struct can_model {
    bool is_absent;   /* every register reads 0 */
    bool bus_is_idle; /* the receive pin shows recessive bits: a transceiver is there */
    /* of the next received frame: 1 an identifier of 29 bits, 2 a remote frame */
    unsigned extended_or_remote;
};

extern struct can_model can_model;

/*
 * The bus is free: the controller begins to send what wins among its mailboxes. False: nothing is
 * to be sent.
 */
bool can_model_begin(struct can_frame *frame);
/*
 * That frame has been sent and acknowledged, or it was lost and is still to be sent unless it has
 * been called back.
 */
void can_model_end(bool acknowledged);
/* Both. */
bool can_model_transfer(struct can_frame *frame);

/* Another node has sent a frame. False: no filter takes it. */
bool can_model_hear(const struct can_frame *frame);

/* The controller has counted its errors beyond 255. */
void can_model_lose_bus(void);
/* 128 times 11 recessive bits have been heard. */
void can_model_calm(void);
/* The error code and counters of the controller. */
void can_model_set_errors(unsigned last, unsigned sending, unsigned receiving);

/* Interrupts the controller now asks for. */
bool can_model_asks_sent(void);
bool can_model_asks_received(void);

/* Frames in mailboxes. */
unsigned can_model_waiting(void);

/* A bit on the bus, in quanta of divider clocks. */
struct can_model_bit {
    uint32_t divider, quanta, sampled,
        jump; /* sampled: before the sample; jump: to keep step, at most */
};

void can_model_get_bit(struct can_model_bit *bit);

extern const uint32_t can_model_clock_hz;
extern const unsigned can_model_fifo; /* frames that have been received and not been read */

#endif

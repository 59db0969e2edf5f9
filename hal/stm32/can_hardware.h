/*
 * What can_controller.c needs of the chip's CAN controller: one, so these are functions of the
 * build, in the folder of the chip. None waits for the bus.
 */
#ifndef TAKT_STM32_CAN_HARDWARE_H
#define TAKT_STM32_CAN_HARDWARE_H

#include "hal/can.h"

#define CAN_MAILBOXES 3
#define CAN_NODES_MAX 28

struct can_rates {
    uint32_t nominal; /* bit/s */
    uint32_t data;    /* of the data of CAN FD; 0: classical CAN */
};

struct can_config {
    uint32_t clock_hz; /* of the controller */
    struct can_rates rates;
    unsigned nodes;      /* 0: every data frame with an 11-bit identifier is received */
    const uint8_t *node; /* else: those whose lowest 7 bits are one of these node ids */
};

/*
 * A rate that the clock cannot be divided into, or that the controller does not have; 0: all is
 * well.
 */
uint32_t takt_can_hardware_find_impossible(uint32_t clock_hz, const struct can_rates *rates);

/*
 * Switches the controller on, sets it for possible rates, and stays off the bus. False: it does not
 * answer.
 */
bool takt_can_hardware_open(const struct can_config *config);

/* Asks to take part. False: the bus is not idle yet; it takes part when it is. */
bool takt_can_hardware_join(void);
bool takt_can_hardware_takes_part(void);

bool takt_can_hardware_is_off(void); /* thrown out by its errors */
/*
 * After that: gives up what is in mailboxes and goes off the bus; then leads back. False: it is not
 * off yet.
 */
void takt_can_hardware_leave(void);
bool takt_can_hardware_rejoin(void);

/*
 * Loads one of the mailboxes 0 ... CAN_MAILBOXES - 1: the most urgent one is sent first, until it
 * is acknowledged.
 */
void takt_can_hardware_load(unsigned i, const struct can_frame *frame);
void takt_can_hardware_take_back(unsigned i);
/* Bit i: the request to mailbox i is over; in sent: its frame has been sent. */
unsigned takt_can_hardware_take_done(unsigned *sent);

enum can_heard { CAN_HEARD_NOTHING, CAN_HEARD_FRAME, CAN_HEARD_OTHER };

/*
 * Takes the oldest of what has been received. Other: no data frame of an 11-bit identifier, or it
 * could not be read.
 */
enum can_heard takt_can_hardware_hear(struct can_frame *frame);
/* Frames have been lost since the last call. */
bool takt_can_hardware_take_overrun(void);

/* The last error: 1 stuff, 2 form, 3 no acknowledge, 4 5 bit, 6 CRC; told once. 0: none. */
unsigned takt_can_hardware_take_error(void);
/* To 96 healthy, from 128 passive, sending beyond 255 is bus-off. */
void takt_can_hardware_get_errors(unsigned *sending, unsigned *receiving);

#endif

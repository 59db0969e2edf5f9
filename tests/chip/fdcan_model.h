/* What FDCAN does more than the contract of can_model.h. */
#ifndef TAKT_TESTS_FDCAN_MODEL_H
#define TAKT_TESTS_FDCAN_MODEL_H

#include "can_model.h"

struct fdcan_model {
    bool hears_fd;  /* the next frames that come are of CAN FD */
    bool sent_fd;   /* the last frame that was sent was, */
    bool sent_fast; /* with its data at their own rate */
};

extern struct fdcan_model fdcan_model;

/*
 * The bit of fast data. false: classical CAN alone is spoken. offset: of the second sample behind
 * the delay; 0: none.
 */
bool fdcan_model_get_data_bit(struct can_model_bit *bit, unsigned *offset);

/* The last error was one in fast data. */
void fdcan_model_set_data_error(unsigned last);

#endif

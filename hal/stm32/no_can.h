/*
 * The bus of a machine without drives on CAN: what is sent goes nowhere, and nothing comes.
 */
#ifndef TAKT_STM32_NO_CAN_H
#define TAKT_STM32_NO_CAN_H

#include "hal/can.h"

struct can_port takt_no_can_get_port(void);

#endif

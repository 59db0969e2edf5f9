/*
 * The firmware of a drive (firmware/servo) on a board: its motor at timers, its bus, and what it
 * stores in flash. Each cycle it takes what has come over the bus, makes a step of the loops, and
 * waits in it for the timer of the control cycle.
 */
#ifndef TAKT_STM32DRIVE_DRIVE_NODE_H
#define TAKT_STM32DRIVE_DRIVE_NODE_H

#include "servo/stored.h"
#include "stm32/can_controller.h"
#include "stm32/flash.h"
#include "stm32/servo_motor.h"
#include "storage/store.h"

struct drive_node_config {
    struct servo_config servo; /* a cycle is its loop_period_us */
    struct servo_motor_config motor;
    struct can_config can;
    struct gpio_pin enable; /* high while the motor may have torque */
    const uint8_t *mapped;  /* where the first sector of what is stored can be read */
    bool has_crashed;       /* the last run: then it starts in fault */
};

/* Private. */
struct drive_node {
    struct drive_node_config config;
    struct servo servo;
    struct servo_motor motor;
    struct can_controller can;
    struct can_port bus;
    struct flash flash;
    struct store store;
    uint8_t stored[SERVO_STORED_MAX];
};

/*
 * Switches the drive on, and boots it. False: there is no bus. node must not be moved afterwards.
 */
bool takt_drive_node_open(struct drive_node *node, const struct drive_node_config *config);

/* The timer of the control cycle runs. */
void takt_drive_node_cycle(struct drive_node *node);

#endif

/*
 * The virtual spindle behind the registers of its frequency converter (vfd/vfd.h), for any Modbus
 * client.
 *
 * Beside those of the converter there are some of the iron, which a test or a script may set:
 * SPINDLE_CUT and SPINDLE_TRIP.
 */
#ifndef TAKT_SPINDLE_VFD_REGISTERS_H
#define TAKT_SPINDLE_VFD_REGISTERS_H

#include "hal/inputs.h"
#include "modbus/modbus.h"
#include "spindle/virtual_spindle.h"

#include <stdbool.h>
#include <stdint.h>

/* Torque that a cut takes, 0.1 % of the rated. */
#define SPINDLE_CUT 0x3000
/* Written: trips it with this number (enum virtual_spindle_trip); 0: nothing. */
#define SPINDLE_TRIP 0x3001

struct vfd_registers {
    struct virtual_spindle spindle;
    double pole_pairs;
    uint16_t command, frequency; /* as written */
    uint16_t cut;
    struct spindle_feedback feedback;
};

/* config has passed virtual_spindle_check. */
void vfd_registers_init(struct vfd_registers *registers,
                        const struct virtual_spindle_config *config);

/* Some time goes by. */
void vfd_registers_step(struct vfd_registers *registers, double dt_s);

struct modbus_map vfd_registers_get_map(struct vfd_registers *registers);

#endif

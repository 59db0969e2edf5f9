/*
 * The spindle of `takt serve`: virtual and inside, or behind a frequency converter on Modbus.
 */
#ifndef TAKT_HOST_SERVING_SPINDLE_H
#define TAKT_HOST_SERVING_SPINDLE_H

#include "client/registers_client.h"
#include "config/machine_setup.h"
#include "serve/serial_line.h"
#include "spindle/virtual_spindle.h"
#include "vfd/vfd.h"

#include <stdbool.h>
#include <stdint.h>

/* It must not be moved once opened. Private. */
struct serving_spindle {
    bool is_outside;
    double cycle_s;
    struct virtual_spindle inside;
    struct vfd vfd;
    struct registers_client client;
    struct registers_port port;
    struct serial_settings serial;
    char address[MACHINE_SETUP_PATH_MAX + 1];
};

/*
 * where: NULL: inside; HOST:PORT; or PATH[,BAUD[,PARITY]] with a '/' in it. False after a message:
 * nothing is open.
 */
bool serving_spindle_open(struct serving_spindle *spindle, const struct machine_setup *setup,
                          const char *where, uint8_t unit);
void serving_spindle_close(struct serving_spindle *spindle);

/*
 * One control cycle. cut_mm_s: the feed along the path while it cuts, else 0; what is outside knows
 * its own load.
 */
struct spindle_feedback serving_spindle_cycle(struct serving_spindle *spindle, double commanded_rpm,
                                              double cut_mm_s);

/*
 * The end: it is told to stop, without a ramp of commands. True: it has been, or cannot be reached.
 */
bool serving_spindle_stop(struct serving_spindle *spindle);

/* The operator has acknowledged a trip. */
void serving_spindle_reset(struct serving_spindle *spindle);

#endif

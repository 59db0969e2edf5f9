/*
 * The virtual spindle as a service: its converter's registers on Modbus TCP or on a serial line,
 * its time the wall clock's.
 */
#ifndef TAKT_HOST_SPINDLE_SERVICE_H
#define TAKT_HOST_SPINDLE_SERVICE_H

#include "cli/status.h"
#include "config/machine_setup.h"
#include "serve/serial_line.h"
#include "serve/server.h"
#include "spindle/vfd_registers.h"

#include <stdbool.h>
#include <stdint.h>

/* It must not be moved once started. Private. */
struct spindle_service {
    struct vfd_registers registers; /* the server thread's */
    struct modbus_map map;
    uint64_t time_ns; /* up to which it has turned */
    char address[MACHINE_SETUP_PATH_MAX + 1];
    struct serial_settings serial;
    struct server server;
};

/*
 * where: HOST:PORT, or PATH[,BAUD[,PARITY]] with a '/' in it. Says on stdout where it is, unless
 * quiet. Else than STATUS_DONE after a message: nothing is open.
 */
enum command_status spindle_service_start(struct spindle_service *service,
                                          const struct machine_setup *setup, const char *where,
                                          uint8_t unit, bool quiet);
void spindle_service_stop(struct spindle_service *service);

#endif

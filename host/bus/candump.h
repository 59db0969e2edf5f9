/*
 * Log of a bus in the form of candump -L: one line a frame, "(seconds.micros) can0 123#DEADBEEF".
 */
#ifndef TAKT_BUS_CANDUMP_H
#define TAKT_BUS_CANDUMP_H

#include "bus/bus.h"
#include "bus/wire_frame.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define CANDUMP_BUFFER_SIZE   65536
#define CANDUMP_INTERFACE_MAX 15

struct candump {
    FILE *file;
    bool failed;
    bool is_fd; /* of ports: they speak CAN FD; false at first */
    char interface[CANDUMP_INTERFACE_MAX + 1];
    size_t interface_length;
    size_t used;
    char buffer[CANDUMP_BUFFER_SIZE];
};

/*
 * file: open for writing, stays the caller's. interface: name in the lines ("can0"), cut at
 * CANDUMP_INTERFACE_MAX.
 */
void candump_init(struct candump *log, FILE *file, const char *interface);

/* Lines from now on are of the bus of this index: can0, can1. */
void candump_select(struct candump *log, unsigned bus);

/* Adds one line. Has the form of a bus listener: (struct bus_listener){candump_frame, &log}. */
void candump_frame(void *log, const struct can_frame *frame, uint64_t time_ns);

/*
 * The same for a frame of any kind, as a listener of a link: 29-bit identifiers have eight digits,
 * "#R2" asks for two bytes, "##1DEADBEEF" is CAN FD with its flags (1 rate switch, 2 sender error
 * passive), identifiers from 20000000 on are error messages of an interface.
 */
void candump_wire(void *log, const struct wire_frame *frame, uint64_t time_ns);

/* Writes what is buffered and flushes the file. False: this or an earlier write has failed. */
bool candump_flush(struct candump *log);

#endif

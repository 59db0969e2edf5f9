/*
 * Log of a bus, as candump -L writes it, for commands that run until they are told to end: written
 * straight into its file, at least once a second. (`takt run` writes its log aside and shows it
 * when it is whole: run_outputs.h.)
 */
#ifndef TAKT_HOST_BUS_LOG_H
#define TAKT_HOST_BUS_LOG_H

#include "bus/candump.h"
#include "link/link.h"
#include "simulation/drive_network.h"
#include "simulation/frame_buffer.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* It must not be moved once opened. Private. */
struct bus_log {
    FILE *file; /* NULL: there is none */
    const char *path;
    uint64_t flushed_ns;
    struct candump dump;
    struct frame_buffer frames;
};

/*
 * path: "-" is standard output; NULL: none, and everything below does nothing. False after a
 * message.
 */
bool bus_log_open(struct bus_log *log, const char *path);

/* What is logged: one of these. */
void bus_log_observe_link(struct bus_log *log, struct link *link);
void bus_log_observe_network(struct bus_log *log, struct drive_network *network);

/* Once a cycle or a round. */
void bus_log_keep(struct bus_log *log);

/* A write has failed: the disk is full, or the reader gone. */
bool bus_log_has_failed(const struct bus_log *log);

/*
 * False after a message: not everything could be written; a file then ends with the last line that
 * is whole.
 */
bool bus_log_close(struct bus_log *log);

#endif

/*
 * One line of a bus log, "(seconds.micros) can0 123#DEADBEEF": what candump.h writes, and candump
 * -L.
 */
#ifndef TAKT_BUS_CANDUMP_READ_H
#define TAKT_BUS_CANDUMP_READ_H

#include "bus/wire_frame.h"

#include <stddef.h>

struct candump_line {
    uint64_t time_ns;
    struct wire_frame frame;
    const char *interface; /* its name, in the line */
    size_t interface_length;
};

/*
 * NULL: *read holds the line, which comes without its end. Else what is wrong, and *column, from 1,
 * where. What newer versions of candump put behind the data (direction, flags) is passed over.
 */
const char *candump_read_line(const char *line, size_t length, struct candump_line *read,
                              unsigned *column);

#endif

/*
 * What the bits of an I/O node are, as a machine file says it: "stop !limit - P0".
 */
#ifndef TAKT_HOST_MACHINE_IO_H
#define TAKT_HOST_MACHINE_IO_H

#include "config/machine_keys.h"
#include "drive/io_wiring.h"

/* False: *wrong says why, by the name of the key, and nothing has changed. */
bool machine_io_read(uint8_t field[IO_BITS_MAX], const char *value, bool is_output,
                     const char *name, struct machine_problem *wrong);

/* The same of analogue outputs: "E0 - E1". */
bool machine_io_read_analogues(uint8_t field[IO_ANALOGUE_MAX / 2], const char *value,
                               const char *name, struct machine_problem *wrong);
void machine_io_write_analogues(const uint8_t field[IO_ANALOGUE_MAX / 2], char *text, size_t size);

void machine_io_write(const uint8_t bits[IO_BITS_MAX], char *text, size_t size);

#endif

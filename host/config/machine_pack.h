/*
 * Settings of a target as a file: the machine and its correction tables, as storage/settings.h
 * packs them.
 */
#ifndef TAKT_HOST_MACHINE_PACK_H
#define TAKT_HOST_MACHINE_PACK_H

#include "cli/status.h"
#include "config/machine_setup.h"

/*
 * Writes the settings of a machine file. is_sector: with the head that a target's flash sector
 * begins with, so that the file can be flashed. STATUS_DONE after a line of what it holds (not if
 * it goes to standard output), else a message.
 */
enum command_status machine_pack_write(const struct machine_setup *setup, const char *path,
                                       bool is_sector);

/* Reads such a file, with the head of a sector or without, and prints it as a machine file. */
enum command_status machine_pack_print(const char *path);

#endif

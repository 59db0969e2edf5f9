/*
 * What QEMU does for an image by semihosting (Semihosting for AArch32 and AArch64, 2.0, which that
 * of RISC-V takes over): files of the computer it runs on, and the end of the run. Each call stops
 * the image until it is done.
 */
#ifndef TAKT_SEMIHOSTING_SEMIHOSTING_H
#define TAKT_SEMIHOSTING_SEMIHOSTING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* UPDATE: of a file that exists, for reading and writing anywhere in it. */
enum semihosting_mode { SEMIHOSTING_READ = 1, SEMIHOSTING_UPDATE = 3, SEMIHOSTING_WRITE = 5 };

/* A handle; -1: it cannot be opened. */
int takt_semihosting_open(const char *path, enum semihosting_mode mode);
/* Up to size bytes; returns how many, 0 at the end. */
size_t takt_semihosting_read(int file, void *bytes, size_t size);
/* False: not all of it could be written. */
bool takt_semihosting_write(int file, const void *bytes, size_t size);
bool takt_semihosting_seek(int file, uint32_t offset);
/* The words the image was started with, zero-terminated. False: there is no room for them. */
bool takt_semihosting_command_line(char *text, size_t size);
/* Does not return. */
_Noreturn void takt_semihosting_exit(uint32_t status);

#endif

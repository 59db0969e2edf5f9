/*
 * The one instruction that stops the image until QEMU has done what is asked: each processor has
 * its own.
 */
#ifndef TAKT_SEMIHOSTING_SEMIHOSTING_CALL_H
#define TAKT_SEMIHOSTING_SEMIHOSTING_CALL_H

#include <stdint.h>

uintptr_t takt_semihosting_call(uintptr_t operation, const uintptr_t *arguments);

#endif

/*
 * FNV-1a, 64 bits: the digest of setpoints (public domain algorithm by Fowler, Noll and Vo, RFC
 * 9923).
 */
#ifndef TAKT_BASE_FNV_H
#define TAKT_BASE_FNV_H

#include <stdint.h>

#define FNV_START UINT64_C(0xcbf29ce484222325)

/*
 * Adds the eight bytes of value, least significant first, whatever the byte order of the machine.
 */
uint64_t takt_fnv_add_double(uint64_t digest, double value);

#endif

#include "fnv.h"

#include "bits.h"

#define FNV_PRIME UINT64_C(0x100000001b3)

/* FNV-1a: digest = (digest xor byte) * prime, byte by byte. */
uint64_t takt_fnv_add_double(uint64_t digest, double value)
{
    uint64_t bits = bits_from_double(value);
    for (unsigned shift = 0; shift < 64; shift += 8)
        digest = (digest ^ ((bits >> shift) & 0xffU)) * FNV_PRIME;
    return digest;
}

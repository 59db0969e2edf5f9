/*
 * Conversion between doubles and integers of 64 bits for a core with a unit for doubles, which
 * converts 32 bits at once. The compiler calls them by the names __aeabi_... (Run-time ABI for the
 * Arm Architecture, 5.1.1).
 *
 *     n = 2^32 high + low
 *
 * Both parts are exact as doubles, so that their sum is rounded once, as it should. What no integer
 * holds is left to libgcc.
 */
#include <stdint.h>

#define HELPER __attribute__((pcs("aapcs")))

#define WORD 0x1p32

HELPER double __wrap___aeabi_l2d(int64_t value);
HELPER double __wrap___aeabi_ul2d(uint64_t value);
HELPER int64_t __wrap___aeabi_d2lz(double value);
HELPER uint64_t __wrap___aeabi_d2ulz(double value);
HELPER int64_t __real___aeabi_d2lz(double value);
HELPER uint64_t __real___aeabi_d2ulz(double value);

HELPER double __wrap___aeabi_l2d(int64_t value)
{
    return (double)(int32_t)(value >> 32) * WORD + (double)(uint32_t)value;
}

HELPER double __wrap___aeabi_ul2d(uint64_t value)
{
    return (double)(uint32_t)(value >> 32) * WORD + (double)(uint32_t)value;
}

/* For 0 <= value < 2^64. What is left below the upper word is exact. */
static uint64_t whole(double value)
{
    const uint32_t high = (uint32_t)(value * (1.0 / WORD));

    return (uint64_t)high << 32 | (uint32_t)(value - (double)high * WORD);
}

HELPER int64_t __wrap___aeabi_d2lz(double value)
{
    const double magnitude = __builtin_fabs(value);

    if (!(magnitude < 0x1p63))
        return __real___aeabi_d2lz(value);
    return value < 0.0 ? -(int64_t)whole(magnitude) : (int64_t)whole(magnitude);
}

HELPER uint64_t __wrap___aeabi_d2ulz(double value)
{
    if (!(value >= 0.0 && value < 0x1p64))
        return __real___aeabi_d2ulz(value);
    return whole(value);
}

/* The clock of measurements on a RISC-V in QEMU. */
#include "semihosting/desk_clock.h"

/* The counter of cycles (RISC-V Privileged Architecture, 3.1.10): an instruction each. */
uint32_t takt_desk_clock_now(void)
{
    uintptr_t cycles;

    __asm volatile("csrr %0, mcycle" : "=r"(cycles));
    return (uint32_t)cycles;
}

uint32_t takt_desk_clock_hz(void)
{
    return 1000000000U;
}

void takt_desk_clock_start(void)
{
}

uint32_t takt_desk_clock_ns_since(uint32_t start)
{
    return takt_desk_clock_now() - start;
}

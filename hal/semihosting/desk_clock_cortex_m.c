/* The clock of measurements on a Cortex-M in QEMU. */
#include "port/cortex_m.h"
#include "semihosting/desk_clock.h"

/* The SysTick of the MPS2 boards counts down, a tick in 40 instructions. */
#define NS_PER_TICK 40U

uint32_t takt_desk_clock_hz(void)
{
    return 1000000000U / NS_PER_TICK;
}

void takt_desk_clock_start(void)
{
    CORTEX_SYSTICK_RELOAD = CORTEX_SYSTICK_MAX;
    CORTEX_SYSTICK_VALUE = 0;
    CORTEX_SYSTICK_CONTROL = CORTEX_SYSTICK_ON | CORTEX_SYSTICK_CORE;
}

uint32_t takt_desk_clock_now(void)
{
    return CORTEX_SYSTICK_VALUE;
}

uint32_t takt_desk_clock_ns_since(uint32_t start)
{
    return NS_PER_TICK * ((start - CORTEX_SYSTICK_VALUE) & CORTEX_SYSTICK_MAX);
}

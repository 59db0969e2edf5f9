#include "port/startup.h"

#include "port/cortex_m.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* From image.ld. */
extern uint8_t image_stack_top[];
extern uint8_t image_data_begin[], image_data_end[], image_data_values[];
extern uint8_t image_bss_begin[], image_bss_end[];
extern uint8_t image_core_begin[], image_core_end[];

/* What a port does not replace. */
#define WEAK __attribute__((weak))

WEAK void takt_port_begin(void)
{
}

WEAK void takt_port_fault(void)
{
    for (;;) {
    }
}

WEAK void takt_port_nmi(void)
{
    takt_port_fault();
}

WEAK void takt_port_supervisor_call(void)
{
    takt_port_fault();
}

WEAK void takt_port_pending_call(void)
{
    takt_port_fault();
}

WEAK void takt_port_systick(void)
{
    takt_port_fault();
}

/* The core's own vectors (ARMv7-M, B1.5.3); those of the chip follow. */
struct vectors {
    uint8_t *stack;
    startup_vector vector[15];
};

__attribute__((section(".vectors"), used)) static const struct vectors vectors = {
    .stack = image_stack_top,
    .vector = {port_reset, takt_port_nmi, takt_port_fault, takt_port_fault, takt_port_fault,
               takt_port_fault, NULL, NULL, NULL, NULL, takt_port_supervisor_call, takt_port_fault,
               NULL, takt_port_pending_call, takt_port_systick},
};

void port_reset(void)
{
    CORTEX_VTOR = (uint32_t)(uintptr_t)&vectors;
    CORTEX_CPACR |= CORTEX_CPACR_FPU;
    __asm volatile("dsb\n\tisb" ::: "memory");
    takt_port_begin();
    memcpy(image_data_begin, image_data_values, (size_t)(image_data_end - image_data_begin));
    memset(image_bss_begin, 0, (size_t)(image_bss_end - image_bss_begin));
    memset(image_core_begin, 0, (size_t)(image_core_end - image_core_begin));
    (void)main();
    takt_port_fault();
}

/*
 * From reset to main on a RISC-V, with one processor and without interrupts: for images in QEMU.
 */
#include "port/startup.h"

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* From image.ld. */
extern uint8_t image_data_begin[], image_data_end[], image_data_values[];
extern uint8_t image_bss_begin[], image_bss_end[];

void takt_port_fault(void)
{
    for (;;) {
    }
}

__attribute__((used)) static void start(void)
{
    memcpy(image_data_begin, image_data_values, (size_t)(image_data_end - image_data_begin));
    memset(image_bss_begin, 0, (size_t)(image_bss_end - image_bss_begin));
    (void)main();
    takt_port_fault();
}

/* First of the image: the stack, the floating-point unit (mstatus.FS), and where exceptions go. */
__attribute__((naked, section(".vectors"), used)) void port_reset(void)
{
    __asm volatile("la sp, image_stack_top\n\t"
                   "li t0, 0x2000\n\tcsrs mstatus, t0\n\tfscsr zero\n\t"
                   "la t0, port_fault\n\tcsrw mtvec, t0\n\t"
                   "j start");
}

/* The instructions by which a RISC-V asks its debugger. */
#include "semihosting/semihosting_call.h"

/*
 * RISC-V Semihosting, 1.0: these three instructions uncompressed, one behind the other on one page.
 */
uintptr_t takt_semihosting_call(uintptr_t operation, const uintptr_t *arguments)
{
    register uintptr_t number __asm("a0") = operation;
    register const uintptr_t *block __asm("a1") = arguments;

    __asm volatile(".option push\n\t.option norvc\n\t.balign 16\n\t"
                   "slli x0, x0, 0x1f\n\tebreak\n\tsrai x0, x0, 7\n\t"
                   ".option pop"
                   : "+r"(number)
                   : "r"(block)
                   : "memory");
    return number;
}

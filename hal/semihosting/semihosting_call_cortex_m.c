/* The instruction by which a Cortex-M asks its debugger. */
#include "semihosting/semihosting_call.h"

uintptr_t takt_semihosting_call(uintptr_t operation, const uintptr_t *arguments)
{
    register uintptr_t number __asm("r0") = operation;
    register const uintptr_t *block __asm("r1") = arguments;

    __asm volatile("bkpt 0xAB" : "+r"(number) : "r"(block) : "memory");
    return number;
}

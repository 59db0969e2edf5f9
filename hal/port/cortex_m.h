/*
 * The few registers of a Cortex-M core that ports use (ARMv7-M Architecture Reference Manual, B3).
 */
#ifndef TAKT_PORT_CORTEX_M_H
#define TAKT_PORT_CORTEX_M_H

#include <stdbool.h>
#include <stdint.h>

static inline volatile uint32_t *cortex_register(uintptr_t address)
{
    return (volatile uint32_t *)address;
}

#define CORTEX_SYSTICK_CONTROL *cortex_register(0xE000E010U)
#define CORTEX_SYSTICK_RELOAD  *cortex_register(0xE000E014U)
#define CORTEX_SYSTICK_VALUE   *cortex_register(0xE000E018U)
#define CORTEX_NVIC_ENABLE(n)  *cortex_register(0xE000E100U + 4U * ((n) / 32U))
#define CORTEX_ICSR            *cortex_register(0xE000ED04U)
#define CORTEX_VTOR            *cortex_register(0xE000ED08U)
#define CORTEX_AIRCR           *cortex_register(0xE000ED0CU)
#define CORTEX_CFSR            *cortex_register(0xE000ED28U)
#define CORTEX_HFSR            *cortex_register(0xE000ED2CU)
#define CORTEX_BFAR            *cortex_register(0xE000ED38U)
#define CORTEX_CPACR           *cortex_register(0xE000ED88U)

#define CORTEX_SYSTICK_ON        1U
#define CORTEX_SYSTICK_INTERRUPT 2U
#define CORTEX_SYSTICK_CORE      4U /* counts the core's clock */
#define CORTEX_SYSTICK_WRAPPED   (1U << 16)
#define CORTEX_SYSTICK_MAX       0xFFFFFFU
#define CORTEX_ICSR_SYSTICK_SET  (1U << 26)
#define CORTEX_CPACR_FPU         (0xFU << 20) /* full access to the floating-point unit */
#define CORTEX_AIRCR_RESET       0x05FA0004U

/*
 * Priorities: 0 is the most urgent; the number of bits a chip has are the upper ones of the byte.
 */
static inline void cortex_set_priority(unsigned interrupt, uint8_t priority)
{
    *(volatile uint8_t *)(uintptr_t)(0xE000E400U + interrupt) = priority;
}

static inline void cortex_set_systick_priority(uint8_t priority)
{
    *(volatile uint8_t *)(uintptr_t)0xE000ED23U = priority;
}

static inline void cortex_enable_interrupt(unsigned interrupt)
{
    CORTEX_NVIC_ENABLE(interrupt) = 1U << interrupt % 32U;
}

static inline void cortex_disable_all(void)
{
    __asm volatile("cpsid i" ::: "memory");
}

static inline void cortex_enable_all(void)
{
    __asm volatile("cpsie i" ::: "memory");
}

/* Interrupts of this priority and less urgent ones wait; 0: none does. */
static inline void cortex_mask_from(uint32_t priority)
{
    __asm volatile("msr basepri, %0\n\tisb" ::"r"(priority) : "memory");
}

/* For the control cycle, on every board: lines and the bus are more urgent. */
#define CORTEX_PRIORITY_CYCLE 0x80U

/* For struct embedded_port: what is more urgent than the control cycle goes on. */
static inline void cortex_lock(void *context)
{
    (void)context;
    cortex_mask_from(CORTEX_PRIORITY_CYCLE);
}

static inline void cortex_unlock(void *context)
{
    (void)context;
    cortex_mask_from(0);
}

/*
 * Sleeps until an interrupt, also one that came just before: masked, it wakes the core and is
 * served after.
 */
static inline void cortex_sleep(void)
{
    __asm volatile("cpsid i\n\twfi\n\tcpsie i\n\tisb" ::: "memory");
}

#endif

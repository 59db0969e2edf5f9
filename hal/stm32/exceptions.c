#include "stm32/exceptions.h"

#include "base/assert.h"
#include "chip/peripherals.h"
#include "port/cortex_m.h"
#include "port/startup.h"

/* They stay in their registers. */
#define UNUSED __attribute__((unused))

/* What the core has put on the stack (ARMv7-M, B1.5.6). */
struct frame {
    uint32_t r0, r1, r2, r3, r12, lr, pc, xpsr;
};

/* For the configurable fault status register. */
#define CFSR_MEMORY 0x000000FFU
#define CFSR_BUS    0x0000FF00U
#define CFSR_USAGE  0xFFFF0000U
#define CFSR_BFAR   (1U << 15) /* the address of a bus fault is known */

__attribute__((section(".noinit"))) static struct crash_memory memory;

bool takt_exceptions_take_crash(struct crash_record *record)
{
    return takt_crash_take(&memory, record);
}

static _Noreturn void start_anew(const struct crash_record *record)
{
    cortex_disable_all();
    takt_crash_keep(&memory, record);
    peripherals_write_back(&memory, sizeof memory);
    __asm volatile("dsb" ::: "memory");
    CORTEX_AIRCR = CORTEX_AIRCR_RESET;
    for (;;) {
    }
}

void takt_exceptions_crash(enum crash_cause cause, uint32_t address, uint32_t caller)
{
    const struct crash_record record = {.cause = cause, .address = address, .caller = caller};

    start_anew(&record);
}

static enum crash_cause cause_of(uint32_t status)
{
    if ((status & CFSR_MEMORY) != 0)
        return CRASH_MEMORY_FAULT;
    if ((status & CFSR_BUS) != 0)
        return CRASH_BUS_FAULT;
    return (status & CFSR_USAGE) != 0 ? CRASH_USAGE_FAULT : CRASH_HARD_FAULT;
}

/* A stack that has run out cannot be read: that would be the next fault, and the last. */
extern const uint8_t image_stack_low[], image_stack_top[];

static bool is_on_stack(const struct frame *frame)
{
    const uintptr_t at = (uintptr_t)frame;

    return at >= (uintptr_t)image_stack_low && at + sizeof *frame <= (uintptr_t)image_stack_top;
}

void exceptions_fault(const struct frame *frame);
void exceptions_fault(const struct frame *frame)
{
    const uint32_t status = CORTEX_CFSR;
    struct crash_record record = {
        .cause = cause_of(status),
        .status = status,
        .hard = CORTEX_HFSR,
        .access = (status & CFSR_BFAR) != 0 ? CORTEX_BFAR : 0,
    };

    if (is_on_stack(frame)) {
        record.address = frame->pc;
        record.caller = frame->lr;
        record.registers[0] = frame->r0;
        record.registers[1] = frame->r1;
        record.registers[2] = frame->r2;
        record.registers[3] = frame->r3;
        record.registers[4] = frame->r12;
    }
    start_anew(&record);
}

/* All handlers run on the main stack, and so did whoever failed. */
__attribute__((naked)) void takt_port_fault(void)
{
    __asm volatile("mrs r0, msp\n\tb exceptions_fault");
}

/* Only the clock security system raises it. */
void takt_port_nmi(void)
{
    takt_exceptions_crash(CRASH_CRYSTAL, 0, 0);
}

_Noreturn void exceptions_invariant(const char *file, int line);
void exceptions_invariant(const char *file, int line)
{
    struct crash_record record = {.cause = CRASH_INVARIANT, .address = (uint32_t)line};

    crash_set_file(&record, file);
    start_anew(&record);
}

/*
 * Nobody comes back: the whole stack is free again. So a broken invariant needs none where it is
 * deepest.
 */
__attribute__((naked)) void takt_assert_failed(const char *file UNUSED, int line UNUSED,
                                               const char *text UNUSED)
{
    __asm volatile("ldr r3, =image_stack_top\n\tmov sp, r3\n\tb exceptions_invariant");
}

/*
 * From reset to main, and where interrupts go.
 */
#ifndef TAKT_PORT_STARTUP_H
#define TAKT_PORT_STARTUP_H

typedef void (*startup_vector)(void);

/*
 * A port defines the interrupts of its chip as an array in the section ".vectors.interrupts", the
 * first for interrupt 0:
 *
 *     STARTUP_INTERRUPTS(port_interrupts, COUNT) = {[3] = uart_interrupt, ...};
 *
 * and replaces, where it has something to say, the handlers below by functions of the same names.
 * An exception without a handler of its own comes to takt_port_fault, which stays there.
 */
#define STARTUP_INTERRUPTS(name, count)                                                            \
    __attribute__((section(".vectors.interrupts"), used)) const startup_vector name[count]

/*
 * For a variable without a first value: in the memory CORE of the port's linker script, which may
 * be one that only the processor reaches: no direct memory access. It is zero at the start like all
 * others.
 */
#define STARTUP_CORE_MEMORY __attribute__((section(".bss.core")))

void port_reset(void);
void takt_port_nmi(void);
void takt_port_fault(void); /* hard fault, and those of memory, bus and usage */
void takt_port_supervisor_call(void);
void takt_port_pending_call(void);
void takt_port_systick(void);

/* Called first of all, with the stack alone: clocks, watchdogs. May be left out. */
void takt_port_begin(void);

int main(void);

#endif

/*
 * How the control cycle and the background hand each other memory. The cycle is an interrupt: it
 * may come between any two instructions of the background, and what it does is done at once as the
 * background sees it. There is one processor, so nothing but the compiler may put reads and writes
 * in another order; here it must not.
 *
 *     writer   fills what it hands on, then sets a count with handoff_set_count
 *     reader   reads that with handoff_get_count, then what it was handed
 *
 * Each count has one writer, or two that write it in turn, as a state that says whose turn it is.
 * What is handed on belongs to the reader until it hands it back in the same way. Counts are 32
 * bits: one access on every processor here.
 */
#ifndef TAKT_BASE_HANDOFF_H
#define TAKT_BASE_HANDOFF_H

#include <stdint.h>

/* What stands before it is done before what stands behind it: for a state that is no count. */
static inline void handoff_order(void)
{
    __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

/* Also to look whether what was read in between has been changed meanwhile. */
static inline uint32_t handoff_get_count(const uint32_t *count)
{
    __atomic_signal_fence(__ATOMIC_ACQUIRE);
    const uint32_t value = *(const volatile uint32_t *)count;

    __atomic_signal_fence(__ATOMIC_ACQUIRE);
    return value;
}

static inline void handoff_set_count(uint32_t *count, uint32_t value)
{
    __atomic_signal_fence(__ATOMIC_RELEASE);
    *(volatile uint32_t *)count = value;
}

#endif

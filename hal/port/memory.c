/*
 * memcpy and memset by eight words at a time: those of the C library go byte by byte, to be small.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define WORD  sizeof(uint32_t)
#define BLOCK (8 * WORD)

static int is_aligned(const void *at)
{
    return ((uintptr_t)at & (WORD - 1)) == 0;
}

/* Several registers at once: half an instruction a byte less than a loop over words takes. */
static void copy_block(uint8_t **to, const uint8_t **from)
{
    __asm volatile(
        "ldmia %1!, {r3-r6}\n\tstmia %0!, {r3-r6}\n\tldmia %1!, {r3-r6}\n\tstmia %0!, {r3-r6}"
        : "+r"(*to), "+r"(*from)
        :
        : "r3", "r4", "r5", "r6", "memory");
}

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    uint8_t *t = to;
    const uint8_t *f = from;

    if (is_aligned(t) && is_aligned(f)) {
        for (; size >= BLOCK; size -= BLOCK)
            copy_block(&t, &f);
        for (; size >= WORD; size -= WORD, t += WORD, f += WORD)
            *(uint32_t *)(void *)t = *(const uint32_t *)(const void *)f;
    }
    while (size-- > 0)
        *t++ = *f++;
    return to;
}

static void set_block(uint8_t **to, uint32_t word)
{
    __asm volatile("mov r3, %1\n\tmov r4, %1\n\tmov r5, %1\n\tmov r6, %1\n\t"
                   "stmia %0!, {r3-r6}\n\tstmia %0!, {r3-r6}"
                   : "+r"(*to)
                   : "r"(word)
                   : "r3", "r4", "r5", "r6", "memory");
}

void *memset(void *to, int value, size_t size)
{
    const uint32_t word = 0x01010101U * (uint8_t)value;
    uint8_t *t = to;

    if (is_aligned(t)) {
        for (; size >= BLOCK; size -= BLOCK)
            set_block(&t, word);
        for (; size >= WORD; size -= WORD, t += WORD)
            *(uint32_t *)(void *)t = word;
    }
    while (size-- > 0)
        *t++ = (uint8_t)value;
    return to;
}

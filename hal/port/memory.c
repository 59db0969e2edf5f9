/*
 * memcpy and memset by eight words at a time: those of the C library go byte by byte, to be small.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#define WORD sizeof(uint32_t)

static int is_aligned(const void *at)
{
    return ((uintptr_t)at & (WORD - 1)) == 0;
}

/*
 * All whole words: eight each time in 6 instructions, then four, two and one, as the bits of what
 * is left say (16 is the carry of a shift by 28, 8 the sign). Returns the bytes that are left.
 */
static size_t copy_words(uint8_t **to, const uint8_t **from, size_t size)
{
    __asm volatile("b 2f\n"
                   "1:\tldmia %1!, {r3-r6}\n\tstmia %0!, {r3-r6}\n\t"
                   "ldmia %1!, {r3-r6}\n\tstmia %0!, {r3-r6}\n"
                   "2:\tsubs %2, #32\n\tbcs 1b\n\t"
                   "lsls r3, %2, #28\n\t"
                   "itt cs\n\tldmiacs %1!, {r3-r6}\n\tstmiacs %0!, {r3-r6}\n\t"
                   "itt mi\n\tldmiami %1!, {r3-r4}\n\tstmiami %0!, {r3-r4}\n\t"
                   "tst %2, #4\n\t"
                   "itt ne\n\tldrne r3, [%1], #4\n\tstrne r3, [%0], #4"
                   : "+r"(*to), "+r"(*from), "+r"(size)
                   :
                   : "r3", "r4", "r5", "r6", "cc", "memory");
    return size & (WORD - 1);
}

void *memcpy(void *restrict to, const void *restrict from, size_t size)
{
    uint8_t *t = to;
    const uint8_t *f = from;

    if (is_aligned(t) && is_aligned(f))
        size = copy_words(&t, &f, size);
    while (size-- > 0)
        *t++ = *f++;
    return to;
}

/* Likewise, eight words in 4 instructions. */
static size_t set_words(uint8_t **to, uint32_t word, size_t size)
{
    __asm volatile("mov r3, %2\n\tmov r4, %2\n\tmov r5, %2\n\tmov r6, %2\n\tb 2f\n"
                   "1:\tstmia %0!, {r3-r6}\n\tstmia %0!, {r3-r6}\n"
                   "2:\tsubs %1, #32\n\tbcs 1b\n\t"
                   "lsls r12, %1, #28\n\t"
                   "it cs\n\tstmiacs %0!, {r3-r6}\n\tit mi\n\tstmiami %0!, {r3-r4}\n\t"
                   "tst %1, #4\n\tit ne\n\tstrne r3, [%0], #4"
                   : "+r"(*to), "+r"(size)
                   : "r"(word)
                   : "r3", "r4", "r5", "r6", "r12", "cc", "memory");
    return size & (WORD - 1);
}

void *memset(void *to, int value, size_t size)
{
    const uint32_t word = 0x01010101U * (uint8_t)value;
    uint8_t *t = to;

    if (is_aligned(t))
        size = set_words(&t, word, size);
    while (size-- > 0)
        *t++ = (uint8_t)value;
    return to;
}

/*
 * An image that computes with what stands under every image (hal/port): it reads pairs of doubles
 * from one file and writes what it makes of them to another. target_arithmetic.py has the pairs,
 * and knows the answers.
 */
#include "semihosting/semihosting.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#define PAIRS 256

struct pair {
    double a, b;
};

struct answer {
    double sum, difference, product, quotient, root, from_signed, from_unsigned;
    int64_t to_signed;
    uint64_t to_unsigned;
    uint64_t compared; /* a < b, <=, ==, >=, > : bits 0 to 4 */
};

static struct pair pairs[PAIRS];
static struct answer answers[PAIRS];

static uint64_t bits_of(double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static uint64_t compare(double a, double b)
{
    return (uint64_t)(a < b) | (uint64_t)(a <= b) << 1 | (uint64_t)(a == b) << 2 |
           (uint64_t)(a >= b) << 3 | (uint64_t)(a > b) << 4;
}

/* What no integer holds is undefined in C. */
static int64_t to_signed(double value)
{
    return value > -9e18 && value < 9e18 ? (int64_t)value : 0;
}

static uint64_t to_unsigned(double value)
{
    return value > -1.0 && value < 1.8e19 ? (uint64_t)value : 0;
}

static void compute(const struct pair *p, struct answer *x)
{
    x->sum = p->a + p->b;
    x->difference = p->a - p->b;
    x->product = p->a * p->b;
    x->quotient = p->a / p->b;
    x->root = sqrt(p->a);
    x->from_signed = (double)(int64_t)bits_of(p->a);
    x->from_unsigned = (double)bits_of(p->a);
    x->to_signed = to_signed(p->a);
    x->to_unsigned = to_unsigned(p->a);
    x->compared = compare(p->a, p->b);
}

/* -- memory -- */

#define MEMORY_MAX 80

static uint8_t from[MEMORY_MAX], to[MEMORY_MAX];

static int is_copied(unsigned at, unsigned target, unsigned size)
{
    for (unsigned i = 0; i < MEMORY_MAX; i++) {
        from[i] = (uint8_t)(i + 1);
        to[i] = 0xA5;
    }
    if (memcpy(to + target, from + at, size) != to + target)
        return 0;
    for (unsigned i = 0; i < MEMORY_MAX; i++) {
        const int inside = i >= target && i < target + size;

        if (to[i] != (inside ? (uint8_t)(i - target + at + 1) : 0xA5))
            return 0;
    }
    return 1;
}

static int is_set(unsigned target, unsigned size)
{
    for (unsigned i = 0; i < MEMORY_MAX; i++)
        to[i] = 0xA5;
    if (memset(to + target, 0x1C3, size) != to + target)
        return 0;
    for (unsigned i = 0; i < MEMORY_MAX; i++) {
        if (to[i] != (i >= target && i < target + size ? 0xC3 : 0xA5))
            return 0;
    }
    return 1;
}

static int memory_works(void)
{
    int good = 1;

    for (unsigned size = 0; size <= 70; size++) {
        for (unsigned at = 0; at < 5; at++) {
            for (unsigned target = 0; target < 5; target++)
                good = good && is_copied(at, target, size);
            good = good && is_set(at, size);
        }
    }
    return good;
}

int main(void)
{
    const int in = takt_semihosting_open("pairs.bin", SEMIHOSTING_READ);
    const int out = takt_semihosting_open("answers.bin", SEMIHOSTING_WRITE);
    size_t count;

    while ((count = takt_semihosting_read(in, pairs, sizeof pairs) / sizeof pairs[0]) > 0) {
        for (size_t i = 0; i < count; i++)
            compute(&pairs[i], &answers[i]);
        if (!takt_semihosting_write(out, answers, count * sizeof answers[0]))
            takt_semihosting_exit(3);
    }
    takt_semihosting_exit(memory_works() ? 0 : 1);
}

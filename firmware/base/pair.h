/*
 * A number as the unevaluated sum hi + lo of two doubles, |lo| much smaller than |hi|: about 100
 * bits, for the few places where one rounding too many would show in the last bit of a result.
 * Method: T. J. Dekker, "A floating-point technique for extending the available precision", 1971.
 * Private to this room.
 */
#ifndef TAKT_BASE_PAIR_H
#define TAKT_BASE_PAIR_H

#include "bits.h"

struct pair {
    double hi;
    double lo;
};

/* The 26 leading bits of x: the product of two such numbers is exact. */
static inline double pair_leading_half(double x)
{
    return bits_to_double(bits_from_double(x) & ~UINT64_C(0x7ffffff));
}

/* a + b without error, for |a| >= |b| or a = 0. */
static inline struct pair pair_sum_ordered(double a, double b)
{
    double sum = a + b;
    return (struct pair){sum, (a - sum) + b};
}

/*
 * a / (d + d_tail) with one division: q = leading half of a/d, then the exact rest a - q d over d.
 */
static inline struct pair pair_quotient(double a, double d, double d_tail)
{
    double inverse = 1.0 / d;
    double q = pair_leading_half(a * inverse);
    double d_lead = pair_leading_half(d);
    double rest = (a - q * d_lead) - q * ((d - d_lead) + d_tail);
    return (struct pair){q, rest * inverse};
}

#endif

#include "smooth/single.h"

#include <stdint.h>

#define NEWTON_STEPS 3
#define CBRT_BITS    709921077U

union bits_of_single {
    float value;
    uint32_t bits;
};

/*
 * The bits of x as an integer are 2^23 (127 + log2 x), nearly, so those of its cube root a third of
 * them and 2^23 2/3 127; some less makes the error the same to both sides.
 */
static float near_cbrt(float x)
{
    union bits_of_single near = {.value = x};

    near.bits = near.bits / 3U + CBRT_BITS;
    return near.value;
}

/* From within a twentieth of it y <- (2 y + x/y^2)/3. */
float takt_single_cbrt(float x)
{
    if (!(x > 0.0f)) {
        return 0.0f;
    }
    float y = near_cbrt(x);

    for (unsigned i = 0; i < NEWTON_STEPS; i++) {
        y = (2.0f * y + x / (y * y)) * (1.0f / 3.0f);
    }
    return y;
}

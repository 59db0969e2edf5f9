/*
 * A broken invariant in a program on a desk: it says which, and aborts.
 */
#include "base/assert.h"

#include <stdio.h>
#include <stdlib.h>

void takt_assert_failed(const char *file, int line, const char *text)
{
    (void)fprintf(stderr, "%s:%d: broken invariant: %s\n", file, line, text);
    abort();
}

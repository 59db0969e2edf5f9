/*
 * A broken invariant in an image whose port has nothing else to do about it: the processor's trap,
 * which ends in the port's handler of faults.
 */
#include "base/assert.h"

void takt_assert_failed(const char *file, int line, const char *text)
{
    (void)file;
    (void)line;
    (void)text;
    __builtin_trap();
}

#include "translation/dialects.h"

#include <stddef.h>
#include <string.h>

static const char *const names[DIALECT_COUNT + 1] = {
    [DIALECT_LINUXCNC] = "linuxcnc", [DIALECT_GRBL] = "grbl",   [DIALECT_FANUC] = "fanuc",
    [DIALECT_HAAS] = "haas",         [DIALECT_MACH3] = "mach3", [DIALECT_MARLIN] = "marlin",
    [DIALECT_SIEMENS] = "siemens",   [DIALECT_AUTO] = "auto",
};

const char *dialect_name(enum dialect dialect)
{
    return (unsigned)dialect <= DIALECT_COUNT ? names[dialect] : NULL;
}

unsigned dialect_find(const char *name)
{
    unsigned i = 0;

    while (i <= DIALECT_COUNT && strcmp(names[i], name) != 0)
        i++;
    return i;
}

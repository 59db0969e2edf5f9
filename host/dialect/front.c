/* Names of dialects, and the values that a machine file gives to names of programs. */
#include "dialect/dialect.h"

#include "dialect/line.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

/* The name of #NAME, or of #<_NAME>. */
static bool is_plain(const char *name)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz";

    name += name[0] == '_' ? 1 : 0;
    if (name[0] == '\0' || strchr(letters, line_lower(name[0])) == NULL)
        return false;
    for (; *name != '\0'; name++) {
        if (strchr(letters, line_lower(*name)) == NULL && strchr("_0123456789", *name) == NULL)
            return false;
    }
    return true;
}

const char *dialect_value_set(struct dialect_codes *codes, const char *name, const char *value)
{
    char *end;
    const double number = strtod(value, &end);
    unsigned i = 0;

    if ((strncmp(name, "_ini[", 5) != 0 && strncmp(name, "_hal[", 5) != 0 && !is_plain(name)) ||
        strlen(name) >= sizeof codes->value[0].name)
        return "the name of a value is expected, such as _ini[TRAJ]MAX_LINEAR_VELOCITY, _hal[PIN] "
               "that of #NAME or _NAME";
    if (end == value || *end != '\0' || !isfinite(number))
        return "a number is expected";
    while (i < codes->values && strcmp(codes->value[i].name, name) != 0)
        i++;
    if (i == DIALECT_CODES_MAX)
        return "there is no room for more values";
    codes->values = i == codes->values ? i + 1 : codes->values;
    codes->value[i].value = number;
    (void)snprintf(codes->value[i].name, sizeof codes->value[i].name, "%s", name);
    return NULL;
}

#include "program/names.h"

#include <string.h>

double *names_find(struct program_names *names, const char *name, size_t length)
{
    for (unsigned i = 0; i < names->count; i++) {
        if (memcmp(names->text[i], name, length) == 0 && names->text[i][length] == '\0') {
            return &names->value[i];
        }
    }
    return NULL;
}

double *names_add(struct program_names *names, const char *name, size_t length)
{
    if (names->count == PROGRAM_NAMES_MAX) {
        return NULL;
    }
    const unsigned i = names->count++;

    memset(names->text[i], 0, sizeof(names->text[i]));
    memcpy(names->text[i], name, length);
    names->value[i] = 0.0;
    return &names->value[i];
}

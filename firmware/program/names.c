#include "program/names.h"

#include <string.h>

/* Of globals. */
#define CALL_NONE UINT8_MAX

static uint8_t call_of(const struct program_names *names, const char *name)
{
    return name[0] == '_' ? CALL_NONE : names->call;
}

double *names_find(struct program_names *names, const char *name, size_t length)
{
    const uint8_t call = call_of(names, name);

    for (unsigned i = 0; i < names->count; i++) {
        if (names->of_call[i] != call) {
            continue;
        }
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
    names->of_call[i] = call_of(names, name);
    return &names->value[i];
}

void names_enter_call(struct program_names *names)
{
    names->call++;
}

void names_leave_call(struct program_names *names)
{
    unsigned kept = 0;

    for (unsigned i = 0; i < names->count; i++) {
        if (names->of_call[i] == names->call) {
            continue;
        }
        if (kept != i) {
            memcpy(names->text[kept], names->text[i], sizeof(names->text[kept]));
            names->value[kept] = names->value[i];
            names->of_call[kept] = names->of_call[i];
        }
        kept++;
    }
    names->count = (uint16_t)kept;
    names->call--;
}

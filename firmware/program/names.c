#include "program/names.h"

#include "base/assert.h"

#include <string.h>

/* Names of globals. */
#define CALL_NONE UINT8_MAX

static uint8_t call_of(const struct program_names *names, const char *name)
{
    return name[0] == '_' ? CALL_NONE : names->call;
}

/* -- texts -- */

static bool is_text_at(const struct program_names *names, unsigned place, const char *text,
                       size_t length)
{
    return memcmp(&names->text[place], text, length) == 0 && names->text[place + length] == '\0';
}

static unsigned size_at(const struct program_names *names, unsigned place)
{
    unsigned end = place;

    TAKT_ASSERT(place < sizeof names->text);
    while (names->text[end] != '\0') {
        end++;
    }
    return end + 1 - place;
}

uint16_t takt_names_place(struct program_names *names, const char *text, size_t length)
{
    unsigned place = 0;

    TAKT_ASSERT(names->text_length <= sizeof names->text);

    while (place < names->text_length && !is_text_at(names, place, text, length)) {
        place += size_at(names, place);
    }
    if (place == names->text_length) {
        memcpy(&names->text[place], text, length);
        names->text[place + length] = '\0';
    }
    return (uint16_t)place;
}

static bool move_label(struct program_label *label, unsigned from, unsigned to)
{
    if (label->id != (PROGRAM_LABEL_NAME | from)) {
        return false;
    }
    label->id = PROGRAM_LABEL_NAME | to;
    return true;
}

/* A text moves, with all that is named by it. False: nothing is. */
static bool move_named(struct program *p, unsigned from, unsigned to)
{
    struct program_flow *f = &p->flow;
    bool found = move_label(&f->skip_label, from, to);

    for (unsigned i = 0; i < f->blocks; i++) {
        found |= move_label(&f->block[i].label, from, to);
    }
    for (unsigned i = 0; i < f->subs; i++) {
        found |= move_label(&f->sub[i].label, from, to);
    }
    for (unsigned i = 0; i < p->names.count; i++) {
        if (p->names.place[i] == from) {
            p->names.place[i] = (uint16_t)to;
            found = true;
        }
    }
    return found;
}

/* Drops the texts that name nothing any more. */
static void drop_texts(struct program *p)
{
    struct program_names *names = &p->names;
    unsigned kept = 0;
    unsigned size;

    for (unsigned place = 0; place < names->text_length; place += size) {
        size = size_at(names, place);
        if (move_named(p, place, kept)) {
            memmove(&names->text[kept], &names->text[place], size);
            kept += size;
        }
    }
    names->text_length = (uint16_t)kept;
}

bool takt_names_keep(struct program *p, uint16_t *place)
{
    struct program_names *names = &p->names;
    const unsigned size = size_at(names, *place);

    if (*place < names->text_length) {
        return true;
    }
    if (*place + size > PROGRAM_TEXT_MAX) {
        drop_texts(p);
        memmove(&names->text[names->text_length], &names->text[*place], size);
        *place = names->text_length;
    }
    if (*place + size > PROGRAM_TEXT_MAX) {
        return false;
    }
    names->text_length = (uint16_t)(*place + size);
    return true;
}

/* -- parameters -- */

int takt_names_find(const struct program_names *names, const char *name, size_t length)
{
    const uint8_t call = call_of(names, name);

    TAKT_ASSERT(names->count <= PROGRAM_NAMES_MAX);
    for (unsigned i = 0; i < names->count; i++) {
        if (names->of_call[i] == call && is_text_at(names, names->place[i], name, length)) {
            return (int)i;
        }
    }
    return -1;
}

double *takt_names_add(struct program *p, const char *name, size_t length)
{
    struct program_names *names = &p->names;
    uint16_t place;

    TAKT_ASSERT(p->names.count <= PROGRAM_NAMES_MAX);
    if (names->count == PROGRAM_NAMES_MAX) {
        return NULL;
    }
    place = takt_names_place(names, name, length);
    if (!takt_names_keep(p, &place)) {
        return NULL;
    }
    const unsigned i = names->count++;

    names->place[i] = place;
    names->value[i] = 0.0;
    names->of_call[i] = call_of(names, name);
    return &names->value[i];
}

void takt_names_enter_call(struct program_names *names)
{
    names->call++;
}

void takt_names_leave_call(struct program_names *names)
{
    unsigned kept = 0;

    TAKT_ASSERT(names->call > 0);
    for (unsigned i = 0; i < names->count; i++) {
        if (names->of_call[i] == names->call) {
            continue;
        }
        names->place[kept] = names->place[i];
        names->value[kept] = names->value[i];
        names->of_call[kept] = names->of_call[i];
        kept++;
    }
    names->count = (uint16_t)kept;
    names->call--;
}

/*
 * Electronic data sheets, as they are written by many tools: keys in any case, spaces anywhere,
 * arrays in full or compact (CiA 306, 4.6).
 */
#include "drives/dictionary_sections.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static const char *const key_names[DICTIONARY_COUNT] = {
    "parametername",  "objecttype", "datatype",  "accesstype", "defaultvalue",
    "parametervalue", "lowlimit",   "highlimit", "pdomapping", "compactsubobj"};

void *dictionary_grow(void *memory, unsigned count, unsigned *capacity, size_t size)
{
    if (count < *capacity)
        return memory;
    unsigned more = *capacity == 0 ? 256 : 2 * *capacity;
    void *grown = realloc(memory, more * size);
    if (grown != NULL)
        *capacity = more;
    return grown;
}

/* "6040", "6099sub1", "1600Value". */
static bool read_section_name(struct text_part name, struct dictionary_section *section)
{
    unsigned index, sub;
    size_t at = words_read_hex(name, 4, &index);
    struct text_part rest = {name.start + at, name.length - at};
    const struct text_part word = {rest.start, rest.length < 3 ? rest.length : 3};
    if (at != 4)
        return false;
    section->index = (uint16_t)index;
    section->sub = DICTIONARY_WHOLE;
    section->has_values = words_are(rest, "value");
    if (rest.length == 0 || section->has_values)
        return true;
    if (!words_are(word, "sub"))
        return false;
    rest.start += 3;
    rest.length -= 3;
    at = words_read_hex(rest, 2, &sub);
    section->sub = (int)sub;
    return at > 0 && at == rest.length;
}

static bool begin_section(struct dictionary_sections *r, struct text_part name, unsigned line)
{
    struct dictionary_section section = {.line = line};
    r->in_dummies = words_are(name, "dummyusage");
    /* CiA 306 spells it with one m. */
    r->is_configuration = r->is_configuration || words_are(name, "devicecomissioning") ||
                          words_are(name, "devicecommissioning");
    r->has_section = read_section_name(name, &section);
    if (!r->has_section)
        return true;
    struct dictionary_section *grown =
        dictionary_grow(r->section, r->count, &r->capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    r->section = grown;
    r->section[r->count++] = section;
    return true;
}

static bool take_compact_value(struct dictionary_sections *r,
                               const struct dictionary_section *section, struct text_part key,
                               struct text_part value)
{
    long sub = words_plain_number(key, 0);
    if (sub < 1 || sub > DICTIONARY_COMPACT_MAX)
        return true;
    struct dictionary_compact *grown =
        dictionary_grow(r->value, r->values, &r->value_capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    r->value = grown;
    r->value[r->values++] =
        (struct dictionary_compact){(uint32_t)section->index << 8 | (uint32_t)sub, value};
    return true;
}

/* "Dummy0007=1" */
static void take_dummy(struct dictionary_sections *r, struct text_part key, struct text_part value)
{
    const struct text_part word = {key.start, key.length < 5 ? key.length : 5};
    unsigned type;
    if (!words_are(word, "dummy") || words_plain_number(value, 0) == 0)
        return;
    if (words_read_hex((struct text_part){key.start + 5, key.length - 5}, 4, &type) > 0 && type < 8)
        r->dummies |= (uint8_t)(1u << type);
}

static bool take_pair(struct dictionary_sections *r, struct text_part key, struct text_part value)
{
    if (r->in_dummies)
        take_dummy(r, key, value);
    if (!r->has_section)
        return true;
    struct dictionary_section *section = &r->section[r->count - 1];
    if (section->has_values)
        return take_compact_value(r, section, key, value);
    for (unsigned k = 0; k < DICTIONARY_COUNT; k++)
        if (words_are(key, key_names[k]))
            section->key[k] = value;
    return true;
}

/* Some tools take a semicolon behind a space for a comment, so there are sheets with such. */
static struct text_part without_comment(struct text_part line)
{
    for (size_t i = 1; i < line.length; i++)
        if (line.start[i] == ';' && isspace((unsigned char)line.start[i - 1]))
            return words_trim(line.start, i);
    return line;
}

static bool take_line(struct dictionary_sections *r, struct text_part line, unsigned number)
{
    const char *equals = line.length > 0 ? memchr(line.start, '=', line.length) : NULL;
    if (line.length == 0 || *line.start == ';' || *line.start == '#')
        return true;
    if (*line.start == '[' && line.start[line.length - 1] == ']')
        return begin_section(r, words_trim(line.start + 1, line.length - 2), number);
    if (equals == NULL)
        return true;
    return take_pair(r, words_trim(line.start, (size_t)(equals - line.start)),
                     words_trim(equals + 1, line.length - (size_t)(equals - line.start) - 1));
}

static bool read_lines(struct dictionary_sections *r, const char *text, size_t length)
{
    size_t at = 0;
    for (unsigned number = 1; at < length; number++) {
        const char *end = memchr(text + at, '\n', length - at);
        size_t line = end ? (size_t)(end - text) - at : length - at;
        if (!take_line(r, without_comment(words_trim(text + at, line)), number))
            return false;
        at += line + 1;
    }
    return true;
}

static bool is_hidden(const struct dictionary_section *section)
{
    return section->has_values;
}

static int compare_sections(const void *a, const void *b)
{
    const struct dictionary_section *x = a, *y = b;
    if (x->index != y->index)
        return x->index < y->index ? -1 : 1;
    if (is_hidden(x) != is_hidden(y))
        return is_hidden(x) ? 1 : -1;
    if (x->sub != y->sub)
        return x->sub < y->sub ? -1 : 1;
    return x->line < y->line ? -1 : 1;
}

/*
 * In a configuration the values that have been set count; what has not been set is as it comes from
 * the maker.
 */
static void prefer_values(struct dictionary_sections *r)
{
    for (unsigned i = 0; i < r->count; i++) {
        struct text_part *key = r->section[i].key;
        if (key[DICTIONARY_VALUE].length > 0)
            key[DICTIONARY_DEFAULT] = key[DICTIONARY_VALUE];
    }
}

bool dictionary_sections_read(struct dictionary_sections *r, const char *text, size_t length)
{
    if (!read_lines(r, text, length))
        return false;
    if (r->is_configuration)
        prefer_values(r);
    if (r->count > 0)
        qsort(r->section, r->count, sizeof *r->section, compare_sections);
    return true;
}

void dictionary_sections_free(struct dictionary_sections *r)
{
    free(r->section);
    free(r->value);
}

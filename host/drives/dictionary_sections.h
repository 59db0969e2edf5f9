/*
 * Sections and keys of an electronic data sheet, as they stand in its text: what they mean is for
 * dictionary_read.c.
 */
#ifndef TAKT_HOST_DICTIONARY_SECTIONS_H
#define TAKT_HOST_DICTIONARY_SECTIONS_H

#include "drives/dictionary_words.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* An index by itself, as a sub-index; the same for what a compact array says of each. */
#define DICTIONARY_WHOLE (-1)

#define DICTIONARY_COMPACT_MAX 254

enum dictionary_key {
    DICTIONARY_NAME,
    DICTIONARY_KIND,
    DICTIONARY_TYPE,
    DICTIONARY_ACCESS,
    DICTIONARY_DEFAULT,
    DICTIONARY_VALUE,
    DICTIONARY_LOW,
    DICTIONARY_HIGH,
    DICTIONARY_MAPPING,
    DICTIONARY_COMPACT,
    DICTIONARY_COUNT
};

/* A section that describes an entry. */
struct dictionary_section {
    uint16_t index;
    int sub;
    unsigned line;
    bool has_values; /* [1600Value]: its keys are numbers of sub-indices */
    struct text_part key[DICTIONARY_COUNT];
};

/* A default of a compact array. */
struct dictionary_compact {
    uint32_t place; /* index << 8 | sub */
    struct text_part text;
};

struct dictionary_sections {
    struct dictionary_section *section;
    unsigned count, capacity;
    struct dictionary_compact *value;
    unsigned values, value_capacity;
    uint8_t dummies;
    bool in_dummies;
    bool is_configuration; /* a DCF: a drive as its maker's tool has set it up */
    bool has_section;
};

/*
 * The same memory with room for one more, perhaps elsewhere; NULL: there is none, and the old
 * stays.
 */
void *dictionary_grow(void *memory, unsigned count, unsigned *capacity, size_t size);

/* All of a text, in order of index and sub-index. False: out of memory. */
bool dictionary_sections_read(struct dictionary_sections *r, const char *text, size_t length);
void dictionary_sections_free(struct dictionary_sections *r);

#endif

/*
 * Electronic data sheets, as they are written by many tools: keys in any case, spaces anywhere, numbers decimal or
 * hexadecimal, $NODEID before or behind a sum, arrays in full or compact (CiA 306, 4.6).
 */
#include "drives/dictionary_read.h"
#include "drives/dictionary_words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* An index by itself, as a sub-index; the same for what a compact array says of each. */
#define WHOLE (-1)

#define COMPACT_MAX 254

/* Types of CiA 301 beside those of object_table.h. */
#define TYPE_BOOLEAN 1
#define TYPE_REAL32  8

enum key {
    KEY_NAME,
    KEY_KIND,
    KEY_TYPE,
    KEY_ACCESS,
    KEY_DEFAULT,
    KEY_VALUE,
    KEY_LOW,
    KEY_HIGH,
    KEY_MAPPING,
    KEY_COMPACT,
    KEY_COUNT
};

static const char *const key_names[KEY_COUNT] = {
    "parametername",  "objecttype", "datatype",  "accesstype", "defaultvalue",
    "parametervalue", "lowlimit",   "highlimit", "pdomapping", "compactsubobj"};

/* A section that describes an entry. */
struct section {
    uint16_t index;
    int sub;
    unsigned line;
    bool has_values; /* [1600Value]: its keys are numbers of sub-indices */
    struct text_part key[KEY_COUNT];
};

/* A default of a compact array. */
struct compact_value {
    uint32_t place; /* index << 8 | sub */
    struct text_part text;
};

struct reader {
    struct section *section;
    unsigned count, capacity;
    struct compact_value *value;
    unsigned values, value_capacity;
    uint8_t dummies;
    bool in_dummies;
    bool is_configuration; /* a DCF: a drive as its maker's tool has set it up */
    bool has_section;
    struct dictionary_problem *wrong;
};

/* The same memory with room for one more, perhaps elsewhere; NULL: there is none, and the old stays. */
static void *grow(void *memory, unsigned count, unsigned *capacity, size_t size)
{
    if (count < *capacity)
        return memory;
    unsigned more = *capacity == 0 ? 256 : 2 * *capacity;
    void *grown = realloc(memory, more * size);
    if (grown != NULL)
        *capacity = more;
    return grown;
}

/* ---- Sections and keys ---- */

/* "6040", "6099sub1", "1600Value". */
static bool read_section_name(struct text_part name, struct section *section)
{
    unsigned index, sub;
    size_t at = words_read_hex(name, 4, &index);
    struct text_part rest = {name.start + at, name.length - at};
    const struct text_part word = {rest.start, rest.length < 3 ? rest.length : 3};
    if (at != 4)
        return false;
    section->index = (uint16_t)index;
    section->sub = WHOLE;
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

static bool begin_section(struct reader *r, struct text_part name, unsigned line)
{
    struct section section = {.line = line};
    r->in_dummies = words_are(name, "dummyusage");
    /* CiA 306 spells it with one m. */
    r->is_configuration = r->is_configuration || words_are(name, "devicecomissioning") ||
                          words_are(name, "devicecommissioning");
    r->has_section = read_section_name(name, &section);
    if (!r->has_section)
        return true;
    struct section *grown = grow(r->section, r->count, &r->capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    r->section = grown;
    r->section[r->count++] = section;
    return true;
}

static bool take_compact_value(struct reader *r, const struct section *section,
                               struct text_part key, struct text_part value)
{
    long sub = words_plain_number(key, 0);
    if (sub < 1 || sub > COMPACT_MAX)
        return true;
    struct compact_value *grown = grow(r->value, r->values, &r->value_capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    r->value = grown;
    r->value[r->values++] =
        (struct compact_value){(uint32_t)section->index << 8 | (uint32_t)sub, value};
    return true;
}

/* "Dummy0007=1" */
static void take_dummy(struct reader *r, struct text_part key, struct text_part value)
{
    const struct text_part word = {key.start, key.length < 5 ? key.length : 5};
    unsigned type;
    if (!words_are(word, "dummy") || words_plain_number(value, 0) == 0)
        return;
    if (words_read_hex((struct text_part){key.start + 5, key.length - 5}, 4, &type) > 0 && type < 8)
        r->dummies |= (uint8_t)(1u << type);
}

static bool take_pair(struct reader *r, struct text_part key, struct text_part value)
{
    if (r->in_dummies)
        take_dummy(r, key, value);
    if (!r->has_section)
        return true;
    struct section *section = &r->section[r->count - 1];
    if (section->has_values)
        return take_compact_value(r, section, key, value);
    for (unsigned k = 0; k < KEY_COUNT; k++)
        if (words_are(key, key_names[k]))
            section->key[k] = value;
    return true;
}

static bool take_line(struct reader *r, struct text_part line, unsigned number)
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

static bool read_lines(struct reader *r, const char *text, size_t length)
{
    size_t at = 0;
    for (unsigned number = 1; at < length; number++) {
        const char *end = memchr(text + at, '\n', length - at);
        size_t line = end ? (size_t)(end - text) - at : length - at;
        if (!take_line(r, words_trim(text + at, line), number))
            return false;
        at += line + 1;
    }
    return true;
}

/* ---- From sections to rows ---- */

struct builder {
    const struct reader *reader;
    struct object_row *row;
    unsigned count, capacity;
    char *names;
    size_t names_length;
    size_t extra; /* bytes of memory that is no object of takt's own drive */
};

static bool is_hidden(const struct section *section)
{
    return section->has_values;
}

static int compare_sections(const void *a, const void *b)
{
    const struct section *x = a, *y = b;
    if (x->index != y->index)
        return x->index < y->index ? -1 : 1;
    if (is_hidden(x) != is_hidden(y))
        return is_hidden(x) ? 1 : -1;
    if (x->sub != y->sub)
        return x->sub < y->sub ? -1 : 1;
    return x->line < y->line ? -1 : 1;
}

/* Numbers of one, two or four bytes are such; all else is told as a text. */
static uint8_t type_of(const struct section *section)
{
    long type = words_plain_number(section->key[KEY_TYPE], 0);
    if (type == TYPE_BOOLEAN)
        return OBJECT_UNSIGNED8;
    if (type == TYPE_REAL32)
        return OBJECT_UNSIGNED32;
    return type >= OBJECT_INTEGER8 && type <= OBJECT_UNSIGNED32 ? (uint8_t)type : OBJECT_STRING;
}

static uint8_t access_of(const struct section *section)
{
    const struct text_part access = section->key[KEY_ACCESS];
    if (words_are(access, "const"))
        return OBJECT_CONST;
    if (words_are(access, "wo"))
        return OBJECT_WO;
    return words_are(access, "ro") ? OBJECT_RO : OBJECT_RW;
}

/* CiA 306: rww goes into RPDOs, rwr into TPDOs, rw into both. */
static uint8_t mapping_of(const struct section *section)
{
    const struct text_part access = section->key[KEY_ACCESS];
    if (words_plain_number(section->key[KEY_MAPPING], 0) == 0)
        return 0;
    if (words_are(access, "rww") || words_are(access, "wo"))
        return OBJECT_TO_RPDO;
    return words_are(access, "rw") ? OBJECT_TO_RPDO | OBJECT_TO_TPDO : OBJECT_TO_TPDO;
}

static struct text_part default_of(const struct section *section)
{
    const struct text_part value = section->key[KEY_DEFAULT];
    return value.length > 0 ? value : section->key[KEY_VALUE];
}

static const char *keep(struct builder *b, struct text_part part)
{
    char *kept = b->names + b->names_length;
    memcpy(kept, part.start != NULL ? part.start : "", part.length);
    kept[part.length] = '\0';
    b->names_length += part.length + 1;
    return kept;
}

static void take_number(struct object_row *row, struct text_part part, int64_t *number)
{
    bool has_node;
    int64_t value;
    if (!words_read_number(part, &value, &has_node))
        return;
    *number = takt_object_type_value((enum object_type)row->type, (uint32_t)value);
}

static int64_t least_of(uint8_t type)
{
    unsigned bits = 8 * takt_object_type_bytes((enum object_type)type);
    bool is_signed = type <= OBJECT_INTEGER32;
    return is_signed ? -(INT64_C(1) << (bits - 1)) : 0;
}

static int64_t most_of(uint8_t type)
{
    unsigned bits = 8 * takt_object_type_bytes((enum object_type)type);
    bool is_signed = type <= OBJECT_INTEGER32;
    return (INT64_C(1) << (is_signed ? bits - 1 : bits)) - 1;
}

static void take_limits(struct object_row *row, const struct section *section)
{
    const struct text_part low = section->key[KEY_LOW], high = section->key[KEY_HIGH];
    row->flags &= (uint8_t)~OBJECT_LIMITED;
    row->min = least_of(row->type);
    row->max = most_of(row->type);
    if (low.length == 0 && high.length == 0)
        return;
    row->flags |= OBJECT_LIMITED;
    take_number(row, low, &row->min);
    take_number(row, high, &row->max);
}

static bool take_default(struct object_row *row, struct text_part part)
{
    bool has_node = false;
    int64_t value;
    if (!words_read_number(part, &value, &has_node))
        return false;
    row->initial = takt_object_type_value((enum object_type)row->type, (uint32_t)value);
    row->flags = (uint8_t)((row->flags & ~OBJECT_NODE_ID) | (has_node ? OBJECT_NODE_ID : 0));
    return true;
}

/*
 * Defaults in increments are the machine's, whatever the unit of the drive is, and limits the motor's; as takt's own drive has
 * them.
 */
static bool is_of_motor(uint16_t index)
{
    switch (index) {
    case 0x6065:
    case 0x6066:
    case 0x6067:
    case 0x606D:
    case 0x606F:
    case 0x6072:
    case 0x607F:
    case 0x6080:
    case 0x6081:
    case 0x6083:
    case 0x6084:
    case 0x6085:
    case 0x60A4:
    case 0x6099:
    case 0x609A:
    case 0x60C5:
    case 0x60C6:
        return true;
    default:
        return false;
    }
}

/* What takt's own drive has there; of the same size it does the same. */
static void take_own(struct builder *b, struct object_row *row)
{
    bool has_index;
    const struct object_row *own = takt_object_table_find(row->index, row->sub, &has_index);
    unsigned bytes = takt_object_type_bytes((enum object_type)row->type);
    if (own != NULL && bytes != 0 && bytes == takt_object_type_bytes((enum object_type)own->type)) {
        const uint8_t kept = OBJECT_EVENT | OBJECT_FIXED | OBJECT_BY_MACHINE | OBJECT_NODE_ID;
        row->field = own->field;
        row->initial = own->initial;
        row->flags |= own->flags & kept;
        return;
    }
    row->field = (uint16_t)(offsetof(struct drive_objects, extra) + b->extra);
    b->extra += 4;
    if (bytes == 0)
        row->flags |= OBJECT_FIXED;
}

/* One entry of the dictionary; value: its default. */
static bool add_row(struct builder *b, const struct section *section, uint8_t sub, uint8_t kind,
                    struct text_part value)
{
    struct object_row row = {.index = section->index, .sub = sub, .kind = kind};
    if (b->count > 0 && b->row[b->count - 1].index == row.index && b->row[b->count - 1].sub == sub)
        return true; /* described twice: the first counts */
    struct object_row *grown = grow(b->row, b->count, &b->capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    b->row = grown;
    row.type = type_of(section);
    row.access = access_of(section);
    row.flags = mapping_of(section);
    row.name = keep(b, section->key[KEY_NAME]);
    take_own(b, &row);
    if (takt_object_type_bytes((enum object_type)row.type) == 0) {
        row.title = keep(b, value);
    } else {
        take_limits(&row, section);
        if (!is_of_motor(row.index) && take_default(&row, value))
            row.flags &= (uint8_t)~OBJECT_BY_MACHINE;
    }
    b->row[b->count++] = row;
    return true;
}

static struct text_part compact_value(const struct reader *r, const struct section *section,
                                      unsigned sub)
{
    for (unsigned i = 0; i < r->values; i++)
        if (r->value[i].place == ((uint32_t)section->index << 8 | sub))
            return r->value[i].text;
    return default_of(section);
}

/* CiA 306, 4.6.3.2: sub-index 0 is how many, and all others are alike. */
static bool add_compact(struct builder *b, const struct section *section, unsigned subs)
{
    static const char number[] = "0x05", read_only[] = "ro";
    struct section head = *section;
    char text[8];
    (void)snprintf(text, sizeof text, "%u", subs);
    head.key[KEY_TYPE] = (struct text_part){number, sizeof number - 1};
    head.key[KEY_ACCESS] = (struct text_part){read_only, sizeof read_only - 1};
    head.key[KEY_LOW] = head.key[KEY_HIGH] = head.key[KEY_MAPPING] = (struct text_part){NULL, 0};
    if (!add_row(b, &head, 0, OBJECT_ARRAY, (struct text_part){text, strlen(text)}))
        return false;
    b->row[b->count - 1].title = b->row[b->count - 1].name;
    for (unsigned sub = 1; sub <= subs; sub++)
        if (!add_row(b, section, (uint8_t)sub, OBJECT_SAME, compact_value(b->reader, section, sub)))
            return false;
    return true;
}

/* An index with sub-indices has a section for itself, which is none of its entries. */
static bool add_section(struct builder *b, const struct section *section)
{
    bool is_next = section > b->reader->section && section[-1].index == section->index;
    long kind = words_plain_number(section->key[KEY_KIND], OBJECT_VAR);
    long subs = words_plain_number(section->key[KEY_COMPACT], 0);
    bool has_entries = kind == OBJECT_ARRAY || kind == OBJECT_RECORD;
    if (section->has_values)
        return true;
    if (section->sub == WHOLE && subs > 0)
        return add_compact(b, section, subs < COMPACT_MAX ? (unsigned)subs : COMPACT_MAX);
    if (section->sub == WHOLE)
        return has_entries || add_row(b, section, 0, OBJECT_VAR, default_of(section));
    if (section->sub > 0)
        return add_row(b, section, (uint8_t)section->sub, OBJECT_SAME, default_of(section));
    if (is_next)
        kind = words_plain_number(section[-1].key[KEY_KIND], OBJECT_RECORD);
    if (!add_row(b, section, 0, kind == OBJECT_ARRAY ? OBJECT_ARRAY : OBJECT_RECORD,
                 default_of(section)))
        return false;
    b->row[b->count - 1].title =
        is_next ? keep(b, section[-1].key[KEY_NAME]) : b->row[b->count - 1].name;
    return true;
}

/* A PDO has as many entries as the sheet has sub-indices for, and no more than a frame. */
static void limit_mappings(struct builder *b)
{
    for (unsigned i = 0; i < b->count; i++) {
        struct object_row *row = &b->row[i];
        bool is_mapping = (row->index >= 0x1600 && row->index < 0x1800) ||
                          (row->index >= 0x1A00 && row->index < 0x1C00);
        int64_t entries = 0;
        if (!is_mapping || row->sub != 0)
            continue;
        while (i + (unsigned)entries + 1 < b->count &&
               b->row[i + (unsigned)entries + 1].index == row->index)
            entries++;
        if (entries > DRIVE_PDO_MAPPED_MAX)
            entries = DRIVE_PDO_MAPPED_MAX;
        if (!(row->flags & OBJECT_LIMITED) || row->max > entries)
            row->max = entries;
        if (!(row->flags & OBJECT_LIMITED))
            row->min = 0;
        row->flags |= OBJECT_LIMITED;
        if (row->initial > row->max)
            row->initial = row->max;
    }
}

/* What is mapped when a drive comes from its maker can be mapped, whatever its sheet says there. */
static void allow_mapped(struct builder *b)
{
    const struct dictionary built = {.row = b->row, .count = b->count};
    for (unsigned i = 0; i < b->count; i++) {
        const struct object_row *entry = &b->row[i];
        bool is_received = entry->index >= 0x1600 && entry->index < 0x1800;
        bool is_sent = entry->index >= 0x1A00 && entry->index < 0x1C00;
        bool has_index;
        if (entry->sub == 0 || !(is_received || is_sent))
            continue;
        const struct object_row *mapped =
            takt_dictionary_find(&built, (uint16_t)((uint64_t)entry->initial >> 16),
                                 (uint8_t)((uint64_t)entry->initial >> 8), &has_index);
        if (mapped != NULL && is_received && mapped->access != OBJECT_RO)
            b->row[mapped - b->row].flags |= OBJECT_TO_RPDO;
        else if (mapped != NULL && is_sent)
            b->row[mapped - b->row].flags |= OBJECT_TO_TPDO;
    }
}

static bool fail(struct dictionary_problem *wrong, const char *text)
{
    wrong->line = 0;
    (void)snprintf(wrong->text, sizeof wrong->text, "%s", text);
    return false;
}

static bool build(struct builder *b, struct dictionary_problem *wrong)
{
    const struct reader *r = b->reader;
    bool has_index;
    for (unsigned i = 0; i < r->count; i++)
        if (!add_section(b, &r->section[i]))
            return fail(wrong, "out of memory");
    limit_mappings(b);
    allow_mapped(b);
    const struct dictionary built = {.row = b->row, .count = b->count};
    if (takt_dictionary_find(&built, 0x1000, 0, &has_index) == NULL)
        return fail(wrong, "this is no electronic data sheet: it has no section [1000]");
    if (takt_dictionary_find(&built, 0x6040, 0, &has_index) == NULL)
        return fail(wrong, "this is no drive: it has no controlword, section [6040]");
    if (b->extra > DRIVE_EXTRA_SIZE)
        return fail(wrong, "it has more objects than a virtual drive has memory for");
    return true;
}

/* In a configuration the values that have been set count; what has not been set is as it comes from the maker. */
static void prefer_values(struct reader *r)
{
    for (unsigned i = 0; i < r->count; i++) {
        struct text_part *key = r->section[i].key;
        if (key[KEY_VALUE].length > 0)
            key[KEY_DEFAULT] = key[KEY_VALUE];
    }
}

/* Names and texts take no more than the file; each compact entry has one of its own. */
static size_t names_most(const struct reader *r, size_t length)
{
    size_t most = length + 4 * (size_t)r->count + 16;
    for (unsigned i = 0; i < r->count; i++) {
        const struct section *section = &r->section[i];
        if (words_plain_number(section->key[KEY_COMPACT], 0) > 0)
            most += (COMPACT_MAX + 2) *
                    (section->key[KEY_NAME].length + section->key[KEY_DEFAULT].length + 16);
        most += section->key[KEY_NAME].length;
    }
    return most;
}

bool dictionary_read(struct dictionary *dictionary, const char *text, size_t length,
                     struct dictionary_problem *wrong)
{
    struct reader r = {.wrong = wrong};
    struct builder b = {.reader = &r};
    bool good = read_lines(&r, text, length) || fail(wrong, "out of memory");
    if (good && r.is_configuration)
        prefer_values(&r);
    if (good && r.count > 0) {
        qsort(r.section, r.count, sizeof *r.section, compare_sections);
        b.names = malloc(names_most(&r, length));
    }
    good = good &&
           (b.names != NULL ||
            fail(wrong, "this is no electronic data sheet: it has no section [1000]")) &&
           build(&b, wrong);
    free(r.section);
    free(r.value);
    *dictionary = (struct dictionary){
        .row = b.row, .memory = b.row, .count = b.count, .dummies = r.dummies, .names = b.names};
    if (!good) {
        free(b.row);
        free(b.names);
        *dictionary = (struct dictionary){0};
    }
    return good;
}

void dictionary_free(struct dictionary *dictionary)
{
    free(dictionary->memory);
    free(dictionary->names);
    *dictionary = (struct dictionary){0};
}

/*
 * A dictionary of an electronic data sheet: numbers decimal or hexadecimal, $NODEID before or
 * behind a sum, arrays in full or compact (CiA 306, 4.6).
 */
#include "drives/dictionary_read.h"
#include "drives/dictionary_sections.h"
#include "drives/dictionary_text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Types of CiA 301 beside those of object_table.h. */
#define TYPE_BOOLEAN 1
#define TYPE_REAL32  8

struct builder {
    const struct dictionary_sections *reader;
    struct object_row *row;
    unsigned count, capacity;
    char *names;
    size_t names_length;
    size_t extra; /* bytes of memory that is no object of takt's own drive */
};

/* Numbers of one, two or four bytes are such; all else is told as a text. */
static uint8_t type_of(const struct dictionary_section *section)
{
    long type = words_plain_number(section->key[DICTIONARY_TYPE], 0);
    if (type == TYPE_BOOLEAN)
        return OBJECT_UNSIGNED8;
    if (type == TYPE_REAL32)
        return OBJECT_UNSIGNED32;
    return type >= OBJECT_INTEGER8 && type <= OBJECT_UNSIGNED32 ? (uint8_t)type : OBJECT_STRING;
}

static uint8_t access_of(const struct dictionary_section *section)
{
    const struct text_part access = section->key[DICTIONARY_ACCESS];
    if (words_are(access, "const"))
        return OBJECT_CONST;
    if (words_are(access, "wo"))
        return OBJECT_WO;
    return words_are(access, "ro") ? OBJECT_RO : OBJECT_RW;
}

/* CiA 306: rww goes into RPDOs, rwr into TPDOs, rw into both. */
static uint8_t mapping_of(const struct dictionary_section *section)
{
    const struct text_part access = section->key[DICTIONARY_ACCESS];
    if (words_plain_number(section->key[DICTIONARY_MAPPING], 0) == 0)
        return 0;
    if (words_are(access, "rww") || words_are(access, "wo"))
        return OBJECT_TO_RPDO;
    return words_are(access, "rw") ? OBJECT_TO_RPDO | OBJECT_TO_TPDO : OBJECT_TO_TPDO;
}

static struct text_part default_of(const struct dictionary_section *section)
{
    const struct text_part value = section->key[DICTIONARY_DEFAULT];
    return value.length > 0 ? value : section->key[DICTIONARY_VALUE];
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

static void take_limits(struct object_row *row, const struct dictionary_section *section)
{
    const struct text_part low = section->key[DICTIONARY_LOW], high = section->key[DICTIONARY_HIGH];
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
 * Defaults in increments are the machine's, whatever the unit of the drive is, and limits the
 * motor's; as takt's own drive has them.
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
static bool add_row(struct builder *b, const struct dictionary_section *section, uint8_t sub,
                    uint8_t kind, struct text_part value)
{
    struct object_row row = {.index = section->index, .sub = sub, .kind = kind};
    if (b->count > 0 && b->row[b->count - 1].index == row.index && b->row[b->count - 1].sub == sub)
        return true; /* described twice: the first counts */
    struct object_row *grown = dictionary_grow(b->row, b->count, &b->capacity, sizeof *grown);
    if (grown == NULL)
        return false;
    b->row = grown;
    row.type = type_of(section);
    row.access = access_of(section);
    row.flags = mapping_of(section);
    row.name = keep(b, section->key[DICTIONARY_NAME]);
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

static struct text_part compact_value(const struct dictionary_sections *r,
                                      const struct dictionary_section *section, unsigned sub)
{
    for (unsigned i = 0; i < r->values; i++)
        if (r->value[i].place == ((uint32_t)section->index << 8 | sub))
            return r->value[i].text;
    return default_of(section);
}

/* CiA 306, 4.6.3.2: sub-index 0 is how many, and all others are alike. */
static bool add_compact(struct builder *b, const struct dictionary_section *section, unsigned subs)
{
    static const char number[] = "0x05", read_only[] = "ro";
    struct dictionary_section head = *section;
    char text[8];
    (void)snprintf(text, sizeof text, "%u", subs);
    head.key[DICTIONARY_TYPE] = (struct text_part){number, sizeof number - 1};
    head.key[DICTIONARY_ACCESS] = (struct text_part){read_only, sizeof read_only - 1};
    head.key[DICTIONARY_LOW] = head.key[DICTIONARY_HIGH] = head.key[DICTIONARY_MAPPING] =
        (struct text_part){NULL, 0};
    if (!add_row(b, &head, 0, OBJECT_ARRAY, (struct text_part){text, strlen(text)}))
        return false;
    b->row[b->count - 1].title = b->row[b->count - 1].name;
    for (unsigned sub = 1; sub <= subs; sub++)
        if (!add_row(b, section, (uint8_t)sub, OBJECT_SAME, compact_value(b->reader, section, sub)))
            return false;
    return true;
}

/* An index with sub-indices has a section for itself, which is none of its entries. */
static bool add_section(struct builder *b, const struct dictionary_section *section)
{
    bool is_next = section > b->reader->section && section[-1].index == section->index;
    long kind = words_plain_number(section->key[DICTIONARY_KIND], OBJECT_VAR);
    long subs = words_plain_number(section->key[DICTIONARY_COMPACT], 0);
    bool has_entries = kind == OBJECT_ARRAY || kind == OBJECT_RECORD;
    if (section->has_values)
        return true;
    if (section->sub == DICTIONARY_WHOLE && subs > 0)
        return add_compact(b, section,
                           subs < DICTIONARY_COMPACT_MAX ? (unsigned)subs : DICTIONARY_COMPACT_MAX);
    if (section->sub == DICTIONARY_WHOLE)
        return has_entries || add_row(b, section, 0, OBJECT_VAR, default_of(section));
    if (section->sub > 0)
        return add_row(b, section, (uint8_t)section->sub, OBJECT_SAME, default_of(section));
    if (is_next)
        kind = words_plain_number(section[-1].key[DICTIONARY_KIND], OBJECT_RECORD);
    if (!add_row(b, section, 0, kind == OBJECT_ARRAY ? OBJECT_ARRAY : OBJECT_RECORD,
                 default_of(section)))
        return false;
    b->row[b->count - 1].title =
        is_next ? keep(b, section[-1].key[DICTIONARY_NAME]) : b->row[b->count - 1].name;
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
    const struct dictionary_sections *r = b->reader;
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

/* Names and texts take no more than the file; each compact entry has one of its own. */
static size_t names_most(const struct dictionary_sections *r, size_t length)
{
    size_t most = length + 4 * (size_t)r->count + 16;
    for (unsigned i = 0; i < r->count; i++) {
        const struct dictionary_section *section = &r->section[i];
        if (words_plain_number(section->key[DICTIONARY_COMPACT], 0) > 0)
            most += (DICTIONARY_COMPACT_MAX + 2) * (section->key[DICTIONARY_NAME].length +
                                                    section->key[DICTIONARY_DEFAULT].length + 16);
        most += section->key[DICTIONARY_NAME].length;
    }
    return most;
}

/* A file without a section of an object: what it is instead, where that can be seen. */
static bool fail_empty(struct dictionary_problem *wrong, const char *plain, size_t length)
{
    const struct text_part text = words_trim(plain, length);
    if (text.length > 0 && memchr(text.start, '<', text.length < 4 ? text.length : 4) != NULL)
        return fail(wrong, "this is XML, no electronic data sheet: of a device description (XDD) "
                           "CANopenEditor or the maker's tool makes an EDS");
    return fail(wrong, "this is no electronic data sheet: it has no section [1000]");
}

bool dictionary_read(struct dictionary *dictionary, const char *text, size_t length,
                     struct dictionary_problem *wrong)
{
    struct dictionary_sections r = {0};
    struct builder b = {.reader = &r};
    char *plain = dictionary_plain_text(text, &length);
    bool good = (plain != NULL && dictionary_sections_read(&r, plain, length)) ||
                fail(wrong, "out of memory");
    if (good && r.count > 0)
        b.names = malloc(names_most(&r, length));
    good = good && (b.names != NULL || fail_empty(wrong, plain, length)) && build(&b, wrong);
    dictionary_sections_free(&r);
    free(plain);
    *dictionary = (struct dictionary){
        .row = b.row, .memory = b.row, .count = b.count, .dummies = r.dummies, .names = b.names};
    if (!good)
        dictionary_free(dictionary);
    return good;
}

void dictionary_free(struct dictionary *dictionary)
{
    free(dictionary->memory);
    free(dictionary->names);
    *dictionary = (struct dictionary){0};
}

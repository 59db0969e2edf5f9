#include "drives/drive_store.h"

#include "canopen/node.h"
#include "drives/dictionary_words.h"
#include "servo/servo_private.h"
#include "servo/stored.h"

#include <stdarg.h>
#include <string.h>

#define COMMENT '#'
#define NODE    "node "

static bool is_text(const struct object_row *row)
{
    return row->type == OBJECT_STRING;
}

static char *text_of(const struct object_row *row, struct drive_objects *objects)
{
    return (char *)objects + row->field;
}

/* ---- To a text ---- */

static void write_number(FILE *stream, const struct object_row *row, uint32_t value)
{
    unsigned bytes = takt_object_type_bytes((enum object_type)row->type);
    (void)fprintf(stream, "%04X:%02X %0*X\n", row->index, row->sub, (int)(2 * bytes),
                  (unsigned)value);
}

static void write_text(FILE *stream, const struct object_row *row, const char *text)
{
    (void)fprintf(stream, "%04X:%02X \"", row->index, row->sub);
    for (; *text != '\0'; text++)
        (void)fprintf(stream, "%02X", (unsigned)(unsigned char)*text);
    (void)fputs("\"\n", stream);
}

static void write_row(FILE *stream, const struct object_row *row,
                      const struct drive_objects *stored, const struct drive_objects *initial)
{
    if (is_text(row)) {
        const char *text = (const char *)stored + row->field;
        if (strcmp(text, (const char *)initial + row->field) != 0)
            write_text(stream, row, text);
    } else if (takt_object_read(row, stored) != takt_object_read(row, initial)) {
        write_number(stream, row, takt_object_read(row, stored));
    }
}

void drive_store_write(FILE *stream, const struct servo *drive)
{
    const struct dictionary *dictionary = drive->dictionary;
    const uint8_t born = drive->config.is_nameless ? LSS_NO_NODE : drive->number;
    (void)fprintf(stream, "%c stored by node %u, object 1010\n", COMMENT,
                  (unsigned)drive->config.node);
    if (drive->lss.stored != born)
        (void)fprintf(stream, NODE "%u\n", (unsigned)drive->lss.stored);
    for (unsigned i = 0; i < dictionary->count; i++)
        if (takt_servo_is_stored(&dictionary->row[i]))
            write_row(stream, &dictionary->row[i], &drive->stored, &drive->initial);
}

/* ---- From a text ---- */

__attribute__((format(printf, 2, 3))) static bool refuse(struct drive_store_problem *wrong,
                                                         const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(wrong->text, sizeof wrong->text, format, arguments);
    va_end(arguments);
    return false;
}

static struct text_part behind(struct text_part part, size_t count)
{
    return words_trim(part.start + count, part.length - count);
}

/* "1017:00 ": false, it does not begin like that. */
static bool read_place(struct text_part *part, unsigned *index, unsigned *sub)
{
    if (words_read_hex(*part, 4, index) != 4 || part->length < 5 || part->start[4] != ':')
        return false;
    *part = behind(*part, 5);
    if (words_read_hex(*part, 2, sub) != 2)
        return false;
    *part = behind(*part, 2);
    return true;
}

static bool take_number(const struct object_row *row, struct drive_objects *stored,
                        struct text_part part, struct drive_store_problem *wrong)
{
    const unsigned bytes = takt_object_type_bytes((enum object_type)row->type);
    unsigned raw;
    size_t digits = words_read_hex(part, 8, &raw);
    int64_t value = takt_object_type_value((enum object_type)row->type, raw);
    if (digits == 0 || digits != part.length || digits > (size_t)2 * bytes)
        return refuse(wrong, "%04X:%02X is a number of %u bytes, in hexadecimal", row->index,
                      row->sub, bytes);
    if (row->flags & OBJECT_LIMITED && (value < row->min || value > row->max))
        return refuse(wrong, "%04X:%02X is %lld ... %lld", row->index, row->sub,
                      (long long)row->min, (long long)row->max);
    takt_object_write(row, stored, raw);
    return true;
}

static bool take_text(const struct object_row *row, struct drive_objects *stored,
                      struct text_part part, struct drive_store_problem *wrong)
{
    char text[DRIVE_LABEL_SIZE] = "";
    bool is_quoted = part.length >= 2 && part.length <= 2 * sizeof text && part.length % 2 == 0 &&
                     part.start[0] == '"' && part.start[part.length - 1] == '"';
    for (size_t i = 0; is_quoted && i < (part.length - 2) / 2; i++) {
        unsigned byte;
        is_quoted = words_read_hex(behind(part, 1 + 2 * i), 2, &byte) == 2;
        text[i] = (char)byte;
    }
    if (!is_quoted)
        return refuse(wrong, "%04X:%02X is up to %u bytes in hexadecimal, between quotes",
                      row->index, row->sub, (unsigned)sizeof text - 1);
    memcpy(text_of(row, stored), text, sizeof text);
    return true;
}

/* What is stored counts from this node id on. */
static bool take_node(struct servo *drive, struct text_part part, struct drive_store_problem *wrong)
{
    unsigned node = 0;
    for (size_t i = 0; i < part.length && i < 3; i++)
        node = part.start[i] >= '0' && part.start[i] <= '9'
                   ? 10 * node + (unsigned)(part.start[i] - '0')
                   : LSS_NO_NODE + 1;
    if (part.length > 3 || node == 0 || (node > NODE_MAX && node != LSS_NO_NODE))
        return refuse(wrong, "a node id is 1 ... %d, or %d: none", NODE_MAX, LSS_NO_NODE);
    drive->lss.stored = (uint8_t)node;
    takt_servo_apply_lss(drive, true);
    return true;
}

static bool take_line(struct servo *drive, struct text_part part, struct drive_store_problem *wrong)
{
    unsigned index, sub;
    bool has_index;
    if (part.length == 0 || part.start[0] == COMMENT)
        return true;
    if (part.length >= strlen(NODE) && memcmp(part.start, NODE, strlen(NODE)) == 0)
        return take_node(drive, behind(part, strlen(NODE)), wrong);
    if (!read_place(&part, &index, &sub))
        return refuse(wrong, "an object is expected, as 1017:00");
    const struct object_row *row =
        takt_dictionary_find(drive->dictionary, (uint16_t)index, (uint8_t)sub, &has_index);
    if (row == NULL || !takt_servo_is_stored(row))
        return refuse(wrong, "node %u has no object %04X:%02X that can be stored",
                      (unsigned)drive->config.node, index, sub);
    return is_text(row) ? take_text(row, &drive->stored, part, wrong)
                        : take_number(row, &drive->stored, part, wrong);
}

bool drive_store_read(struct servo *drive, const char *text, size_t length,
                      struct drive_store_problem *wrong)
{
    size_t at = 0;
    for (wrong->line = 1; at < length; wrong->line++) {
        const char *end = memchr(text + at, '\n', length - at);
        size_t next = end != NULL ? (size_t)(end - text) : length;
        if (!take_line(drive, words_trim(text + at, next - at), wrong))
            return false;
        at = next + 1;
    }
    takt_servo_restore(drive, UINT16_MAX);
    takt_servo_update_pdos(drive);
    return true;
}

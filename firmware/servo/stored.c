#include "servo/stored.h"

#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"
#include "servo/servo_private.h"

#include <string.h>

#define HEAD_BYTES 4

bool takt_servo_is_stored(const struct object_row *row)
{
    bool is_process = row->field < sizeof(struct drive_process);
    return row->access == OBJECT_RW && !(row->flags & OBJECT_FIXED) && !is_process;
}

static size_t width_of(const struct object_row *row)
{
    TAKT_ASSERT(row->type == OBJECT_STRING ||
                takt_object_type_bytes((enum object_type)row->type) <= 4);
    return row->type == OBJECT_STRING ? DRIVE_LABEL_SIZE
                                      : takt_object_type_bytes((enum object_type)row->type);
}

static void get_value(const struct object_row *row, const struct drive_objects *objects,
                      uint8_t bytes[DRIVE_LABEL_SIZE])
{
    if (row->type == OBJECT_STRING)
        memcpy(bytes, (const char *)objects + row->field, DRIVE_LABEL_SIZE);
    else
        little_endian_write32(bytes, takt_object_read(row, objects));
}

static bool is_changed(const struct servo *drive, const struct object_row *row)
{
    uint8_t now[DRIVE_LABEL_SIZE] = {0}, before[DRIVE_LABEL_SIZE] = {0};
    get_value(row, &drive->stored, now);
    get_value(row, &drive->initial, before);
    return memcmp(now, before, width_of(row)) != 0;
}

size_t takt_servo_write_stored(const struct servo *drive, uint8_t *bytes, size_t room)
{
    const struct dictionary *dictionary = drive->dictionary;
    size_t at = 1;
    if (room < 1)
        return 0;
    bytes[0] = drive->lss.stored;
    for (unsigned i = 0; i < dictionary->count; i++) {
        const struct object_row *row = &dictionary->row[i];
        uint8_t value[DRIVE_LABEL_SIZE];
        if (!takt_servo_is_stored(row) || !is_changed(drive, row))
            continue;
        if (room - at < HEAD_BYTES + width_of(row))
            return 0;
        little_endian_write16(bytes + at, row->index);
        bytes[at + 2] = row->sub;
        bytes[at + 3] = (uint8_t)width_of(row);
        get_value(row, &drive->stored, value);
        memcpy(bytes + at + HEAD_BYTES, value, width_of(row));
        at += HEAD_BYTES + width_of(row);
    }
    return at;
}

static bool take_number(const struct object_row *row, struct drive_objects *stored,
                        const uint8_t *bytes)
{
    uint8_t all[4] = {0};
    memcpy(all, bytes, width_of(row));
    uint32_t raw = little_endian_read32(all);
    int64_t value = takt_object_type_value((enum object_type)row->type, raw);
    if (row->flags & OBJECT_LIMITED && (value < row->min || value > row->max))
        return false;
    takt_object_write(row, stored, raw);
    return true;
}

static bool take_text(const struct object_row *row, struct drive_objects *stored,
                      const uint8_t *bytes)
{
    if (bytes[DRIVE_LABEL_SIZE - 1] != 0)
        return false;
    memcpy((char *)stored + row->field, bytes, DRIVE_LABEL_SIZE);
    return true;
}

/* The bytes it has taken; 0: it is wrong. */
static size_t take_value(struct servo *drive, const uint8_t *bytes, size_t left)
{
    bool has_index;
    if (left < HEAD_BYTES)
        return 0;
    const struct object_row *row =
        takt_dictionary_find(drive->dictionary, little_endian_read16(bytes), bytes[2], &has_index);
    if (row == NULL || !takt_servo_is_stored(row) || bytes[3] != width_of(row) ||
        left - HEAD_BYTES < width_of(row))
        return 0;
    bool is_right = row->type == OBJECT_STRING
                        ? take_text(row, &drive->stored, bytes + HEAD_BYTES)
                        : take_number(row, &drive->stored, bytes + HEAD_BYTES);
    return is_right ? HEAD_BYTES + width_of(row) : 0;
}

bool takt_servo_read_stored(struct servo *drive, const uint8_t *bytes, size_t length)
{
    size_t at = 1;
    if (length < 1 || bytes[0] == 0 || (bytes[0] > NODE_MAX && bytes[0] != LSS_NO_NODE))
        return false;
    drive->lss.stored = bytes[0]; /* values count from this node id on */
    takt_servo_apply_lss(drive, true);
    while (at < length) {
        size_t taken = take_value(drive, bytes + at, length - at);
        if (taken == 0) {
            drive->stored = drive->initial;
            return false;
        }
        at += taken;
    }
    takt_servo_restore(drive, UINT16_MAX);
    takt_servo_update_pdos(drive);
    return true;
}

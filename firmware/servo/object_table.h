/*
 * The object dictionary of the drive as one table: what the SDO server answers by, what PDOs
 * are mapped by, and what the EDS file is written from.
 */
#ifndef TAKT_SERVO_OBJECT_TABLE_H
#define TAKT_SERVO_OBJECT_TABLE_H

#include "servo/drive_objects.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Data types, by their number in CiA 301, table 44. */
enum object_type {
    OBJECT_INTEGER8 = 2,
    OBJECT_INTEGER16 = 3,
    OBJECT_INTEGER32 = 4,
    OBJECT_UNSIGNED8 = 5,
    OBJECT_UNSIGNED16 = 6,
    OBJECT_UNSIGNED32 = 7,
    OBJECT_STRING = 9,
    OBJECT_DOMAIN = 15
};

/* What an index holds, by CiA 301, table 42. Only its first row says so. */
enum object_kind { OBJECT_SAME = 0, OBJECT_VAR = 7, OBJECT_ARRAY = 8, OBJECT_RECORD = 9 };

enum object_access { OBJECT_RO, OBJECT_RW, OBJECT_WO, OBJECT_CONST };

/* How a row behaves beside its access. */
enum object_flag {
    OBJECT_TO_TPDO = 1,     /* may be mapped into TPDOs */
    OBJECT_TO_RPDO = 2,     /* may be mapped into RPDOs */
    OBJECT_NODE_ID = 4,     /* the default value counts from the node id */
    OBJECT_LIMITED = 8,     /* min and max hold */
    OBJECT_EVENT = 16,      /* its change is an event that sends an event-driven TPDO */
    OBJECT_BY_MACHINE = 32, /* its default value depends on the machine */
    OBJECT_FIXED = 64       /* value is `initial` itself, there is no field */
};

struct object_row {
    uint16_t index;
    uint8_t sub;
    uint8_t kind;   /* enum object_kind */
    uint8_t type;   /* enum object_type */
    uint8_t access; /* enum object_access */
    uint8_t flags;  /* enum object_flag */
    uint16_t field; /* offset in struct drive_objects */
    int64_t initial;
    int64_t min, max;
    const char *name; /* of this entry */
    const char
        *title; /* of the index, where kind is ARRAY or RECORD; of a string: its constant text */
};

extern const struct object_row takt_object_table[]; /* by rising index and sub-index */
extern const unsigned takt_object_table_count;

/* NULL: no such entry. *has_index: the index exists, so the sub-index is what is missing. */
const struct object_row *takt_object_table_find(uint16_t index, uint8_t sub, bool *has_index);

/* Bytes of a number; 0 for strings and domains. */
unsigned takt_object_type_bytes(enum object_type type);
/* What the bytes say: sign by the type. */
int64_t takt_object_type_value(enum object_type type, uint32_t raw);

/* Numbers as raw bits, of the object's width. */
uint32_t takt_object_read(const struct object_row *row, const struct drive_objects *objects);
void takt_object_write(const struct object_row *row, struct drive_objects *objects, uint32_t raw);

#endif

/*
 * The numbers of struct machine as they are stored: one row each. Numbers are never used again for
 * something else.
 */
#ifndef TAKT_STORAGE_SETTINGS_FIELDS_H
#define TAKT_STORAGE_SETTINGS_FIELDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes are as they stand in memory; takt_machine_check knows which may be. */
enum settings_type {
    SETTINGS_TEXT,
    SETTINGS_BYTES,
    SETTINGS_FLAG,
    SETTINGS_U8,
    SETTINGS_I8,
    SETTINGS_U32,
    SETTINGS_DOUBLE
};

struct settings_field {
    double least, most; /* in the units of the struct */
    const char *name;   /* as in a machine file */
    uint16_t number;
    uint16_t offset; /* in struct machine_axis with of_axis, else in struct machine */
    uint16_t count;  /* numbers; of a text: its bytes with the zero; of bytes: these */
    enum settings_type type;
    bool of_axis;
    bool above; /* least itself is not allowed */
};

extern const struct settings_field takt_settings_fields[];
extern const size_t takt_settings_fields_count;

/* Bytes of a field's value in a record. */
uint32_t takt_settings_field_bytes(const struct settings_field *field);

/* From the struct to a record, and back. base: the struct the offset is in. */
void takt_settings_field_get(const struct settings_field *field, const void *base, uint8_t *bytes);
void takt_settings_field_set(const struct settings_field *field, void *base, const uint8_t *bytes);

/* False: one of its numbers, *value, is out of range or not finite; or the text does not end. */
bool takt_settings_field_check(const struct settings_field *field, const void *base, double *value);

#endif

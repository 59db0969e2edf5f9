#include "storage/settings.h"

#include "base/assert.h"
#include "base/crc32.h"
#include "machine/machine_check.h"
#include "storage/little_words.h"
#include "storage/settings_fields.h"
#include "storage/settings_tables.h"

#include <string.h>

#define MARK 0x314D4B54U /* "TKM1" */

/* Where the words of the head stand. */
#define HEAD_SIZE    4U
#define HEAD_CRC     8U
#define HEAD_VERSION 12U

#define RECORD_HEAD_BYTES 8U
#define ALIGNMENT         8U

/* Numbers of records that are no fields. */
#define RECORD_VOLUME 200U
#define RECORD_AXES   201U
#define RECORD_DCF    202U /* in place of the axis: which drive's */

/* ---- writing ---- */

struct writer {
    uint8_t *bytes;
    size_t at, room;
    bool is_full;
};

static size_t filled_up(size_t size)
{
    return (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
}

/* The place of a record's value; NULL: there is no room for it. */
static uint8_t *begin_record(struct writer *w, uint16_t number, uint16_t axis, uint32_t size)
{
    uint8_t *to = w->bytes + w->at;

    TAKT_ASSERT(w->is_full || w->at <= w->room);
    if (w->is_full || w->room - w->at < RECORD_HEAD_BYTES + filled_up(size)) {
        w->is_full = true;
        return NULL;
    }
    memset(to, 0, RECORD_HEAD_BYTES + filled_up(size));
    little_put32(to, (uint32_t)number | (uint32_t)axis << 16);
    little_put32(to + 4, size);
    w->at += RECORD_HEAD_BYTES + filled_up(size);
    return to + RECORD_HEAD_BYTES;
}

static void write_field(struct writer *w, const struct settings_field *field, uint16_t axis,
                        const void *base)
{
    uint8_t *to = begin_record(w, field->number, axis, takt_settings_field_bytes(field));

    if (to != NULL)
        takt_settings_field_get(field, base, to);
}

static void write_machine(struct writer *w, const struct machine *machine)
{
    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        const struct settings_field *field = &takt_settings_fields[i];

        if (!field->of_axis)
            write_field(w, field, 0, machine);
        for (uint16_t axis = 0; axis < AXIS_COUNT && field->of_axis; axis++) {
            if (machine->axis[axis].present)
                write_field(w, field, axis, &machine->axis[axis]);
        }
    }
}

static void write_tables(struct writer *w, const struct correction_tables *tables)
{
    const uint32_t volume = takt_settings_volume_bytes(&tables->volume);
    const uint32_t axes = takt_settings_axes_bytes(&tables->axes);
    uint8_t *to;

    if (volume > 0 && (to = begin_record(w, RECORD_VOLUME, 0, volume)) != NULL)
        takt_settings_volume_put(&tables->volume, to);
    if (axes > 0 && (to = begin_record(w, RECORD_AXES, 0, axes)) != NULL)
        takt_settings_axes_put(&tables->axes, to);
}

static void write_dcf(struct writer *w, uint16_t drive, const struct concise_dcf *dcf)
{
    uint8_t *to;

    if (dcf->bytes != NULL && (to = begin_record(w, RECORD_DCF, drive, dcf->length)) != NULL)
        memcpy(to, dcf->bytes, dcf->length);
}

static uint32_t crc_of(const uint8_t *bytes, size_t size)
{
    return takt_crc32_add(CRC32_START, bytes + HEAD_VERSION, size - HEAD_VERSION);
}

size_t takt_settings_pack(const struct machine *machine, const struct correction_tables *tables,
                          const struct concise_dcf *dcf, uint8_t *bytes, size_t room)
{
    struct writer w = {bytes, SETTINGS_HEAD_BYTES, room, room < SETTINGS_HEAD_BYTES};

    write_machine(&w, machine);
    if (tables != NULL)
        write_tables(&w, tables);
    for (uint16_t i = 0; dcf != NULL && i < MACHINE_NODES_MAX; i++)
        write_dcf(&w, i, &dcf[i]);
    if (w.is_full)
        return 0;
    little_put32(bytes, MARK);
    little_put32(bytes + HEAD_SIZE, (uint32_t)w.at);
    little_put32(bytes + HEAD_VERSION, SETTINGS_VERSION);
    little_put32(bytes + HEAD_CRC, crc_of(bytes, w.at));
    return w.at;
}

/* ---- reading ---- */

struct reader {
    const uint8_t *bytes;
    size_t size, at;
    uint32_t record; /* how many have been read */
    struct machine *machine;
    struct correction_tables *tables;
    struct concise_dcf *dcf;
    const uint8_t *volume, *axes; /* NULL: none; taken when the machine is known */
    uint32_t volume_size, axes_size;
    struct diagnostic *wrong;
};

static bool refuse(struct reader *r, enum takt_error code, double value)
{
    TAKT_ASSERT(code != TAKT_OK);
    takt_diagnostic_set(r->wrong, code, 0, 0, "", 0, value);
    return false;
}

static bool check_head(struct reader *r)
{
    if (r->size < SETTINGS_HEAD_BYTES || little_get32(r->bytes) != MARK)
        return refuse(r, TAKT_ERROR_SETTINGS_KIND, 0);
    if (little_get32(r->bytes + HEAD_SIZE) != r->size ||
        little_get32(r->bytes + HEAD_CRC) != crc_of(r->bytes, r->size))
        return refuse(r, TAKT_ERROR_SETTINGS_CHECKSUM, 0);
    return little_get32(r->bytes + HEAD_VERSION) == SETTINGS_VERSION ||
           refuse(r, TAKT_ERROR_SETTINGS_KIND, 0);
}

static const struct settings_field *find_field(uint16_t number)
{
    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        if (takt_settings_fields[i].number == number)
            return &takt_settings_fields[i];
    }
    return NULL;
}

static bool read_field(struct reader *r, const struct settings_field *field, uint16_t axis,
                       const uint8_t *value, uint32_t size)
{
    if (size != takt_settings_field_bytes(field) || axis >= AXIS_COUNT)
        return refuse(r, TAKT_ERROR_SETTINGS_SHAPE, r->record);
    if (!field->of_axis) {
        takt_settings_field_set(field, r->machine, value);
        return true;
    }
    r->machine->axis[axis].present = true;
    takt_settings_field_set(field, &r->machine->axis[axis], value);
    return true;
}

/* Stays where it is. */
static bool read_dcf(struct reader *r, uint16_t drive, const uint8_t *value, uint32_t size)
{
    const struct concise_dcf dcf = {.bytes = value, .length = size};
    uint32_t object;

    if (drive >= MACHINE_NODES_MAX || !takt_concise_dcf_is_well(&dcf, &object))
        return refuse(r, TAKT_ERROR_SETTINGS_SHAPE, r->record);
    if (r->dcf != NULL)
        r->dcf[drive] = dcf;
    return true;
}

static bool read_value(struct reader *r, uint32_t label, const uint8_t *value, uint32_t size)
{
    const uint16_t number = (uint16_t)label;
    const struct settings_field *field = find_field(number);

    if (field != NULL)
        return read_field(r, field, (uint16_t)(label >> 16), value, size);
    if (number == RECORD_DCF)
        return read_dcf(r, (uint16_t)(label >> 16), value, size);
    if (number == RECORD_VOLUME) {
        r->volume = value;
        r->volume_size = size;
    } else if (number == RECORD_AXES) {
        r->axes = value;
        r->axes_size = size;
    } else {
        return refuse(r, TAKT_ERROR_SETTINGS_UNKNOWN, number);
    }
    return true;
}

static bool read_record(struct reader *r)
{
    const uint8_t *at = r->bytes + r->at;
    const size_t left = r->size - r->at;
    uint32_t size;

    TAKT_ASSERT(r->at <= r->size);
    r->record++;
    if (left < RECORD_HEAD_BYTES)
        return refuse(r, TAKT_ERROR_SETTINGS_SHAPE, r->record);
    size = little_get32(at + 4);
    if (size > left || filled_up(size) > left - RECORD_HEAD_BYTES)
        return refuse(r, TAKT_ERROR_SETTINGS_SHAPE, r->record);
    r->at += RECORD_HEAD_BYTES + filled_up(size);
    return read_value(r, little_get32(at), at + RECORD_HEAD_BYTES, size);
}

/* "X max_jerk_mm_s3". */
static bool refuse_value(struct reader *r, const struct settings_field *field, unsigned axis,
                         double value)
{
    char word[DIAGNOSTIC_WORD_MAX + 1];
    size_t length = 0;

    TAKT_ASSERT(axis < AXIS_COUNT);
    if (field->of_axis) {
        word[length++] = AXIS_LETTERS[axis];
        word[length++] = ' ';
    }
    for (const char *c = field->name; *c != '\0' && length < DIAGNOSTIC_WORD_MAX; c++)
        word[length++] = *c;
    takt_diagnostic_set(r->wrong, TAKT_ERROR_SETTINGS_VALUE, 0, 0, word, length, value);
    return false;
}

static bool check_field(struct reader *r, const struct settings_field *field)
{
    double value;

    if (!field->of_axis)
        return takt_settings_field_check(field, r->machine, &value) ||
               refuse_value(r, field, 0, value);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &r->machine->axis[i];

        if (axis->present && !takt_settings_field_check(field, axis, &value))
            return refuse_value(r, field, i, value);
    }
    return true;
}

/* X Y Z are never rotary, A B C always. */
static bool check_kinds(struct reader *r)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &r->machine->axis[i];

        if (axis->present && axis->rotary != (i >= AXIS_LINEAR_COUNT))
            return refuse_value(r, find_field(100), i, axis->rotary);
    }
    return true;
}

static bool check_machine(struct reader *r)
{
    for (size_t i = 0; i < takt_settings_fields_count; i++) {
        if (!check_field(r, &takt_settings_fields[i]))
            return false;
    }
    return check_kinds(r) && takt_machine_check(r->machine, r->wrong);
}

static bool take_tables(struct reader *r)
{
    struct table_rules rules;
    const char *problem = NULL;

    takt_correction_table_rules(&r->machine->correction, takt_machine_axes(r->machine), &rules);
    if (r->volume != NULL)
        problem = takt_settings_volume_take(r->volume, r->volume_size, &rules, &r->tables->volume);
    if (problem == NULL && r->axes != NULL)
        problem = takt_settings_axes_take(r->axes, r->axes_size, &rules, &r->tables->axes);
    if (problem == NULL)
        return true;
    (void)refuse(r, TAKT_ERROR_SETTINGS_TABLE, 0);
    r->wrong->meaning = problem;
    return false;
}

/* Axes are those that have records. */
static void forget_axes(struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        machine->axis[i].present = false;
}

bool takt_settings_read(const uint8_t *bytes, size_t size, struct machine *machine,
                        struct correction_tables *tables, struct concise_dcf *dcf,
                        struct diagnostic *wrong)
{
    struct reader r = {.bytes = bytes,
                       .size = size,
                       .at = SETTINGS_HEAD_BYTES,
                       .machine = machine,
                       .tables = tables,
                       .dcf = dcf,
                       .wrong = wrong};

    memset(tables, 0, sizeof *tables);
    if (dcf != NULL)
        memset(dcf, 0, MACHINE_NODES_MAX * sizeof *dcf);
    takt_machine_set_default(machine);
    forget_axes(machine);
    if (!check_head(&r))
        return false;
    while (r.at < r.size) {
        if (!read_record(&r))
            return false;
    }
    return check_machine(&r) && take_tables(&r);
}

bool takt_settings_check_share(const struct machine *machine,
                               const struct correction_tables *tables, struct correction *scratch,
                               struct diagnostic *wrong)
{
    const struct point start = {{0}};
    struct motion_bound most;
    struct need need;
    enum axis axis;
    double share;

    takt_correction_init(scratch, &machine->correction, takt_machine_axes(machine),
                         1e-6 * (double)machine->cycle_us, tables, &start);
    takt_machine_motion_bound(machine, &most);
    takt_correction_reserve(scratch, &most, &need);
    share = takt_correction_largest_share(&need, &most, &axis);
    if (share <= CORRECTION_SHARE_MAX)
        return true;
    takt_diagnostic_set(wrong, TAKT_ERROR_SETTINGS_SHARE, 0, 0, &AXIS_LETTERS[axis], 1,
                        100.0 * share);
    takt_diagnostic_set_limit(wrong, 100.0 * CORRECTION_SHARE_MAX);
    return false;
}

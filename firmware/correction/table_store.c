#include "correction/table_store.h"

#include "base/crc32.h"

#include <string.h>

#define STORE_MARK_SIZE 4
#define STORE_HEAD_SIZE (STORE_MARK_SIZE + 4)
#define STORE_CRC_SIZE  4

/* Axis and number of points; axis and direction. */
#define STORE_INPUT_SIZE  4
#define STORE_OUTPUT_SIZE 2

static const uint8_t mark[STORE_MARK_SIZE] = {'T', 'K', 'T', '1'};

_Static_assert(sizeof(double) == 8 && sizeof(float) == 4, "stored as IEEE-754");

static size_t knots_of(const struct table *table)
{
    size_t knots = 0;

    for (unsigned i = 0; i < table->inputs; i++) {
        knots += table->knots[i];
    }
    return knots;
}

size_t takt_table_store_size(const struct table *table)
{
    return STORE_HEAD_SIZE + (size_t)STORE_INPUT_SIZE * table->inputs +
           (size_t)STORE_OUTPUT_SIZE * table->outputs + sizeof(double) * knots_of(table) +
           sizeof(float) * takt_table_rows(table) * table->outputs + STORE_CRC_SIZE;
}

/* ---- bytes ---- */

static uint8_t *put(uint8_t *at, uint64_t value, unsigned bytes)
{
    for (unsigned i = 0; i < bytes; i++) {
        *at++ = (uint8_t)(value >> (8U * i));
    }
    return at;
}

static uint64_t get(const uint8_t **at, unsigned bytes)
{
    uint64_t value = 0;

    for (unsigned i = 0; i < bytes; i++) {
        value |= (uint64_t) * (*at)++ << (8U * i);
    }
    return value;
}

static uint8_t *put_double(uint8_t *at, double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof(bits));
    return put(at, bits, sizeof(bits));
}

static uint8_t *put_float(uint8_t *at, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof(bits));
    return put(at, bits, sizeof(bits));
}

static double get_double(const uint8_t **at)
{
    const uint64_t bits = get(at, sizeof(bits));
    double value;

    memcpy(&value, &bits, sizeof(value));
    return value;
}

static float get_float(const uint8_t **at)
{
    const uint32_t bits = (uint32_t)get(at, sizeof(bits));
    float value;

    memcpy(&value, &bits, sizeof(value));
    return value;
}

/* ---- tables ---- */

static uint8_t *put_head(uint8_t *at, const struct table *table)
{
    memcpy(at, mark, sizeof(mark));
    at = put(at + sizeof(mark), table->inputs, 1);
    at = put(at, table->outputs, 3);
    for (unsigned i = 0; i < table->inputs; i++) {
        at = put(at, table->input[i], 2);
        at = put(at, table->knots[i], 2);
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        at = put(at, table->output[i].axis, 1);
        at = put(at, table->output[i].direction, 1);
    }
    return at;
}

void takt_table_store(const struct table *table, uint8_t *bytes)
{
    const uint32_t values = takt_table_rows(table) * table->outputs;
    uint8_t *at = put_head(bytes, table);

    for (unsigned i = 0; i < table->inputs; i++) {
        for (unsigned k = 0; k < table->knots[i]; k++) {
            at = put_double(at, table->knot_mm[i][k]);
        }
    }
    for (uint32_t i = 0; i < values; i++) {
        at = put_float(at, table->value_mm[i]);
    }
    (void)put(at, takt_crc32_add(CRC32_START, bytes, (size_t)(at - bytes)), STORE_CRC_SIZE);
}

static bool refuse(struct diagnostic *wrong, enum takt_error code)
{
    takt_diagnostic_set(wrong, code, 0, 0, "", 0, 0.0);
    return false;
}

static bool get_inputs(const uint8_t **at, struct table *table)
{
    for (unsigned i = 0; i < table->inputs; i++) {
        table->input[i] = (uint8_t)get(at, 2);
        table->knots[i] = (uint16_t)get(at, 2);
        if (table->input[i] >= AXIS_COUNT || table->knots[i] > TABLE_KNOTS_MAX) {
            return false;
        }
    }
    return true;
}

static bool get_outputs(const uint8_t **at, struct table *table)
{
    for (unsigned i = 0; i < table->outputs; i++) {
        table->output[i].axis = (uint8_t)get(at, 1);
        table->output[i].direction = (uint8_t)get(at, 1);
        if (table->output[i].axis >= AXIS_COUNT || table->output[i].direction > TABLE_DOWN) {
            return false;
        }
    }
    return true;
}

/* Everything before the numbers. False: it is no table, or one that does not fit. */
static bool get_head(const uint8_t **at, size_t size, struct table *table)
{
    if (size < STORE_HEAD_SIZE + STORE_CRC_SIZE || memcmp(*at, mark, sizeof(mark)) != 0) {
        return false;
    }
    *at += sizeof(mark);
    table->errors = false;
    table->inputs = (uint8_t)get(at, 1);
    table->outputs = (uint8_t)get(at, 3);
    if (table->inputs == 0 || table->inputs > TABLE_INPUTS_MAX || table->outputs == 0 ||
        table->outputs > TABLE_OUTPUTS_MAX ||
        size < STORE_HEAD_SIZE + STORE_CRC_SIZE + (size_t)STORE_INPUT_SIZE * table->inputs +
                   (size_t)STORE_OUTPUT_SIZE * table->outputs) {
        return false;
    }
    return get_inputs(at, table) && get_outputs(at, table) &&
           takt_table_rows(table) <= TABLE_VALUES_MAX / table->outputs &&
           size == takt_table_store_size(table);
}

static void get_numbers(const uint8_t **at, struct table *table)
{
    const uint32_t values = takt_table_rows(table) * table->outputs;

    for (unsigned i = 0; i < table->inputs; i++) {
        for (unsigned k = 0; k < table->knots[i]; k++) {
            table->knot_mm[i][k] = get_double(at);
        }
    }
    for (uint32_t i = 0; i < values; i++) {
        table->value_mm[i] = get_float(at);
    }
}

bool takt_table_restore(const uint8_t *bytes, size_t size, const struct table_rules *rules,
                        struct table *table, struct diagnostic *wrong)
{
    const uint8_t *at = bytes;

    if (!get_head(&at, size, table)) {
        return refuse(wrong, TAKT_ERROR_TABLE_DAMAGED);
    }
    get_numbers(&at, table);
    if (get(&at, STORE_CRC_SIZE) != takt_crc32_add(CRC32_START, bytes, size - STORE_CRC_SIZE)) {
        return refuse(wrong, TAKT_ERROR_TABLE_CHECKSUM);
    }
    return takt_table_check(table, rules, wrong);
}

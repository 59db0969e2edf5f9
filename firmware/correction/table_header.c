#include "correction/table_header.h"

#include "base/maths.h"

#define DEGREE (MATHS_PI / 180.0)

struct unit {
    const char *name;
    bool rotary;
    bool small; /* of corrections alone */
    double size;
};

static const struct unit units[] = {
    {"mm", false, false, 1.0},
    {"in", false, false, 25.4},
    {"um", false, true, 1e-3},
    {"deg", true, false, DEGREE},
    {"rad", true, false, 1.0},
    {"urad", true, true, 1e-6},
    {"arcsec", true, true, DEGREE / 3600.0},
};

/*
 * What the name of a column says: "KX_up_um" is a correction of X, up, in um; "EA_urad" a turn of a
 * unit about X.
 */
struct column {
    bool correction;
    bool error; /* of a unit: E instead of K */
    uint8_t axis;
    uint8_t direction;
    double unit;
};

static char capital(char character)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ";

    if (character < 'a' || character > 'z') {
        return character;
    }
    return letters[character - 'a'];
}

static bool axis_of(char character, uint8_t *axis)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (AXIS_LETTERS[i] == capital(character)) {
            *axis = (uint8_t)i;
            return true;
        }
    }
    return false;
}

/* The rest of the cell, without the part that has been understood. */
static bool take(struct cells *rest, const char *word)
{
    struct cells head = *rest;

    head.until = rest->cell;
    while (head.until < rest->until && word[head.until - rest->cell] != '\0') {
        head.until++;
    }
    if (!takt_cells_is(&head, word)) {
        return false;
    }
    rest->cell = head.until;
    return true;
}

static bool read_unit(const struct cells *rest, const struct column *column, double *unit)
{
    for (size_t i = 0; i < sizeof(units) / sizeof(units[0]); i++) {
        if (takt_cells_is(rest, units[i].name) &&
            units[i].rotary == (column->axis >= AXIS_LINEAR_COUNT) &&
            (column->correction || !units[i].small)) {
            *unit = units[i].size;
            return true;
        }
    }
    return false;
}

static bool read_column(const struct cells *cells, struct column *column)
{
    struct cells rest = *cells;

    column->error = take(&rest, "E");
    column->correction = column->error || take(&rest, "K");
    column->direction = TABLE_BOTH;
    if (rest.cell >= rest.until || !axis_of(rest.text[rest.cell], &column->axis)) {
        return false;
    }
    rest.cell++;
    if (column->correction && take(&rest, "_up")) {
        column->direction = TABLE_UP;
    } else if (column->correction && take(&rest, "_down")) {
        column->direction = TABLE_DOWN;
    }
    return take(&rest, "_") && read_unit(&rest, column, &column->unit);
}

/* A rotary axis, and another one has been named before. */
static bool is_second_rotary(const struct table *table, uint8_t axis)
{
    bool second = false;

    for (unsigned i = 0; i < table->inputs; i++) {
        second |= table->input[i] >= AXIS_LINEAR_COUNT && table->input[i] != axis;
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        second |= table->output[i].axis >= AXIS_LINEAR_COUNT && table->output[i].axis != axis;
    }
    return second && axis >= AXIS_LINEAR_COUNT;
}

static enum takt_error add_input(struct table *table, const struct column *column)
{
    for (unsigned i = 0; i < table->inputs; i++) {
        if (table->input[i] == column->axis) {
            return TAKT_ERROR_TABLE_COLUMN_TWICE;
        }
    }
    if (is_second_rotary(table, column->axis)) {
        return TAKT_ERROR_TABLE_ROTARY_SECOND;
    }
    if (table->outputs > 0) {
        return TAKT_ERROR_TABLE_COLUMN_ORDER;
    }
    if (table->inputs == TABLE_INPUTS_MAX) {
        return TAKT_ERROR_TABLE_POSITIONS;
    }
    table->input[table->inputs++] = column->axis;
    return TAKT_OK;
}

/* The same correction for the same direction, or for both. */
static bool is_same(const struct table_output *output, const struct column *column)
{
    return output->axis == column->axis &&
           (output->direction == column->direction || output->direction == TABLE_BOTH ||
            column->direction == TABLE_BOTH);
}

static enum takt_error add_output(struct table *table, const struct column *column)
{
    if (table->inputs == 0) {
        return TAKT_ERROR_TABLE_POSITIONS;
    }
    if (table->inputs > 1 && column->direction != TABLE_BOTH) {
        return TAKT_ERROR_TABLE_DIRECTION_GRID;
    }
    if (table->inputs > 1 && is_second_rotary(table, column->axis)) {
        return TAKT_ERROR_TABLE_ROTARY_SECOND;
    }
    if (column->error && (table->inputs > 1 || column->direction != TABLE_BOTH)) {
        return TAKT_ERROR_TABLE_ERRORS;
    }
    if (table->outputs > 0 && column->error != table->errors) {
        return TAKT_ERROR_TABLE_ERRORS;
    }
    table->errors = column->error;
    for (unsigned i = 0; i < table->outputs; i++) {
        if (is_same(&table->output[i], column)) {
            return TAKT_ERROR_TABLE_COLUMN_TWICE;
        }
    }
    table->output[table->outputs++] = (struct table_output){column->axis, column->direction};
    return TAKT_OK;
}

static enum takt_error add_column(const struct cells *cells, struct table *table,
                                  struct table_header *header)
{
    struct column column = {.axis = AXIS_X};

    if (!read_column(cells, &column)) {
        return TAKT_ERROR_TABLE_COLUMN_UNKNOWN;
    }
    const enum takt_error error =
        column.correction ? add_output(table, &column) : add_input(table, &column);

    if (error == TAKT_OK) {
        header->unit[header->columns++] = column.unit;
    }
    return error;
}

/* One direction of approach without the other. */
static bool is_alone(const struct table *table, const struct table_output *output)
{
    for (unsigned i = 0; i < table->outputs; i++) {
        if (output->direction == TABLE_BOTH || (table->output[i].axis == output->axis &&
                                                table->output[i].direction != output->direction)) {
            return false;
        }
    }
    return true;
}

static bool check_columns(const struct cells *cells, const struct table *table,
                          struct diagnostic *wrong)
{
    if (table->outputs == 0) {
        return takt_cells_refuse(cells, wrong, TAKT_ERROR_TABLE_OUTPUTS_MISSING, 0.0);
    }
    for (unsigned i = 0; i < table->outputs; i++) {
        if (is_alone(table, &table->output[i])) {
            const char word[] = {'K', AXIS_LETTERS[table->output[i].axis]};

            takt_diagnostic_set(wrong, TAKT_ERROR_TABLE_DIRECTION_ALONE, cells->line, 1, word,
                                sizeof(word), 0.0);
            return false;
        }
    }
    return true;
}

bool takt_table_header_read(struct cells *cells, struct table *table, struct table_header *header,
                            struct diagnostic *wrong)
{
    header->columns = 0;
    while (takt_cells_next(cells, false)) {
        const enum takt_error error = add_column(cells, table, header);

        if (error != TAKT_OK) {
            return takt_cells_refuse(cells, wrong, error, TABLE_INPUTS_MAX);
        }
    }
    return check_columns(cells, table, wrong);
}

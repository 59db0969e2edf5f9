/* A correction table from its text: header, rows in order, checksum. */
#include "correction/table_text.h"

#include "base/crc32.h"
#include "base/maths.h"
#include "correction/table_cells.h"
#include "correction/table_header.h"

/* Positions that differ by less are the same point: a file has only so many decimals. */
#define TABLE_SAME 1e-6

struct reader {
    struct cells cells;
    struct table_header header;
    struct table *table;
    const struct table_rules *rules;
    struct diagnostic *wrong;
    uint32_t rows;
    uint32_t first_line;              /* of the first row; 0: rows and lines do not go together */
    unsigned index[TABLE_INPUTS_MAX]; /* of the last row's point along each input */
    bool complete[TABLE_INPUTS_MAX];  /* all points along this input are known */
};

static bool is_same(double a, double b)
{
    return maths_abs(a - b) <= TABLE_SAME;
}

/* The number of the current cell. False: r->wrong names it. */
static bool read_number(struct reader *r, unsigned column, double *value)
{
    const enum takt_error error = takt_cells_number(&r->cells, value);

    if (error != TAKT_OK) {
        return takt_cells_refuse(&r->cells, r->wrong, error, 0.0);
    }
    *value *= r->header.unit[column];
    return true;
}

static bool read_cells(struct reader *r, double value[TABLE_COLUMNS_MAX])
{
    unsigned count = 0;

    while (takt_cells_next(&r->cells, false)) {
        if (count < r->header.columns && !read_number(r, count, &value[count])) {
            return false;
        }
        count++;
    }
    return count == r->header.columns ||
           takt_cells_refuse(&r->cells, r->wrong, TAKT_ERROR_TABLE_CELL_COUNT, count);
}

/* ---- the order of the points ---- */

static bool refuse_input(struct reader *r, enum takt_error code, unsigned input, double value)
{
    takt_diagnostic_set(r->wrong, code, r->cells.line, 1, &AXIS_LETTERS[r->table->input[input]], 1,
                        value);
    return false;
}

static bool add_knot(struct reader *r, unsigned input, double position)
{
    struct table *t = r->table;

    if (t->knots[input] == TABLE_KNOTS_MAX) {
        return refuse_input(r, TAKT_ERROR_TABLE_POINTS_MANY, input, TABLE_KNOTS_MAX);
    }
    r->index[input] = t->knots[input];
    t->knot_mm[input][t->knots[input]++] = position;
    return true;
}

/*
 * Goes to the next point along an input, which the row says or which is known. False: it is the
 * first one again.
 */
static bool step_along(struct reader *r, unsigned input, double position)
{
    const struct table *t = r->table;

    if (!r->complete[input] && input + 1U < t->inputs && is_same(position, t->knot_mm[input][0])) {
        r->complete[input] = true;
    }
    if (!r->complete[input]) {
        return true;
    }
    r->index[input] = (r->index[input] + 1U) % t->knots[input];
    return r->index[input] != 0;
}

/* The row of a point that is not the one expected. */
static bool refuse_point(struct reader *r)
{
    char name[DIAGNOSTIC_WORD_MAX + 1];
    size_t length = 0;
    uint32_t row = 0;

    for (unsigned i = r->table->inputs; i-- > 0;) {
        row = row * r->table->knots[i] + r->index[i];
    }
    takt_table_name_cell(r->table, row, TABLE_OUTPUTS_MAX, name);
    while (name[length] != '\0') {
        length++;
    }
    takt_diagnostic_set(r->wrong, TAKT_ERROR_TABLE_POINT, r->cells.line, 1, name, length, 0.0);
    return false;
}

/* The point of the first row begins every input. */
static bool begin_points(struct reader *r, const double *position)
{
    for (unsigned i = 0; i < r->table->inputs; i++) {
        (void)add_knot(r, i, position[i]);
    }
    return true;
}

static bool take_point(struct reader *r, const double *position)
{
    struct table *t = r->table;
    unsigned input = 0;

    while (input < t->inputs && !step_along(r, input, position[input])) {
        input++;
    }
    if (input == t->inputs) {
        return refuse_point(r);
    }
    if (!r->complete[input] && !add_knot(r, input, position[input])) {
        return false;
    }
    for (unsigned i = 0; i < t->inputs; i++) {
        if (!is_same(position[i], t->knot_mm[i][r->index[i]])) {
            return refuse_point(r);
        }
    }
    return r->complete[input] ||
           t->knot_mm[input][r->index[input]] > t->knot_mm[input][r->index[input] - 1] ||
           refuse_input(r, TAKT_ERROR_TABLE_ORDER, input, position[input]);
}

/* ---- rows ---- */

static bool take_values(struct reader *r, const double *value)
{
    struct table *t = r->table;
    const uint32_t at = r->rows * t->outputs;

    if (at + t->outputs > TABLE_VALUES_MAX) {
        return takt_cells_refuse(&r->cells, r->wrong, TAKT_ERROR_TABLE_FULL, TABLE_VALUES_MAX);
    }
    for (unsigned i = 0; i < t->outputs; i++) {
        t->value_mm[at + i] = (float)value[i];
    }
    return true;
}

static bool read_row(struct reader *r)
{
    double value[TABLE_COLUMNS_MAX] = {0.0};

    if (!read_cells(r, value)) {
        return false;
    }
    if (r->rows == 0) {
        r->first_line = r->cells.line;
    } else if (r->cells.line != r->first_line + r->rows) {
        r->first_line = 0;
    }
    if (r->rows == 0 ? !begin_points(r, value) : !take_point(r, value)) {
        return false;
    }
    if (!take_values(r, value + r->table->inputs)) {
        return false;
    }
    r->rows++;
    return true;
}

/* ---- the checksum ---- */

static bool read_hexadecimal(const struct cells *c, uint32_t *value)
{
    *value = 0;
    for (size_t i = c->cell; i < c->until; i++) {
        const char digit = c->text[i];

        if (digit >= '0' && digit <= '9') {
            *value = *value << 4 | (uint32_t)(digit - '0');
        } else if (digit >= 'a' && digit <= 'f') {
            *value = *value << 4 | (uint32_t)(digit - 'a' + 10);
        } else {
            return false;
        }
    }
    return c->until - c->cell == 8;
}

static bool read_checksum(struct reader *r)
{
    const uint32_t found = takt_crc32_add(CRC32_START, r->cells.text, r->cells.begin);
    uint32_t expected;

    if (!takt_cells_next(&r->cells, false) || !read_hexadecimal(&r->cells, &expected) ||
        expected != found) {
        return takt_cells_refuse(&r->cells, r->wrong, TAKT_ERROR_TABLE_CHECKSUM, 0.0);
    }
    return !takt_cells_next_line(&r->cells) ||
           takt_cells_refuse(&r->cells, r->wrong, TAKT_ERROR_TABLE_AFTER_CHECKSUM, 0.0);
}

/* Looks at the line without reading it. */
static bool is_checksum(const struct reader *r)
{
    struct cells ahead = r->cells;

    return takt_cells_next(&ahead, false) && takt_cells_is(&ahead, "checksum");
}

static bool read_lines(struct reader *r)
{
    while (takt_cells_next_line(&r->cells)) {
        if (is_checksum(r)) {
            (void)takt_cells_next(&r->cells, false);
            return read_checksum(r);
        }
        if (!read_row(r)) {
            return false;
        }
    }
    return true;
}

/* All points of the grid there? */
static bool check_complete(struct reader *r)
{
    struct table *t = r->table;

    r->cells.line++;
    for (unsigned i = 0; i + 1U < t->inputs; i++) {
        if (t->knots[i] < 2 || !r->complete[i]) {
            const unsigned few = t->knots[i] < 2 ? i : i + 1U;

            r->cells.line = 0;
            return refuse_input(r, TAKT_ERROR_TABLE_POINTS_FEW, few, 0.0);
        }
        if (r->index[i] + 1U != t->knots[i]) {
            r->index[i]++;
            for (unsigned k = 0; k < i; k++) {
                r->index[k] = 0;
            }
            return refuse_point(r);
        }
    }
    return true;
}

/* What was found by the numbers alone gets its line, when rows and lines go together. */
static bool check_numbers(struct reader *r)
{
    if (takt_table_check(r->table, r->rules, r->wrong)) {
        return true;
    }
    for (uint32_t row = 0; row < r->rows && r->first_line > 0; row++) {
        char name[DIAGNOSTIC_WORD_MAX + 1];
        unsigned same = 0;

        takt_table_name_cell(r->table, row, TABLE_OUTPUTS_MAX, name);
        while (name[same] != '\0' && name[same] == r->wrong->word[same]) {
            same++;
        }
        if (name[same] == '\0' && (r->wrong->word[same] == '\0' || r->wrong->word[same] == ':')) {
            r->wrong->line = r->first_line + row;
            break;
        }
    }
    return false;
}

bool takt_table_read_text(const char *text, size_t length, const struct table_rules *rules,
                          struct table *table, struct diagnostic *wrong)
{
    struct reader r = {.table = table, .rules = rules, .wrong = wrong};

    table->inputs = table->outputs = 0;
    table->errors = false;
    for (unsigned i = 0; i < TABLE_INPUTS_MAX; i++) {
        table->knots[i] = 0;
    }
    takt_cells_open(&r.cells, text, length);
    if (!takt_cells_next_line(&r.cells)) {
        return takt_cells_refuse(&r.cells, wrong, TAKT_ERROR_TABLE_OUTPUTS_MISSING, 0.0);
    }
    return takt_table_header_read(&r.cells, table, &r.header, wrong) && read_lines(&r) &&
           check_complete(&r) && check_numbers(&r);
}

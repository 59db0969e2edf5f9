#include "correction/table.h"

#include "base/assert.h"
#include "base/decimal.h"
#include "base/maths.h"

/*
 * Steps of a grid may differ by this part of a step: positions are written with a limited number of
 * decimals.
 */
#define TABLE_UNEVEN_MAX 1e-3

#define DEGREES_PER_RAD (180.0 / MATHS_PI)
#define NAME_PLACES     3

/*
 * More rows than any table can have: from here on they are not counted exactly, and nothing
 * overflows.
 */
#define TABLE_ROWS_COUNTED UINT32_C(0x100000)
_Static_assert(TABLE_VALUES_MAX < TABLE_ROWS_COUNTED, "tables are counted exactly");

uint32_t takt_table_rows(const struct table *table)
{
    uint32_t rows = 1;

    for (unsigned i = 0; i < table->inputs; i++) {
        rows = (rows < TABLE_ROWS_COUNTED ? rows : TABLE_ROWS_COUNTED) * table->knots[i];
    }
    return rows;
}

/* ---- names ---- */

struct name {
    char *text;
    size_t length;
};

static void name_add(struct name *n, const char *text, size_t length)
{
    TAKT_ASSERT(n->length <= DIAGNOSTIC_WORD_MAX);
    for (size_t i = 0; i < length && n->length < DIAGNOSTIC_WORD_MAX; i++) {
        n->text[n->length++] = text[i];
    }
}

static void name_add_position(struct name *n, double value)
{
    char digits[DECIMAL_TEXT_MAX];
    size_t length = takt_decimal_write(digits, value, NAME_PLACES);

    while (digits[length - 1] == '0') {
        length--;
    }
    if (digits[length - 1] == '.') {
        length--;
    }
    name_add(n, digits, length);
}

/* kind: ": K" of a correction, ": E" of an error. */
static void name_add_output(struct name *n, const char kind[3], const struct table_output *output)
{
    static const char *const direction[] = {"", "_up", "_down"};
    const char *word = direction[output->direction];

    name_add(n, kind, 3);
    name_add(n, &AXIS_LETTERS[output->axis], 1);
    while (*word != '\0') {
        name_add(n, word++, 1);
    }
}

void takt_table_name_cell(const struct table *table, uint32_t row, unsigned output,
                          char name[DIAGNOSTIC_WORD_MAX + 1])
{
    struct name n = {name, 0};

    for (unsigned i = 0; i < table->inputs; i++) {
        const uint8_t axis = table->input[i];
        const double at = table->knot_mm[i][row % table->knots[i]];

        row /= table->knots[i];
        name_add(&n, " ", n.length > 0 ? 1 : 0);
        name_add(&n, &AXIS_LETTERS[axis], 1);
        name_add(&n, " ", 1);
        name_add_position(&n, axis < AXIS_LINEAR_COUNT ? at : at * DEGREES_PER_RAD);
    }
    if (output < table->outputs) {
        name_add_output(&n, table->errors ? ": E" : ": K", &table->output[output]);
    }
    name[n.length] = '\0';
}

/* ---- checks ---- */

static size_t length_of(const char *word)
{
    size_t length = 0;

    while (word[length] != '\0') {
        length++;
    }
    return length;
}

static bool refuse(struct diagnostic *wrong, enum takt_error code, const char *word, double value)
{
    takt_diagnostic_set(wrong, code, 0, 0, word, length_of(word), value);
    return false;
}

static bool refuse_axis(struct diagnostic *wrong, enum takt_error code, uint8_t axis, double value)
{
    const char word[] = {AXIS_LETTERS[axis], '\0'};

    TAKT_ASSERT(axis < AXIS_COUNT);
    return refuse(wrong, code, word, value);
}

static bool refuse_cell(const struct table *table, struct diagnostic *wrong, enum takt_error code,
                        uint32_t row, unsigned output, double value)
{
    char name[DIAGNOSTIC_WORD_MAX + 1];

    takt_table_name_cell(table, row, output, name);
    return refuse(wrong, code, name, value);
}

static bool check_axes(const struct table *table, const struct table_rules *rules,
                       struct diagnostic *wrong)
{
    for (unsigned i = 0; i < table->inputs; i++) {
        if ((rules->axes & 1U << table->input[i]) == 0) {
            return refuse_axis(wrong, TAKT_ERROR_AXIS_MISSING, table->input[i], 0.0);
        }
    }
    for (unsigned i = 0; i < table->outputs && !table->errors; i++) {
        if ((rules->axes & 1U << table->output[i].axis) == 0) {
            return refuse_axis(wrong, TAKT_ERROR_AXIS_MISSING, table->output[i].axis, 0.0);
        }
    }
    return true;
}

/* Row of the point that is first along every input but one. */
static uint32_t row_on_edge(const struct table *table, unsigned input, unsigned knot)
{
    uint32_t row = knot;

    TAKT_ASSERT(input < table->inputs);
    for (unsigned i = 0; i < input; i++) {
        row *= table->knots[i];
    }
    return row;
}

static bool check_steps(const struct table *table, unsigned input, struct diagnostic *wrong)
{
    const double *knot = table->knot_mm[input];
    const unsigned last = table->knots[input] - 1U;
    const double even = (knot[last] - knot[0]) / last;

    TAKT_ASSERT(input < table->inputs);
    for (unsigned k = 1; k <= last; k++) {
        const uint32_t row = row_on_edge(table, input, k);
        const double off = maths_abs(knot[k] - knot[0] - k * even) / even;

        if (!(knot[k] > knot[k - 1])) {
            return refuse_cell(table, wrong, TAKT_ERROR_TABLE_ORDER, row, TABLE_OUTPUTS_MAX, 0.0);
        }
        if (table->inputs > 1 && !(off <= TABLE_UNEVEN_MAX)) {
            return refuse_cell(table, wrong, TAKT_ERROR_TABLE_UNEVEN, row, TABLE_OUTPUTS_MAX, off);
        }
    }
    return true;
}

static bool check_knots(const struct table *table, struct diagnostic *wrong)
{
    for (unsigned i = 0; i < table->inputs; i++) {
        if (table->knots[i] < 2) {
            return refuse_axis(wrong, TAKT_ERROR_TABLE_POINTS_FEW, table->input[i], 0.0);
        }
        if (!check_steps(table, i, wrong)) {
            return false;
        }
    }
    return true;
}

/* The largest slope from the points before this one, along each input. */
static double slope_at(const struct table *table, uint32_t row, unsigned output)
{
    uint32_t stride = 1;
    double steepest = 0.0;

    for (unsigned i = 0; i < table->inputs; i++) {
        const unsigned k = row / stride % table->knots[i];

        if (k > 0) {
            const double here = (double)table->value_mm[row * table->outputs + output];
            const double before = (double)table->value_mm[(row - stride) * table->outputs + output];
            const double slope =
                (here - before) / (table->knot_mm[i][k] - table->knot_mm[i][k - 1]);

            steepest = maths_max(steepest, maths_abs(slope));
        }
        stride *= table->knots[i];
    }
    return steepest;
}

static bool check_cell(const struct table *table, const struct table_rules *rules, uint32_t row,
                       unsigned output, struct diagnostic *wrong)
{
    const double value = (double)table->value_mm[row * table->outputs + output];

    if (!maths_is_finite(value)) {
        return refuse_cell(table, wrong, TAKT_ERROR_TABLE_NOT_FINITE, row, output, 0.0);
    }
    if (maths_abs(value) > rules->largest_mm) {
        return refuse_cell(table, wrong, TAKT_ERROR_TABLE_LARGE, row, output, value);
    }
    const double slope = slope_at(table, row, output);

    if (slope > rules->steepest_ratio) {
        return refuse_cell(table, wrong, TAKT_ERROR_TABLE_STEEP, row, output, slope);
    }
    return true;
}

bool takt_table_check(const struct table *table, const struct table_rules *rules,
                      struct diagnostic *wrong)
{
    if (!check_axes(table, rules, wrong) || !check_knots(table, wrong)) {
        return false;
    }
    const uint32_t rows = takt_table_rows(table);

    for (uint32_t row = 0; row < rows; row++) {
        for (unsigned output = 0; output < table->outputs; output++) {
            if (!check_cell(table, rules, row, output, wrong)) {
                return false;
            }
        }
    }
    return true;
}

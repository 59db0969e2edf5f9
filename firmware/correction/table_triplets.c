/* LinuxCNC's COMP_FILE. */
#include "correction/table_cells.h"
#include "correction/table_text.h"

#define TRIPLET 3

enum { NOMINAL, FORWARD, REVERSE };

static void open_table(struct table *table, enum axis axis)
{
    table->inputs = 1;
    table->errors = false;
    table->input[0] = (uint8_t)axis;
    table->knots[0] = 0;
    table->outputs = 2;
    table->output[0] = (struct table_output){(uint8_t)axis, TABLE_UP};
    table->output[1] = (struct table_output){(uint8_t)axis, TABLE_DOWN};
}

/* The numbers of the current line, in mm or rad. */
static bool read_triplet(struct cells *cells, double unit_mm, double number[TRIPLET],
                         struct diagnostic *wrong)
{
    unsigned count = 0;

    while (takt_cells_next(cells, true)) {
        double value;
        const enum takt_error error = takt_cells_number(cells, &value);

        if (error != TAKT_OK) {
            return takt_cells_refuse(cells, wrong, error, 0.0);
        }
        if (count < TRIPLET) {
            number[count] = value * unit_mm;
        }
        count++;
    }
    return count == TRIPLET || takt_cells_refuse(cells, wrong, TAKT_ERROR_TABLE_TRIPLET, count);
}

/* Measured where it came to (type 0), what is missing is added; else the file says what to add. */
static bool add_triplet(struct table *table, const double number[TRIPLET], unsigned type)
{
    const size_t k = table->knots[0];
    const double measured = type == 0 ? number[NOMINAL] : 0.0;
    const double sign = type == 0 ? -1.0 : 1.0;

    if (k == TABLE_KNOTS_MAX) {
        return false;
    }
    table->knot_mm[0][k] = number[NOMINAL];
    table->value_mm[2 * k] = (float)(measured + sign * number[FORWARD]);
    table->value_mm[2 * k + 1] = (float)(measured + sign * number[REVERSE]);
    table->knots[0]++;
    return true;
}

bool takt_table_read_triplets(const char *text, size_t length, enum axis axis, unsigned type,
                              double unit_mm, const struct table_rules *rules, struct table *table,
                              struct diagnostic *wrong)
{
    struct cells cells;
    double number[TRIPLET] = {0.0};

    open_table(table, axis);
    takt_cells_open(&cells, text, length);
    while (takt_cells_next_line(&cells)) {
        if (!read_triplet(&cells, unit_mm, number, wrong)) {
            return false;
        }
        if (!add_triplet(table, number, type)) {
            takt_diagnostic_set(wrong, TAKT_ERROR_TABLE_POINTS_MANY, cells.line, 1,
                                &AXIS_LETTERS[axis], 1, TABLE_KNOTS_MAX);
            return false;
        }
    }
    return takt_table_check(table, rules, wrong);
}

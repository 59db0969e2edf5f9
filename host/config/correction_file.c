#include "config/correction_file.h"

#include "base/maths.h"
#include "cli/axis_unit.h"
#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/text.h"
#include "config/correction_curve.h"
#include "controller/controller.h"
#include "correction/table_text.h"

#include <math.h>
#include <stdlib.h>

/* mm or degrees. */
#define POSITION_MAX 1e6

static void report(const char *path, const struct diagnostic *wrong)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)takt_diagnostic_text(wrong, text);
    message_error(path, wrong->line, wrong->line > 0 && wrong->column == 0 ? 1 : wrong->column,
                  "%s", text);
}

static void set_rules(const struct machine *machine, struct table_rules *rules)
{
    takt_correction_table_rules(&machine->correction, takt_machine_axes(machine), rules);
}

/* Positions are read on in single precision, and farther no axis goes (machine_keys.c). */
static bool check_positions(const struct table *table, const char *path)
{
    for (unsigned i = 0; i < table->inputs; i++) {
        const double *knot = table->knot_mm[i];
        const unsigned last = table->knots[i] - 1U;
        const unsigned far = fabs(knot[0]) > fabs(knot[last]) ? 0 : last;
        const double ratio = axis_unit_ratio(table->input[i]);

        if (fabs(knot[far]) * ratio > POSITION_MAX) {
            message_error(path, 0, 0, "%c %.9g %s: a table goes from -%g to %g at most",
                          AXIS_LETTERS[table->input[i]], knot[far] * ratio,
                          axis_unit_name(table->input[i]), POSITION_MAX, POSITION_MAX);
            return false;
        }
    }
    return true;
}

/* What the firmware's own check leaves to the host: tables on a board were read here, too. */
static bool check_further(const struct table *table, const char *path)
{
    return check_positions(table, path) && correction_curve_check(table, path);
}

bool correction_file_read(struct table *table, const char *path, const struct machine *machine)
{
    struct diagnostic wrong;
    struct table_rules rules;
    struct text text;
    bool good;

    if (!text_read(&text, path))
        return false;
    set_rules(machine, &rules);
    good = takt_table_read_text(text.bytes, text.length, &rules, table, &wrong);
    if (!good)
        report(path, &wrong);
    text_free(&text);
    return good && check_further(table, path);
}

bool correction_file_read_triplets(struct table *table, const char *path, enum axis axis,
                                   unsigned type, const struct machine *machine)
{
    double unit = axis < AXIS_LINEAR_COUNT ? 1.0 : MATHS_PI / 180.0;
    struct diagnostic wrong;
    struct table_rules rules;
    struct text text;
    bool good;

    if (!text_read(&text, path))
        return false;
    set_rules(machine, &rules);
    good =
        takt_table_read_triplets(text.bytes, text.length, axis, type, unit, &rules, table, &wrong);
    if (!good)
        report(path, &wrong);
    text_free(&text);
    return good && check_further(table, path);
}

static bool load_volume(struct correction_tables *tables, struct table *table,
                        const struct machine_setup *setup)
{
    struct diagnostic wrong;

    if (setup->volume_table[0] == '\0')
        return true;
    if (!correction_file_read(table, setup->volume_table, &setup->machine))
        return false;
    if (takt_grid_set(&tables->volume, table, &wrong))
        return true;
    report(setup->volume_table, &wrong);
    return false;
}

static bool load_axis(struct correction_tables *tables, struct table *table,
                      const struct machine_setup *setup, unsigned axis)
{
    const char *path = setup->axis_table[axis];
    struct diagnostic wrong;

    if (path[0] == '\0')
        return true;
    if (!correction_file_read(table, path, &setup->machine))
        return false;
    if (table->inputs == 1 && table->input[0] != axis) {
        message_error(path, 0, 0, "this table is over axis %c, and the machine file has it for %c",
                      AXIS_LETTERS[table->input[0]], AXIS_LETTERS[axis]);
        return false;
    }
    if (!table->errors && takt_axis_tables_add(&tables->axes, table, &wrong))
        return true;
    if (table->errors)
        message_error(path, 0, 0, "errors of a unit (columns E...) belong to unit_table_%c",
                      AXIS_LETTERS[axis] | 0x20);
    else
        report(path, &wrong);
    return false;
}

/* What is allocated together, so that one free() releases it. */
struct loaded {
    struct correction_tables tables;
    struct geometry geometry;
};

static bool load_unit(struct geometry *geometry, struct table *table,
                      const struct machine_setup *setup, unsigned axis)
{
    const char *path = setup->unit_table[axis];
    struct diagnostic wrong;

    if (path[0] == '\0')
        return true;
    if (!correction_file_read(table, path, &setup->machine))
        return false;
    if (table->input[0] != axis) {
        message_error(path, 0, 0, "this table is over axis %c, and the machine file has it for %c",
                      AXIS_LETTERS[table->input[0]], AXIS_LETTERS[axis]);
        return false;
    }
    if (takt_geometry_add(geometry, table, &wrong))
        return true;
    report(path, &wrong);
    return false;
}

static bool has_geometry(const struct machine_setup *setup)
{
    bool any = false;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        any = any || setup->unit_table[i][0] != '\0';
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        any = any || setup->known_geometry.squareness_rad[i] != 0;
    return any;
}

/* The chain has passed machine_setup_check. */
static bool load_geometry(struct loaded *loaded, struct table *table,
                          const struct machine_setup *setup)
{
    struct geometry *g = &loaded->geometry;

    takt_geometry_init(g);
    (void)machine_setup_chain(setup, &g->chain);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        g->tool_mm[i] = setup->known_geometry.tool_mm[i];
        g->centre_mm[i] = setup->known_geometry.centre_mm[i];
        g->squareness_rad[i] = setup->known_geometry.squareness_rad[i];
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!load_unit(g, table, setup, i))
            return false;
    }
    loaded->tables.geometry = has_geometry(setup) ? g : NULL;
    return true;
}

/* What is left of every axis must be enough to move. */
static bool check_share(const struct correction_tables *tables, const struct machine *machine)
{
    struct correction *correction = calloc(1, sizeof *correction);
    const struct point start = {{0}};
    struct motion_bound most;
    struct need need;
    enum axis axis;
    double share;

    if (correction == NULL) {
        message_command_error("out of memory");
        return false;
    }
    takt_correction_init(correction, &machine->correction, takt_machine_axes(machine),
                         1e-6 * (double)machine->cycle_us, tables, &start);
    takt_machine_motion_bound(machine, &most);
    takt_correction_reserve(correction, &most, &need);
    share = takt_correction_largest_share(&need, &most, &axis);
    free(correction);
    if (share <= CORRECTION_SHARE_MAX)
        return true;
    message_command_error("position-error correction would take %.0f %% of what axis %c can do; "
                          "at most %.0f %% are possible: make the fades of [correction] longer, or "
                          "the corrections smaller",
                          100 * share, AXIS_LETTERS[axis], 100 * CORRECTION_SHARE_MAX);
    return false;
}

static bool has_tables(const struct machine_setup *setup)
{
    bool any = setup->volume_table[0] != '\0' || has_geometry(setup);

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        any = any || setup->axis_table[i][0] != '\0';
    return any;
}

static bool load_all(struct loaded *loaded, const struct machine_setup *setup)
{
    struct table *table = calloc(1, sizeof *table);
    bool good = table != NULL;

    if (!good)
        message_command_error("out of memory");
    good = good && load_volume(&loaded->tables, table, setup);
    for (unsigned i = 0; i < AXIS_COUNT && good; i++)
        good = load_axis(&loaded->tables, table, setup, i);
    good = good && load_geometry(loaded, table, setup);
    free(table);
    return good;
}

bool correction_file_load(struct correction_tables **tables, const struct machine_setup *setup)
{
    struct loaded *loaded;

    *tables = NULL;
    if (has_tables(setup)) {
        loaded = calloc(1, sizeof *loaded);
        if (loaded == NULL) {
            message_command_error("out of memory");
            return false;
        }
        if (!load_all(loaded, setup)) {
            free(loaded);
            return false;
        }
        *tables = &loaded->tables; /* the first member */
    }
    return check_share(*tables, &setup->machine);
}

static void write_to_file(void *context, const char *text, size_t length)
{
    (void)fwrite(text, 1, length, context);
}

bool correction_file_write(const struct table *table, const char *path, const char *comment)
{
    struct output_file file;

    if (!output_file_open(&file, path))
        return false;
    takt_table_write_text(table, comment,
                          &(struct table_sink){.context = file.stream, .write = write_to_file});
    return output_file_finish(&file) && output_file_place(&file);
}

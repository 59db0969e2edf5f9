#include "storage/settings_tables.h"

#include "base/assert.h"
#include "base/maths.h"
#include "correction/grid_bound.h"
#include "correction/grid_patch.h"
#include "storage/little_words.h"

#include <string.h>

_Static_assert(sizeof(float) == 4 && sizeof(double) == 8, "stored as IEEE-754");
_Static_assert(sizeof(struct axis_piece) == 8 * sizeof(float), "stored as eight numbers");

/* Where the parts of a volume begin. */
#define INPUTS       16U
#define INPUT_BYTES  8U
#define RANGES       (INPUTS + TABLE_INPUTS_MAX * INPUT_BYTES)
#define RANGE_BYTES  16U
#define COEFFICIENTS (RANGES + TABLE_INPUTS_MAX * RANGE_BYTES)

/* The same for axis tables. */
#define PAIRS      8U
#define PAIR_BYTES 8U

/*
 * Coefficients are rounded to single precision: what a table's points keep to, the spline keeps to
 * this much more.
 */
#define ROUNDING 1.0001

/* ---- a volume ---- */

static uint32_t components_of(const struct grid *grid)
{
    return grid->turn_axis < AXIS_COUNT ? GRID_COMPONENTS : GRID_COMPONENTS - 1U;
}

uint32_t takt_settings_volume_bytes(const struct grid *grid)
{
    if (grid->inputs == 0)
        return 0;
    return COEFFICIENTS + components_of(grid) * (uint32_t)grid->size * (uint32_t)sizeof(float);
}

static void put_double(uint8_t *at, double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof bits);
    little_put64(at, bits);
}

static double get_double(const uint8_t *at)
{
    const uint64_t bits = little_get64(at);
    double value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static void put_float(uint8_t *at, float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    little_put32(at, bits);
}

void takt_settings_volume_put(const struct grid *grid, uint8_t *bytes)
{
    const size_t count = components_of(grid) * grid->size;

    TAKT_ASSERT(grid->inputs >= 2 && grid->inputs <= TABLE_INPUTS_MAX);
    memset(bytes, 0, COEFFICIENTS);
    little_put32(bytes, grid->inputs);
    little_put32(bytes + 4, grid->components);
    little_put32(bytes + 8, grid->turn_axis);
    for (unsigned i = 0; i < grid->inputs; i++) {
        const struct grid_input *input = &grid->input[i];

        uint8_t *place = bytes + INPUTS + (size_t)INPUT_BYTES * i;
        uint8_t *range = bytes + RANGES + (size_t)RANGE_BYTES * i;

        little_put32(place, input->axis);
        little_put32(place + 4, input->points);
        put_double(range, input->first_mm);
        put_double(range + 8, input->per_mm);
    }
    for (size_t i = 0; i < count; i++)
        put_float(bytes + COEFFICIENTS + i * sizeof(float), grid->coefficient[i]);
}

static bool has_axis(const struct table_rules *rules, uint32_t axis)
{
    return axis < AXIS_COUNT && (rules->axes >> axis & 1U) != 0;
}

/* False: it is no range. */
static bool take_input(const uint8_t *bytes, unsigned i, const struct table_rules *rules,
                       struct grid_input *input)
{
    const uint8_t *place = bytes + INPUTS + (size_t)INPUT_BYTES * i;
    const uint8_t *range = bytes + RANGES + (size_t)RANGE_BYTES * i;
    const uint32_t axis = little_get32(place);
    const uint32_t points = little_get32(place + 4);
    const double first_mm = get_double(range);
    const double per_mm = get_double(range + 8);

    if (!has_axis(rules, axis) || points < 2 || points > TABLE_KNOTS_MAX ||
        !maths_is_finite(first_mm) || !maths_is_finite(per_mm) || !(per_mm > 0.0))
        return false;
    *input = (struct grid_input){
        .axis = (uint8_t)axis,
        .points = (uint16_t)points,
        .last_cell = points - 2,
        .first_mm = first_mm,
        .per_mm = per_mm,
        .last = points - 1,
        .steps_per_mm = (float)per_mm,
        .mm_per_step = (float)(1.0 / per_mm),
    };
    return true;
}

static bool take_inputs(const uint8_t *bytes, const struct table_rules *rules, struct grid *grid)
{
    unsigned axes = 0;
    size_t stride = 1;

    for (unsigned i = 0; i < grid->inputs; i++) {
        if (!take_input(bytes, i, rules, &grid->input[i]) ||
            (axes & 1U << grid->input[i].axis) != 0)
            return false;
        axes |= 1U << grid->input[i].axis;
        grid->input[i].stride = stride;
        stride *= grid->input[i].points + 2U;
        if (stride > UINT16_MAX)
            return false;
    }
    grid->size = stride;
    return true;
}

/* The turning axis is one that turns, and there; so are the others that are corrected. */
static bool take_outputs(const struct table_rules *rules, struct grid *grid)
{
    const bool turns = grid->turn_axis < AXIS_COUNT;

    if (turns && (grid->turn_axis < AXIS_LINEAR_COUNT || !has_axis(rules, grid->turn_axis)))
        return false;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (((unsigned)grid->components >> i & 1U) != 0 && !has_axis(rules, i))
            return false;
    }
    return ((unsigned)grid->components >> AXIS_LINEAR_COUNT & 1U) == (turns ? 1U : 0U) &&
           grid->components < 1U << GRID_COMPONENTS && grid->components != 0;
}

static void correct_at(const struct grid *grid, const unsigned index[TABLE_INPUTS_MAX],
                       float k[AXIS_COUNT])
{
    struct point at = {{0}};

    memset(k, 0, AXIS_COUNT * sizeof *k);
    for (unsigned i = 0; i < grid->inputs; i++)
        at.at[grid->input[i].axis] = grid->input[i].first_mm + index[i] / grid->input[i].per_mm;
    (void)takt_grid_add(grid, &at, 1.0F, k);
}

static bool keeps_within(const float k[AXIS_COUNT], double most)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!(maths_abs((double)k[i]) <= most * ROUNDING))
            return false;
    }
    return true;
}

/* The slopes from the points before this one. */
static const char *check_slopes(const struct grid *grid, const struct table_rules *rules,
                                const unsigned index[TABLE_INPUTS_MAX],
                                const float here[AXIS_COUNT])
{
    for (unsigned i = 0; i < grid->inputs; i++) {
        unsigned before[TABLE_INPUTS_MAX];
        float k[AXIS_COUNT];

        if (index[i] == 0)
            continue;
        memcpy(before, index, sizeof before);
        before[i]--;
        correct_at(grid, before, k);
        for (unsigned axis = 0; axis < AXIS_COUNT; axis++)
            k[axis] = here[axis] - k[axis];
        if (!keeps_within(k, rules->steepest_ratio / grid->input[i].per_mm))
            return "a slope of the volume is above the machine's maximum";
    }
    return NULL;
}

/* False: that was the last point. */
static bool next_point(const struct grid *grid, unsigned index[TABLE_INPUTS_MAX])
{
    for (unsigned i = 0; i < grid->inputs; i++) {
        if (++index[i] < grid->input[i].points)
            return true;
        index[i] = 0;
    }
    return false;
}

static const char *check_points(const struct grid *grid, const struct table_rules *rules)
{
    unsigned index[TABLE_INPUTS_MAX] = {0};
    const char *wrong = NULL;

    do {
        float k[AXIS_COUNT];

        correct_at(grid, index, k);
        if (!keeps_within(k, rules->largest_mm))
            return "a correction of the volume is above the machine's maximum";
        wrong = check_slopes(grid, rules, index, k);
    } while (wrong == NULL && next_point(grid, index));
    return wrong;
}

const char *takt_settings_volume_take(const uint8_t *bytes, uint32_t size,
                                      const struct table_rules *rules, struct grid *grid)
{
    const char *wrong;

    memset(grid, 0, sizeof *grid);
    if (size < COEFFICIENTS)
        return "the volume is too short";
    grid->inputs = little_get32(bytes);
    grid->components = (uint8_t)little_get32(bytes + 4);
    grid->turn_axis = (uint8_t)little_get32(bytes + 8);
    if (grid->inputs < 2 || grid->inputs > TABLE_INPUTS_MAX || !take_inputs(bytes, rules, grid) ||
        !take_outputs(rules, grid) || takt_settings_volume_bytes(grid) != size) {
        grid->inputs = 0;
        return "the volume's axes or points are wrong";
    }
    grid->coefficient = (const float *)(const void *)(bytes + COEFFICIENTS);
    wrong = check_points(grid, rules);
    if (wrong != NULL) {
        grid->inputs = 0;
        return wrong;
    }
    takt_grid_bound_all(grid);
    takt_grid_patch_set_pace(grid);
    return NULL;
}

/* ---- tables over one axis ---- */

uint32_t takt_settings_axes_bytes(const struct axis_tables *tables)
{
    if (tables->count == 0)
        return 0;
    return PAIRS + tables->count * PAIR_BYTES +
           tables->points * (uint32_t)(sizeof(double) + sizeof(struct axis_piece));
}

static void put_piece(uint8_t *at, const struct axis_piece *piece)
{
    for (unsigned i = 0; i < 4; i++) {
        put_float(at + sizeof(float) * i, piece->mean[i]);
        put_float(at + sizeof(float) * (i + 4), piece->half[i]);
    }
}

static void put_pair(uint8_t *at, const struct axis_pair *pair)
{
    at[0] = pair->input;
    at[1] = pair->corrected;
    at[2] = pair->directed;
    at[3] = 0;
    little_put32(at + 4, (uint32_t)pair->first | (uint32_t)pair->points << 16);
}

void takt_settings_axes_put(const struct axis_tables *tables, uint8_t *bytes)
{
    uint8_t *at = bytes + PAIRS;

    little_put32(bytes, tables->count);
    little_put32(bytes + 4, tables->points);
    for (unsigned i = 0; i < tables->count; i++, at += PAIR_BYTES)
        put_pair(at, &tables->pair[i]);
    for (uint32_t i = 0; i < tables->points; i++, at += sizeof(double))
        put_double(at, tables->knot_mm[i]);
    for (uint32_t i = 0; i < tables->points; i++, at += sizeof(struct axis_piece))
        put_piece(at, &tables->piece[i]);
}

static bool has_pair(const struct axis_tables *tables, const struct axis_pair *pair)
{
    for (unsigned i = 0; i < tables->count; i++) {
        if (tables->pair[i].input == pair->input && tables->pair[i].corrected == pair->corrected)
            return true;
    }
    return false;
}

/* Pairs lie one behind the other; the next begins at point number *points. */
static bool take_pair(const uint8_t *at, const struct table_rules *rules,
                      struct axis_tables *tables, uint32_t *points)
{
    const uint32_t range = little_get32(at + 4);
    const struct axis_pair pair = {.input = at[0],
                                   .corrected = at[1],
                                   .directed = at[2] != 0,
                                   .first = (uint16_t)range,
                                   .points = (uint16_t)(range >> 16)};

    if (!has_axis(rules, pair.input) || !has_axis(rules, pair.corrected) || pair.first != *points ||
        pair.points < 2 || pair.points > TABLE_KNOTS_MAX || has_pair(tables, &pair))
        return false;
    *points += pair.points;
    tables->inputs |= pair.directed ? 1U << pair.input : 0;
    tables->pair[tables->count++] = pair;
    return true;
}

static bool take_pairs(const uint8_t *bytes, const struct table_rules *rules, unsigned count,
                       struct axis_tables *tables)
{
    uint32_t points = 0;

    for (unsigned i = 0; i < count; i++) {
        if (!take_pair(bytes + PAIRS + (size_t)PAIR_BYTES * i, rules, tables, &points))
            return false;
    }
    return points == tables->points;
}

/* The correction at a knot, for both directions: a slope is verified from knot to knot. */
static bool check_knot(const struct axis_tables *tables, const struct axis_pair *pair, unsigned k,
                       const struct table_rules *rules)
{
    const double *knot = tables->knot_mm + pair->first;
    const double step_mm = k > 0 ? knot[k] - knot[k - 1] : 1.0;

    if (!(step_mm > 0.0))
        return false;
    for (int direction = -1; direction <= 1; direction += 2) {
        float approach[AXIS_COUNT] = {0}, here[AXIS_COUNT] = {0}, before[AXIS_COUNT] = {0};
        const struct axis_tables one = {
            .count = 1, .pair = {*pair}, .knot_mm = tables->knot_mm, .piece = tables->piece};
        struct point at = {{0}};

        approach[pair->input] = (float)direction;
        at.at[pair->input] = knot[k];
        (void)takt_axis_tables_sum(&one, &at, approach, 1.0F, here);
        at.at[pair->input] = k > 0 ? knot[k - 1] : knot[k];
        (void)takt_axis_tables_sum(&one, &at, approach, 1.0F, before);
        before[pair->corrected] = here[pair->corrected] - before[pair->corrected];
        if (!keeps_within(here, rules->largest_mm) ||
            !keeps_within(before, rules->steepest_ratio * step_mm))
            return false;
    }
    return true;
}

static const char *check_pairs(const struct axis_tables *tables, const struct table_rules *rules)
{
    for (unsigned i = 0; i < tables->count; i++) {
        const struct axis_pair *pair = &tables->pair[i];

        if (!maths_is_finite(tables->knot_mm[pair->first]))
            return "a position of an axis table is no number";
        for (unsigned k = 0; k < pair->points; k++) {
            if (!check_knot(tables, pair, k, rules))
                return "a point of an axis table is out of order, too large or too steep";
        }
    }
    return NULL;
}

const char *takt_settings_axes_take(const uint8_t *bytes, uint32_t size,
                                    const struct table_rules *rules, struct axis_tables *tables)
{
    const uint32_t count = size >= PAIRS ? little_get32(bytes) : 0;
    const char *wrong = "the axis tables' axes or points are wrong";
    const uint8_t *knots = bytes + PAIRS + (size_t)PAIR_BYTES * count;

    memset(tables, 0, sizeof *tables);
    if (count == 0 || count > AXIS_TABLES_PAIRS_MAX || size < PAIRS + PAIR_BYTES * count)
        return "the axis tables are too short";
    tables->points = little_get32(bytes + 4);
    if (tables->points <= UINT16_MAX && take_pairs(bytes, rules, count, tables) &&
        takt_settings_axes_bytes(tables) == size) {
        tables->knot_mm = (const double *)(const void *)knots;
        tables->piece =
            (const struct axis_piece *)(const void *)(knots + sizeof(double) * tables->points);
        wrong = check_pairs(tables, rules);
    }
    if (wrong != NULL)
        tables->count = 0;
    return wrong;
}

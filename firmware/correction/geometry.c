/*
 * Units from the tool to the bed carry the tool, those from the bed on the part:
 *
 *     tool:  v = tool + x_1 e_1 + ... as seen from unit u,    deviation += s_u + r_u x v
 *     part:  v likewise, u's own travel included,             deviation -= s_u + r_u x v
 *
 * s and r are shifts and turns of a unit in machine axes, x_i the positions of the units before it,
 * e_i their directions. Products of small numbers are left out. What the turning unit is off about
 * its own axis is corrected there, and moves nothing here.
 */
#include "correction/geometry.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

#define SIDE   AXIS_LINEAR_COUNT
#define ERRORS (2 * SIDE)

/*
 * Squareness leans a linear axis: which coordinate it moves, by which of the angles, with which
 * sign.
 */
static const struct lean {
    uint8_t axis, moved, angle;
    double sign;
} leans[] = {{AXIS_Y, AXIS_X, 0, -1.0}, {AXIS_Z, AXIS_X, 1, 1.0}, {AXIS_Z, AXIS_Y, 2, -1.0}};

#define LEANS (sizeof(leans) / sizeof(leans[0]))

static bool is_turning(const struct geometry *g, unsigned unit)
{
    TAKT_ASSERT(unit < g->chain.units);
    return g->chain.axis[unit] >= AXIS_LINEAR_COUNT;
}

static bool carries_tool(const struct geometry *g, unsigned unit)
{
    TAKT_ASSERT(unit < g->chain.units);
    return unit < g->chain.tool_units;
}

void takt_geometry_init(struct geometry *g)
{
    memset(g, 0, sizeof(*g));
    g->take_back = takt_geometry_take_back;
    g->need = takt_geometry_need;
}

bool takt_geometry_add(struct geometry *g, const struct table *table, struct diagnostic *wrong)
{
    for (unsigned u = 0; u < g->chain.units && table->errors; u++) {
        if (table->input[0] == g->chain.axis[u]) {
            return takt_axis_tables_add(&g->errors[u], table, wrong);
        }
    }
    takt_diagnostic_set(wrong, TAKT_ERROR_TABLE_UNIT, 0, 0, &AXIS_LETTERS[table->input[0]], 1, 0.0);
    return false;
}

/* sum += sign (s + r x arm) */
static void add_moved(double sum[SIDE], double sign, const double s[SIDE], const double r[SIDE],
                      const double arm[SIDE])
{
    for (unsigned i = 0; i < SIDE; i++) {
        const unsigned j = (i + 1) % SIDE;
        const unsigned k = (i + 2) % SIDE;

        sum[i] += sign * (s[i] + r[j] * arm[k] - r[k] * arm[j]);
    }
}

/* The six errors of a unit where it stands. */
static unsigned errors_of(const struct geometry *g, unsigned unit, const struct point *at,
                          double e[ERRORS])
{
    static const float no_direction[AXIS_COUNT] = {0.0F};
    float k[AXIS_COUNT] = {0.0F};
    const unsigned outside = takt_axis_tables_sum(&g->errors[unit], at, no_direction, 1.0F, k);

    TAKT_ASSERT(unit < g->chain.units);
    for (unsigned i = 0; i < ERRORS; i++) {
        e[i] = (double)k[i];
    }
    return outside;
}

/*
 * The turning unit: its turn about its own axis goes to that axis, the others act about its centre.
 */
static void add_turning(const struct geometry *g, unsigned unit, const struct point *at,
                        double e[ERRORS], double deviation[AXIS_COUNT])
{
    const unsigned axis = g->chain.axis[unit];
    double arm[SIDE];

    deviation[axis] = e[axis];
    e[axis] = 0.0;
    for (unsigned i = 0; i < SIDE; i++) {
        arm[i] = at->at[i] - g->centre_mm[i];
    }
    add_moved(deviation, -1.0, e, e + SIDE, arm);
}

unsigned takt_geometry_deviation(const struct geometry *g, const struct point *at,
                                 double deviation[AXIS_COUNT])
{
    double arm[SIDE];
    unsigned outside = 0;

    memset(deviation, 0, AXIS_COUNT * sizeof(deviation[0]));
    memcpy(arm, g->tool_mm, sizeof(arm));
    for (unsigned u = 0; u < g->chain.units; u++) {
        const unsigned axis = g->chain.axis[u];
        double e[ERRORS];

        outside |= errors_of(g, u, at, e);
        if (is_turning(g, u)) {
            add_turning(g, u, at, e, deviation);
        } else if (carries_tool(g, u)) {
            add_moved(deviation, 1.0, e, e + SIDE, arm);
            arm[axis] += at->at[axis];
        } else {
            arm[axis] += at->at[axis];
            add_moved(deviation, -1.0, e, e + SIDE, arm);
        }
    }
    for (unsigned i = 0; i < LEANS; i++) {
        const struct lean *l = &leans[i];

        deviation[l->moved] += l->sign * g->squareness_rad[l->angle] * at->at[l->axis];
    }
    return outside;
}

unsigned takt_geometry_take_back(const struct geometry *g, const struct point *at, double weight,
                                 unsigned axes_end, float k[AXIS_COUNT])
{
    double deviation[AXIS_COUNT];
    const unsigned outside = takt_geometry_deviation(g, at, deviation);

    TAKT_ASSERT(axes_end <= AXIS_COUNT);
    for (unsigned i = 0; i < axes_end; i++) {
        k[i] -= (float)(weight * deviation[i]);
    }
    return outside;
}

/* ---- what it takes of the axes ---- */

static struct need_jet jet_of(const struct need *errors, unsigned i)
{
    TAKT_ASSERT(i < AXIS_COUNT);
    return (struct need_jet){{errors->size_mm[i], errors->velocity_mm_s[i],
                              errors->acceleration_mm_s2[i], errors->jerk_mm_s3[i]}};
}

/* Shifts and turns of one unit, over arms no longer than these. */
static void add_unit(const struct need *errors, const struct need_jet arm[SIDE], struct need *need)
{
    static const struct need_jet one = {{1.0, 0.0, 0.0, 0.0}};

    for (unsigned i = 0; i < SIDE; i++) {
        const struct need_jet shift = jet_of(errors, i);
        const unsigned j = (i + 1) % SIDE;
        const unsigned k = (i + 2) % SIDE;
        const struct need_jet about_j = jet_of(errors, SIDE + j);
        const struct need_jet about_k = jet_of(errors, SIDE + k);

        takt_need_add_product(need, i, &shift, &one);
        takt_need_add_product(need, i, &about_j, &arm[k]);
        takt_need_add_product(need, i, &about_k, &arm[j]);
    }
}

/* The turning unit's own turn, which its axis takes back; it moves nothing else. */
static void add_own_turn(struct need *errors, unsigned axis, struct need *need)
{
    static const struct need_jet one = {{1.0, 0.0, 0.0, 0.0}};
    const struct need_jet turn = jet_of(errors, axis);

    TAKT_ASSERT(axis >= AXIS_LINEAR_COUNT && axis < AXIS_COUNT);
    takt_need_add_product(need, axis, &turn, &one);
    errors->size_mm[axis] = errors->velocity_mm_s[axis] = 0.0;
    errors->acceleration_mm_s2[axis] = errors->jerk_mm_s3[axis] = 0.0;
}

static void add_leans(const struct geometry *g, const struct motion_bound *most, struct need *need)
{
    for (unsigned i = 0; i < LEANS; i++) {
        const struct lean *l = &leans[i];
        const double slope = maths_abs(g->squareness_rad[l->angle]);
        const double size = slope * most->farthest_mm[l->axis];

        takt_need_add_slope(need, l->moved, l->axis, slope, most);
        need->size_mm[l->moved] += size;
        need->noise_mm[l->moved] += NEED_ROUNDING * size;
    }
}

/* The arms of the turning unit: all of X Y Z, from its centre. */
static void set_turning_arms(const struct geometry *g, const struct motion_bound *most,
                             struct need_jet arm[SIDE])
{
    for (unsigned i = 0; i < SIDE; i++) {
        arm[i] = (struct need_jet){{maths_abs(g->centre_mm[i]), 0.0, 0.0, 0.0}};
        takt_need_jet_add_travel(&arm[i], most, i);
    }
}

void takt_geometry_need(const struct geometry *g, const struct motion_bound *most,
                        struct need *need)
{
    static const struct approach_bound still = {0.0, 0.0, 0.0};
    struct need_jet arm[SIDE];

    for (unsigned i = 0; i < SIDE; i++) {
        arm[i] = (struct need_jet){{maths_abs(g->tool_mm[i]), 0.0, 0.0, 0.0}};
    }
    for (unsigned u = 0; u < g->chain.units; u++) {
        const unsigned axis = g->chain.axis[u];
        struct need errors;

        memset(&errors, 0, sizeof(errors));
        takt_axis_tables_need(&g->errors[u], &still, most, &errors);
        if (is_turning(g, u)) {
            add_own_turn(&errors, axis, need);
            set_turning_arms(g, most, arm);
        } else if (!carries_tool(g, u)) {
            takt_need_jet_add_travel(&arm[axis], most, axis);
        }
        add_unit(&errors, arm, need);
        if (!is_turning(g, u) && carries_tool(g, u)) {
            takt_need_jet_add_travel(&arm[axis], most, axis);
        }
    }
    add_leans(g, most, need);
}

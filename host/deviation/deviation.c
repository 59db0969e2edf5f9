#include "deviation/deviation.h"

#include "base/maths.h"

#include <stddef.h>

#define N      DEVIATION_LINEAR
#define MICRO  1e-6
#define UM     1e-3 /* in mm */
#define DEGREE (MATHS_PI / 180.0)

/* The chain of a machine that tells none. */
static const struct unit_chain usual_chain = {
    .units = N, .tool_units = N, .axis = {AXIS_Z, AXIS_Y, AXIS_X}};

static void set_chain(struct deviation_config *config)
{
    if (config->chain.units > 0)
        return;
    config->chain = usual_chain;
    if (config->table_axis < AXIS_COUNT)
        config->chain.axis[config->chain.units++] = (uint8_t)config->table_axis;
}

static void set_direction(double direction[N])
{
    const double length = maths_sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                                     direction[2] * direction[2]);

    for (unsigned i = 0; i < N; i++)
        direction[i] /= length;
}

void deviation_init(struct deviation *d, const struct deviation_config *config,
                    const double min_mm[AXIS_COUNT], const double max_mm[AXIS_COUNT])
{
    const double *number = (const double *)config->axis;

    *d = (struct deviation){.config = *config};
    set_chain(&d->config);
    set_direction(d->config.tool_direction);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        d->min_mm[i] = min_mm[i];
        d->max_mm[i] = max_mm[i];
    }
    for (size_t i = 0; i < sizeof config->axis / sizeof(double); i++)
        d->any = d->any || number[i] != 0;
    for (unsigned i = 0; i < N; i++)
        d->any = d->any || config->squareness_urad[i] != 0 || config->backlash_um[i] != 0 ||
                 config->growth_um_per_m_k[i] != 0;
    d->any = d->any || config->table_axis < AXIS_COUNT || config->wear_along_um_per_m != 0 ||
             config->wear_along_um_per_min != 0;
}

/* The table lags by up to half the gap: play, as a pin in a slot. */
static void take_up(double *lost_mm, double step_mm, double gap_mm)
{
    *lost_mm = maths_clamp(*lost_mm - step_mm, -0.5 * gap_mm, 0.5 * gap_mm);
}

/* rise(t) = warming (1 - e^(-t / T)) */
static double rise_at(const struct deviation_config *config, double time_s)
{
    if (config->warming_time_s <= 0)
        return config->warming_k;
    return config->warming_k * (1.0 - takt_maths_exp(-time_s / config->warming_time_s));
}

void deviation_follow(struct deviation *d, const struct point *drives, double time_s)
{
    for (unsigned i = 0; i < N; i++) {
        take_up(&d->lost_mm[i], drives->at[i] - d->drives_mm[i], d->config.backlash_um[i] * UM);
        d->drives_mm[i] = drives->at[i];
    }
    d->rise_k = rise_at(&d->config, time_s);
}

void deviation_set_wear(struct deviation *d, double length_mm, double time_s)
{
    d->wear_mm = UM * (d->config.wear_along_um_per_m * length_mm * 1e-3 +
                       d->config.wear_along_um_per_min * time_s / 60.0);
}

double deviation_sensor_k(const struct deviation *d)
{
    const double step = d->config.sensor_step_k;

    return step > 0 ? step * takt_maths_round(d->rise_k / step) : d->rise_k;
}

/* v = R v, R the product of small rotations about X, Y, Z, to the first order: R v = v + r x v. */
static void turn_slightly(const double r[N], double v[N])
{
    const double x = v[0], y = v[1], z = v[2];

    v[0] += r[1] * z - r[2] * y;
    v[1] += r[2] * x - r[0] * z;
    v[2] += r[0] * y - r[1] * x;
}

/* Where the table of an axis stands: play taken off, grown. */
static double table_mm(const struct deviation *d, unsigned axis, double drive_mm)
{
    const double x = drive_mm + d->lost_mm[axis];

    return x + MICRO * d->config.growth_um_per_m_k[axis] * d->rise_k *
                   (x - d->config.growth_reference_mm[axis]);
}

/* Shifts (mm) and turns (rad) of a unit. The table's curves are over degrees. */
static void errors_of(const struct deviation *d, unsigned axis, double drive_mm,
                      double e[DEVIATION_OF_AXIS])
{
    const bool turns = axis >= N;
    const unsigned unit = turns ? DEVIATION_TABLE : axis;
    const double size = turns ? DEGREE : 1.0;

    for (unsigned i = 0; i < DEVIATION_OF_AXIS; i++)
        e[i] = deviation_curve(d->config.axis[unit][i], drive_mm / size, d->min_mm[axis] / size,
                               d->max_mm[axis] / size) *
               (i < N ? UM : MICRO);
}

/* v += x (direction of the axis, which squareness leans) */
static void travel(const struct deviation *d, unsigned axis, double x, double v[N])
{
    const double *square = d->config.squareness_urad;

    v[axis] += x;
    if (axis == AXIS_Y)
        v[AXIS_X] -= square[0] * MICRO * x;
    if (axis == AXIS_Z) {
        v[AXIS_X] += square[1] * MICRO * x;
        v[AXIS_Y] -= square[2] * MICRO * x;
    }
}

/*
 * A unit that carries the tool: v, seen from it, becomes v = R v + travel + shifts, seen from what
 * it stands on.
 */
static void carry_tool(const struct deviation *d, unsigned axis, double drive_mm, double v[N])
{
    double e[DEVIATION_OF_AXIS];

    errors_of(d, axis, drive_mm, e);
    turn_slightly(e + N, v);
    travel(d, axis, table_mm(d, axis, drive_mm), v);
    for (unsigned i = 0; i < N; i++)
        v[i] += e[i];
}

/* v -= s, and back by r */
static void take_back(double e[DEVIATION_OF_AXIS], double v[N])
{
    for (unsigned i = 0; i < N; i++) {
        v[i] -= e[i];
        e[N + i] = -e[N + i];
    }
    turn_slightly(e + N, v);
}

/*
 * A unit that carries the part: v, seen from what it stands on, is seen from it. It goes against
 * its axis.
 */
static void enter_part(const struct deviation *d, unsigned axis, double drive_mm, double v[N])
{
    double e[DEVIATION_OF_AXIS];

    errors_of(d, axis, drive_mm, e);
    travel(d, axis, table_mm(d, axis, drive_mm), v);
    take_back(e, v);
}

double deviation_table_angle(const struct deviation *d, const struct point *drives)
{
    const struct deviation_config *config = &d->config;
    const double angle = drives->at[config->table_axis];
    const double turn_deg = angle / DEGREE;

    double e[DEVIATION_OF_AXIS];

    errors_of(d, config->table_axis, angle, e);
    return angle + e[config->table_axis] +
           MICRO * deviation_curve(config->table_yaw, turn_deg,
                                   d->min_mm[config->table_axis] / DEGREE,
                                   d->max_mm[config->table_axis] / DEGREE);
}

/* Turns v about a line along the linear axis that a rotary axis belongs to. */
static void turn_about(unsigned axis, const double centre[N], double angle, double v[N])
{
    const unsigned first = (axis - AXIS_A + 1) % N, second = (axis - AXIS_A + 2) % N;
    const double u = v[first] - centre[first], w = v[second] - centre[second];
    double sine, cosine;

    takt_maths_sincos(angle, &sine, &cosine);
    v[first] = centre[first] + cosine * u - sine * w;
    v[second] = centre[second] + sine * u + cosine * w;
}

/* From the tool's point into its spindle, as the head stands. */
static void get_direction(const struct deviation *d, const struct point *drives,
                          double direction[N])
{
    static const double own_axis[N] = {0};

    for (unsigned i = 0; i < N; i++)
        direction[i] = d->config.tool_direction[i];
    if (d->config.head_axis < AXIS_COUNT)
        turn_about(d->config.head_axis, own_axis, drives->at[d->config.head_axis], direction);
}

/* The table: about its centre; its turn about its own axis is in its angle. */
static void enter_table(const struct deviation *d, double drive_rad, double v[N])
{
    const double *centre = d->config.table_centre_mm;
    const double *tool =
        d->config.tool_mm; /* the centre is where X Y Z stand when the tool is on it */
    double e[DEVIATION_OF_AXIS];

    errors_of(d, d->config.table_axis, drive_rad, e);
    e[d->config.table_axis] = 0;
    for (unsigned i = 0; i < N; i++)
        v[i] -= centre[i] + tool[i];
    take_back(e, v);
    for (unsigned i = 0; i < N; i++)
        v[i] += centre[i] + tool[i];
}

void deviation_unit(const struct deviation *d, unsigned axis, const struct point *drives,
                    double at_mm, double errors[DEVIATION_OF_AXIS])
{
    const struct unit_chain *chain = &d->config.chain;
    const double drive = drives->at[axis];
    double way[N] = {0}, sign = -1;

    errors_of(d, axis, drive, errors);
    if (axis >= N) {
        errors[axis] = deviation_table_angle(d, drives) - at_mm;
        return;
    }
    for (unsigned i = 0; i < chain->tool_units; i++)
        sign = chain->axis[i] == axis ? 1 : sign;
    travel(d, axis, table_mm(d, axis, drive), way);
    way[axis] -= at_mm;
    for (unsigned i = 0; i < N; i++)
        errors[i] += sign * way[i];
}

/* From the tool down to the bed, and from the bed up to the part. */
void deviation_tool_point(const struct deviation *d, const struct point *drives, double turn_rad,
                          struct point *tool)
{
    const struct unit_chain *chain = &d->config.chain;
    double v[N], direction[N];

    get_direction(d, drives, direction);
    for (unsigned i = 0; i < N; i++)
        v[i] = d->config.tool_mm[i] + d->wear_mm * direction[i];
    for (unsigned i = 0; i < chain->units; i++) {
        const unsigned axis = chain->axis[i];

        if (axis >= N)
            enter_table(d, drives->at[axis], v);
        else if (i < chain->tool_units)
            carry_tool(d, axis, drives->at[axis], v);
        else
            enter_part(d, axis, drives->at[axis], v);
    }
    *tool = *drives;
    for (unsigned i = 0; i < N; i++)
        tool->at[i] = v[i] - d->config.tool_mm[i];
    if (d->config.table_axis < AXIS_COUNT)
        turn_about(d->config.table_axis, d->config.table_centre_mm,
                   turn_rad - deviation_table_angle(d, drives), tool->at);
}

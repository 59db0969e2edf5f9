#include "probe/virtual_probe.h"

#include "base/maths.h"

static bool is_in_box(const struct virtual_probe_solid *s, const struct point *at)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!(at->at[i] >= s->low[i] && at->at[i] <= s->high[i]))
            return false;
    }
    return true;
}

static bool is_in_ball(const struct virtual_probe_solid *s, const struct point *at)
{
    double sum = 0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        sum += (at->at[i] - s->low[i]) * (at->at[i] - s->low[i]);
    return sum <= s->radius_mm * s->radius_mm;
}

static bool is_around_hole(const struct virtual_probe_solid *s, const struct point *at)
{
    double x = at->at[AXIS_X] - s->low[AXIS_X];
    double y = at->at[AXIS_Y] - s->low[AXIS_Y];

    return at->at[AXIS_Z] <= s->low[AXIS_Z] && x * x + y * y >= s->radius_mm * s->radius_mm;
}

/* v turned about X, Y or Z. */
static void turn(double v[AXIS_LINEAR_COUNT], unsigned about, double angle_rad)
{
    double *first = &v[(about + 1) % AXIS_LINEAR_COUNT];
    double *second = &v[(about + 2) % AXIS_LINEAR_COUNT];
    double before = *first;
    double sine, cosine;

    takt_maths_sincos(angle_rad, &sine, &cosine);
    *first = cosine * before - sine * *second;
    *second = sine * before + cosine * *second;
}

/*
 * Where a point of the machine is on the part, as its solids are told: P + R' (T' (p - P) - offset)
 */
static void to_part(const struct virtual_probe_part *part, struct point *at)
{
    double v[AXIS_LINEAR_COUNT];

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        v[i] = at->at[i] - part->pivot_mm[i];
    if (part->table != AXIS_COUNT)
        turn(v, part->table - AXIS_A, -at->at[part->table]);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        at->at[i] = part->pivot_mm[i];
        for (unsigned j = 0; j < AXIS_LINEAR_COUNT; j++)
            at->at[i] += part->rotation[j][i] * (v[j] - part->offset_mm[j]);
    }
}

void virtual_probe_place(struct virtual_probe_part *part,
                         const double turned_rad[AXIS_LINEAR_COUNT])
{
    for (unsigned j = 0; j < AXIS_LINEAR_COUNT; j++) {
        double column[AXIS_LINEAR_COUNT] = {0};

        column[j] = 1;
        for (unsigned about = 0; about < AXIS_LINEAR_COUNT; about++)
            turn(column, about, turned_rad[about]);
        for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
            part->rotation[i][j] = column[i];
    }
    part->is_displaced = true;
}

static bool touches_solid(const struct virtual_probe_solid *s, const struct point *at)
{
    if (s->is_hole)
        return is_around_hole(s, at);
    return s->radius_mm > 0 ? is_in_ball(s, at) : is_in_box(s, at);
}

bool virtual_probe_touches(const struct virtual_probe *probe, const struct point *at)
{
    struct point on_part = *at;

    if (probe->part.is_displaced)
        to_part(&probe->part, &on_part);
    for (unsigned i = 0; i < probe->solids; i++) {
        if (touches_solid(&probe->solid[i], &on_part))
            return true;
    }
    return false;
}

static void set_input(const struct virtual_probe_change *c, struct inputs *inputs)
{
    uint32_t bit = UINT32_C(1) << (c->channel % INPUTS_DIGITAL_MAX);

    if (c->analogue)
        inputs->analogue[c->channel] = c->value;
    else if (c->value != 0)
        inputs->digital |= bit;
    else
        inputs->digital &= ~bit;
}

void virtual_probe_set_inputs(const struct virtual_probe *probe, double time_s,
                              const struct point *at, struct inputs *inputs)
{
    inputs->probe_contact = virtual_probe_touches(probe, at);
    for (unsigned i = 0; i < probe->changes && probe->change[i].time_s <= time_s; i++)
        set_input(&probe->change[i], inputs);
}

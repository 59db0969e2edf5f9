#include "probe/virtual_probe.h"

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

bool virtual_probe_touches(const struct virtual_probe *probe, const struct point *at)
{
    for (unsigned i = 0; i < probe->solids; i++) {
        const struct virtual_probe_solid *s = &probe->solid[i];

        if (s->radius_mm > 0 ? is_in_ball(s, at) : is_in_box(s, at))
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

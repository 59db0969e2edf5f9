#include "stepper/virtual_steppers.h"

#include <string.h>

void virtual_steppers_init(struct virtual_steppers *v,
                           const struct virtual_stepper_config config[AXIS_COUNT],
                           uint32_t cycle_ns)
{
    memset(v, 0, sizeof *v);
    v->cycle_ns = cycle_ns;
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        v->axis[i] = (struct virtual_stepper){
            .config = config[i], .shortest_ns = UINT64_MAX, .last_ns = UINT64_MAX};
}

static void measure(struct virtual_stepper *axis, uint64_t since_ns)
{
    if (since_ns >= axis->shortest_ns)
        return;
    axis->shortest_ns = since_ns;
    axis->rate_peak_hz = since_ns > 0 ? 1e9 / (double)since_ns : 1e9;
}

/* Times are whole nanoseconds, so the shortest time a motor can follow is rounded down. */
static bool can_follow(const struct virtual_stepper *axis, uint64_t since_ns)
{
    return (double)(since_ns + 1) * axis->config.rate_max_hz >= 1e9;
}

static void step(struct virtual_stepper *axis, uint64_t time_ns, bool backwards)
{
    bool follows = true;

    if (axis->last_ns != UINT64_MAX) {
        uint64_t since_ns = time_ns - axis->last_ns;

        measure(axis, since_ns);
        follows = can_follow(axis, since_ns);
        axis->reversals += backwards != axis->backwards ? 1 : 0;
    }
    axis->last_ns = time_ns;
    axis->backwards = backwards;
    axis->steps++;
    if (follows)
        axis->position_steps += backwards ? -1 : 1;
    else
        axis->missed++;
}

static bool is_in(unsigned axes, unsigned axis)
{
    return (axes >> axis & 1) != 0;
}

static bool take_pulse(void *context, const struct step_pulse *pulse)
{
    struct virtual_steppers *v = context;
    uint64_t time_ns = v->cycle_start_ns + pulse->time_ns;

    if (time_ns < v->newest_ns || pulse->time_ns >= v->cycle_ns)
        v->disordered++;
    if (time_ns > v->newest_ns)
        v->newest_ns = time_ns;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (v->axis[i].config.present && is_in(pulse->axes, i))
            step(&v->axis[i], v->newest_ns, is_in(pulse->direction, i));
    }
    if (v->listener.on_pulse != NULL)
        v->listener.on_pulse(v->listener.context, time_ns, pulse);
    return true;
}

static bool read_encoder(void *context, enum axis axis, int32_t *steps)
{
    const struct virtual_steppers *v = context;

    *steps = v->axis[axis].position_steps;
    return v->axis[axis].config.present && v->axis[axis].config.has_encoder != 0;
}

struct step_port virtual_steppers_get_port(struct virtual_steppers *v)
{
    return (struct step_port){take_pulse, read_encoder, v};
}

void virtual_steppers_end_cycle(struct virtual_steppers *v)
{
    v->cycle_start_ns += v->cycle_ns;
}

void virtual_steppers_listen(struct virtual_steppers *v,
                             const struct virtual_steppers_listener *listener)
{
    v->listener = *listener;
}

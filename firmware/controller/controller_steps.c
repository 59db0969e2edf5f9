#include "controller/controller_steps.h"

#include "base/assert.h"

#include <string.h>

static void set_config(struct steps_config *config, const struct machine *machine)
{
    memset(config, 0, sizeof(*config));
    config->form = (enum steps_form)machine->step_form;
    config->cycle_us = machine->cycle_us;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &machine->axis[i];

        if (machine_axis_is_stepped(axis)) {
            TAKT_ASSERT(axis->steps_per_mm > 0.0 && axis->step_rate_max_hz > 0.0);
            config->axes |= 1U << i;
            config->axis[i] = (struct steps_config_axis){
                .steps_per_mm = axis->steps_per_mm,
                .rate_max_hz = axis->step_rate_max_hz,
                .following_error_max_mm = axis->following_error_max_mm,
                .stop_mm_s2 = axis->max_acceleration_mm_s2,
            };
        }
    }
}

void takt_controller_steps_init(struct controller *c, const struct step_port *port)
{
    static const struct point home;
    struct steps_config config;

    set_config(&config, &c->machine);
    c->step_port = *port;
    takt_steps_init(&c->steps, &config, &home);
}

/* The curve the setpoint is on, but for correction. */
static const struct curve *curve_of(const struct controller *c)
{
    const struct block *block = takt_controller_get_block(c);

    if (block == NULL || !move_is_motion(&block->move)) {
        return NULL;
    }
    return &block->curve;
}

void takt_controller_steps_cycle(struct controller *c)
{
    const bool stops = c->state == CONTROLLER_STOPPING || c->state == CONTROLLER_FAULTED;

    if (!stops &&
        takt_steps_cycle(&c->steps, &c->step_port, &c->record.set, curve_of(c), c->record.block)) {
        return;
    }
    if (takt_steps_get_fault(&c->steps)->code != TAKT_OK) {
        takt_drives_stop_for(&c->drives, takt_steps_get_fault(&c->steps));
    }
    takt_steps_brake(&c->steps, &c->step_port);
}

void takt_controller_steps_restart(struct controller *c)
{
    takt_steps_restart(&c->steps);
}

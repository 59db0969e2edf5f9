#include "studies/precision.h"

#include "base/maths.h"
#include "controller/controller.h"

#include <string.h>

/* Nothing is to stop the watching: no rate is too high for these motors. */
#define ANY_RATE_HZ 1e9

static void init_form(struct precision_form *form, const struct machine *machine,
                      enum steps_form which)
{
    static const struct point start;
    struct virtual_stepper_config motors[AXIS_COUNT] = {0};
    struct steps_config config = {.form = which, .cycle_us = machine->cycle_us};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!machine->axis[i].present)
            continue;
        config.axes |= 1U << i;
        config.axis[i] =
            (struct steps_config_axis){machine->axis[i].steps_per_mm, ANY_RATE_HZ, 0, 1};
        motors[i] = (struct virtual_stepper_config){true, 0, ANY_RATE_HZ};
    }
    virtual_steppers_init(&form->motors, motors, machine->cycle_us * 1000);
    takt_steps_init(&form->steps, &config, &start);
}

void precision_init(struct precision *p, const struct machine *machine)
{
    struct interpolator_config config;

    takt_controller_interpolator_config(machine, &config);
    memset(p, 0, sizeof *p);
    p->machine = *machine;
    for (unsigned i = 0; i < PRECISION_FORMS; i++)
        init_form(&p->form[i], machine, (enum steps_form)i);
    config.kind = INTERPOLATOR_INTEGRATE;
    takt_interpolator_init(&p->integrate, &config);
    ramps_init(&p->ramps, machine, config.unit_mm);
    config.kind = INTERPOLATOR_ROTATE;
    takt_interpolator_init(&p->rotate, &config);
}

static void raise_to(double *largest, double value)
{
    if (value > *largest)
        *largest = value;
}

static void step(struct precision_form *form, const struct cycle_record *record,
                 const struct curve *curve)
{
    struct step_port port = virtual_steppers_get_port(&form->motors);

    (void)takt_steps_cycle(&form->steps, &port, &record->cmd, curve, record->block);
    virtual_steppers_end_cycle(&form->motors);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct virtual_stepper *motor = &form->motors.axis[i];
        double per_mm = form->steps.config.axis[i].steps_per_mm;

        if (!motor->config.present)
            continue;
        raise_to(&form->off_steps,
                 maths_abs((double)motor->position_steps - form->before.at[i] * per_mm));
        raise_to(&form->rate_hz, motor->rate_peak_hz);
    }
    form->before = record->cmd;
}

static void look_at_line(struct precision *p, const struct curve *curve)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        raise_to(&p->longest_mm[i], maths_abs(curve->end.at[i] - curve->start.at[i]));
    raise_to(&p->cycles_max, p->block_cycles);
}

static void look_at_curve(struct precision *p, const struct curve *curve, uint32_t block)
{
    p->block_cycles = block == p->block ? p->block_cycles + 1 : 1;
    p->block = block;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (curve->start.at[i] != curve->end.at[i])
            p->axes |= 1U << i;
    }
    if (curve->kind == CURVE_LINE)
        look_at_line(p, curve);
    if (curve->kind == CURVE_ARC) {
        p->axes |= 1U << curve->arc.first | 1U << curve->arc.second;
        raise_to(&p->radius_mm, curve->arc.radius_start_mm);
    }
}

static void interpolate(struct interpolator *i, const struct cycle_record *record,
                        const struct curve *curve)
{
    struct point cmd = record->cmd;

    takt_interpolator_cycle(i, curve, record->block, record->landed, &cmd);
}

void precision_add(struct precision *p, const struct cycle_record *record,
                   const struct block *block)
{
    const struct curve *curve = block_is_motion(block) ? &block->curve : NULL;

    p->setpoints++;
    ramps_add(&p->ramps, record, block);
    for (unsigned i = 0; i < PRECISION_FORMS; i++)
        step(&p->form[i], record, curve);
    if (curve == NULL)
        return;
    look_at_curve(p, curve, record->block);
    interpolate(&p->integrate, record, curve);
    interpolate(&p->rotate, record, curve);
}

void precision_finish(struct precision *p)
{
    ramps_finish(&p->ramps);
}

#include "takt/simulation.h"

#include "takt/stopwatch.h"

#include <stdlib.h>

static void set_drives(struct virtual_drives_config *config, const struct machine_setup *setup)
{
    config->count = 0;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct machine_axis *axis = &setup->machine.axis[i];

        if (!axis->present)
            continue;
        config->drive[config->count++] = (struct virtual_drive_config){
            .node = axis->drive_node,
            .increments_per_mm = axis->increments_per_mm,
            .start_mm = 0,
            .plant = setup->drive[i],
        };
    }
}

static void start_controller(struct simulation *s, const struct session *session,
                             struct can_port port)
{
    struct controller_config config = {
        .machine = &session->setup.machine,
        .can = port,
        .tools = &session->tools.table,
        .parameters = &s->parameters,
        .exact_path = session->options->exact_path,
        .block_delete = session->options->block_delete,
        .from_line = session->options->from_line,
    };

    s->parameters = session->parameters.values;
    source_open_text(&config.source, &s->text, session->program.bytes, session->program.length);
    controller_init(&s->controller, &config);
}

struct simulation *simulation_open(const struct session *session)
{
    struct simulation *s = calloc(1, sizeof *s);
    struct virtual_drives_config drives;
    struct can_port port;

    if (s == NULL)
        return NULL;
    s->cycle_ns = session->setup.machine.cycle_us * 1000;
    s->cost.min_ns = UINT64_MAX;
    s->inputs = inputs_idle();
    (void)bus_init(&s->bus,
                   session->setup.machine.can_bitrate); /* its range is checked with the machine */
    port = bus_attach(&s->bus, NULL);
    set_drives(&drives, &session->setup);
    virtual_drives_init(&s->drives, &s->bus, &drives);
    start_controller(s, session, port);
    return s;
}

void simulation_close(struct simulation *s)
{
    free(s);
}

static void cycle_cost_add(struct cycle_cost *cost, uint64_t ns)
{
    uint64_t step = ns / CYCLE_COST_STEP_NS;

    cost->count++;
    cost->sum_ns += ns;
    if (ns < cost->min_ns)
        cost->min_ns = ns;
    if (ns > cost->max_ns)
        cost->max_ns = ns;
    cost->steps[step < CYCLE_COST_STEPS ? step : CYCLE_COST_STEPS]++;
}

static void measured_cycle(struct simulation *s)
{
    uint64_t start_ns = stopwatch_now_ns();

    controller_cycle(&s->controller, &s->inputs);
    cycle_cost_add(&s->cost, stopwatch_now_ns() - start_ns);
}

void simulation_step(struct simulation *s)
{
    controller_background(&s->controller);
    if (s->cycles % CYCLE_COST_EVERY == 0)
        measured_cycle(s);
    else
        controller_cycle(&s->controller, &s->inputs);
    s->cycles++;
    bus_run_until(&s->bus, s->cycles * s->cycle_ns);
    virtual_drives_step(&s->drives, s->cycle_ns);
}

double cycle_cost_get_p99_ns(const struct cycle_cost *cost)
{
    uint64_t wanted = cost->count - cost->count / 100;
    uint64_t seen = 0;

    for (unsigned i = 0; i < CYCLE_COST_STEPS; i++) {
        seen += cost->steps[i];
        if (seen >= wanted)
            return (double)(i + 1) * CYCLE_COST_STEP_NS;
    }
    return (double)cost->max_ns;
}

#include "results/run.h"

#include "cli/message.h"
#include "config/shaper.h"
#include "simulation/target_setup.h"

#include <string.h>

enum command_status run_open(struct run *run, const struct options *options)
{
    struct drive_network_options network = {
        .bus = options->bus,
        .drives = options->drives,
        .drive_image = options->drive_image,
        .is_paced = options->realtime,
        .has_script = options->inject != NULL,
    };
    enum command_status status =
        drive_network_check_options(&network) ? session_open(&run->session, options) : STATUS_INPUT;

    run->session.runs = true;
    return status == STATUS_DONE ? target_setup_check(&run->session) : status;
}

/* Who plans: the controller as it runs, or takt before it. */
static enum command_status plan(struct run *run)
{
    const struct options *options = run->session.options;
    const char *how = options->plan;
    enum command_status status;

    if (how == NULL || strcmp(how, "board") == 0)
        return STATUS_DONE;
    if (options->override_method != NULL)
        message_command_warning("--override-method %s is not used: what is planned ahead of the "
                                "run changes its rate in its own way",
                                options->override_method);
    status = compiled_open(&run->compiled, &run->session, &run->totals,
                           strcmp(how, "ahead") == 0 ? NULL : how);
    run->session.compiled = &run->compiled;
    return status;
}

static void prepare_verifier(struct run *run)
{
    const struct machine *machine = &run->session.setup.machine;
    struct program_config config;
    struct source source;

    session_begin_reading(&run->session, &run->reading[0], &config, &source);
    verifier_init(&run->verifier, machine, &config, &source);
    session_begin_reading(&run->session, &run->reading[1], &config, &source);
    verifier_follow(&run->verifier, machine, &config, &source, run->session.compiled != NULL);
    if (run->session.compiled != NULL && run->session.setup.shaper == SHAPER_NONE)
        verifier_follow_tool(&run->verifier, &run->session.setup.vibration);
}

static void set_until(struct run *run)
{
    double cycle_s = machine_cycle_s(&run->session.setup.machine);
    double cycles = run->session.options->until_s / cycle_s;

    /* Half a cycle of room: 0.1 s are 100 cycles of 1 ms, whatever the division's last bit says. */
    run->until_cycles =
        run->session.options->until_s > 0 && cycles < 1e18 ? (uint64_t)(cycles + 0.5) : UINT64_MAX;
}

enum command_status run_prepare(struct run *run)
{
    enum command_status status = session_check(&run->session, 1, &run->totals);

    if (status == STATUS_DONE)
        status = plan(run);
    if (status == STATUS_DONE)
        status = simulation_open(&run->session, &run->simulation);
    if (status != STATUS_DONE)
        return status;
    prepare_verifier(run);
    set_until(run);
    return STATUS_DONE;
}

/* At most one in a cycle. */
static void tell_answers(struct run *run)
{
    struct program_answer answer;
    uint32_t answers = takt_controller_get_answers(&run->simulation->controller, &answer);

    if (answers != run->answers)
        verifier_answer(&run->verifier, &answer);
    run->answers = answers;
}

static void see(const struct run *run, const struct cycle_record *record, const struct block *block)
{
    if (run->watcher.see != NULL)
        run->watcher.see(run->watcher.context, record, block);
}

bool run_cycle(struct run *run)
{
    const struct cycle_record *record;
    const struct block *block;
    bool good = simulation_step(run->simulation);

    tell_answers(run);
    record = simulation_get_record(run->simulation);
    block = takt_controller_get_block(&run->simulation->controller);
    if (record != NULL && block != NULL) /* a target may differ, which is told */
        good = verifier_add(&run->verifier, record, block) && good;
    see(run, record, block);
    return good;
}

bool run_is_over(const struct run *run)
{
    return takt_controller_get_state(&run->simulation->controller) >= CONTROLLER_COMPLETED ||
           run->verifier.figures.cycles >= run->until_cycles;
}

/* The way to rest of a run that is cut short is part of it: trace and judge see it. */
static void end_cycle(struct run *run)
{
    if (run->cut != STATUS_DONE) {
        (void)run_cycle(run);
        return;
    }
    (void)simulation_step(run->simulation);
    see(run, NULL, NULL);
}

/* Drives of a target are the target's: they end with its process. */
void run_end_drives(struct run *run)
{
    struct controller *controller = &run->simulation->controller;

    if (run->simulation->has_target)
        return;
    run->ending.stays_on = run->session.setup.drives_stay_on != 0;
    ending_ask(&run->ending, controller, ENDING_ON_PATH);
    while (drive_network_get_problem(&run->simulation->network) == NULL &&
           !ending_is_over(&run->ending, controller)) {
        end_cycle(run);
        ending_ask(&run->ending, controller, ending_by_signals());
    }
}

static enum summary_outcome outcome_of(const struct run *run)
{
    enum controller_state state = takt_controller_get_state(&run->simulation->controller);

    if (run->cut != STATUS_DONE)
        return OUTCOME_INTERRUPTED;
    if (state == CONTROLLER_FAULTED)
        return OUTCOME_FAULTED;
    return state == CONTROLLER_COMPLETED ? OUTCOME_COMPLETED : OUTCOME_STOPPED;
}

void run_finish(struct run *run, enum command_status cut)
{
    struct summary_source source = {
        .session = &run->session,
        .totals = &run->totals,
        .simulation = run->simulation,
        .verifier = &run->verifier,
        .interrupted = cut,
        .wall_time_s = 1e-9 * (double)run->wall_ns,
    };

    run->cut = cut;
    source.outcome = outcome_of(run);
    run->fault = *takt_controller_get_fault(&run->simulation->controller);
    if (cut != STATUS_DONE)
        run_end_drives(run);
    verifier_finish(&run->verifier, source.outcome == OUTCOME_COMPLETED);
    summary_set(&run->summary, &source);
    if (cut == STATUS_DONE)
        run_end_drives(run);
    for (unsigned i = 0; i < run->summary.buses; i++)
        run->summary.bus[i].frames = drive_network_get_frames(&run->simulation->network, i);
}

void run_close(struct run *run)
{
    simulation_close(run->simulation);
    verifier_free(&run->verifier);
    compiled_close(&run->compiled);
    session_close(&run->session);
}

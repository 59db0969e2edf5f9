#include "service/service.h"

#include "base/assert.h"
#include "base/fnv.h"
#include "base/maths.h"
#include "service/service_private.h"

#include <string.h>

/*
 * This many cycles without motion after a hold was asked for are rest: the first may be the last
 * one before the hold is seen, and a stretch may begin with a cycle too slow to move any axis by a
 * bit.
 */
#define REST_CYCLES 3

/* What is known of the spindle is older than what it is told by less than this. */
#define FEEDBACK_CYCLES 4

#define MS_PER_US 1e-3

struct controller_config takt_service_controller_config(const struct service *s)
{
    return (struct controller_config){
        .machine = &s->controller.machine,
        .reader = s->config.reader,
        .can = s->config.can,
        .step = s->config.step,
        .dcf = s->config.dcf,
        .tools = &s->tools,
        .parameters = s->config.parameters,
        .correction = s->config.correction,
#ifndef SHAPE_IS_ABSENT
        .shape = s->config.shape,
#endif
        .exact_path = s->config.exact_path,
        .block_delete = s->settings.block_delete,
    };
}

void takt_service_recover(struct service *s, bool home)
{
    struct controller_config config = takt_service_controller_config(s);

    takt_source_open_text(&config.source, &s->source_text, s->text, 0);
    takt_controller_recover(&s->controller, &config, home);
}

/* Of a table in service_state.h. */
#define INITIAL(id, field, type, initial) .field = (initial),

void takt_service_init(struct service *s, const struct service_config *config)
{
    struct controller_config controller;

    memset(s, 0, sizeof *s);
    s->config = *config;
    s->tools = (struct tool_table){config->tools, config->tools_count};
    s->settings = (struct service_settings){.corrections = CORRECTION_ALL_LAYERS &
                                                           ~config->machine->correction.off,
                                            SERVICE_SETTINGS(INITIAL) SERVICE_SWITCHES(INITIAL)};
    s->digest = FNV_START;
    controller = takt_service_controller_config(s);
    controller.machine = config->machine;
    takt_source_open_text(&controller.source, &s->source_text, s->text, 0);
    takt_controller_init(&s->controller, &controller);
}

void takt_service_set_program(struct service *s, uint32_t size, uint32_t crc)
{
    s->program_size = size;
    s->program_crc = crc;
}

void takt_service_set_start_line(struct service *s, uint32_t line)
{
    s->settings.start_line = line;
}

uint32_t takt_service_get_cut_line(const struct service *s)
{
    return s->job == SERVICE_PROGRAM ? s->controller.record.line : s->cut_line;
}

/* The first alarm stays until it is acknowledged: it is the cause of the others. */
void takt_service_raise(struct service *s, enum panel_alarm alarm, const struct diagnostic *text)
{
    TAKT_ASSERT(alarm != PANEL_ALARM_NONE);
    if (s->alarm != PANEL_ALARM_NONE)
        return;
    s->alarm = alarm;
    s->alarm_text = *text;
}

/*
 * A jog has nothing to go on with: it is given up. Drives that look for their homes can only be
 * stopped at once.
 */
void takt_service_hold(struct service *s, enum panel_hold reason)
{
    if (s->job == SERVICE_NOTHING)
        return;
    if (s->finds_home)
        takt_controller_stop_at_once(&s->controller, TAKT_ERROR_HOMING_STOPPED);
    else if (s->job == SERVICE_JOG)
        takt_service_give_up(s);
    else if (reason > s->hold)
        s->hold = reason;
}

void takt_service_alive(struct service *s)
{
    s->quiet_cycles = 0;
}

static void raise_simple(struct service *s, enum panel_alarm alarm, enum takt_error error,
                         double value)
{
    struct diagnostic text;

    takt_diagnostic_set(&text, error, 0, 0, "", 0, value);
    takt_service_raise(s, alarm, &text);
}

/*
 * Whoever has claimed control and is no longer heard has lost it, and nothing goes on without the
 * operator.
 */
static void watch_panel(struct service *s)
{
    const double quiet_ms =
        (double)s->quiet_cycles * (double)s->controller.machine.cycle_us * MS_PER_US;

    if (s->settings.watchdog_ms == 0)
        return;
    s->quiet_cycles++;
    if (quiet_ms < (double)s->settings.watchdog_ms)
        return;
    raise_simple(s, PANEL_ALARM_PANEL, TAKT_ERROR_PANEL_SILENT, (double)s->settings.watchdog_ms);
    s->settings.watchdog_ms = 0;
    takt_service_hold(s, PANEL_HOLD_PANEL);
}

/* The axes rest in a hold. */
static bool rests(const struct service *s)
{
    return s->hold != PANEL_HOLD_NONE && s->rest_cycles >= REST_CYCLES;
}

/* SPINDLE_STOP is in effect. */
static bool stops_spindle(const struct service *s)
{
    return s->settings.spindle_stop && rests(s);
}

bool takt_service_spindle_is_back(const struct service *s)
{
    const struct spindle_feedback *spindle = &s->inputs.spindle;

    return !s->has_stood ||
           (!spindle->silent && !spindle->tripped && (spindle->at_speed || !s->tells_speed) &&
            s->cycles - s->stood_cycle > FEEDBACK_CYCLES);
}

/*
 * A spindle that should turn and is lost stops the axes on their path, while they are still on it.
 */
static void watch_spindle(struct service *s)
{
    const struct spindle_feedback *spindle = &s->inputs.spindle;

    if (takt_service_get_outputs(s).spindle_speed_rpm == 0.0 ||
        (!spindle->silent && !spindle->tripped))
        return;
    raise_simple(s, PANEL_ALARM_SPINDLE,
                 spindle->silent ? TAKT_ERROR_SPINDLE_SILENT : TAKT_ERROR_SPINDLE_TRIPPED, 0.0);
    takt_service_hold(s, PANEL_HOLD_SPINDLE);
    s->has_stood = true;
}

/*
 * Nothing is held: the axes go on as soon as the text does. The operator is told, once a program.
 */
static void watch_text(struct service *s)
{
    if (s->has_starved || s->job != SERVICE_PROGRAM || !takt_controller_is_starved(&s->controller))
        return;
    s->has_starved = true;
    raise_simple(s, PANEL_ALARM_STARVED, TAKT_ERROR_PROGRAM_STARVED, 0.0);
}

/* Jogs and homing are no blocks of a program. */
static bool has_blocks(const struct service *s)
{
    return s->job == SERVICE_PROGRAM || s->job == SERVICE_MDI;
}

/* The program cannot forbid this hold: only that of the operator, and not where the axes rest. */
static bool holds_anyway(const struct service *s)
{
    return s->giving_up || s->hold > PANEL_HOLD_OPERATOR || rests(s);
}

static void set_inputs(struct service *s, const struct inputs *world)
{
    const struct service_settings *settings = &s->settings;

    s->inputs = *world;
    s->tells_speed = s->tells_speed || world->spindle.at_speed;
    if (stops_spindle(s)) {
        s->has_stood = true;
        s->stood_cycle = s->cycles;
    }
    s->inputs.feed_override_percent = 0.1 * (double)settings->feed_override;
    s->inputs.rapid_override_percent = 0.1 * (double)settings->rapid_override;
    s->inputs.single_block = settings->single_block && has_blocks(s);
    s->inputs.program_stop = has_blocks(s);
    s->inputs.optional_stop = settings->optional_stop;
    s->inputs.feed_hold = s->hold != PANEL_HOLD_NONE || s->giving_up;
    s->inputs.feed_stop = holds_anyway(s);
}

static void count_rest(struct service *s, const struct cycle_record *record)
{
    if (record == NULL || !s->inputs.feed_hold)
        s->rest_cycles = record == NULL ? REST_CYCLES : 0;
    else if (point_is_same(&record->cmd, &s->at) && takt_controller_is_settled(&s->controller))
        s->rest_cycles++;
    else
        s->rest_cycles = 0;
}

static void add_to_digest(struct service *s, const struct cycle_record *record)
{
    const unsigned axes = takt_machine_axes(&s->controller.machine);

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((axes & 1U << i) != 0)
            s->digest = takt_fnv_add_double(s->digest, record->set.at[i]);
    }
}

static void take_record(struct service *s)
{
    const struct cycle_record *record = takt_controller_get_record(&s->controller);

    count_rest(s, record);
    for (unsigned i = DRIVES_LATENCY_CYCLES - 1; i > 0; i--)
        s->sent[i] = s->sent[i - 1];
    if (record != NULL) {
        add_to_digest(s, record);
        s->limiter = record->limiter;
        s->at = record->cmd;
    }
    s->sent[0] = s->controller.record.set;
}

/* A fault of a drive stops everything; an error of the program only the program. */
static void take_fault(struct service *s)
{
    const struct diagnostic *fault = takt_controller_get_fault(&s->controller);
    const bool drives = drives_get_state(&s->controller.drives) >= DRIVES_STOPPING;

    if (s->failed)
        return;
    s->failed = true;
    takt_service_raise(s, drives ? PANEL_ALARM_DRIVE : PANEL_ALARM_PROGRAM, fault);
    takt_service_end_job(s, PANEL_OUTCOME_FAILED);
    takt_controller_quieten(&s->controller);
}

void takt_service_lose_bus(struct service *s, unsigned bus)
{
    const char name[] = {'c', 'a', 'n', (char)('0' + bus)};
    struct diagnostic fault;

    takt_diagnostic_set(&fault, TAKT_ERROR_BUS_LOST, 0, 0, name, sizeof name, 0);
    takt_controller_stop_for(&s->controller, &fault);
    take_fault(s);
}

static void follow_controller(struct service *s)
{
    switch (takt_controller_get_state(&s->controller)) {
    case CONTROLLER_STARTING:
    case CONTROLLER_RUNNING:
    case CONTROLLER_STOPPING:
        break;
    case CONTROLLER_COMPLETED:
        if (s->finds_home && !s->is_planning)
            takt_service_go_to_zero(s);
        else if (!s->finds_home && s->job != SERVICE_NOTHING)
            takt_service_end_job(s, PANEL_OUTCOME_COMPLETED);
        break;
    case CONTROLLER_FAULTED:
        take_fault(s);
        break;
    }
}

/* For a program or a line; after a hold the next block has to come first. */
static void stop_after_block(struct service *s)
{
    const struct cycle_record *record = takt_controller_get_record(&s->controller);

    if (record == NULL || !has_blocks(s))
        return;
    if (takt_controller_passed_stop(&s->controller))
        takt_service_hold(s, PANEL_HOLD_PROGRAM);
    if (s->settings.single_block && record->landed && takt_motion_rests(&s->controller.motion) &&
        record->block != s->held_block) {
        s->held_block = record->block;
        takt_service_hold(s, PANEL_HOLD_SINGLE_BLOCK);
    }
}

static void drop_at_rest(struct service *s)
{
    if (!s->giving_up || s->rest_cycles < REST_CYCLES || s->is_planning)
        return;
    takt_controller_drop_program(&s->controller);
    if (s->job != SERVICE_JOG)
        takt_controller_quieten(&s->controller);
    takt_service_end_job(s,
                         s->job == SERVICE_JOG ? PANEL_OUTCOME_COMPLETED : PANEL_OUTCOME_ABORTED);
}

void takt_service_background(struct service *s)
{
    s->is_planning = true;
    takt_controller_background(&s->controller);
    s->is_planning = false;
    takt_service_take_back(s);
}

void takt_service_cycle(struct service *s, const struct inputs *inputs)
{
    set_inputs(s, inputs);
    if (takt_controller_get_state(&s->controller) == CONTROLLER_STARTING)
        takt_controller_follow_drives(&s->controller, &s->at);
    takt_controller_cycle(&s->controller, &s->inputs);
    take_record(s);
    stop_after_block(s);
    follow_controller(s);
    watch_spindle(s);
    watch_panel(s);
    watch_text(s);
    drop_at_rest(s);
    s->cycles++;
}

struct outputs takt_service_get_outputs(const struct service *s)
{
    struct outputs outputs = *takt_controller_get_outputs(&s->controller);

    if (stops_spindle(s))
        outputs.spindle_speed_rpm = 0.0;
    outputs.spindle_speed_rpm *= 0.001 * (double)s->settings.spindle_override;
    return outputs;
}

bool takt_service_take_spindle_reset(struct service *s)
{
    const bool resets = s->resets_spindle;

    s->resets_spindle = false;
    return resets;
}

static enum panel_state state_of_job(enum service_job job)
{
    switch (job) {
    case SERVICE_PROGRAM:
        return PANEL_RUNNING;
    case SERVICE_MDI:
        return PANEL_MDI;
    case SERVICE_JOG:
        return PANEL_JOGGING;
    case SERVICE_HOME:
        return PANEL_HOMING;
    case SERVICE_NOTHING:
        break;
    }
    return PANEL_IDLE;
}

/* At rest or coming to it: not as long as the program forbids it. */
static bool is_held(const struct service *s)
{
    return s->hold != PANEL_HOLD_NONE &&
           (holds_anyway(s) || motion_may_hold(&s->controller.motion));
}

enum panel_state takt_service_get_state(const struct service *s)
{
    if (s->emergency)
        return PANEL_EMERGENCY;
    if (s->failed)
        return PANEL_ALARM;
    if (takt_controller_get_state(&s->controller) == CONTROLLER_STARTING)
        return s->job == SERVICE_HOME ? PANEL_HOMING : PANEL_STARTING;
    if (s->giving_up || takt_controller_get_state(&s->controller) == CONTROLLER_STOPPING ||
        drives_get_state(&s->controller.drives) == DRIVES_STOPPING)
        return PANEL_STOPPING;
    return is_held(s) ? PANEL_HELD : state_of_job(s->job);
}

void takt_service_set_health(struct service *s, const struct service_health *health)
{
    s->health = *health;
}

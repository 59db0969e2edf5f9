/*
 * What the service starts: programs, and jogs, MDI lines and homing as short programs that it
 * writes itself.
 */
#include "base/assert.h"
#include "base/decimal.h"
#include "base/fnv.h"
#include "base/maths.h"
#include "program/parameters.h"
#include "service/service_private.h"

#define DEGREES_PER_RAD (180.0 / MATHS_PI)

/* Decimals of the positions a jog names: finer than any machine's resolution. */
#define JOG_PLACES 6

/* mm, degrees */
#define SETUP_UNITS_PER_COUNT 0.0001

/* A jog ends this far inside the travel at least, so that its end as text is not outside. */
#define JOG_ROOM 1e-6

static void begin_job(struct service *s, enum service_job job)
{
    TAKT_ASSERT(job != SERVICE_NOTHING);
    s->job = job;
    s->finds_home = false;
    s->hold = PANEL_HOLD_NONE;
    s->giving_up = false;
    s->rest_cycles = 0;
    s->has_stood = false;
    s->has_starved = false;
    s->held_block = 0;
    s->jog_is_endless = false;
    s->streams = false;
    s->settings.spindle_stop = false;
    s->digest = FNV_START;
}

/*
 * Lines are one session: what one sets counts for those after it, until a program or a reset ends
 * the session.
 */
static void keep_modes(struct service *s)
{
    s->modes = *takt_program_get_modes(&s->controller.reader->program);
    s->has_modes = true;
}

struct tool *takt_service_find_tool(const struct service *s, uint32_t number)
{
    for (size_t i = 0; i < s->config.tools_count; i++) {
        if (s->config.tools[i].number == number)
            return &s->config.tools[i];
    }
    return NULL;
}

/*
 * What a program or line has made of tools (G10 L1) lasts, as what it has made of parameters does.
 */
static void keep_tools(const struct service *s)
{
    const struct program_tools *changed = &s->controller.reader->program.tools;

    for (unsigned i = 0; i < changed->count; i++) {
        struct tool *tool = takt_service_find_tool(s, changed->tool[i].number);

        if (tool != NULL)
            *tool = changed->tool[i];
    }
}

void takt_service_end_job(struct service *s, enum panel_outcome outcome)
{
    TAKT_ASSERT(outcome != PANEL_OUTCOME_NONE);
    if (s->job == SERVICE_MDI && outcome == PANEL_OUTCOME_COMPLETED)
        keep_modes(s);
    if (s->streams)
        takt_service_end_lines(s, outcome);
    if (s->job == SERVICE_PROGRAM) {
        takt_service_forget_plan(s);
        s->cut_line = outcome == PANEL_OUTCOME_COMPLETED ? 0 : s->controller.record.line;
    }
    if (s->job == SERVICE_PROGRAM || s->job == SERVICE_MDI)
        s->outcome = outcome;
    if (s->job != SERVICE_NOTHING) {
        s->takes_back = outcome != PANEL_OUTCOME_COMPLETED;
        if (!s->takes_back)
            keep_tools(s);
        s->ended = outcome;
        s->runs++;
    }
    s->job = SERVICE_NOTHING;
    s->finds_home = false;
    s->hold = PANEL_HOLD_NONE;
    s->giving_up = false;
    s->settings.spindle_stop = false;
}

void takt_service_take_back(struct service *s)
{
    struct diagnostic why;

    if (!s->takes_back)
        return;
    s->takes_back = false;
    if (!takt_controller_take_back(&s->controller)) {
        takt_diagnostic_set(&why, TAKT_ERROR_CHANGES_AHEAD, 0, 0, "", 0, PROGRAM_CHANGES_MAX);
        takt_service_raise(s, PANEL_ALARM_PROGRAM, &why);
    }
    keep_tools(s);
}

void takt_service_give_up(struct service *s)
{
    if (s->finds_home)
        takt_controller_stop_at_once(&s->controller, TAKT_ERROR_HOMING_STOPPED);
    else if (s->job != SERVICE_NOTHING)
        s->giving_up = true;
}

enum service_plan takt_service_open_plan(const struct service *s, struct replay_source *source)
{
    const struct service_plans *plans = &s->config.plans;

    return plans->open != NULL ? plans->open(plans->context, source) : SERVICE_PLAN_NONE;
}

void takt_service_forget_plan(struct service *s)
{
    if (s->config.plans.forget != NULL)
        s->config.plans.forget(s->config.plans.context);
}

bool takt_service_start_program(struct service *s)
{
    struct controller_config config = takt_service_controller_config(s);
    const struct service_programs *programs = &s->config.programs;
    struct replay_source plan;

    if (takt_service_open_plan(s, &plan) == SERVICE_PLAN_READY)
        config.compiled = &plan;
    if (s->program_size == 0 || !programs->open(programs->context, &config.source))
        return false;
    config.from_line = s->settings.start_line;
    s->settings.start_line = 0;
    s->controller.record.line = 0;
    takt_controller_start_program(&s->controller, &config, &s->at);
    s->has_modes = false;
    begin_job(s, SERVICE_PROGRAM);
    return true;
}

/* The text is the source of the configuration. */
static void start_with(struct service *s, struct controller_config *config, enum service_job job)
{
    config->keeps_outputs = true;
    config->modes = s->has_modes && job == SERVICE_MDI ? &s->modes : NULL;
    takt_controller_start_program(&s->controller, config, &s->at);
    begin_job(s, job);
}

static void start_text(struct service *s, enum service_job job)
{
    struct controller_config config = takt_service_controller_config(s);

    takt_source_open_text(&config.source, &s->source_text, s->text, s->text_length);
    start_with(s, &config, job);
}

void takt_service_start_text_of(struct service *s, const struct controller_config *config)
{
    struct controller_config copy = *config;

    start_with(s, &copy, SERVICE_MDI);
}

static void add_character(struct service *s, char c)
{
    TAKT_ASSERT(s->text_length < sizeof s->text);
    s->text[s->text_length++] = c;
}

static void add_text(struct service *s, const char *text)
{
    for (; *text != '\0'; text++)
        add_character(s, *text);
}

void takt_service_start_mdi(struct service *s, const char *line)
{
    s->text_length = 0;
    add_text(s, line);
    start_text(s, SERVICE_MDI);
}

void takt_service_start_jog_line(struct service *s, const char *line)
{
    s->text_length = 0;
    add_text(s, line);
    start_text(s, SERVICE_JOG);
}

static void add_word(struct service *s, char letter, double value)
{
    char digits[DECIMAL_TEXT_MAX];
    const size_t length = takt_decimal_write(digits, value, JOG_PLACES);

    TAKT_ASSERT(letter >= 'A' && letter <= 'Z');
    add_character(s, letter);
    for (size_t i = 0; i < length; i++)
        add_character(s, digits[i]);
}

/* mm or degrees, as programs count. */
static double program_units(const struct machine_axis *axis, double mm)
{
    return axis->rotary ? mm * DEGREES_PER_RAD : mm;
}

/* Where a jog would end, mm or degrees. Without a distance: the end of the travel. */
static double jog_end(const struct service *s, bool negative)
{
    const struct machine_axis *axis = &s->controller.machine.axis[s->settings.jog_axis];
    const double from = program_units(axis, s->at.at[s->settings.jog_axis]);
    const double distance = 0.001 * (double)s->settings.jog_distance;

    TAKT_ASSERT(s->settings.jog_axis < AXIS_COUNT);
    if (s->settings.jog_distance > 0)
        return negative ? from - distance : from + distance;
    return negative ? program_units(axis, axis->travel_min_mm) + JOG_ROOM
                    : program_units(axis, axis->travel_max_mm) - JOG_ROOM;
}

bool takt_service_jog_is_possible(const struct service *s, bool negative)
{
    const struct machine_axis *axis = &s->controller.machine.axis[s->settings.jog_axis];
    const double end = jog_end(s, negative);

    TAKT_ASSERT(s->settings.jog_axis < AXIS_COUNT);
    return axis->present && end >= program_units(axis, axis->travel_min_mm) &&
           end <= program_units(axis, axis->travel_max_mm);
}

/* G53 G1: a straight line to a place of the machine, whatever offsets are in effect. */
void takt_service_start_jog(struct service *s, bool negative)
{
    TAKT_ASSERT(s->settings.jog_axis < AXIS_COUNT);
    s->text_length = 0;
    add_text(s, "G53 G1 ");
    add_word(s, AXIS_LETTERS[s->settings.jog_axis], jog_end(s, negative));
    add_word(s, 'F', (double)s->settings.jog_feed_mm_min);
    s->jog_is_negative = negative;
    start_text(s, SERVICE_JOG);
    s->jog_is_endless = s->settings.jog_distance == 0;
}

/* By a line, so that it is weighed as that of a program is. */
void takt_service_start_setup(struct service *s)
{
    static const char letters[] = {'X', 'Y', 'Z', 'I', 'J', 'K', 'R'};

    _Static_assert(sizeof letters == CORRECTION_SETUP_VALUES, "a letter for each number");
    s->text_length = 0;
    add_text(s, "G10 L13 ");
    for (unsigned i = 0; i < CORRECTION_SETUP_VALUES; i++) {
        if ((s->settings.setup_given & 1U << i) != 0)
            add_word(s, letters[i], SETUP_UNITS_PER_COUNT * (double)s->settings.setup[i]);
    }
    s->settings.setup_given = 0;
    start_text(s, SERVICE_JOG);
}

static void add_home(struct service *s, unsigned axis)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    if (s->controller.machine.axis[axis].present)
        add_word(s, AXIS_LETTERS[axis], 0.0);
}

static bool has_home(const struct service *s)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (s->controller.machine.axis[i].present && s->controller.machine.axis[i].home_order != 0)
            return true;
    }
    return false;
}

void takt_service_start_home(struct service *s)
{
    if (!has_home(s)) {
        takt_service_go_to_zero(s);
        return;
    }
    takt_service_recover(s, true);
    begin_job(s, SERVICE_HOME);
    s->finds_home = true;
}

/* Z first, so that the tool is out of the way of the others. */
void takt_service_go_to_zero(struct service *s)
{
    s->text_length = 0;
    if (s->controller.machine.axis[AXIS_Z].present)
        add_text(s, "G53 G0 Z0\n");
    add_text(s, "G53 G0 ");
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        add_home(s, i);
    start_text(s, SERVICE_HOME);
}

/*
 * Everything a panel can read, in counts of its register.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "program/changes.h"
#include "program/coordinates.h"
#include "program/parameters.h"
#include "service/service_private.h"

#include <string.h>

#define DEGREES_PER_RAD (180.0 / MATHS_PI)

#define COUNTS_PER_UNIT 1000.0 /* of positions and offsets */
#define MM_MIN_PER_MM_S 60.0
#define TENTHS          10.0
#define LIMITER_COUNTS  10000.0

/* Rounded, and kept within what a register can say. */
static uint32_t counts(double value, double per_unit, enum panel_id id)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const double rounded = takt_maths_round(value * per_unit);

    TAKT_ASSERT(id < REGISTER_COUNT && per_unit > 0.0);
    return (uint32_t)(int64_t)maths_clamp(rounded, (double)takt_panel_least(row),
                                          (double)panel_most(row));
}

static double shown_units(unsigned axis, double mm)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    return axis >= AXIS_LINEAR_COUNT ? mm * DEGREES_PER_RAD : mm;
}

static void set_axes(uint32_t *value, enum panel_id first, const struct point *at)
{
    TAKT_ASSERT(first + AXIS_COUNT <= REGISTER_COUNT);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value[first + i] =
            counts(shown_units(i, at->at[i]), COUNTS_PER_UNIT, (enum panel_id)(first + i));
}

/* The report of a position belongs to a setpoint of some cycles ago. */
static void look_at_axes(const struct service *s, uint32_t *value)
{
    uint16_t statusword[AXIS_COUNT];
    struct point actual, following;

    takt_controller_get_actual(&s->controller, &actual);
    takt_drives_get_statuswords(&s->controller.drives, statusword);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const struct point *set = &s->sent[DRIVES_LATENCY_CYCLES - 1];

        following.at[i] = set->at[i] - actual.at[i];
        value[REGISTER_DRIVE_STATUS_X + i] = statusword[i];
    }
    value[REGISTER_DRIVES_GIVEN_UP] = takt_drives_get_all_given_up(&s->controller.drives);
    set_axes(value, REGISTER_POSITION_X, &s->at);
    set_axes(value, REGISTER_ACTUAL_X, &actual);
    set_axes(value, REGISTER_FOLLOWING_X, &following);
    value[REGISTER_AXES] = takt_machine_axes(&s->controller.machine);
}

/*
 * The line read last may be ahead of the one being executed: linear offsets are those of the
 * latter.
 */
static void look_at_work(const struct service *s, const struct block *block, struct point *work)
{
    const struct program *p = &s->controller.reader->program;
    struct point zero, ahead;

    takt_coordinates_work_of(p, &s->at, work);
    if (block == NULL || !move_is_motion(&block->move))
        return;
    zero = s->at;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        zero.at[i] = (double)block->move.work_mm[i] + (double)block->move.overhang_mm[i];
    takt_coordinates_work_of(p, &zero, &ahead);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        work->at[i] -= ahead.at[i];
}

/* Where the setpoint is on its way. */
static void look_at_way(const struct service *s, uint32_t *value)
{
    const struct block *block = takt_controller_get_block(&s->controller);
    const double per_min = MM_MIN_PER_MM_S / machine_cycle_s(&s->controller.machine);
    struct point work, left = {{0}}, feed;

    look_at_work(s, block, &work);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        feed.at[i] = (s->sent[0].at[i] - s->sent[1].at[i]) * per_min;
        if (block != NULL && move_is_motion(&block->move))
            left.at[i] = block->move.end.at[i] - s->at.at[i];
    }
    set_axes(value, REGISTER_WORK_POSITION_X, &work);
    set_axes(value, REGISTER_DISTANCE_TO_GO_X, &left);
    set_axes(value, REGISTER_AXIS_FEED_X, &feed);
}

/* Number of the code times ten; G80 leaves none. */
#define NO_MOTION 800U

static uint32_t motion_of(const struct program_modes *m)
{
    return m->motion != NULL ? m->motion->number_x10 : NO_MOTION;
}

static void look_at_modes(const struct service *s, uint32_t *value)
{
    const struct program_modes *m = takt_program_get_modes(&s->controller.reader->program);

    value[REGISTER_SYSTEM] = m->system;
    value[REGISTER_MODES] =
        (unsigned)m->plane | (unsigned)m->incremental << 2 | (unsigned)(m->unit_mm != 1.0) << 3 |
        (unsigned)m->path << 4 | (unsigned)m->cutter_side << 6 | (unsigned)m->inverse_time << 8 |
        (unsigned)m->per_revolution << 9 | (unsigned)!m->retract_to_r << 10 |
        (unsigned)m->surface_speed << 11 | (unsigned)m->diameter << 12 | motion_of(m) << 16;
}

static unsigned homed_axes(const struct service *s)
{
    unsigned axes = takt_machine_axes(&s->controller.machine);

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (s->controller.machine.axis[i].home_order != 0 &&
            !takt_drives_are_homed(&s->controller.drives))
            axes &= ~(1U << i);
    }
    return axes;
}

static enum panel_override_reason override_reason(const struct service *s,
                                                  const struct block *block)
{
    if (s->giving_up || takt_service_get_state(s) == PANEL_HELD)
        return PANEL_OVERRIDE_HELD;
    if (block != NULL && move_is_motion(&block->move) &&
        (block->move.overrides & OVERRIDE_FEED) == 0)
        return PANEL_OVERRIDE_LOCKED;
    return s->limiter < 1.0 ? PANEL_OVERRIDE_LIMITED : PANEL_OVERRIDE_FOLLOWS;
}

/* What the program does now; between programs, nothing. */
static void look_at_motion(const struct service *s, uint32_t *value)
{
    const struct cycle_record *record = takt_controller_get_record(&s->controller);
    const struct block *block = takt_controller_get_block(&s->controller);
    const bool moves = record != NULL;

    value[REGISTER_ACTIVE_LINE] = moves ? record->line : 0;
    value[REGISTER_BLOCK] = moves ? record->block : 0;
    value[REGISTER_FEED] =
        moves ? counts(record->feed_mm_s, MM_MIN_PER_MM_S * TENTHS, REGISTER_FEED) : 0;
    value[REGISTER_OVERRIDE_EFFECTIVE] =
        moves ? counts(record->override_percent, TENTHS, REGISTER_OVERRIDE_EFFECTIVE)
              : s->settings.feed_override;
    value[REGISTER_OVERRIDE_REASON] = override_reason(s, block);
    value[REGISTER_LIMITER] =
        counts(moves ? record->limiter : 1.0, LIMITER_COUNTS, REGISTER_LIMITER);
    value[REGISTER_DIGEST_HIGH] = (uint32_t)(s->digest >> 32);
    value[REGISTER_DIGEST_LOW] = (uint32_t)s->digest;
}

static void look_at_outputs(const struct service *s, uint32_t *value)
{
    const struct outputs outputs = takt_service_get_outputs(s);
    const struct spindle_feedback *spindle = &s->inputs.spindle;

    value[REGISTER_SPINDLE_COMMANDED] =
        counts(outputs.spindle_speed_rpm, TENTHS, REGISTER_SPINDLE_COMMANDED);
    value[REGISTER_SPINDLE_SPEED] = counts(spindle->speed_rpm, TENTHS, REGISTER_SPINDLE_SPEED);
    value[REGISTER_SPINDLE_LOAD] = counts(spindle->load_percent, TENTHS, REGISTER_SPINDLE_LOAD);
    value[REGISTER_SPINDLE_STATUS] =
        (spindle->at_speed ? 1 : 0) | (spindle->tripped ? 2 : 0) | (spindle->silent ? 4 : 0);
    value[REGISTER_TOOL] = outputs.tool;
    value[REGISTER_COOLANT] = (outputs.mist ? 1 : 0) | (outputs.flood ? 2 : 0);
    value[REGISTER_FLOOD] = outputs.flood;
    value[REGISTER_MIST] = outputs.mist;
    value[REGISTER_DIGITAL_OUTPUTS] = outputs.digital;
}

static void look_at_health(const struct service *s, uint32_t *value)
{
    value[REGISTER_BUS_LOAD] = counts(s->health.bus_load_percent, TENTHS, REGISTER_BUS_LOAD);
    value[REGISTER_CYCLE_MIN] = s->health.cycle_min_ns;
    value[REGISTER_CYCLE_MEAN] = s->health.cycle_mean_ns;
    value[REGISTER_CYCLE_MAX] = s->health.cycle_max_ns;
    value[REGISTER_CYCLES] = s->cycles;
    value[REGISTER_OVERRUNS] = s->health.overruns;
}

static void look_at_state(const struct service *s, uint32_t *value)
{
    const enum panel_state state = takt_service_get_state(s);

    value[REGISTER_STATE] = state;
    value[REGISTER_HOLD_REASON] = state == PANEL_HELD ? s->hold : PANEL_HOLD_NONE;
    value[REGISTER_ALARM] = s->alarm;
    value[REGISTER_ALARM_LINE] = s->alarm_text.line;
    value[REGISTER_OUTCOME] = s->outcome;
    value[REGISTER_RUNS] = s->runs;
    value[REGISTER_PROGRAM_SIZE] = s->program_size;
    value[REGISTER_PROGRAM_CRC] = s->program_crc;
    value[REGISTER_CUT_LINE] = takt_service_get_cut_line(s);
    value[REGISTER_HOMED] = homed_axes(s);
    value[REGISTER_CYCLE_START] = s->job == SERVICE_PROGRAM;
    value[REGISTER_FEED_HOLD] = s->hold != PANEL_HOLD_NONE;
    value[REGISTER_EMERGENCY_STOP] = s->emergency;
    value[REGISTER_MDI_START] = s->job == SERVICE_MDI;
    value[REGISTER_JOG_PLUS] = s->job == SERVICE_JOG && !s->jog_is_negative;
    value[REGISTER_JOG_MINUS] = s->job == SERVICE_JOG && s->jog_is_negative;
    value[REGISTER_PROBE] = s->inputs.probe_contact;
    value[REGISTER_HOME] = s->job == SERVICE_HOME;
}

/* Of a table in service_state.h. */
#define LOOK_AT_FIELD(id, field, type, initial) value[REGISTER_##id] = (uint32_t)settings->field;

static void look_at_settings(const struct service *s, uint32_t *value)
{
    const struct service_settings *settings = &s->settings;

    SERVICE_SETTINGS(LOOK_AT_FIELD)
    SERVICE_SWITCHES(LOOK_AT_FIELD)
    for (unsigned i = 0; i < SERVICE_LAYER_COILS; i++)
        value[REGISTER_CORRECTION_MATRIX + i] = settings->corrections >> i & 1U;
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value[REGISTER_RISE_X + i] = (uint32_t)settings->rise[i];
}

/* Parameters hold mm and degrees already. What has been read ahead is not in force yet. */
static void look_at_work_offset(const struct service *s, uint32_t *value)
{
    const struct program *p = &s->controller.reader->program;
    const unsigned first =
        PARAMETER_SYSTEM_OFFSET + (s->settings.work_system - 1) * PARAMETER_SYSTEM_STRIDE;

    TAKT_ASSERT(s->settings.work_system >= 1);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        value[REGISTER_WORK_OFFSET_X + i] =
            counts(takt_changes_value(p, first + i, s->controller.reached), COUNTS_PER_UNIT,
                   REGISTER_WORK_OFFSET_X);
}

/* A tool that is not in the table has offsets 0. */
static void look_at_tool(const struct service *s, uint32_t *value)
{
    const struct tool *tool = takt_tool_table_find(&s->tools, s->settings.tool_select);
    const struct point none = {{0}};
    double length_mm, time_s;

    takt_correction_get_wear(&s->controller.correction, s->settings.tool_select, &length_mm,
                             &time_s);
    value[REGISTER_TOOL_WEAR_LENGTH] = counts(length_mm, 1.0, REGISTER_TOOL_WEAR_LENGTH);
    value[REGISTER_TOOL_WEAR_TIME] = counts(time_s, 1.0, REGISTER_TOOL_WEAR_TIME);
    set_axes(value, REGISTER_TOOL_OFFSET_X, tool != NULL ? &tool->offset : &none);
    value[REGISTER_TOOL_DIAMETER] =
        tool != NULL ? counts(tool->diameter_mm, COUNTS_PER_UNIT, REGISTER_TOOL_DIAMETER) : 0;
}

/* As it is in force, until something else is written that waits to be taken. */
static void look_at_setup(const struct service *s, uint32_t *value)
{
    double number[CORRECTION_SETUP_VALUES];

    takt_correction_get_setup(&s->controller.correction, number);
    for (unsigned i = 0; i < CORRECTION_SETUP_VALUES; i++) {
        const enum panel_id id = (enum panel_id)(REGISTER_SETUP_X + i);
        const double unit = i < AXIS_LINEAR_COUNT ? 1.0 : DEGREES_PER_RAD;

        value[id] = (s->settings.setup_given & 1U << i) != 0
                        ? (uint32_t)s->settings.setup[i]
                        : counts(number[i] * unit, takt_panel_counts_per_unit(id), id);
    }
}

void takt_service_look(const struct service *s, struct panel_snapshot *snapshot)
{
    memset(snapshot, 0, sizeof *snapshot);
    look_at_state(s, snapshot->value);
    look_at_axes(s, snapshot->value);
    look_at_motion(s, snapshot->value);
    look_at_way(s, snapshot->value);
    look_at_modes(s, snapshot->value);
    look_at_outputs(s, snapshot->value);
    look_at_health(s, snapshot->value);
    look_at_settings(s, snapshot->value);
    look_at_work_offset(s, snapshot->value);
    look_at_tool(s, snapshot->value);
    look_at_setup(s, snapshot->value);
    if (s->alarm != PANEL_ALARM_NONE)
        (void)takt_diagnostic_text(&s->alarm_text, snapshot->alarm_text);
}

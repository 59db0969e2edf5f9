/*
 * What a panel may order. Each order is checked as a whole first, then done: so nothing has changed
 * when it is refused.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "program/coordinates.h"
#include "program/parameters.h"
#include "service/service_private.h"

_Static_assert(SERVICE_LAYER_COILS <= CORRECTION_LAYERS_COUNT &&
                   CORRECTION_WEAR + 1 == SERVICE_LAYER_COILS,
               "coils for the first layers, in their order");

#define RAD_PER_DEGREE (MATHS_PI / 180.0)

/* Offsets are counted in 0.001 mm or degrees. */
#define UNITS_PER_COUNT 0.001

static bool is_between(enum panel_id id, enum panel_id first, enum panel_id last)
{
    TAKT_ASSERT(first <= last);
    return id >= first && id <= last;
}

static struct tool *selected_tool(const struct service *s)
{
    return takt_service_find_tool(s, s->settings.tool_select);
}

/* What stopped it must have been seen, and be gone. */
static bool may_go_on(const struct service *s)
{
    return s->alarm == PANEL_ALARM_NONE && !s->settings.spindle_stop &&
           takt_service_spindle_is_back(s);
}

static enum panel_verdict verdict_on(bool allowed)
{
    return allowed ? PANEL_DONE : PANEL_WRONG_STATE;
}

static enum panel_verdict check_start(const struct service *s)
{
    struct replay_source plan;

    if (takt_service_get_state(s) == PANEL_HELD)
        return verdict_on(may_go_on(s));
    return verdict_on(s->settings.mode == PANEL_MODE_PROGRAM && s->alarm == PANEL_ALARM_NONE &&
                      s->program_size > 0 &&
                      takt_service_open_plan(s, &plan) != SERVICE_PLAN_UNFIT);
}

/*
 * A jog without a distance ends when its coil is cleared: whoever starts it must be known to be
 * there.
 */
static enum panel_verdict check_jog(const struct service *s, bool negative)
{
    if (s->job == SERVICE_JOG)
        return verdict_on(s->jog_is_negative == negative && !s->giving_up);
    if (s->job != SERVICE_NOTHING || s->settings.mode != PANEL_MODE_JOG ||
        s->alarm != PANEL_ALARM_NONE)
        return PANEL_WRONG_STATE;
    if (s->settings.jog_distance == 0 && s->settings.watchdog_ms == 0)
        return PANEL_WRONG_STATE;
    return takt_service_jog_is_possible(s, negative) ? PANEL_DONE : PANEL_WRONG_VALUE;
}

/* Step drives brake by themselves after every fault. */
static bool steps_brake(const struct service *s)
{
    const struct steps *steps = &s->controller.steps;

    return s->failed && steps_are_there(steps) && !steps_rest(steps);
}

/* Drives that brake are left alone until they stand. */
static enum panel_verdict check_reset(const struct service *s)
{
    const enum drives_state drives = drives_get_state(&s->controller.drives);

    return verdict_on(!s->emergency && drives != DRIVES_STOPPING && drives != DRIVES_BRAKING &&
                      !steps_brake(s));
}

/* Coils that start something, written as 1. */
static enum panel_verdict check_coil(const struct service *s, enum panel_id id)
{
    TAKT_ASSERT(id < REGISTER_COUNT);
    if (id == REGISTER_CYCLE_START)
        return check_start(s);
    if (id == REGISTER_RESUME)
        return verdict_on(may_go_on(s));
    if (id == REGISTER_SPINDLE_STOP)
        return verdict_on(s->hold != PANEL_HOLD_NONE);
    if (id == REGISTER_MDI_START)
        return verdict_on(s->settings.mode == PANEL_MODE_MDI && s->alarm == PANEL_ALARM_NONE);
    if (id == REGISTER_SETUP_TAKE)
        return verdict_on(s->alarm == PANEL_ALARM_NONE);
    if (id == REGISTER_HOME)
        return verdict_on(s->settings.mode == PANEL_MODE_JOG && s->alarm == PANEL_ALARM_NONE);
    if (is_between(id, REGISTER_JOG_PLUS, REGISTER_JOG_MINUS))
        return check_jog(s, id == REGISTER_JOG_MINUS);
    if (id == REGISTER_RESET)
        return check_reset(s);
    if (id == REGISTER_ACKNOWLEDGE)
        return verdict_on(!s->failed);
    return PANEL_DONE;
}

/* A plan for the program that is there, on a machine that can replay it. */
static enum panel_verdict check_plan(const struct service *s)
{
    const struct machine *machine = &s->controller.machine;

    if (s->config.plans.announce == NULL || s->config.exact_path ||
        machine->interpolator != INTERPOLATOR_EXACT || machine->landing == LANDING_SCALE ||
        machine->limiter != LIMITER_CEILING)
        return PANEL_WRONG_VALUE;
    return verdict_on(s->job == SERVICE_NOTHING && s->program_size > 0);
}

static enum panel_verdict check_holding(const struct service *s, enum panel_id id, int64_t value)
{
    if (id == REGISTER_JOG_AXIS)
        return s->controller.machine.axis[value].present ? PANEL_DONE : PANEL_WRONG_VALUE;
    if (is_between(id, REGISTER_TOOL_OFFSET_X, REGISTER_TOOL_DIAMETER) ||
        is_between(id, REGISTER_TOOL_WEAR_LENGTH, REGISTER_TOOL_WEAR_TIME))
        return selected_tool(s) != NULL ? PANEL_DONE : PANEL_WRONG_VALUE;
    if (id == REGISTER_UPLOAD_COMMAND)
        return verdict_on(takt_service_get_state(s) == PANEL_IDLE);
    if (id == REGISTER_UPLOAD_KIND)
        return check_plan(s);
    return PANEL_DONE;
}

static enum panel_verdict check_item(const struct service *s, const struct panel_order_item *item)
{
    const enum panel_state state = takt_service_get_state(s);
    const bool is_coil = takt_panel_registers[item->id].form == PANEL_BIT;

    TAKT_ASSERT(item->id < REGISTER_COUNT);
    if (is_coil && item->value == 0 && item->id != REGISTER_BLOCK_DELETE)
        return PANEL_DONE;
    if (!takt_panel_may_write(item->id, state))
        return PANEL_WRONG_STATE;
    return is_coil ? check_coil(s, item->id) : check_holding(s, item->id, item->value);
}

static void go_on(struct service *s)
{
    s->hold = PANEL_HOLD_NONE;
    s->rest_cycles = 0;
    s->has_stood = false;
}

static void acknowledge(struct service *s)
{
    s->resets_spindle = s->resets_spindle || s->inputs.spindle.tripped;
    s->alarm = PANEL_ALARM_NONE;
    s->alarm_text = (struct diagnostic){0};
}

static void reset(struct service *s)
{
    acknowledge(s);
    s->has_modes = false;
    takt_service_forget_plan(s);
    if (!s->failed) {
        takt_service_give_up(s);
        return;
    }
    s->failed = false;
    if (drives_get_state(&s->controller.drives) >= DRIVES_STOPPING)
        takt_service_recover(s, false);
    else
        takt_controller_drop_program(&s->controller);
}

static void set_emergency(struct service *s, bool in)
{
    if (in && !s->emergency) {
        takt_controller_stop_at_once(&s->controller, TAKT_ERROR_EMERGENCY_STOP);
        acknowledge(s);
        takt_service_raise(s, PANEL_ALARM_EMERGENCY, takt_controller_get_fault(&s->controller));
        takt_service_end_job(s, PANEL_OUTCOME_ABORTED);
        s->failed = true;
    }
    s->emergency = in;
}

static void jog(struct service *s, bool negative, bool on)
{
    if (on && s->job == SERVICE_NOTHING)
        takt_service_start_jog(s, negative);
    else if (!on && s->job == SERVICE_JOG && s->jog_is_negative == negative && s->jog_is_endless)
        takt_service_give_up(s);
}

static void switch_correction(struct service *s, unsigned layer, bool on)
{
    struct service_settings *settings = &s->settings;

    TAKT_ASSERT(layer < CORRECTION_LAYERS_COUNT);
    settings->corrections =
        on ? settings->corrections | 1U << layer : settings->corrections & ~(1U << layer);
    takt_correction_switch(takt_controller_get_correction(&s->controller),
                           (enum correction_layer_number)layer, on);
}

/* Of a table in service_state.h: the register is a field, which becomes the value. */
#define SET_FIELD(register_id, field, type, initial)                                               \
    if (id == REGISTER_##register_id) {                                                            \
        settings->field = (type)value;                                                             \
        return true;                                                                               \
    }

/* Coils that are mere settings. False: it is none of them. */
static bool set_field(struct service_settings *settings, enum panel_id id, bool value)
{
    SERVICE_SWITCHES(SET_FIELD)
    return false;
}

/* Coils that stay as they are written. False: it is none of them. */
static bool set_switch(struct service *s, enum panel_id id, bool on)
{
    if (id == REGISTER_EMERGENCY_STOP)
        set_emergency(s, on);
    else if (is_between(id, REGISTER_FLOOD, REGISTER_MIST))
        takt_controller_set_coolant(&s->controller, id == REGISTER_FLOOD, on);
    else if (is_between(id, REGISTER_CORRECTION_MATRIX, REGISTER_CORRECTION_WEAR))
        switch_correction(s, id - REGISTER_CORRECTION_MATRIX, on);
    else if (is_between(id, REGISTER_JOG_PLUS, REGISTER_JOG_MINUS))
        jog(s, id == REGISTER_JOG_MINUS, on);
    else
        return set_field(&s->settings, id, on);
    return true;
}

static bool start_text(struct service *s, const struct panel_order *order)
{
    if (order->text == PANEL_ORDER_LINES)
        return takt_service_start_lines(s);
    if (order->text == PANEL_ORDER_JOG)
        takt_service_start_jog_line(s, order->mdi);
    else
        takt_service_start_mdi(s, order->mdi);
    return true;
}

/* Coils that do something when 1 is written. */
static bool push_button(struct service *s, enum panel_id id, const struct panel_order *order)
{
    if (id == REGISTER_RESUME || (id == REGISTER_CYCLE_START && s->job != SERVICE_NOTHING))
        go_on(s);
    else if (id == REGISTER_CYCLE_START)
        return takt_service_start_program(s);
    else if (id == REGISTER_FEED_HOLD)
        takt_service_hold(s, PANEL_HOLD_OPERATOR);
    else if (id == REGISTER_RESET)
        reset(s);
    else if (id == REGISTER_ACKNOWLEDGE)
        acknowledge(s);
    else if (id == REGISTER_MDI_START)
        return start_text(s, order);
    else if (id == REGISTER_HOME)
        takt_service_start_home(s);
    else if (id == REGISTER_SETUP_TAKE)
        takt_service_start_setup(s);
    return true;
}

/*
 * Lines that go on with the modes of the line before, and the position shown, go by the new offset
 * at once.
 */
static void load_system(struct service *s)
{
    struct program *p = &s->controller.reader->program;

    if (p->modes.system != s->settings.work_system)
        return;
    takt_coordinates_load_system(p, p->modes.system);
    s->modes.system_offset = p->modes.system_offset;
}

static bool set_work_offset(struct service *s, unsigned axis, int64_t value)
{
    const unsigned number =
        PARAMETER_SYSTEM_OFFSET + (s->settings.work_system - 1) * PARAMETER_SYSTEM_STRIDE + axis;
    const bool good =
        takt_parameters_set(s->config.parameters, number, (double)value * UNITS_PER_COUNT);

    TAKT_ASSERT(axis < AXIS_COUNT && s->settings.work_system >= 1);
    load_system(s);
    return good;
}

static void set_wear(struct service *s, enum panel_id id, int64_t value)
{
    struct correction *correction = takt_controller_get_correction(&s->controller);
    double length_mm, time_s;

    takt_correction_get_wear(correction, s->settings.tool_select, &length_mm, &time_s);
    if (id == REGISTER_TOOL_WEAR_LENGTH)
        length_mm = (double)value;
    else
        time_s = (double)value;
    takt_correction_set_wear(correction, s->settings.tool_select, length_mm, time_s);
}

static void set_tool_offset(struct service *s, unsigned axis, int64_t value)
{
    const bool rotary = axis >= AXIS_LINEAR_COUNT;

    TAKT_ASSERT(axis < AXIS_COUNT && selected_tool(s) != NULL);
    selected_tool(s)->offset.at[axis] =
        (double)value * UNITS_PER_COUNT * (rotary ? RAD_PER_DEGREE : 1.0);
}

static void set_setup(struct service_settings *settings, unsigned which, int64_t value)
{
    TAKT_ASSERT(which < CORRECTION_SETUP_VALUES);
    settings->setup[which] = (int32_t)value;
    settings->setup_given |= 1U << which;
}

/* Holding registers that are mere settings. False: it is none of them. */
static bool set_setting(struct service_settings *settings, enum panel_id id, int64_t value)
{
    SERVICE_SETTINGS(SET_FIELD)
    if (!is_between(id, REGISTER_SETUP_X, REGISTER_SETUP_TABLE))
        return false;
    set_setup(settings, id - REGISTER_SETUP_X, value);
    return true;
}

static void set_rise(struct service *s, unsigned axis, int64_t value)
{
    TAKT_ASSERT(axis < AXIS_COUNT);
    s->settings.rise[axis] = (int32_t)value;
    takt_correction_set_rise(takt_controller_get_correction(&s->controller), (enum axis)axis,
                             (double)value * UNITS_PER_COUNT);
}

/* A plan of the program before does not fit any more, and its lines are others. */
static void adopt_program(struct service *s)
{
    takt_service_forget_plan(s);
    s->cut_line = 0;
    s->settings.start_line = 0;
    s->config.programs.adopt(s->config.programs.context);
}

/* The other holding registers. */
static bool set_holding(struct service *s, enum panel_id id, int64_t value)
{
    if (is_between(id, REGISTER_WORK_OFFSET_X, REGISTER_WORK_OFFSET_C))
        return set_work_offset(s, id - REGISTER_WORK_OFFSET_X, value);
    if (is_between(id, REGISTER_TOOL_OFFSET_X, REGISTER_TOOL_OFFSET_C))
        set_tool_offset(s, id - REGISTER_TOOL_OFFSET_X, value);
    else if (is_between(id, REGISTER_RISE_X, REGISTER_RISE_C))
        set_rise(s, id - REGISTER_RISE_X, value);
    else if (is_between(id, REGISTER_TOOL_WEAR_LENGTH, REGISTER_TOOL_WEAR_TIME))
        set_wear(s, id, value);
    else if (id == REGISTER_TOOL_DIAMETER)
        selected_tool(s)->diameter_mm = (double)value * UNITS_PER_COUNT;
    else if (id == REGISTER_UPLOAD_SIZE)
        s->program_size = (uint32_t)value;
    else if (id == REGISTER_UPLOAD_CRC)
        s->program_crc = (uint32_t)value;
    else if (id == REGISTER_UPLOAD_COMMAND)
        adopt_program(s);
    else if (id == REGISTER_UPLOAD_KIND)
        s->config.plans.announce(s->config.plans.context);
    return true;
}

static bool do_item(struct service *s, const struct panel_order_item *item,
                    const struct panel_order *order)
{
    TAKT_ASSERT(item->id < REGISTER_COUNT);
    if (takt_panel_registers[item->id].form != PANEL_BIT)
        return set_setting(&s->settings, item->id, item->value) ||
               set_holding(s, item->id, item->value);
    return set_switch(s, item->id, item->value != 0) || item->value == 0 ||
           push_button(s, item->id, order);
}

/* Two buttons at once that start or end something: no order says which is meant first. */
static bool is_ambiguous(const struct panel_order *order)
{
    unsigned buttons = 0;

    for (unsigned i = 0; i < order->count; i++) {
        const enum panel_id id = order->item[i].id;

        if (order->item[i].value != 0 &&
            (is_between(id, REGISTER_CYCLE_START, REGISTER_RESUME) || id == REGISTER_RESET ||
             id == REGISTER_SETUP_TAKE || is_between(id, REGISTER_MDI_START, REGISTER_HOME)) &&
            takt_panel_registers[id].form == PANEL_BIT)
            buttons++;
    }
    return buttons > 1;
}

/*
 * Settings are made on the way, since what follows may depend on them: which tool is selected, say.
 */
static enum panel_verdict check_order(struct service *s, const struct panel_order *order)
{
    enum panel_verdict verdict = PANEL_DONE;

    for (unsigned i = 0; i < order->count && verdict == PANEL_DONE; i++) {
        verdict = check_item(s, &order->item[i]);
        if (verdict == PANEL_DONE)
            (void)set_setting(&s->settings, order->item[i].id, order->item[i].value);
    }
    return verdict;
}

/* Nobody is known to be there any more who would end it. */
static void watch_jog(struct service *s)
{
    if (s->job == SERVICE_JOG && s->jog_is_endless && s->settings.watchdog_ms == 0)
        takt_service_give_up(s);
}

enum panel_verdict takt_service_order(struct service *s, const struct panel_order *order)
{
    const struct service_settings before = s->settings;
    enum panel_verdict verdict;

    TAKT_ASSERT(order->count <= PANEL_ORDER_MAX);
    if (is_ambiguous(order))
        return PANEL_WRONG_VALUE;
    takt_service_take_back(s);
    verdict = check_order(s, order);
    if (verdict != PANEL_DONE) {
        s->settings = before;
        return verdict;
    }
    for (unsigned i = 0; i < order->count; i++) {
        if (!do_item(s, &order->item[i], order))
            return PANEL_WRONG_STATE;
    }
    if (s->settings.watchdog_ms != before.watchdog_ms)
        takt_service_alive(s);
    watch_jog(s);
    return PANEL_DONE;
}

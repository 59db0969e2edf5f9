/*
 * From power-on to the first setpoint: boot, configure, start, enable, home.
 *
 *     BOOT --all booted--> CONFIGURE --all told--> IO --they work--> START --all started--> ENABLE --all enabled--> SELECT
 *       SELECT --modes shown, axes left to home--> HOME --they are--> SELECT ... --none left--> FOLLOW --> SQUARE --> DRIVES_ENABLED
 *
 * A drive that boots before the end of ENABLE has forgotten what it was told: CONFIGURE begins
 * again.
 */
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "drive/drives_private.h"

/* Configurations begun again because a drive has booted; one that always does is of no use. */
#define RESTARTS_MAX 16

/* A mode and four controlwords for each drive, twice. */
#define TELLS_MAX (2 * 5 * AXIS_COUNT)

static void rewind_to(struct drives *d, unsigned index)
{
    d->at_axis = (uint8_t)index;
    d->at_part = DRIVES_ASK;
    d->at_step = 0;
    d->repeats = 0;
    d->is_looking = false;
    d->mapping.pass = d->mapping.step = 0;
    d->dcf.at = CONCISE_DCF_FIRST;
    d->dcf.writes = false;
    d->sdo.result = SDO_IDLE;
}

/* Nothing is known of it but that it shares no frame. */
void takt_drives_begin_axis(struct drives *d, unsigned index)
{
    rewind_to(d, index);
    if (index == d->count)
        return;
    d->axis[index].given_up &= 1u << DRIVES_NO_PAIR;
    d->axis[index].guard.is_on = false;
    takt_drives_forget_pdos(&d->axis[index]);
}

void takt_drives_enter_phase(struct drives *d, enum drives_phase phase)
{
    d->phase = phase;
    d->phase_cycles = 0;
    d->tells = d->progress = 0;
    d->is_telling = false;
    rewind_to(d, 0);
    if (phase == DRIVES_CONFIGURE)
        takt_drives_begin_axis(d, 0);
}

/* It is to be configured, which many drives take while they are pre-operational alone. */
static void hold(struct drives_axis *axis)
{
    axis->hold_pending = true;
    axis->started = false;
    axis->heard = false;
    axis->controlword = 0;
    axis->told_mode = CIA402_MODE_NONE;
}

/* Whom the request under way is for, as axis_of_node has it. */
static unsigned asked(const struct drives *d)
{
    return d->axis_of_node[d->sdo_bus][d->sdo.node];
}

/* A request to another drive is waited for: its answer would be taken for that to the next one. */
static void begin_again(struct drives *d, unsigned booted)
{
    for (unsigned i = 0; i < d->count; i++)
        hold(&d->axis[i]);
    bool is_stale = d->phase <= DRIVES_IO && sdo_client_is_busy(&d->sdo) && asked(d) != booted;
    takt_drives_enter_phase(d, DRIVES_CONFIGURE);
    d->is_stale = is_stale;
    if (is_stale)
        d->sdo.result = SDO_BUSY;
}

void takt_drives_start_again(struct drives *d, unsigned index)
{
    struct drives_axis *axis = &d->axis[index];
    if (axis->reset_pending)
        return; /* it does not know of its reset yet, and will boot again */
    axis->booted = true;
    takt_drives_doubt_home(d, index);
    hold(axis);
    if (d->phase >= DRIVES_SELECT || d->restarts++ == RESTARTS_MAX)
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_REBOOTED, 0, NULL);
    else if (d->phase != DRIVES_BOOT)
        begin_again(d, index);
}

/*
 * Reset once, and once more when that has taken too long: the order may have been lost, or the
 * answer. There are drives that boot without a word: whether one is there its first answer tells.
 */
static void boot(struct drives *d)
{
    bool all = takt_drives_io_boot(d);
    for (unsigned i = 0; i < d->count; i++) {
        struct drives_axis *axis = &d->axis[i];
        all = all && (axis->booted || d->phase_cycles > 2 * d->boot_timeout_cycles);
        if (!axis->booted && d->phase_cycles == d->boot_timeout_cycles)
            axis->reset_pending = true;
    }
    if (all)
        takt_drives_enter_phase(d, DRIVES_CONFIGURE);
}

void takt_drives_ask(struct drives *d, unsigned bus, uint8_t node, const struct drives_step *step)
{
    d->sdo_bus = (uint8_t)bus;
    if (step->length > 0)
        takt_sdo_client_download_number(&d->sdo, node, step->object, step->value, step->length,
                                        d->sdo_timeout_cycles);
    else
        takt_sdo_client_upload(&d->sdo, node, step->object, d->sdo_timeout_cycles);
}

/* The next request of this part of the configuration is made; false: there is none. */
static bool ask_of_part(struct drives *d)
{
    struct drives_step step;
    bool is_any = false;
    switch ((enum drives_part)d->at_part) {
    case DRIVES_DCF:
        return takt_drives_ask_dcf(d);
    case DRIVES_ASK:
        is_any = takt_drives_next_ask(d, &step);
        break;
    case DRIVES_SET:
        is_any = takt_drives_next_set(d, &step);
        break;
    case DRIVES_MAP:
        is_any = takt_drives_next_map(d, &step);
        break;
    case DRIVES_PARTS:
        break;
    }
    if (is_any)
        takt_drives_ask(d, drives_bus_of(d, d->at_axis), d->node[d->at_axis], &step);
    return is_any;
}

/* The next request of the axis is made; false: it is configured, or of no use. */
static bool ask_next(struct drives *d)
{
    while (d->at_part < DRIVES_PARTS && d->state == DRIVES_STARTING) {
        unsigned part = d->at_part;
        if (ask_of_part(d))
            return true;
        if (d->at_part == part) {
            d->at_part++;
            d->at_step = 0;
        }
    }
    return false;
}

static bool takes(const struct drives_axis *axis, uint16_t cob_id)
{
    return (axis->target_frame.length > 0 && axis->target_frame.cob_id == cob_id) ||
           (axis->control_frame.length > 0 && axis->control_frame.cob_id == cob_id);
}

/*
 * Drives that keep their PDOs may have been set up for one identifier: each would take the other's
 * target for its own.
 */
static void check_shared(struct drives *d, unsigned i)
{
    const struct drives_axis *axis = &d->axis[i];
    for (unsigned k = 0; k < d->count; k++) {
        const struct drives_axis *other = &d->axis[k];
        const bool is_pair = drives_are_grouped(d, i, k) && axis->is_paired && other->is_paired;
        if (k == i || is_pair || drives_bus_of(d, k) != drives_bus_of(d, i))
            continue;
        if (other->target_frame.length > 0 && takes(axis, other->target_frame.cob_id))
            takt_drives_raise(d, i, TAKT_ERROR_DRIVE_SHARES, other->target_frame.cob_id, NULL);
        else if (other->control_frame.length > 0 && takes(axis, other->control_frame.cob_id))
            takt_drives_raise(d, i, TAKT_ERROR_DRIVE_SHARES, other->control_frame.cob_id, NULL);
    }
}

static void check_load(struct drives *d)
{
    struct drives_load load;
    for (unsigned bus = 0; bus < drives_bus_count(d) && d->state == DRIVES_STARTING; bus++) {
        takt_drives_get_load(d, bus, &load);
        if (load.percent <= 100.0)
            continue;
        takt_drives_set_overload(&load, bus, &d->fault);
        takt_drives_brake(d);
    }
}

static void next_step(struct drives *d)
{
    d->repeats = 0;
    while (d->at_axis < d->count && d->state == DRIVES_STARTING) {
        if (ask_next(d))
            return;
        takt_drives_begin_axis(d, d->at_axis + 1u);
    }
    for (unsigned i = 0; i < d->count && d->state == DRIVES_STARTING; i++)
        check_shared(d, i);
    if (d->state == DRIVES_STARTING)
        check_load(d);
    if (d->state == DRIVES_STARTING)
        takt_drives_enter_phase(d, d->io_count > 0 ? DRIVES_IO : DRIVES_START);
}

static void take_answer(struct drives *d)
{
    const struct sdo_client *sdo = &d->sdo;
    bool is_done = sdo->result == SDO_DONE;
    const struct drives_answer answer = {.abort_code = is_done ? SDO_ABORT_NONE : sdo->abort_code,
                                         .value = is_done ? takt_sdo_client_number(sdo) : 0};
    if (d->at_part == DRIVES_ASK)
        takt_drives_take_ask(d, &answer);
    else if (d->at_part == DRIVES_DCF)
        takt_drives_take_dcf(d);
    else if (d->at_part == DRIVES_SET)
        takt_drives_take_set(d, &answer);
    else
        takt_drives_take_map(d, &answer);
}

/*
 * No answer: the request is repeated, and then the drive is lost. The first one of a drive is
 * repeated for as long as it may take to boot: what was heard may have been of the time before its
 * reset.
 */
static void miss_answer(struct drives *d)
{
    const uint32_t object = d->sdo.object;
    bool is_first = d->at_part == DRIVES_ASK && d->at_step == 0;
    bool may_boot = is_first && d->phase_cycles < 2 * d->boot_timeout_cycles;
    if (is_first && !d->axis[d->at_axis].booted)
        takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_ABSENT,
                          2e-3 * takt_drives_cycles_ms(d, d->boot_timeout_cycles), NULL);
    else if (!(may_boot || d->repeats++ < DRIVES_SDO_REPEATS) || !ask_next(d))
        takt_drives_raise_object(d, d->at_axis, object, TAKT_ERROR_DRIVE_UNANSWERED,
                                 takt_drives_cycles_ms(d, d->sdo_timeout_cycles), NULL);
}

/* A request of a configuration that has been begun again has come to its end. */
static void settle_request(struct drives *d)
{
    if (d->is_stale && !sdo_client_is_busy(&d->sdo)) {
        d->is_stale = false;
        d->sdo.result = SDO_IDLE;
    }
}

static void configure(struct drives *d)
{
    settle_request(d);
    switch (d->sdo.result) {
    case SDO_BUSY:
        return;
    case SDO_UNANSWERED:
        miss_answer(d);
        return;
    case SDO_DONE:
    case SDO_ABORTED:
        take_answer(d);
        break;
    case SDO_IDLE:
        break;
    }
    next_step(d);
}

/* One that has not been for so long cannot be: the bus takes no frame for it. */
static bool all_are_started(struct drives *d)
{
    bool all = true;
    for (unsigned i = 0; i < d->count; i++) {
        all = all && d->axis[i].started;
        if (!d->axis[i].started && d->phase_cycles > d->start_timeout_cycles)
            takt_drives_raise(d, i, TAKT_ERROR_DRIVE_UNREACHABLE, 0, NULL);
    }
    return all;
}

static bool all_are_enabled(const struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!takt_drives_axis_is_enabled(&d->axis[i]))
            return false;
    return true;
}

/*
 * Emergencies of the time before are history, even where a drive does not say that they are over.
 */
static void enter_operation(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        d->axis[i].emcy_code = EMCY_NONE;
    takt_drives_home_next(d);
}

static void raise_not_enabled(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    enum cia402_state state = takt_cia402_state(axis->statusword);
    if (!axis->heard || drives_is_silent(d, axis))
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_SILENT,
                          takt_drives_cycles_ms(d, drives_silent_cycles(d, axis)), NULL);
    else if (state == CIA402_FAULT)
        takt_drives_raise_reported(d, index, axis->emcy_code);
    else
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_NOT_ENABLED, axis->statusword,
                          takt_cia402_state_text(state));
}

static void raise_late(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!takt_drives_axis_is_enabled(&d->axis[i]))
            raise_not_enabled(d, i);
}

/* Statuswords on the way to "operation enabled" have 0, 1, 3 and 7 here, and not a fault's bit. */
#define STEP_BITS 0x07
#define FAULT_BIT 0x08

/*
 * Drives that charge, look for their commutation or open a brake take their time over a state. Each
 * first step of them all gives as much time again, which is three for a drive: one that falls back
 * gets no more.
 */
static void count_progress(struct drives *d)
{
    unsigned steps = 0;
    for (unsigned i = 0; i < d->count; i++) {
        const uint16_t statusword = d->axis[i].statusword;
        steps += d->axis[i].heard && !(statusword & FAULT_BIT) ? statusword & STEP_BITS : 0;
    }
    if (steps <= d->progress)
        return;
    d->progress = (uint8_t)steps;
    d->phase_cycles = 0;
}

static void enable(struct drives *d)
{
    count_progress(d);
    if (all_are_enabled(d))
        enter_operation(d);
    else if (d->phase_cycles > d->start_timeout_cycles)
        raise_late(d);
}

/* ---- What does not fit into a PDO ---- */

bool takt_drives_tells_mode(const struct drives_axis *axis)
{
    return drives_has_given_up(axis, DRIVES_NO_MODE_PDO) && axis->told_mode != axis->mode;
}

/*
 * A fault is reset by an edge; one that has come too early for the drive does nothing, so it comes
 * again and again. The times between are long beside those in which drives look at their
 * controlword, 0.25 to 10 ms, and those over which some want to see bit 7, whatever the cycle is.
 */
#define RESET_US 100000U

uint16_t takt_drives_controlword(const struct drives *d, const struct drives_axis *axis)
{
    enum cia402_state state = takt_cia402_state(axis->statusword);
    if (state == CIA402_FAULT && d->phase_cycles / (RESET_US / d->cycle_us + 1) % 2 == 1)
        return CIA402_DISABLE_VOLTAGE;
    uint16_t command = state == CIA402_ENABLED ? axis->command : 0;
    return (uint16_t)(takt_cia402_step_to_enabled(state) | command);
}

static bool tells_control(const struct drives *d, const struct drives_axis *axis)
{
    return drives_has_given_up(axis, DRIVES_NO_CONTROL_PDO) && axis->heard &&
           axis->controlword != takt_drives_controlword(d, axis);
}

/* The mode first: the controlword is meant for it. */
static void tell(struct drives *d, const struct drives_axis *axis)
{
    bool is_mode = takt_drives_tells_mode(axis);
    uint32_t object = (is_mode ? CIA402_MODE : CIA402_CONTROLWORD) & ~0xFFu;
    const struct drives_step step = {object, is_mode ? 1 : 2,
                                     is_mode ? axis->mode : takt_drives_controlword(d, axis)};
    takt_drives_ask(d, drives_axis_bus(axis), axis->config.node, &step);
    d->is_telling = true;
    d->tells = (uint8_t)(d->tells + (d->tells <= TELLS_MAX));
}

/* A lost one is told again, as a PDO would be, until its phase has lasted too long. */
static void take_told(struct drives *d)
{
    unsigned index = asked(d);
    struct drives_axis *axis = &d->axis[index];
    d->is_telling = false;
    if (d->sdo.result == SDO_ABORTED)
        takt_drives_raise_object(d, index, d->sdo.object, TAKT_ERROR_DRIVE_REFUSES,
                                 d->sdo.abort_code, takt_sdo_abort_text(d->sdo.abort_code));
    else if (d->sdo.result == SDO_DONE && sdo_index(d->sdo.object) == sdo_index(CIA402_MODE))
        axis->told_mode = (uint8_t)takt_sdo_client_number(&d->sdo);
    else if (d->sdo.result == SDO_DONE)
        axis->controlword = (uint16_t)takt_sdo_client_number(&d->sdo);
    d->sdo.result = SDO_IDLE;
}

static void tell_by_sdo(struct drives *d)
{
    if (d->is_telling && !sdo_client_is_busy(&d->sdo))
        take_told(d);
    if (d->sdo.result != SDO_IDLE || d->state != DRIVES_STARTING)
        return;
    for (unsigned i = 0; i < d->count && !d->is_telling; i++)
        if (takt_drives_tells_mode(&d->axis[i]) || tells_control(d, &d->axis[i]))
            tell(d, &d->axis[i]);
}

/*
 * The time of a slow request is not the drive's; but a drive that has to be told ever again does
 * not get ready.
 */
static void count_cycle(struct drives *d)
{
    if (!d->is_telling || d->tells > TELLS_MAX)
        d->phase_cycles++;
}

static void run_phase(struct drives *d)
{
    switch (d->phase) {
    case DRIVES_BOOT:
        boot(d);
        break;
    case DRIVES_CONFIGURE:
        configure(d);
        break;
    case DRIVES_IO:
        settle_request(d);
        if (!d->is_stale)
            takt_drives_io_start(d);
        break;
    case DRIVES_START:
        if (all_are_started(d))
            takt_drives_enter_phase(d, DRIVES_ENABLE);
        break;
    case DRIVES_ENABLE:
        enable(d);
        break;
    case DRIVES_SELECT:
        takt_drives_select(d);
        break;
    case DRIVES_HOME:
        takt_drives_home(d);
        break;
    case DRIVES_FOLLOW:
        takt_drives_follow(d);
        break;
    case DRIVES_SQUARE:
        takt_drives_square(d);
        break;
    }
}

void takt_drives_start(struct drives *d)
{
    takt_sdo_client_tick(&d->sdo);
    count_cycle(d);
    if (d->phase >= DRIVES_ENABLE)
        tell_by_sdo(d);
    if (d->state == DRIVES_STARTING)
        run_phase(d);
}

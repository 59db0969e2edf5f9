/*
 * From power-on to the first setpoint: boot, configure, start, enable, home.
 *
 *     BOOT --all booted--> CONFIGURE --all told--> START --all started--> ENABLE --all enabled--> SELECT
 *       SELECT --modes shown, axes left to home--> HOME --they are--> SELECT ... --none left--> DRIVES_ENABLED
 *
 * A drive that boots before the end of ENABLE has forgotten what it was told: CONFIGURE begins again.
 */
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "drive/drives_private.h"

/* A node that has not booted is reset again after so long. */
#define RESET_AGAIN_MS 500

void drives_enter_phase(struct drives *d, enum drives_phase phase)
{
    d->phase = phase;
    d->phase_cycles = 0;
    d->at_axis = 0;
    d->at_step = 0;
    d->repeats = 0;
    d->sdo.result = SDO_IDLE;
}

void drives_start_again(struct drives *d, unsigned index)
{
    struct drives_axis *axis = &d->axis[index];
    axis->booted = true;
    axis->started = false;
    axis->heard = false;
    if (d->phase == DRIVES_SELECT || d->phase == DRIVES_HOME)
        drives_raise(d, index, TAKT_ERROR_DRIVE_REBOOTED, 0, NULL);
    else if (d->phase != DRIVES_BOOT)
        drives_enter_phase(d, DRIVES_CONFIGURE);
}

static void boot(struct drives *d)
{
    bool all = true;
    for (unsigned i = 0; i < d->count; i++) {
        all = all && d->axis[i].booted;
        if (!d->axis[i].booted && drives_cycles_ms(d, d->phase_cycles) >= RESET_AGAIN_MS)
            d->axis[i].reset_pending = true;
    }
    if (drives_cycles_ms(d, d->phase_cycles) >= RESET_AGAIN_MS)
        d->phase_cycles = 0;
    if (all)
        drives_enter_phase(d, DRIVES_CONFIGURE);
}

static void ask(struct drives *d, const struct drives_step *step)
{
    if (step->length > 0)
        sdo_client_download_number(&d->sdo, d->node[d->at_axis], step->object, step->value,
                                   step->length, d->sdo_timeout_cycles);
    else
        sdo_client_upload(&d->sdo, d->node[d->at_axis], step->object, d->sdo_timeout_cycles);
}

static bool is_lacking(uint32_t abort_code)
{
    return abort_code == SDO_ABORT_NO_OBJECT || abort_code == SDO_ABORT_NO_SUB_INDEX;
}

/* True: the step is done and the next may follow. */
static bool finish_step(struct drives *d, const struct drives_step *step)
{
    const struct sdo_client *sdo = &d->sdo;
    switch (sdo->result) {
    case SDO_DONE:
        return step->length > 0 || drives_accept(d, d->at_axis, step, sdo_client_number(sdo));
    case SDO_ABORTED:
        if (step->optional && is_lacking(sdo->abort_code))
            return true;
        drives_raise_object(d, d->at_axis, step->object, TAKT_ERROR_DRIVE_REFUSES, sdo->abort_code,
                            sdo_abort_text(sdo->abort_code));
        return false;
    case SDO_UNANSWERED:
        if (d->repeats++ < DRIVES_SDO_REPEATS) {
            ask(d, step);
            return false;
        }
        drives_raise_object(d, d->at_axis, step->object, TAKT_ERROR_DRIVE_UNANSWERED,
                            drives_cycles_ms(d, d->sdo_timeout_cycles), NULL);
        return false;
    case SDO_IDLE:
    case SDO_BUSY:
        break;
    }
    return false;
}

static void next_step(struct drives *d)
{
    struct drives_step step;
    d->repeats = 0;
    while (d->at_axis < d->count && !drives_find_step(d, d->at_axis, d->at_step, &step)) {
        d->at_axis++;
        d->at_step = 0;
    }
    if (d->at_axis < d->count)
        ask(d, &step);
    else
        drives_enter_phase(d, DRIVES_START);
}

static void configure(struct drives *d)
{
    struct drives_step step;
    if (d->sdo.result == SDO_IDLE) {
        next_step(d);
        return;
    }
    if (!drives_find_step(d, d->at_axis, d->at_step, &step) || !finish_step(d, &step))
        return;
    d->at_step++;
    next_step(d);
}

static bool all_are_started(const struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!d->axis[i].started)
            return false;
    return true;
}

static bool all_are_enabled(const struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_axis_is_enabled(&d->axis[i]))
            return false;
    return true;
}

/* Emergencies of the time before are history, even where a drive does not say that they are over. */
static void enter_operation(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        d->axis[i].emcy_code = EMCY_NONE;
    drives_home_next(d);
}

static void raise_not_enabled(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    enum cia402_state state = cia402_state(axis->statusword);
    if (!axis->heard)
        drives_raise(d, index, TAKT_ERROR_DRIVE_SILENT,
                     drives_cycles_ms(d, drives_silent_cycles(d, axis)), NULL);
    else if (state == CIA402_FAULT)
        drives_raise_reported(d, index, axis->emcy_code);
    else
        drives_raise(d, index, TAKT_ERROR_DRIVE_NOT_ENABLED, axis->statusword,
                     cia402_state_text(state));
}

static void raise_late(struct drives *d)
{
    double timeout_ms = drives_cycles_ms(d, d->start_timeout_cycles);
    for (unsigned i = 0; i < d->count; i++)
        if (!d->axis[i].booted)
            drives_raise(d, i, TAKT_ERROR_DRIVE_ABSENT, 1e-3 * timeout_ms, NULL);
    for (unsigned i = 0; i < d->count && d->phase == DRIVES_ENABLE; i++)
        if (!drives_axis_is_enabled(&d->axis[i]))
            raise_not_enabled(d, i);
    if (d->state == DRIVES_STARTING)
        drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_UNANSWERED, timeout_ms, NULL);
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
    case DRIVES_START:
        if (all_are_started(d))
            drives_enter_phase(d, DRIVES_ENABLE);
        break;
    case DRIVES_ENABLE:
        if (all_are_enabled(d))
            enter_operation(d);
        break;
    case DRIVES_SELECT:
        drives_select(d);
        break;
    case DRIVES_HOME:
        drives_home(d);
        break;
    }
}

void drives_start(struct drives *d)
{
    sdo_client_tick(&d->sdo);
    d->phase_cycles++;
    run_phase(d);
    if (d->state == DRIVES_STARTING && d->phase < DRIVES_SELECT &&
        d->start_cycles++ >= d->start_timeout_cycles)
        raise_late(d);
}

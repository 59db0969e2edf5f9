/*
 * What is watched once a cycle, and the way to rest after a fault.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "drive/drives_private.h"

/*
 * A drive stands when in each of this many reports it has moved by REST_MM (mm or rad), or an
 * increment, at most.
 */
#define REST_REPORTS 10
#define REST_MM      1e-5

void takt_drives_raise_reported(struct drives *d, unsigned index, uint16_t code)
{
    takt_drives_raise(d, index, TAKT_ERROR_DRIVE_FAULT, code,
                      code != EMCY_NONE ? takt_emcy_text(code) : "a fault without a code");
}

static void raise_state(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    enum cia402_state state = takt_cia402_state(axis->statusword);
    TAKT_ASSERT(index < d->count);
    if (state == CIA402_FAULT || state == CIA402_FAULT_REACTION)
        takt_drives_raise_reported(d, index, axis->emcy_code);
    else
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_STATE, axis->statusword,
                          takt_cia402_state_text(state));
}

static void raise_link(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    TAKT_ASSERT(index < d->count);
    if (!cia402_is_enabled(axis->statusword))
        raise_state(d, index);
    else if (drives_is_silent(d, axis))
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_SILENT,
                          takt_drives_cycles_ms(d, drives_silent_cycles(d, axis)), NULL);
    else
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_HEARTBEAT,
                          takt_drives_cycles_ms(d, drives_heartbeat_age_cycles(d, axis)), NULL);
}

static inline bool check_links(struct drives *d, unsigned index)
{
    if (drives_is_linked(d, &d->axis[index]))
        return true;
    raise_link(d, index);
    return false;
}

bool takt_drives_check_links(struct drives *d, unsigned index)
{
    return check_links(d, index);
}

/*
 * After a fault a drive that still follows its setpoints brakes with them and lags no more than
 * before; one that stays behind by this part of what is allowed has left them, whatever its
 * statusword says.
 */
#define STOPPING_LAG_RATIO 0.1

static double allowed_lag_mm(const struct drives *d, const struct drives_axis *axis)
{
    double limit_mm = axis->config.following_error_max_mm;
    if (d->state != DRIVES_STOPPING)
        return limit_mm;
    return maths_min(limit_mm, axis->lag_mm + STOPPING_LAG_RATIO * limit_mm);
}

/*
 * lag = setpoint of DRIVES_LATENCY_CYCLES ago - actual position. Without a report this cycle the
 * two do not belong together.
 */
static inline void check_following(struct drives *d, unsigned index, double set_mm)
{
    struct drives_axis *axis = &d->axis[index];
    double lag_mm = maths_abs(set_mm - axis->actual_mm);
    if (lag_mm > allowed_lag_mm(d, axis))
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_FOLLOWING,
                          takt_drives_axis_shown(axis, lag_mm), NULL);
    if (d->state == DRIVES_ENABLED)
        axis->lag_mm = lag_mm;
}

/*
 * In operation: how many drives from the first one on do what they should, which is what nearly
 * every cycle finds of all of them.
 */
static unsigned count_well(struct drives *d, const double *set_mm)
{
    const uint32_t cycle = d->cycle, most = d->heartbeat_age_max_cycles;
    unsigned i = 0;
    for (; i < d->count; i++) {
        struct drives_axis *axis = &d->axis[i];
        double lag_mm = maths_abs(set_mm[i] - axis->actual_mm);
        if (!cia402_is_enabled(axis->statusword) || axis->reported != cycle ||
            cycle - axis->heartbeat > most || lag_mm > axis->config.following_error_max_mm)
            break;
        axis->lag_mm = lag_mm;
    }
    return i;
}

void takt_drives_check_operation(struct drives *d)
{
    const double *set_mm = drives_sent(d, DRIVES_LATENCY_CYCLES);
    for (unsigned i = d->state == DRIVES_ENABLED ? count_well(d, set_mm) : 0; i < d->count; i++)
        if (check_links(d, i) && drives_silent_cycles(d, &d->axis[i]) == 0)
            check_following(d, i, set_mm[i]);
    if (d->gantry_count > 0)
        takt_drives_check_skew(d);
}

static bool setpoint_moves(const struct drives *d, unsigned index)
{
    return maths_abs(drives_sent(d, 0)[index] - drives_sent(d, 1)[index]) > 0;
}

/* With an emergency as the fault, a statusword that does not come soon would have told of it. */
static bool is_lost(const struct drives *d, const struct drives_axis *axis)
{
    return axis->lost || drives_silent_cycles(d, axis) > DRIVES_LATENCY_CYCLES;
}

/*
 * Setpoints have come to rest when they have not changed for as long as a report takes. Where a
 * lost axis has to move, the path is left anyway, and least if all brake as hard as they can.
 */
void takt_drives_watch_stop(struct drives *d)
{
    bool at_rest = true;
    bool leaves_path = false;
    TAKT_ASSERT(d->state == DRIVES_STOPPING);
    for (unsigned i = 0; i < d->count; i++) {
        bool moves = setpoint_moves(d, i);
        at_rest = at_rest && !moves;
        leaves_path = leaves_path || (moves && is_lost(d, &d->axis[i]));
    }
    d->rest_cycles = at_rest ? d->rest_cycles + 1 : 0;
    if (leaves_path || d->rest_cycles >= DRIVES_LATENCY_CYCLES ||
        d->stop_cycles++ >= d->stop_timeout_cycles)
        takt_drives_brake(d);
}

static bool is_switched_off(const struct drives_axis *axis)
{
    switch (takt_cia402_state(axis->statusword)) {
    case CIA402_SWITCH_ON_DISABLED:
    case CIA402_READY:
    case CIA402_SWITCHED_ON:
    case CIA402_FAULT:
    case CIA402_NOT_READY:
        return true;
    case CIA402_ENABLED:
    case CIA402_QUICK_STOP:
    case CIA402_FAULT_REACTION:
        break;
    }
    return false;
}

/* A drive that has never been started has never had torque. */
static bool rests(const struct drives *d, struct drives_axis *axis)
{
    double moved_inc = maths_abs((double)axis->actual_inc - axis->braking_inc);
    bool still = drives_silent_cycles(d, axis) == 0 && is_switched_off(axis) &&
                 moved_inc <= maths_max(REST_MM * maths_abs(axis->config.increments_per_mm), 1);
    axis->braking_inc = axis->actual_inc;
    axis->rest_cycles = still ? axis->rest_cycles + 1 : 0;
    return !axis->started || axis->rest_cycles >= REST_REPORTS;
}

void takt_drives_watch_brakes(struct drives *d)
{
    bool all = true;
    TAKT_ASSERT(d->state == DRIVES_BRAKING);
    for (unsigned i = 0; i < d->count; i++)
        all = rests(d, &d->axis[i]) && all;
    if (all || d->stop_cycles++ >= d->brake_timeout_cycles)
        d->state = DRIVES_FAULTED;
}

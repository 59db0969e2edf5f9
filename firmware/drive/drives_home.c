/*
 * Homing, and the change of modes before and after it (CiA 402-2, homing mode). The drive finds its
 * home by itself; the master chooses when, and watches.
 *
 *     statusword bits 13 12 10:  0 0 0 under way,  0 1 1 done,  0 0 1 idle,  1 x x error
 */
#include "base/assert.h"
#include "base/maths.h"
#include "canopen/cia402.h"
#include "drive/drives_private.h"

/* A drive that does not show the mode it was given within this time will not. */
#define MODE_TIMEOUT_MS 1000

/*
 * A drive that shows "done" for so long is: what it shows first may be of an older homing, and its
 * position may follow later than its statusword. An error counts when it could have begun anew.
 */
#define HOMING_SHOWN_MS 100

/* Lowest order above the present one; 0: none. */
static uint8_t next_order(const struct drives *d)
{
    uint8_t next = 0;
    for (unsigned i = 0; i < d->count && !d->homed; i++) {
        uint8_t order = d->axis[i].config.homing.order;
        if (order > d->home_order && (next == 0 || order < next))
            next = order;
    }
    return next;
}

/*
 * Homing has given positions another zero: the target of a drive that leaves it is where it stands
 * now.
 */
static void select_mode(struct drives_axis *axis, bool is_homing)
{
    if (axis->mode == CIA402_MODE_HOMING)
        takt_drives_rest(axis);
    axis->mode = is_homing ? CIA402_MODE_HOMING : axis->follow_mode;
    axis->command = 0;
}

void takt_drives_home_next(struct drives *d)
{
    uint8_t order = next_order(d);
    for (unsigned i = 0; i < d->count; i++)
        select_mode(&d->axis[i], order != 0 && d->axis[i].config.homing.order == order);
    d->home_order = order;
    d->homed = order == 0;
    takt_drives_enter_phase(d, DRIVES_SELECT);
}

void takt_drives_check_all_links(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_is_linked(d, &d->axis[i]))
            (void)takt_drives_check_links(d, i);
}

/* One that has been started boots by itself, so it may have lost its zero. */
void takt_drives_doubt_home(struct drives *d, unsigned index)
{
    TAKT_ASSERT(index < d->count);
    d->homed = d->homed && !d->axis[index].started;
}

/* So may one that is not heard any more; where there are no heartbeats, by its reports. */
void takt_drives_doubt_homes(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_axis *axis = &d->axis[i];
        if (d->heartbeat_ms > 0 ? drives_heartbeat_age_cycles(d, axis) > d->heartbeat_age_max_cycles
                                : drives_is_silent(d, axis))
            takt_drives_doubt_home(d, i);
    }
}

static bool is_late(const struct drives *d)
{
    return takt_drives_cycles_ms(d, d->phase_cycles) > MODE_TIMEOUT_MS;
}

void takt_drives_enter_enabled(struct drives *d)
{
    TAKT_ASSERT(d->state == DRIVES_STARTING);
    d->state = DRIVES_ENABLED;
    for (unsigned i = 0; i < d->count; i++)
        for (unsigned k = 0; k < DRIVES_HISTORY; k++)
            d->sent_mm[k][i] = d->axis[i].actual_mm;
}

/*
 * A drive whose brake opens may show "operation enabled", and that it does not follow yet; older
 * ones never show it.
 */
static bool may_follow(const struct drives *d, const struct drives_axis *axis)
{
    bool is_cyclic = axis->mode == CIA402_MODE_CYCLIC_SYNC_POSITION ||
                     axis->mode == CIA402_MODE_CYCLIC_SYNC_VELOCITY;
    return !is_cyclic || axis->statusword & CIA402_FOLLOWS_TARGET || is_late(d);
}

/* Interpolated position mode follows targets from controlword bit 4 on. */
static bool follows(const struct drives *d, struct drives_axis *axis)
{
    const uint16_t told = CIA402_ENABLE_OPERATION | CIA402_INTERPOLATE;
    if (axis->mode != CIA402_MODE_INTERPOLATED_POSITION)
        return may_follow(d, axis);
    axis->command = CIA402_INTERPOLATE;
    return axis->controlword == told && axis->statusword & CIA402_INTERPOLATES;
}

void takt_drives_follow(struct drives *d)
{
    bool all = true;
    takt_drives_check_all_links(d);
    for (unsigned i = 0; i < d->count && d->state == DRIVES_STARTING; i++) {
        bool is_following = follows(d, &d->axis[i]);
        if (!is_following && is_late(d))
            takt_drives_raise(d, i, TAKT_ERROR_DRIVE_MODE, d->axis[i].mode, NULL);
        all = all && is_following;
    }
    if (all && d->state == DRIVES_STARTING)
        takt_drives_begin_square(d);
}

/* All show their modes: those that are to be homed begin; without any the drives are ready. */
static void begin_homing(struct drives *d)
{
    bool is_any = false;
    for (unsigned i = 0; i < d->count; i++) {
        struct drives_axis *axis = &d->axis[i];
        if (axis->mode != CIA402_MODE_HOMING)
            continue;
        is_any = true;
        axis->command = CIA402_START_HOMING;
        axis->homed = false;
        axis->attained_cycles = 0;
    }
    takt_drives_enter_phase(d, is_any ? DRIVES_HOME : DRIVES_FOLLOW);
    if (!is_any)
        takt_drives_follow(d);
}

/* The drive shows its mode, or cannot. */
static bool shows_mode(struct drives *d)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    TAKT_ASSERT(d->at_axis < d->count || d->sdo.result == SDO_IDLE);
    if (d->sdo.result == SDO_ABORTED)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_MODE_DISPLAY);
    return d->sdo.result == SDO_ABORTED ||
           (d->sdo.result == SDO_DONE && (uint8_t)takt_sdo_client_number(&d->sdo) == axis->mode);
}

/* The question or its answer has got lost: it is asked again, and then the drive is lost. */
static void miss_mode(struct drives *d)
{
    TAKT_ASSERT(d->at_axis < d->count && d->repeats <= DRIVES_SDO_REPEATS);
    if (d->repeats++ == DRIVES_SDO_REPEATS)
        takt_drives_raise_object(d, d->at_axis, d->sdo.object, TAKT_ERROR_DRIVE_UNANSWERED,
                                 takt_drives_cycles_ms(d, d->sdo_timeout_cycles), NULL);
}

/*
 * Modes are not in the statusword: object 6061 is read, of one drive after the other, until it
 * agrees.
 */
void takt_drives_select(struct drives *d)
{
    const uint32_t object = SDO_OBJECT(CIA402_MODE_DISPLAY >> 16, 0);
    takt_drives_check_all_links(d);
    if (d->state != DRIVES_STARTING)
        return;
    if (d->is_telling || sdo_client_is_busy(&d->sdo)) {
        if (d->is_telling && is_late(d))
            takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_MODE, d->axis[d->at_axis].mode, NULL);
        return;
    }
    if (shows_mode(d)) {
        d->at_axis++;
        d->repeats = 0;
        d->phase_cycles = 0;
    } else if (d->sdo.result == SDO_UNANSWERED) {
        miss_mode(d);
    } else {
        d->repeats = 0;
        if (is_late(d))
            takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_MODE, d->axis[d->at_axis].mode, NULL);
    }
    if (d->state != DRIVES_STARTING)
        return;
    if (d->at_axis == d->count)
        begin_homing(d);
    else if (takt_drives_tells_mode(&d->axis[d->at_axis]))
        d->sdo.result = SDO_IDLE;
    else
        takt_drives_ask(d, drives_bus_of(d, d->at_axis), d->node[d->at_axis],
                        &(struct drives_step){.object = object});
}

/*
 * Farthest from its home that a drive stands when it has braked from there, mm: v^2 / (2 a) of the
 * faster velocity.
 */
static double overshoot_mm(const struct drives_config_axis *config)
{
    const struct drives_homing *homing = &config->homing;
    double v = maths_max(homing->velocity_mm_s, homing->zero_mm_s);
    return v * v / (2 * homing->acceleration_mm_s2) + 1 / maths_abs(config->increments_per_mm);
}

/* Its home is where it should be, but for the sign. */
static bool is_mirrored(const struct drives_axis *axis)
{
    double offset_mm = axis->config.homing.offset_mm;
    double most_mm = overshoot_mm(&axis->config);
    double actual_mm = axis->actual_mm;
    return maths_abs(actual_mm + offset_mm) <= most_mm &&
           maths_abs(actual_mm - offset_mm) > most_mm;
}

static void take_home(struct drives *d, unsigned index)
{
    struct drives_axis *axis = &d->axis[index];
    TAKT_ASSERT(index < d->count && !d->axis[index].homed);
    axis->homed = true;
    if (is_mirrored(axis))
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_HOME_OFFSET,
                          takt_drives_axis_shown(axis, axis->actual_mm), NULL);
}

static bool lasts(const struct drives *d, uint32_t cycles)
{
    return takt_drives_cycles_ms(d, cycles) >= HOMING_SHOWN_MS;
}

static void follow_homing(struct drives *d, unsigned index)
{
    struct drives_axis *axis = &d->axis[index];
    bool is_told = axis->controlword == (CIA402_ENABLE_OPERATION | CIA402_START_HOMING);
    TAKT_ASSERT(index < d->count);
    if (!is_told || !(axis->statusword & CIA402_HOMING_ATTAINED))
        axis->attained_cycles = 0;
    else if (axis->statusword & CIA402_TARGET_REACHED)
        axis->attained_cycles++;
    if (is_told && lasts(d, d->phase_cycles) && axis->statusword & CIA402_HOMING_ERROR)
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_HOMING, axis->statusword, NULL);
    else if (d->phase_cycles > axis->config.homing.timeout_cycles)
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_HOMING_SLOW,
                          1e-3 * takt_drives_cycles_ms(d, axis->config.homing.timeout_cycles),
                          NULL);
    else if (lasts(d, axis->attained_cycles))
        take_home(d, index);
}

void takt_drives_home(struct drives *d)
{
    bool all = true;
    takt_drives_check_all_links(d);
    for (unsigned i = 0; i < d->count && d->state == DRIVES_STARTING; i++) {
        if (d->axis[i].mode != CIA402_MODE_HOMING)
            continue;
        if (!d->axis[i].homed)
            follow_homing(d, i);
        all = all && d->axis[i].homed;
    }
    if (all && d->state == DRIVES_STARTING)
        takt_drives_home_next(d);
}

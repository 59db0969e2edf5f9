/*
 * What the master asks a drive before it is started, and what it tells it beside its process data
 * (drives_map.c): who it is, in which mode it follows targets, how it is scaled; when its heartbeat
 * is due, how it stops, how it finds its home.
 *
 * Hardly anything of that is required. What a drive refuses to be told is read, for it may be so
 * already; if it is not, it is given up (enum drives_given_up), or the one thing that cannot be
 * done without is a fault.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/objects.h"
#include "canopen/sync.h"
#include "drive/drives_private.h"

#include <stddef.h>

#define UINT32_LIMIT 4294967295.0
#define INT32_LIMIT  2147483647.0

void takt_drives_give_up(struct drives *d, unsigned index, enum drives_given_up what)
{
    TAKT_ASSERT(index < d->count);
    d->axis[index].given_up |= 1u << what;
}

static void raise_refusal(struct drives *d, uint32_t object, uint32_t abort_code)
{
    takt_drives_raise_object(d, d->at_axis, object, TAKT_ERROR_DRIVE_REFUSES, abort_code,
                             takt_sdo_abort_text(abort_code));
}

/* ---- What it is asked ---- */

#define ASKED_MODES   5
#define ASKED_SCALING 6 /* from here on: only where it is checked */
static const uint32_t asked[] = {
    SDO_OBJECT(OBJECT_DEVICE_TYPE, 0),        SDO_OBJECT(OBJECT_IDENTITY, 1),
    SDO_OBJECT(OBJECT_IDENTITY, 2),           SDO_OBJECT(OBJECT_IDENTITY, 3),
    SDO_OBJECT(OBJECT_IDENTITY, 4),           SDO_OBJECT(CIA402_SUPPORTED_MODES, 0),
    SDO_OBJECT(CIA402_ENCODER_RESOLUTION, 1), SDO_OBJECT(CIA402_ENCODER_RESOLUTION, 2),
    SDO_OBJECT(CIA402_GEAR_RATIO, 1),         SDO_OBJECT(CIA402_GEAR_RATIO, 2),
    SDO_OBJECT(CIA402_FEED_CONSTANT, 1),      SDO_OBJECT(CIA402_FEED_CONSTANT, 2),
};
#define ASKED_COUNT (sizeof asked / sizeof asked[0])

bool takt_drives_next_ask(struct drives *d, struct drives_step *step)
{
    bool checks_scaling = d->axis[d->at_axis].config.travel_per_turn_mm > 0;
    TAKT_ASSERT(d->at_axis < d->count);
    if (d->at_step == (checks_scaling ? ASKED_COUNT : ASKED_SCALING))
        return false;
    *step = (struct drives_step){.object = asked[d->at_step]};
    return true;
}

/*
 * A node of another type is a drive all the same, if it tells modes or names no profile: see
 * take_modes.
 */
static void take_type(struct drives *d, const struct drives_answer *answer)
{
    const bool is_told = answer->abort_code == SDO_ABORT_NONE;
    d->read[0] = is_told ? answer->value : 0;
    if ((d->read[0] & OBJECT_DEVICE_PROFILE_MASK) != OBJECT_DEVICE_PROFILE_402)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_TYPE);
}

static void take_identity(struct drives *d, const struct drives_answer *answer)
{
    static const char *const texts[] = {
        "vendor id, object 1018:01,", "product code, object 1018:02,", "revision, object 1018:03,",
        "serial number, object 1018:04,"};
    const struct drives_identity *identity = &d->axis[d->at_axis].config.identity;
    const uint32_t expected[] = {identity->vendor, identity->product, identity->revision,
                                 identity->serial};
    const unsigned part = d->at_step - 1u;
    if (expected[part] == 0 ||
        (answer->abort_code == SDO_ABORT_NONE && answer->value == expected[part]))
        return;
    if (answer->abort_code != SDO_ABORT_NONE)
        raise_refusal(d, asked[d->at_step], answer->abort_code);
    else
        takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_IDENTITY, answer->value, texts[part]);
}

static uint16_t mode_bit(unsigned mode)
{
    TAKT_ASSERT(mode >= 1 && mode <= 16);
    return (uint16_t)(1u << (mode - 1));
}

/* Device profiles are CiA 400 to 499. */
static bool is_something_else(uint32_t type)
{
    const uint32_t profile = type & OBJECT_DEVICE_PROFILE_MASK;
    return profile >= 400 && profile <= 499 && profile != OBJECT_DEVICE_PROFILE_402;
}

/*
 * The best mode it has; one that does not tell is tried in cyclic synchronous position, and if it
 * has no target position in profile velocity, unless it is something else.
 */
static void take_modes(struct drives *d, const struct drives_answer *answer)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    const char *missing = NULL;
    axis->modes = (uint16_t)answer->value;
    if (answer->abort_code != SDO_ABORT_NONE || answer->value == 0) {
        axis->modes = mode_bit(CIA402_MODE_CYCLIC_SYNC_POSITION) |
                      mode_bit(CIA402_MODE_PROFILE_VELOCITY) | mode_bit(CIA402_MODE_HOMING);
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_MODES);
        if (is_something_else(d->read[0]))
            takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_TYPE, d->read[0], NULL);
    }
    axis->follow_mode = takt_drives_mode_after(axis, CIA402_MODE_NONE);
    if (axis->follow_mode == CIA402_MODE_NONE)
        missing = "cyclic position or velocity";
    else if (axis->config.homing.order != 0 && !(axis->modes & mode_bit(CIA402_MODE_HOMING)))
        missing = "homing";
    if (missing != NULL)
        takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_MODES, answer->value, missing);
}

/*
 * Position units in a turn of the motor, CiA 402-2, 6091 and 6092; by an encoder alone where there
 * is no feed constant:
 *     units = feed / shaft turns * shaft turns / motor turns      or      increments / motor turns
 * 0: the drive does not tell. Its objects are whole numbers: *rounding is what half a unit of the
 * first makes of units.
 */
static double units_per_turn(const uint32_t read[6], double *rounding)
{
    const uint32_t *const encoder = read, *const gear = read + 2, *const feed = read + 4;
    bool has_feed = feed[0] != 0 && feed[1] != 0;
    const uint32_t *const scale = has_feed ? feed : encoder;
    double units = 0;
    if (scale[0] == 0 || scale[1] == 0)
        return 0;
    units = (double)scale[0] / scale[1];
    if (has_feed && gear[0] != 0 && gear[1] != 0)
        units = units * gear[1] / gear[0];
    *rounding = 0.5 * units / scale[0];
    return units;
}

static void check_scaling(struct drives *d)
{
    const struct drives_config_axis *config = &d->axis[d->at_axis].config;
    double expected = maths_abs(config->increments_per_mm) * config->travel_per_turn_mm;
    double rounding = 0;
    double units = units_per_turn(d->read, &rounding);
    if (units <= 0) {
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_SCALING);
    } else if (maths_abs(units - expected) > rounding) {
        takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_SCALING, units, NULL);
        takt_diagnostic_set_limit(&d->fault, expected);
    }
}

void takt_drives_take_ask(struct drives *d, const struct drives_answer *answer)
{
    TAKT_ASSERT(d->at_axis < d->count);
    if (d->at_step == 0)
        take_type(d, answer);
    else if (d->at_step < ASKED_MODES)
        take_identity(d, answer);
    else if (d->at_step == ASKED_MODES)
        take_modes(d, answer);
    else
        d->read[d->at_step - ASKED_SCALING] =
            answer->abort_code == SDO_ABORT_NONE ? answer->value : 0;
    d->at_step++;
    if (d->at_step == ASKED_COUNT)
        check_scaling(d);
}

/* ---- What it is told ---- */

#define REQUIRED  DRIVES_GIVEN_UP_COUNT
#define NOTHING   (DRIVES_GIVEN_UP_COUNT + 1)
#define SET_PLAIN 16 /* from here on: only where the axis is homed */

struct setting {
    uint16_t index;
    uint8_t sub, length;
    uint8_t given_up; /* if it is not so; REQUIRED: a fault */
};

#define SET_HEARTBEAT 0
#define SET_GUARD     2 /* and the life time factor: only where there is no heartbeat */
#define SET_LIFE      3
#define SET_SYNC      4
#define SET_PERIOD    8
#define SET_EXPONENT  9
#define SET_AGAIN     10 /* the period, in the unit that the drive keeps */
#define SET_RAMPS     14 /* up and down: only of profile velocity */
static const struct setting settings[] = {
    {OBJECT_PRODUCER_HEARTBEAT, 0, 2, DRIVES_NO_HEARTBEAT},
    {OBJECT_CONSUMER_HEARTBEAT, 1, 4, DRIVES_NO_WATCH},
    {OBJECT_GUARD_TIME, 0, 2, NOTHING},
    {OBJECT_LIFE_TIME_FACTOR, 0, 1, NOTHING},
    {OBJECT_SYNC_COB_ID, 0, 4, REQUIRED},
    {OBJECT_SYNC_PERIOD, 0, 4, NOTHING}, /* 1019 is taken while that is 0 alone */
    {OBJECT_SYNC_OVERFLOW, 0, 1, NOTHING},
    {OBJECT_SYNC_PERIOD, 0, 4, DRIVES_NO_SYNC_PERIOD},
    {CIA402_INTERPOLATION_PERIOD, 1, 1, DRIVES_NO_PERIOD},
    {CIA402_INTERPOLATION_PERIOD, 2, 1, DRIVES_NO_PERIOD},
    {CIA402_INTERPOLATION_PERIOD, 1, 1, DRIVES_NO_PERIOD},
    {CIA402_CONNECTION_OPTION, 0, 2, DRIVES_NO_STOP_OPTION},
    {CIA402_QUICK_STOP_OPTION, 0, 2, DRIVES_NO_STOP_OPTION},
    {CIA402_FAULT_OPTION, 0, 2, DRIVES_NO_STOP_OPTION},
    {CIA402_PROFILE_ACCELERATION, 0, 4, DRIVES_NO_RAMPS},
    {CIA402_PROFILE_DECELERATION, 0, 4, DRIVES_NO_RAMPS},
    {CIA402_HOMING_METHOD, 0, 1, REQUIRED},
    {CIA402_HOMING_SPEEDS, 1, 4, DRIVES_NO_HOMING_SPEED},
    {CIA402_HOMING_SPEEDS, 2, 4, DRIVES_NO_HOMING_SPEED},
    {CIA402_HOMING_ACCELERATION, 0, 4, DRIVES_NO_HOMING_SPEED},
    {CIA402_HOME_OFFSET, 0, 4, REQUIRED},
};
#define SET_COUNT (sizeof settings / sizeof settings[0])

/*
 * Object 60C2: period = value * 10^exponent seconds, the value a byte. The largest unit that is
 * exact; a period that has none is rounded in the smallest unit that holds it.
 */
static void split_period(uint32_t cycle_us, uint32_t *value, int *exponent)
{
    TAKT_ASSERT(cycle_us > 0);
    *value = cycle_us;
    *exponent = -6;
    while (*value % 10 == 0 || *value > UINT8_MAX) {
        *value = (*value + 5) / 10;
        ++*exponent;
    }
}

/* of an int8 */
static int exponent_of(uint32_t raw)
{
    return (int)(raw & 0x7F) - (int)(raw & 0x80);
}

/* The nearest value in a unit of the drive's own; such a unit is between 1 us and 1 s. */
static uint32_t period_in(uint32_t cycle_us, int exponent)
{
    double value = cycle_us;
    for (; exponent > -6; exponent--)
        value /= 10;
    return (uint32_t)maths_clamp(takt_maths_round(value), 1, UINT8_MAX);
}

/* units = round(value * velocity_units_per_mm_s) of a velocity or an acceleration. */
static uint32_t velocity_of(const struct drives_config_axis *config, double value_mm_s)
{
    double units = takt_maths_round(value_mm_s * maths_abs(config->velocity_units_per_mm_s));
    return (uint32_t)maths_clamp(units, 0, UINT32_LIMIT);
}

/*
 * Ramps of profile velocity: twice as steep as setpoints are, so that they do not round these off,
 * and leave as much to the position loop.
 */
static uint32_t ramp_of(const struct drives_config_axis *config)
{
    return velocity_of(config, 2 * config->max_acceleration_mm_s2);
}

/*
 * CiA 402: zero = home + home offset. So the offset is minus the coordinate that home is to have.
 * There are drives whose position at home is the offset.
 */
static uint32_t home_offset_of(const struct drives_config_axis *config)
{
    const struct drives_homing *homing = &config->homing;
    double offset_mm = homing->offset_is_position ? homing->offset_mm : -homing->offset_mm;
    double offset_inc = takt_maths_round(offset_mm * config->increments_per_mm);
    return (uint32_t)(int32_t)maths_clamp(offset_inc, -INT32_LIMIT, INT32_LIMIT);
}

/* In the order of settings. */
static uint32_t value_of(const struct drives *d, unsigned number)
{
    const struct drives_config_axis *config = &d->axis[d->at_axis].config;
    const struct drives_homing *homing = &config->homing;
    uint32_t lost_ms = (uint32_t)d->heartbeat_ms * DRIVES_HEARTBEATS_LOST;
    uint32_t period;
    int exponent;
    split_period(d->cycle_us, &period, &exponent);
    const uint32_t values[] = {d->heartbeat_ms,
                               (uint32_t)d->controller_node << 16 | lost_ms,
                               takt_drives_guard_ms(d),
                               DRIVES_HEARTBEATS_LOST,
                               SYNC_COB_ID,
                               0,
                               0,
                               d->cycle_us,
                               period,
                               (uint8_t)exponent,
                               period_in(d->cycle_us, exponent_of(d->read[1])),
                               CIA402_CONNECTION_QUICK_STOP,
                               CIA402_OPTION_QUICK_STOP_RAMP,
                               CIA402_OPTION_QUICK_STOP_RAMP,
                               ramp_of(config),
                               ramp_of(config),
                               (uint8_t)homing->method,
                               velocity_of(config, homing->velocity_mm_s),
                               velocity_of(config, homing->zero_mm_s),
                               velocity_of(config, homing->acceleration_mm_s2),
                               home_offset_of(config)};
    _Static_assert(sizeof values / sizeof values[0] == SET_COUNT, "a value of every setting");
    return values[number];
}

/* It shall have a heartbeat and has none, whatever the reason. */
static bool is_mute(const struct drives *d)
{
    return drives_has_given_up(&d->axis[d->at_axis], DRIVES_NO_HEARTBEAT) && d->read[0] == 0 &&
           d->heartbeat_ms > 0;
}

static void take_back(struct drives *d, enum drives_given_up what)
{
    d->axis[d->at_axis].given_up &= ~(1u << what);
}

static void raise_period(struct drives *d, double period_us)
{
    takt_drives_raise(d, d->at_axis, TAKT_ERROR_DRIVE_PERIOD, period_us, NULL);
    takt_diagnostic_set_limit(&d->fault, d->cycle_us);
}

/*
 * A drive that keeps a time between targets of its own makes its motion of it: a longer one lags
 * behind, a shorter one stops between targets. With 0 it takes the time as it comes.
 */
static void check_period(struct drives *d)
{
    double period_us = (uint8_t)d->read[0];
    int exponent = exponent_of(d->read[1]);
    for (; exponent < -6; exponent++)
        period_us /= 10;
    for (; exponent > -6; exponent--)
        period_us *= 10;
    bool is_used = d->axis[d->at_axis].follow_mode != CIA402_MODE_PROFILE_VELOCITY;
    if (maths_abs(period_us - d->cycle_us) <= 0.5)
        take_back(d, DRIVES_NO_PERIOD);
    else if (is_used && period_us > 0)
        raise_period(d, period_us);
}

/* Whether the value is to be told in another unit; else what the drive has is looked at. */
static bool has_unit_of_its_own(struct drives *d)
{
    const bool is_known = d->read[2] + d->read[3] == 0;
    const bool is_otherwise =
        is_known && drives_has_given_up(&d->axis[d->at_axis], DRIVES_NO_PERIOD);
    if (is_otherwise && d->read[1] != (value_of(d, SET_EXPONENT) & 0xFF))
        return true;
    if (is_otherwise)
        check_period(d);
    return false;
}

bool takt_drives_next_set(struct drives *d, struct drives_step *step)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    TAKT_ASSERT(d->at_axis < d->count);
    if (d->at_step == SET_GUARD && !is_mute(d))
        d->at_step = SET_LIFE + 1;
    if (d->at_step == SET_AGAIN && !has_unit_of_its_own(d))
        d->at_step++;
    if (d->at_step == SET_RAMPS && axis->follow_mode != CIA402_MODE_PROFILE_VELOCITY)
        d->at_step = SET_PLAIN;
    if (d->at_step == (axis->config.homing.order != 0 ? SET_COUNT : SET_PLAIN))
        return false;
    const struct setting *setting = &settings[d->at_step];
    d->is_looking = d->is_looking || axis->config.keeps_settings;
    *step = (struct drives_step){.object = SDO_OBJECT(setting->index, setting->sub),
                                 .length = d->is_looking ? 0 : setting->length,
                                 .value = value_of(d, d->at_step)};
    return true;
}

/* Ramps that round setpoints off let the axis lag behind. */
static bool is_too_slow(const struct drives *d, const struct drives_answer *answer)
{
    const struct drives_config_axis *config = &d->axis[d->at_axis].config;
    return settings[d->at_step].given_up == DRIVES_NO_RAMPS &&
           answer->abort_code == SDO_ABORT_NONE &&
           answer->value < velocity_of(config, config->max_acceleration_mm_s2);
}

/*
 * The drive has this value, and ours is another, or it could not be read. Without an object there
 * is nothing to be done where that is as good: 0, or the identifier that SYNC has without it.
 */
static void miss(struct drives *d, const struct drives_answer *answer)
{
    const struct setting *setting = &settings[d->at_step];
    bool is_absent = sdo_says_absent(answer->abort_code);
    bool is_required = setting->given_up == REQUIRED || is_too_slow(d, answer);
    TAKT_ASSERT(d->at_step < sizeof settings / sizeof settings[0]);
    if (setting->given_up == NOTHING)
        return;
    if (!is_required)
        takt_drives_give_up(d, d->at_axis, (enum drives_given_up)setting->given_up);
    else if (!is_absent || (value_of(d, d->at_step) != 0 && d->at_step != SET_SYNC))
        raise_refusal(d, SDO_OBJECT(setting->index, setting->sub),
                      answer->abort_code != SDO_ABORT_NONE ? answer->abort_code : SDO_ABORT_VALUE);
}

/*
 * What stands in for a heartbeat. read: 1017; then 100C, 0 where there is none, and the time after
 * which the drive takes us for lost, 100C times 100D. Where that is too short the drive is better
 * left alone.
 */
static void take_guard(struct drives *d, uint32_t factor)
{
    const uint32_t life_ms = d->read[1] * factor;
    struct drives_guard *guard = &d->axis[d->at_axis].guard;
    guard->is_on = d->read[1] > 0 && drives_guards_in_time(d, life_ms);
    if (!guard->is_on)
        return;
    take_back(d, DRIVES_NO_HEARTBEAT);
    takt_drives_give_up(d, d->at_axis, DRIVES_GUARDED);
    if (life_ms > 0)
        take_back(d, DRIVES_NO_WATCH);
}

/* What the drive has: read after a refusal, else what it has been told. */
static void take_period(struct drives *d, const struct drives_answer *answer, uint32_t value)
{
    unsigned part = d->at_step == SET_EXPONENT;
    d->read[part] = value;
    d->read[2 + part] = answer->abort_code != SDO_ABORT_NONE;
    if (d->at_step == SET_AGAIN)
        check_period(d);
}

/* What the drive has now, 0 where it has no such object. */
static void take_kept(struct drives *d, uint32_t value)
{
    switch (d->at_step) {
    case SET_HEARTBEAT:
        d->read[0] = value;
        break;
    case SET_GUARD:
        d->read[1] = value;
        break;
    case SET_LIFE:
        take_guard(d, value);
        break;
    default:
        break;
    }
}

/* Bit 31 of the identifier of SYNC has no meaning. */
static uint32_t mask_of(const struct setting *setting)
{
    if (setting->index == OBJECT_SYNC_COB_ID)
        return INT32_MAX;
    return setting->length == 4 ? UINT32_MAX : (1u << 8 * setting->length) - 1;
}

void takt_drives_take_set(struct drives *d, const struct drives_answer *answer)
{
    const struct setting *setting = &settings[d->at_step];
    uint32_t wanted = value_of(d, d->at_step) & mask_of(setting);
    bool is_refused = answer->abort_code != SDO_ABORT_NONE;
    TAKT_ASSERT(d->at_axis < d->count && d->at_step < sizeof settings / sizeof settings[0]);
    if (!d->is_looking && is_refused && !sdo_says_absent(answer->abort_code)) {
        d->is_looking = true;
        return;
    }
    uint32_t value = d->is_looking ? answer->value & mask_of(setting) : wanted;
    if (is_refused || value != wanted)
        miss(d, answer);
    take_kept(d, is_refused ? 0 : value);
    if (d->at_step >= SET_PERIOD && d->at_step <= SET_AGAIN)
        take_period(d, answer, value);
    d->is_looking = false;
    d->at_step++;
}

/*
 * Values of the objects that the machine makes at power-on, and what motion needs to know of the
 * settings.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

#include <string.h>

#define PDO_NOT_VALID 0x80000000u

/* Object 607E. */
#define POLARITY_POSITION 0x80u
#define POLARITY_VELOCITY 0x40u
#define POLARITY_TORQUE   0x20u

#define NOT_WATCHED UINT32_MAX /* windows of position and following error */

/* Turns of the motor per second, and per second squared, a drive starts with. */
#define DEFAULT_PROFILE_TURNS_S       5.0
#define DEFAULT_PROFILE_TURNS_S2      50.0
#define DEFAULT_PROFILE_TURNS_S3      1000.0
#define DEFAULT_MAX_TURNS_S           50.0
#define DEFAULT_HOMING_TURNS_S        2.0
#define DEFAULT_HOMING_SLOW_TURNS_S   0.2
#define DEFAULT_HOMING_TURNS_S2       20.0
#define DEFAULT_POSITION_WINDOW_TURNS 1e-3
#define DEFAULT_VELOCITY_TURNS_S      0.05 /* window and threshold */
#define DEFAULT_CYCLE_US              1000

static uint32_t unsigned_round(double value)
{
    return (uint32_t)maths_clamp(takt_maths_round(value), 0, (double)UINT32_MAX);
}

static uint32_t unsigned_increments(const struct servo *drive, double value_mm)
{
    return unsigned_round(value_mm * servo_scale(drive));
}

/* A velocity or an acceleration as objects tell it. */
static uint32_t unsigned_velocity(const struct servo *drive, double value_mm_s)
{
    return unsigned_round(value_mm_s * servo_velocity_scale(drive));
}

/* The period as 60C2 tells it: the fewest microseconds that fit, exactly where they do. */
static void set_interpolation_period(struct drive_settings *s, uint32_t cycle_us)
{
    uint32_t period = cycle_us != 0 ? cycle_us : DEFAULT_CYCLE_US;
    int8_t index = -6;
    while (index < 0 && (period > UINT8_MAX || period % 10 == 0)) {
        period = period / 10;
        index++;
    }
    s->interpolation_period = (uint8_t)period;
    s->interpolation_index = index;
}

static bool has_object(const struct servo *drive, unsigned index, uint8_t sub)
{
    bool has_index;
    return takt_dictionary_find(drive->dictionary, (uint16_t)index, sub, &has_index) != NULL;
}

/* Values of a data sheet, and PDOs that it has. */
static void take_data_sheet(struct servo *drive)
{
    struct drive_communication *c = &drive->objects.communication;
    takt_dictionary_set_initial(drive->dictionary, DICTIONARY_NOT_OF_MACHINE, &drive->objects,
                                drive->config.node);
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++) {
        if (!has_object(drive, 0x1400 + i, 1) || !has_object(drive, 0x1600 + i, 0))
            c->rpdo[i].cob_id |= PDO_NOT_VALID;
        if (!has_object(drive, 0x1800 + i, 1) || !has_object(drive, 0x1A00 + i, 0))
            c->tpdo[i].cob_id |= PDO_NOT_VALID;
    }
}

/* What is 1 of object 2020: g mm2, mHz, us, thousandths. */
#define INERTIA_PER_KG_M2  1e9
#define THOUSANDTHS        1e3
#define MICROSECONDS_PER_S 1e6

/* Object 2020, as far as its numbers can say it. */
static void set_loops(struct drive_settings *s, const struct servo_loop_config *loop)
{
    const double told_kg_m2 =
        loop->told_inertia_kg_m2 > 0 ? loop->told_inertia_kg_m2 : loop->inertia_kg_m2;
    s->told_inertia = unsigned_round(maths_max(INERTIA_PER_KG_M2 * told_kg_m2, 1));
    s->velocity_bandwidth = unsigned_round(maths_max(THOUSANDTHS * loop->velocity_bandwidth_hz, 1));
    s->velocity_integral = unsigned_round(MICROSECONDS_PER_S * loop->velocity_integral_time_s);
    s->position_gain = unsigned_round(maths_max(THOUSANDTHS * loop->position_gain_per_s, 1));
    s->velocity_feed_forward =
        (uint16_t)unsigned_round(THOUSANDTHS * loop->velocity_feed_forward_ratio);
    s->torque_feed_forward =
        (uint16_t)unsigned_round(THOUSANDTHS * loop->torque_feed_forward_ratio);
}

/* What the machine makes of the initial values: everything that is counted in increments. */
void takt_servo_init_objects(struct servo *drive)
{
    const struct servo_config *config = &drive->config;
    struct drive_objects *o = &drive->objects;
    double turn_mm = config->loop.travel_per_revolution_mm;
    memset(o, 0, sizeof *o);
    takt_dictionary_set_initial(&takt_dictionary_own, DICTIONARY_ALL, o, drive->config.node);
    drive->increments_per_mm = drive->config.increments_per_mm;
    o->identity.serial = drive->config.node;
    o->identity.encoder_counts = config->loop.encoder_counts_per_revolution;
    o->settings.following_window =
        config->following_error_window_mm > 0
            ? unsigned_increments(drive, config->following_error_window_mm)
            : NOT_WATCHED;
    o->settings.following_timeout_ms = (uint16_t)config->following_error_timeout_ms;
    o->settings.quick_stop_deceleration =
        unsigned_velocity(drive, config->quick_stop_deceleration_mm_s2);
    o->settings.position_window =
        unsigned_increments(drive, DEFAULT_POSITION_WINDOW_TURNS * turn_mm);
    o->settings.max_profile_velocity = unsigned_velocity(drive, DEFAULT_MAX_TURNS_S * turn_mm);
    o->settings.profile_velocity = unsigned_velocity(drive, DEFAULT_PROFILE_TURNS_S * turn_mm);
    o->settings.profile_acceleration = unsigned_velocity(drive, DEFAULT_PROFILE_TURNS_S2 * turn_mm);
    o->settings.profile_deceleration = o->settings.profile_acceleration;
    o->settings.profile_jerk = unsigned_velocity(drive, DEFAULT_PROFILE_TURNS_S3 * turn_mm);
    o->settings.homing_velocity[0] = unsigned_velocity(drive, DEFAULT_HOMING_TURNS_S * turn_mm);
    o->settings.homing_velocity[1] =
        unsigned_velocity(drive, DEFAULT_HOMING_SLOW_TURNS_S * turn_mm);
    o->settings.homing_acceleration = unsigned_velocity(drive, DEFAULT_HOMING_TURNS_S2 * turn_mm);
    o->settings.feed_increments = unsigned_increments(drive, turn_mm);
    o->settings.velocity_window = o->settings.velocity_threshold = (uint16_t)maths_min(
        unsigned_velocity(drive, DEFAULT_VELOCITY_TURNS_S * turn_mm), UINT16_MAX);
    o->settings.max_torque =
        (uint16_t)maths_clamp(takt_maths_round(TORQUE_PER_RATED * config->loop.torque_max_nm /
                                               config->loop.torque_rated_nm),
                              0, UINT16_MAX);
    set_interpolation_period(&o->settings, drive->config.cycle_us);
    set_loops(&o->settings, &config->loop);
    if (drive->dictionary != &takt_dictionary_own)
        take_data_sheet(drive);
}

/*
 * Object 607E has been changed in this bit; as it was at power-on it is part of what the machine
 * says.
 */
static bool is_turned(const struct servo *drive, unsigned bit)
{
    return (drive->objects.settings.polarity ^ drive->initial.settings.polarity) & bit;
}

/*
 * Increments are what objects 6091 and 6092 make of a turn of the motor:
 *     increments/turn = feed / feed_shaft_turns * gear_shaft_turns / gear_motor_turns
 * As they were at power-on they stand for what the machine says, which need not be a whole number.
 */
static void rescale(struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    const struct drive_settings *initial = &drive->initial.settings;
    double turn = (double)s->feed_increments / s->feed_shaft * s->gear_shaft / s->gear_motor;
    double polarity = is_turned(drive, POLARITY_POSITION) ? -1 : 1;
    bool is_initial = s->feed_increments == initial->feed_increments &&
                      s->feed_shaft == initial->feed_shaft &&
                      s->gear_motor == initial->gear_motor && s->gear_shaft == initial->gear_shaft;
    double increments_per_mm =
        is_initial ? drive->config.increments_per_mm
                   : servo_sign(drive) * turn / drive->config.loop.travel_per_revolution_mm;
    drive->increments_per_mm = polarity * increments_per_mm;
}

/*
 * A value of the machine that its object could not hold is used as long as nobody has changed it.
 */
static double in_mm(const struct servo *drive, uint32_t value, uint32_t initial, double machine,
                    double per_mm)
{
    bool is_initial = value == initial && maths_abs(drive->increments_per_mm) ==
                                              maths_abs(drive->config.increments_per_mm);
    return is_initial ? machine : value / per_mm;
}

/* period = 60C2:01 10^60C2:02 seconds */
static uint64_t interpolation_ns(const struct drive_settings *s)
{
    uint64_t ns = s->interpolation_period * UINT64_C(1000);
    for (int exponent = -6; exponent < s->interpolation_index; exponent++)
        ns *= 10;
    return ns;
}

static double sign_of(const struct servo *drive, unsigned bit)
{
    return is_turned(drive, bit) ? -servo_sign(drive) : servo_sign(drive);
}

static void derive_signs(struct servo *drive)
{
    drive->velocity_sign = sign_of(drive, POLARITY_VELOCITY);
    drive->torque_sign = sign_of(drive, POLARITY_TORQUE);
}

/* Object 6072. As at power-on it stands for what the motor has. */
void takt_servo_derive_torque(struct servo *drive)
{
    const uint16_t max_torque = drive->objects.settings.max_torque;
    bool is_initial = max_torque == drive->initial.settings.max_torque;
    drive->loop.torque_limit_mm_s2 =
        is_initial ? drive->loop.acceleration_max_mm_s2
                   : max_torque / TORQUE_PER_RATED * drive->loop.mm_s2_per_rated;
}

/* A number of the machine is used as long as its object is what it was made of it. */
static double tuned(uint32_t value, uint32_t initial, double machine, double per_unit)
{
    return value == initial ? machine : value / per_unit;
}

void takt_servo_derive_loops(struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    const struct drive_settings *initial = &drive->initial.settings;
    const struct servo_loop_config *machine = &drive->config.loop;
    struct servo_loop_config loop = *machine;
    loop.told_inertia_kg_m2 = tuned(s->told_inertia, initial->told_inertia,
                                    machine->told_inertia_kg_m2, INERTIA_PER_KG_M2);
    loop.velocity_bandwidth_hz = tuned(s->velocity_bandwidth, initial->velocity_bandwidth,
                                       machine->velocity_bandwidth_hz, THOUSANDTHS);
    loop.velocity_integral_time_s = tuned(s->velocity_integral, initial->velocity_integral,
                                          machine->velocity_integral_time_s, MICROSECONDS_PER_S);
    loop.position_gain_per_s =
        tuned(s->position_gain, initial->position_gain, machine->position_gain_per_s, THOUSANDTHS);
    loop.velocity_feed_forward_ratio =
        tuned(s->velocity_feed_forward, initial->velocity_feed_forward,
              machine->velocity_feed_forward_ratio, THOUSANDTHS);
    loop.torque_feed_forward_ratio = tuned(s->torque_feed_forward, initial->torque_feed_forward,
                                           machine->torque_feed_forward_ratio, THOUSANDTHS);
    takt_servo_loop_tune(&drive->loop, &loop);
}

void takt_servo_derive(struct servo *drive)
{
    const struct drive_settings *s = &drive->objects.settings;
    const struct drive_settings *initial = &drive->initial.settings;
    const struct servo_config *config = &drive->config;
    rescale(drive);
    const double per_mm_s = servo_velocity_scale(drive);
    drive->interpolation_ns = interpolation_ns(s);
    drive->following_window_mm = 0;
    if (s->following_window != NOT_WATCHED)
        drive->following_window_mm = in_mm(drive, s->following_window, initial->following_window,
                                           config->following_error_window_mm, servo_scale(drive));
    drive->quick_stop_mm_s2 = maths_min(
        in_mm(drive, s->quick_stop_deceleration, initial->quick_stop_deceleration,
              config->quick_stop_deceleration_mm_s2, per_mm_s),
        in_mm(drive, s->max_deceleration, initial->max_deceleration, MATHS_INFINITY, per_mm_s));
    derive_signs(drive);
    takt_servo_derive_torque(drive);
    takt_servo_derive_loops(drive);
}

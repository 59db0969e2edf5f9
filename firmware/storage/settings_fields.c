#include "storage/settings_fields.h"

#include "base/assert.h"
#include "base/maths.h"
#include "classic/interpolator.h"
#include "classic/limiter.h"
#include "machine/machine.h"
#include "storage/little_words.h"

#include <string.h>

_Static_assert(sizeof(double) == 8, "stored as IEEE-754");

#define DEGREE  (MATHS_PI / 180.0)
#define PPM     1e-6
#define UM_MIN  (1e-3 / 60.0)
#define U32_MAX 4294967295.0

#define ROW(number, of_axis, type, offset, count, least, most, above, name)                        \
    {                                                                                              \
        least, most, name, number, offset, count, type, of_axis, above                             \
    }
#define COUNT(number, field, least, most)                                                          \
    ROW(number, false, SETTINGS_U32, offsetof(struct machine, field), 1, least, most, false, #field)
#define BYTE(number, field, least, most)                                                           \
    ROW(number, false, SETTINGS_U8, offsetof(struct machine, field), 1, least, most, false, #field)
#define FROM(number, field, least, most)                                                           \
    ROW(number, false, SETTINGS_DOUBLE, offsetof(struct machine, field), 1, least, most, false,    \
        #field)
#define ABOVE(number, field, least, most)                                                          \
    ROW(number, false, SETTINGS_DOUBLE, offsetof(struct machine, field), 1, least, most, true,     \
        #field)
#define VECTOR(number, field, count, most)                                                         \
    ROW(number, false, SETTINGS_DOUBLE, offsetof(struct machine, correction.field), count,         \
        -(most), most, false, #field)
#define GANTRY_ROW(number, i, type, field, least, most)                                            \
    ROW(number, false, type, offsetof(struct machine, gantry[i].field), 1, least, most, false,     \
        "gantry." #field)
#define GANTRY(i, axis_number, node, reversed, offset, skew, method, bus)                          \
    GANTRY_ROW(axis_number, i, SETTINGS_U32, axis, 0, AXIS_COUNT),                                 \
        GANTRY_ROW(node, i, SETTINGS_U8, drive_node, 1, 127),                                      \
        GANTRY_ROW(reversed, i, SETTINGS_U8, is_reversed, 0, 1),                                   \
        GANTRY_ROW(offset, i, SETTINGS_DOUBLE, home_offset_mm, -1e6, 1e6),                         \
        GANTRY_ROW(skew, i, SETTINGS_DOUBLE, skew_max_mm, 0, 1e3),                                 \
        GANTRY_ROW(method, i, SETTINGS_I8, home_method, -128, 37),                                 \
        GANTRY_ROW(bus, i, SETTINGS_U8, drive_bus, 0, BUS_MOST)
#define OF_AXIS(number, type, field, least, most, above)                                           \
    ROW(number, true, type, offsetof(struct machine_axis, field), 1, least, most, above, #field)

#define CORRECTION_MOST 1e6

/* Highest bus of any build: takt_machine_check knows how many this one has. */
#define BUS_MOST 255

/* clang-format off */
const struct settings_field takt_settings_fields[] = {
    ROW(1, false, SETTINGS_TEXT, offsetof(struct machine, name), MACHINE_NAME_MAX + 1, 0, 0, false, "name"),
    COUNT(2, cycle_us, 100, 10000),
    ABOVE(3, resolution_per_mm, 0, 1e9),
    FROM(4, path_tolerance_mm, 0, 100),
    COUNT(5, sharp_corners, 0, 1),
    COUNT(6, override_proportional, 0, 1),
    COUNT(7, profile, 0, 2),
    COUNT(8, landing, 0, 2),
    COUNT(9, look_ahead_blocks, 1, MACHINE_LOOK_AHEAD_MAX),
    COUNT(10, interpolator, 0, 2),
    COUNT(11, step_form, 0, 2),
    COUNT(12, limiter, 0, 2),
    FROM(20, spindle_max_rpm, 0, 1e6),
    FROM(21, spindle_load_limit_percent, 0, 1000),
    FROM(22, spindle_at_speed_s, 0, 3600),
    FROM(23, spindle_ramp_rpm_s, 1e-3, 1e9),
    COUNT(24, spindle_encoder_counts, 0, 16777216),
    ABOVE(25, thread_tolerance_mm, 0, 100),
    ABOVE(26, tool_change_s, 0, 3600),
    FROM(27, position_gain_per_s, 0, 1e4),
    COUNT(28, can_data_bitrate, 0, MACHINE_DATA_BITRATE_MAX),
    COUNT(30, can_bitrate, 10000, 1000000),
    COUNT(31, heartbeat_ms, 0, 20000),
    BYTE(32, controller_node, 1, 127),
    BYTE(29, error_pdo, 0, 1),
    COUNT(33, boot_timeout_ms, 1, 600000),
    COUNT(34, sdo_timeout_ms, 1, 600000),
    BYTE(74, interpolator_word_bits, INTERPOLATOR_WORD_BITS_MIN, INTERPOLATOR_WORD_BITS_MAX),
    BYTE(75, interpolator_end_shift, 0, INTERPOLATOR_END_SHIFT_MAX),
    BYTE(76, interpolator_angle_bits, 0, INTERPOLATOR_ANGLE_BITS_MAX),
    GANTRY(0, 36, 37, 38, 39, 60, 61, 77),
    GANTRY(1, 62, 63, 64, 65, 66, 67, 78),
    GANTRY(2, 68, 69, 70, 71, 72, 73, 79),
    ROW(35, false, SETTINGS_BYTES, offsetof(struct machine, io), sizeof(struct io_wiring) * IO_NODES_MAX, 0, 0, false, "io"),

    VECTOR(40, machine, CORRECTION_COORDINATES * CORRECTION_COORDINATES, CORRECTION_MOST),
    VECTOR(41, workpiece, CORRECTION_COORDINATES * CORRECTION_COORDINATES, CORRECTION_MOST),
    VECTOR(42, overhang, CORRECTION_COORDINATES * AXIS_LINEAR_COUNT, CORRECTION_MOST),
    VECTOR(43, setup_offset_mm, AXIS_LINEAR_COUNT, CORRECTION_MOST),
    VECTOR(44, setup_rotation_rad, AXIS_LINEAR_COUNT, CORRECTION_MOST * DEGREE),
    VECTOR(45, setup_pivot_mm, AXIS_LINEAR_COUNT, CORRECTION_MOST),
    VECTOR(46, setup_turn_rad, 1, 360 * DEGREE),
    VECTOR(47, thermal_per_k, AXIS_LINEAR_COUNT, CORRECTION_MOST * PPM),
    VECTOR(48, thermal_reference_mm, AXIS_LINEAR_COUNT, CORRECTION_MOST),
    FROM(49, correction.wear_along_per_mm, 0, 1e4 * PPM),
    FROM(50, correction.wear_along_mm_s, 0, 1e4 * UM_MIN),
    FROM(51, correction.wear_across_per_mm, 0, 1e4 * PPM),
    FROM(52, correction.wear_across_mm_s, 0, 1e4 * UM_MIN),
    ABOVE(53, correction.largest_mm, 0, 100),
    ABOVE(54, correction.steepest_ratio, 0, 0.1),
    ABOVE(55, correction.fade_s, 0, 3600),
    ABOVE(56, correction.reversal_fade_s, 0, 60),
    FROM(57, correction.reserve_ratio, 0, 0.5),
    COUNT(58, correction.turn_axis, AXIS_LINEAR_COUNT, AXIS_COUNT),
    COUNT(59, correction.off, 0, 63),
    VECTOR(80, tool_direction, AXIS_LINEAR_COUNT, CORRECTION_MOST),
    COUNT(81, correction.head_axis, AXIS_LINEAR_COUNT, AXIS_COUNT),

    OF_AXIS(100, SETTINGS_FLAG, rotary, 0, 1, false),
    OF_AXIS(101, SETTINGS_DOUBLE, max_velocity_mm_s, 0, 1e5, true),
    OF_AXIS(102, SETTINGS_DOUBLE, max_acceleration_mm_s2, 0, 1e7, true),
    OF_AXIS(103, SETTINGS_DOUBLE, max_jerk_mm_s3, 0, 1e10, true),
    OF_AXIS(104, SETTINGS_DOUBLE, travel_min_mm, -1e6, 0, false),
    OF_AXIS(105, SETTINGS_DOUBLE, travel_max_mm, 0, 1e6, false),
    OF_AXIS(106, SETTINGS_U8, drive_node, 1, 127, false),
    OF_AXIS(107, SETTINGS_DOUBLE, increments_per_mm, -1e11, 1e11, false),
    OF_AXIS(108, SETTINGS_DOUBLE, following_error_max_mm, 0, 1e6, false),
    OF_AXIS(109, SETTINGS_U32, drive_type, 0, 1, false),
    OF_AXIS(110, SETTINGS_DOUBLE, steps_per_mm, 0, 1e11, true),
    OF_AXIS(111, SETTINGS_DOUBLE, step_rate_max_hz, 0, 1e7, true),
    OF_AXIS(112, SETTINGS_U32, drive_vendor, 0, U32_MAX, false),
    OF_AXIS(113, SETTINGS_U32, drive_product, 0, U32_MAX, false),
    OF_AXIS(114, SETTINGS_U32, drive_revision, 0, U32_MAX, false),
    OF_AXIS(115, SETTINGS_U32, drive_serial, 0, U32_MAX, false),
    OF_AXIS(116, SETTINGS_U8, home_order, 0, 100, false),
    OF_AXIS(117, SETTINGS_I8, home_method, -128, 37, false),
    OF_AXIS(118, SETTINGS_DOUBLE, home_velocity_mm_s, 0, 1e5, true),
    OF_AXIS(119, SETTINGS_DOUBLE, home_zero_velocity_mm_s, 0, 1e5, true),
    OF_AXIS(120, SETTINGS_DOUBLE, home_acceleration_mm_s2, 0, 1e7, true),
    OF_AXIS(121, SETTINGS_DOUBLE, home_offset_mm, -1e6, 1e6, false),
    OF_AXIS(122, SETTINGS_DOUBLE, home_timeout_s, 0, 3600, true),
    OF_AXIS(123, SETTINGS_U8, home_offset_is_position, 0, 1, false),
    OF_AXIS(124, SETTINGS_DOUBLE, travel_per_turn_mm, 0, 1e6, false),
    OF_AXIS(125, SETTINGS_U8, drive_is_set_up, 0, 1, false),
    OF_AXIS(126, SETTINGS_DOUBLE, velocity_units_per_mm_s, 0, 1e11, false),
    OF_AXIS(127, SETTINGS_U8, limiter_band_percent, 0, LIMITER_BAND_PERCENT_MAX, false),
    OF_AXIS(128, SETTINGS_U8, drive_bus, 0, BUS_MOST, false),
};
/* clang-format on */

const size_t takt_settings_fields_count =
    sizeof takt_settings_fields / sizeof takt_settings_fields[0];

static uint32_t number_bytes(const struct settings_field *field)
{
    return field->type == SETTINGS_DOUBLE ? 8 : 4;
}

static bool is_plain(const struct settings_field *field)
{
    return field->type == SETTINGS_TEXT || field->type == SETTINGS_BYTES;
}

uint32_t takt_settings_field_bytes(const struct settings_field *field)
{
    return is_plain(field) ? field->count : field->count * number_bytes(field);
}

static const uint8_t *place_of(const struct settings_field *field, const void *base)
{
    return (const uint8_t *)base + field->offset;
}

static void get_number(const struct settings_field *field, const uint8_t *at, uint8_t *bytes)
{
    uint64_t bits;
    uint32_t word;

    TAKT_ASSERT(!is_plain(field));
    if (field->type == SETTINGS_DOUBLE) {
        memcpy(&bits, at, sizeof bits);
        little_put64(bytes, bits);
    } else if (field->type == SETTINGS_U32) {
        memcpy(&word, at, sizeof word);
        little_put32(bytes, word);
    } else if (field->type == SETTINGS_I8) {
        little_put32(bytes, (uint32_t)(int8_t)*at);
    } else {
        little_put32(bytes, *at);
    }
}

void takt_settings_field_get(const struct settings_field *field, const void *base, uint8_t *bytes)
{
    const uint8_t *at = place_of(field, base);

    if (is_plain(field)) {
        memcpy(bytes, at, field->count);
        return;
    }
    for (uint32_t i = 0; i < field->count; i++)
        get_number(field, at + (size_t)8 * i, bytes + (size_t)number_bytes(field) * i);
}

/* What does not fit is made into what no check lets pass. */
static uint8_t narrow(uint32_t word)
{
    return word > UINT8_MAX ? UINT8_MAX : (uint8_t)word;
}

/* The same of a number with a sign: two's complement. */
static uint8_t narrow_signed(uint32_t word)
{
    const bool fits = word <= INT8_MAX || word >= UINT32_MAX - INT8_MAX;

    return fits ? (uint8_t)word : INT8_MAX;
}

static void set_number(const struct settings_field *field, uint8_t *at, const uint8_t *bytes)
{
    const uint64_t bits = field->type == SETTINGS_DOUBLE ? little_get64(bytes) : 0;
    const uint32_t word = little_get32(bytes);

    TAKT_ASSERT(!is_plain(field));
    if (field->type == SETTINGS_DOUBLE)
        memcpy(at, &bits, sizeof bits);
    else if (field->type == SETTINGS_U32)
        memcpy(at, &word, sizeof word);
    else if (field->type == SETTINGS_FLAG)
        *at = word != 0;
    else if (field->type == SETTINGS_I8)
        *at = narrow_signed(word);
    else
        *at = narrow(word);
}

void takt_settings_field_set(const struct settings_field *field, void *base, const uint8_t *bytes)
{
    uint8_t *at = (uint8_t *)base + field->offset;

    if (is_plain(field)) {
        memcpy(at, bytes, field->count);
        return;
    }
    for (uint32_t i = 0; i < field->count; i++)
        set_number(field, at + (size_t)8 * i, bytes + (size_t)number_bytes(field) * i);
}

static double value_at(const struct settings_field *field, const uint8_t *at)
{
    double value;
    uint32_t word;

    TAKT_ASSERT(!is_plain(field));
    if (field->type == SETTINGS_DOUBLE) {
        memcpy(&value, at, sizeof value);
        return value;
    }
    if (field->type == SETTINGS_U32) {
        memcpy(&word, at, sizeof word);
        return word;
    }
    return field->type == SETTINGS_I8 ? (double)(int8_t)*at : (double)*at;
}

/* Not a number is in no range. */
static bool is_in_range(const struct settings_field *field, double value)
{
    return value <= field->most && (field->above ? value > field->least : value >= field->least);
}

static bool text_ends(const uint8_t *at, uint32_t size)
{
    for (uint32_t i = 0; i < size; i++) {
        if (at[i] == 0)
            return true;
    }
    return false;
}

bool takt_settings_field_check(const struct settings_field *field, const void *base, double *value)
{
    const uint8_t *at = place_of(field, base);

    *value = field->count;
    if (field->type == SETTINGS_TEXT)
        return text_ends(at, field->count);
    if (field->type == SETTINGS_BYTES)
        return true; /* takt_machine_check knows what they may be */
    for (uint32_t i = 0; i < field->count; i++) {
        *value = value_at(field, at + (size_t)8 * i);
        if (!is_in_range(field, *value))
            return false;
    }
    return true;
}

/*
 * The objects of the drive: what is computed when it is asked for, what a write sets off, and what
 * may be written.
 */
#include "base/maths.h"
#include "canopen/node.h"
#include "servo/servo_private.h"

#include <string.h>

#define SIGNATURE_SAVE 0x65766173u /* "save", the first letter in the lowest byte */
#define SIGNATURE_LOAD 0x64616F6Cu /* "load" */

static int32_t signed_round(double value)
{
    return (int32_t)maths_clamp(takt_maths_round(value), (double)INT32_MIN, (double)INT32_MAX);
}

static int16_t torque(const struct servo *drive)
{
    double torque = takt_maths_round(drive->torque_sign * TORQUE_PER_RATED *
                                     takt_servo_loop_torque_ratio(&drive->loop));
    return (int16_t)maths_clamp(torque, INT16_MIN, INT16_MAX);
}

static void refresh_rest(struct servo *drive)
{
    const struct servo_loop *loop = &drive->loop;
    struct drive_process *p = &drive->objects.process;
    p->demand_position = takt_servo_increments(drive, loop->command_mm - drive->origin_mm);
    p->actual_internal = signed_round(drive->compensation.encoder_mm * loop->encoder_steps_per_mm);
    double velocity_per_mm = drive->velocity_sign * servo_velocity_scale(drive);
    p->actual_velocity = signed_round(loop->measured_velocity_mm_s * velocity_per_mm);
    p->demand_velocity = signed_round(loop->command_velocity_mm_s * velocity_per_mm);
    p->actual_torque = torque(drive);
    p->manufacturer_status = takt_servo_manufacturer_status(drive);
    p->high_resolution_us = takt_servo_high_resolution_us(drive);
    const struct time_stamp time = takt_servo_time_of_day(drive);
    p->time_ms = time.ms;
    p->time_days = time.days;
}

void takt_servo_refresh_groups(struct servo *drive, unsigned groups)
{
    struct drive_process *p = &drive->objects.process;
    if (groups & DRIVE_GROUP_STATUS)
        p->statusword = takt_servo_statusword(drive);
    if (groups & DRIVE_GROUP_POSITION)
        p->actual_position = takt_servo_increments(drive, takt_servo_actual_mm(drive));
    if (groups & DRIVE_GROUP_FOLLOWING)
        p->following_error =
            takt_servo_increments(drive, takt_servo_loop_following_error_mm(&drive->loop));
    if (groups & DRIVE_GROUP_INPUTS)
        p->digital_inputs = takt_servo_inputs(drive);
    if (groups & DRIVE_GROUP_REST)
        refresh_rest(drive);
}

void takt_servo_refresh(struct servo *drive)
{
    takt_servo_refresh_groups(drive, DRIVE_GROUP_ALL);
}

uint32_t takt_servo_read_row(const struct servo *drive, const struct object_row *row)
{
    const struct servo_meddler *m = &drive->meddler;
    uint32_t value;
    if (m->overrides != NULL && m->overrides(m->context, row, &value))
        return value;
    return takt_object_read(row, &drive->objects);
}

/* The mode first: a controlword that comes with it is meant for it. */
void takt_servo_apply_touches(struct servo *drive, unsigned touches)
{
    if (touches & DRIVE_TOUCH_MODE)
        takt_servo_take_mode(drive, drive->objects.process.mode);
    if (touches & DRIVE_TOUCH_CONTROLWORD)
        takt_servo_take_controlword(drive, drive->objects.process.controlword);
    if (touches & DRIVE_TOUCH_CLOCK)
        takt_servo_set_high_resolution_us(drive, drive->objects.process.high_resolution_us);
    if (touches & DRIVE_TOUCH_TORQUE)
        takt_servo_derive_torque(drive);
    if (touches & DRIVE_TOUCH_PROBE)
        takt_servo_take_probe_function(drive);
}

static uint32_t check_sync_id(uint32_t value)
{
    bool is_allowed = value == 0x80 || (value > 0x180 && value < 0x581);
    return is_allowed ? SDO_ABORT_NONE : SDO_ABORT_VALUE;
}

/*
 * An identifier is changed while nobody listens to it. Nodes of this kind never send it (bit 30).
 */
static uint32_t check_time_id(const struct servo *drive, uint32_t value)
{
    uint32_t old = drive->objects.communication.time_cob_id;
    uint32_t id = value & ~TIME_CONSUMED;
    if (id <= 0x80 || id > 0x7FF)
        return SDO_ABORT_VALUE;
    return old & value & TIME_CONSUMED && value != old ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

static uint32_t check_emcy_id(const struct servo *drive, uint32_t value)
{
    uint32_t old = drive->objects.communication.emcy_cob_id;
    uint32_t id = value & 0x7FFFFFFF;
    if (id <= 0x80 || id > 0x7FF)
        return SDO_ABORT_VALUE;
    return !(old >> 31) && !(value >> 31) && value != old ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

/* SYNC's counter must not change while SYNC has a period. */
static uint32_t check_overflow(const struct servo *drive, uint32_t value)
{
    if (drive->objects.communication.sync_period_us != 0)
        return SDO_ABORT_STATE;
    return value == 1 ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

/* 0 trapezoid, 3 jerk limited; 1 and 2 would be other laws. */
static uint32_t check_profile_type(uint32_t value)
{
    return value == 1 || value == 2 ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

/* 3 and 4 would be limits of current and voltage, 7 and 8 the same and staying. */
static uint32_t check_quick_stop(uint32_t value)
{
    return value == 3 || value == 4 ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

static uint32_t check_communication_write(const struct servo *drive, const struct object_row *row,
                                          uint32_t value)
{
    switch (row->index) {
    case 0x1005:
        return check_sync_id(value);
    case 0x1010:
        return value == SIGNATURE_SAVE ? SDO_ABORT_NONE : SDO_ABORT_STORE;
    case 0x1011:
        return value == SIGNATURE_LOAD ? SDO_ABORT_NONE : SDO_ABORT_STORE;
    case 0x1012:
        return check_time_id(drive, value);
    case 0x1014:
        return check_emcy_id(drive, value);
    case 0x1016:
        return takt_servo_check_consumer(drive, row, value);
    case 0x1019:
        return check_overflow(drive, value);
    default:
        break;
    }
    if (row->index >= 0x1400 && row->index < 0x1C00)
        return takt_servo_check_pdo_write(drive, row, value);
    return SDO_ABORT_NONE;
}

static uint32_t check_loops(const struct servo *drive, const struct object_row *row, int64_t value)
{
    const double period_s = 1e-6 * drive->config.loop.loop_period_us;
    const double gain_per_s = MATHS_TWO_PI * 1e-3 * ((double)value - 0.5); /* it may be rounded */
    return row->sub == 2 && gain_per_s * period_s > SERVO_LOOP_GAIN_STEP_MAX ? SDO_ABORT_TOO_HIGH
                                                                             : SDO_ABORT_NONE;
}

static uint32_t check_profile_write(const struct servo *drive, const struct object_row *row,
                                    int64_t value)
{
    switch (row->index) {
    case 0x2010:
    case 0x2011:
        return takt_servo_check_compensation(drive, row, (uint32_t)value);
    case 0x2020:
        return check_loops(drive, row, value);
    case 0x605A:
        return check_quick_stop((uint32_t)value);
    case 0x6086:
        return check_profile_type((uint32_t)value);
    case 0x6060:
        return takt_servo_has_mode(drive, (int8_t)value) ? SDO_ABORT_NONE : SDO_ABORT_VALUE;
    case 0x607E:
    case 0x6091:
    case 0x6092:
        return drive->state == CIA402_ENABLED ? SDO_ABORT_STATE : SDO_ABORT_NONE;
    case 0x6098:
        return takt_servo_has_homing_method((int32_t)value) ? SDO_ABORT_NONE : SDO_ABORT_VALUE;
    default:
        return SDO_ABORT_NONE;
    }
}

static uint32_t check_number(const struct servo *drive, const struct object_row *row, uint32_t raw)
{
    int64_t value = takt_object_type_value((enum object_type)row->type, raw);
    if (row->index == 0x1003) /* 0 clears the history; what else is written has no meaning */
        return raw == 0 ? SDO_ABORT_NONE : SDO_ABORT_VALUE;
    if (row->flags & OBJECT_LIMITED && value < row->min)
        return SDO_ABORT_TOO_LOW;
    if (row->flags & OBJECT_LIMITED && value > row->max)
        return SDO_ABORT_TOO_HIGH;
    return row->index < 0x2000 ? check_communication_write(drive, row, raw)
                               : check_profile_write(drive, row, value);
}

/*
 * Objects 1010 and 1011. Stored values are those a reset brings back; whoever keeps them may fail,
 * and then nothing has changed.
 */
static uint32_t set_stored(struct servo *drive, const struct drive_objects *values)
{
    const struct drive_objects before = drive->stored;
    drive->objects.process.store = drive->objects.process.restore = 1;
    drive->stored = *values;
    if (drive->keeper.keep == NULL || drive->keeper.keep(drive->keeper.context, drive))
        return SDO_ABORT_NONE;
    drive->stored = before;
    return SDO_ABORT_HARDWARE;
}

void takt_servo_restore(struct servo *drive, uint16_t last)
{
    drive->objects.communication = drive->stored.communication;
    takt_dictionary_copy_memory(drive->dictionary, &drive->objects, &drive->stored, last);
    if (last < UINT16_MAX)
        return;
    drive->objects.settings = drive->stored.settings;
    takt_servo_derive(drive);
    takt_servo_derive_compensation(drive);
}

static void follow_communication_write(struct servo *drive, const struct object_row *row)
{
    switch (row->index) {
    case 0x1003:
        takt_servo_clear_history(drive);
        break;
    case 0x1005:
    case 0x1012:
        takt_servo_set_filter(drive);
        break;
    case 0x1006:
        drive->sync_lost_ns = DRIVE_NEVER;
        break;
    case 0x1013:
        takt_servo_apply_touches(drive, DRIVE_TOUCH_CLOCK);
        break;
    case 0x1016:
        if (row->sub >= 1 && row->sub <= DRIVE_CONSUMERS)
            takt_servo_restart_consumer(drive, row->sub - 1u);
        break;
    case 0x1017:
        takt_servo_restart_heartbeat(drive);
        break;
    default:
        if (row->index >= 0x1400 && row->index < 0x1C00)
            takt_servo_update_pdo(drive, row->index);
        break;
    }
}

static void follow_profile_write(struct servo *drive, const struct object_row *row)
{
    switch (row->index) {
    case 0x6040:
        takt_servo_apply_touches(drive, DRIVE_TOUCH_CONTROLWORD);
        break;
    case 0x6060:
        takt_servo_apply_touches(drive, DRIVE_TOUCH_MODE);
        break;
    case 0x6072:
        takt_servo_apply_touches(drive, DRIVE_TOUCH_TORQUE);
        break;
    case 0x60B8:
        takt_servo_apply_touches(drive, DRIVE_TOUCH_PROBE);
        break;
    case 0x2010:
    case 0x2011:
        takt_servo_derive_compensation(drive);
        break;
    case 0x2020:
        takt_servo_derive_loops(drive);
        break;
    case 0x607E:
    case 0x6091:
    case 0x6092:
        takt_servo_derive(drive);
        takt_servo_derive_compensation(drive);
        takt_servo_hold(drive);
        break;
    case 0x6065:
    case 0x6085:
    case 0x60C2:
    case 0x60C6:
        takt_servo_derive(drive);
        break;
    default:
        break;
    }
}

static uint32_t write_number(struct servo *drive, const struct object_row *row, uint32_t value)
{
    uint32_t code = check_number(drive, row, value);
    if (code != SDO_ABORT_NONE)
        return code;
    takt_object_write(row, &drive->objects, value);
    if (row->index == 0x1010)
        return set_stored(drive, &drive->objects);
    if (row->index == 0x1011)
        return set_stored(drive, &drive->initial);
    if (row->index < 0x2000)
        follow_communication_write(drive, row);
    else
        follow_profile_write(drive, row);
    return SDO_ABORT_NONE;
}

/* The label is a text, the notes are any bytes. */
static uint32_t write_bytes(struct servo *drive, const struct object_row *row, const uint8_t *bytes,
                            size_t length)
{
    struct drive_process *p = &drive->objects.process;
    if (row->flags & OBJECT_FIXED)
        return SDO_ABORT_NONE; /* of a data sheet: it is not kept */
    if (row->type == OBJECT_STRING) {
        if (length >= DRIVE_LABEL_SIZE)
            return SDO_ABORT_TOO_LONG;
        memset(drive->objects.settings.label, 0, DRIVE_LABEL_SIZE);
        memcpy(drive->objects.settings.label, bytes, length);
        return SDO_ABORT_NONE;
    }
    if (length > DRIVE_NOTES_SIZE)
        return SDO_ABORT_TOO_LONG;
    memcpy(p->notes, bytes, length);
    p->notes_length = (uint16_t)length;
    return SDO_ABORT_NONE;
}

static size_t length_of(const char *text)
{
    size_t length = 0;
    while (text[length] != '\0')
        length++;
    return length;
}

static uint32_t read_bytes(const struct servo *drive, const struct object_row *row,
                           const uint8_t **bytes, size_t *length)
{
    const struct drive_objects *o = &drive->objects;
    const char *text = row->flags & OBJECT_FIXED ? row->title : o->settings.label;
    if (row->type == OBJECT_STRING) {
        *bytes = (const uint8_t *)text;
        *length = length_of(text);
    } else if (row->flags & OBJECT_FIXED) {
        *bytes = (const uint8_t *)drive->eds;
        *length = drive->eds_length;
        return drive->eds ? SDO_ABORT_NONE : SDO_ABORT_NO_DATA;
    } else {
        *bytes = (const uint8_t *)o->process.notes;
        *length = o->process.notes_length;
    }
    return SDO_ABORT_NONE;
}

static uint32_t find(const struct servo *drive, uint32_t object, const struct object_row **row)
{
    bool has_index;
    uint32_t code;
    *row = takt_dictionary_find(drive->dictionary, (uint16_t)(object >> 16), (uint8_t)(object >> 8),
                                &has_index);
    const struct servo_meddler *m = &drive->meddler;
    if (m->aborts_sdo != NULL && m->aborts_sdo(m->context, object, &code))
        return code;
    if (*row)
        return SDO_ABORT_NONE;
    return has_index ? SDO_ABORT_NO_SUB_INDEX : SDO_ABORT_NO_OBJECT;
}

static uint32_t tell_abort(const struct servo *drive, uint32_t object, uint32_t code)
{
    if (code != SDO_ABORT_NONE)
        takt_servo_tell(drive, DRIVE_EVENT_SDO_ABORT, object, code);
    return code;
}

static uint32_t read_object(struct servo *drive, uint32_t object, uint8_t number[4],
                            const uint8_t **bytes, size_t *length)
{
    const struct object_row *row;
    uint32_t code = find(drive, object, &row);
    if (code != SDO_ABORT_NONE)
        return code;
    if (row->access == OBJECT_WO)
        return SDO_ABORT_WRITE_ONLY;
    if (row->index == 0x1003 && row->sub > drive->objects.process.history_count)
        return SDO_ABORT_NO_DATA;
    *length = takt_object_type_bytes((enum object_type)row->type);
    if (*length == 0)
        return read_bytes(drive, row, bytes, length);
    takt_servo_refresh_groups(drive, DRIVE_GROUP_ALL);
    uint32_t value = takt_servo_read_row(drive, row);
    for (unsigned i = 0; i < 4; i++)
        number[i] = (uint8_t)(value >> 8 * i);
    *bytes = number;
    return SDO_ABORT_NONE;
}

uint32_t takt_servo_read_sdo(void *drive, uint32_t object, uint8_t number[4], const uint8_t **bytes,
                             size_t *length)
{
    return tell_abort(drive, object, read_object(drive, object, number, bytes, length));
}

static uint32_t may_write(const struct servo *drive, uint32_t object, const struct object_row **row)
{
    uint32_t code = find(drive, object, row);
    if (code == SDO_ABORT_NONE && ((*row)->access == OBJECT_RO || (*row)->access == OBJECT_CONST))
        return SDO_ABORT_READ_ONLY;
    return code;
}

uint32_t takt_servo_may_write_sdo(void *drive, uint32_t object, size_t *size)
{
    const struct object_row *row;
    uint32_t code = may_write(drive, object, &row);
    *size = code == SDO_ABORT_NONE ? takt_object_type_bytes((enum object_type)row->type) : 0;
    return tell_abort(drive, object, code);
}

static uint32_t write_object(struct servo *drive, uint32_t object, const uint8_t *bytes,
                             size_t length)
{
    const struct object_row *row;
    uint32_t value = 0;
    uint32_t code = may_write(drive, object, &row);
    if (code != SDO_ABORT_NONE)
        return code;
    unsigned width = takt_object_type_bytes((enum object_type)row->type);
    if (width == 0)
        return write_bytes(drive, row, bytes, length);
    if (length != width)
        return length > width ? SDO_ABORT_TOO_LONG : SDO_ABORT_TOO_SHORT;
    for (unsigned i = 0; i < width; i++)
        value |= (uint32_t)bytes[i] << 8 * i;
    return write_number(drive, row, value);
}

uint32_t takt_servo_write_sdo(void *drive, uint32_t object, const uint8_t *bytes, size_t length)
{
    return tell_abort(drive, object, write_object(drive, object, bytes, length));
}

/* The number a mapping entry names, and NULL for anything else. */
static const struct object_row *find_number(const struct servo *drive, uint32_t object)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(drive->dictionary, (uint16_t)(object >> 16),
                                                        (uint8_t)(object >> 8), &has_index);
    unsigned bits = row ? 8 * takt_object_type_bytes((enum object_type)row->type) : 0;
    return bits != 0 && bits == (object & 0xFF) ? row : NULL;
}

bool takt_servo_read_object(struct servo *drive, uint32_t object, uint32_t *value)
{
    const struct object_row *row = find_number(drive, object);
    if (!row)
        return false;
    takt_servo_refresh_groups(drive, DRIVE_GROUP_ALL);
    *value = takt_servo_read_row(drive, row);
    return true;
}

bool takt_servo_write_object(struct servo *drive, uint32_t object, uint32_t value)
{
    const struct object_row *row = find_number(drive, object);
    if (!row || row->access == OBJECT_RO || row->access == OBJECT_CONST)
        return false;
    return write_number(drive, row, value) == SDO_ABORT_NONE;
}

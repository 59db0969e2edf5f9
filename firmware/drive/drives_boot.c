/*
 * What the master asks and tells every drive before it is started, as a list of steps: who it is, when its heartbeat is
 * due, how it stops, its process data, and how it finds its home.
 *
 * A PDO is rewritten as CiA 301, 7.5.2.36 has it: not valid, no mapping, entries, their number, valid.
 */
#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/objects.h"
#include "canopen/target_pdo.h"
#include "drive/drives_private.h"

#define UINT32_LIMIT 4294967295.0

/* PDOs that are used of each kind, and those that might be valid by default and must be silent. */
#define PDO_USED   2
#define PDO_UNUSED 2

static const char *const identity_texts[] = {
    "vendor id, object 1018:01,", "product code, object 1018:02,", "revision, object 1018:03,",
    "serial number, object 1018:04,"};

static const uint32_t *identity_of(const struct drives_identity *identity, unsigned sub)
{
    const uint32_t *const parts[] = {&identity->vendor, &identity->product, &identity->revision,
                                     &identity->serial};
    return parts[sub - 1];
}

static void set_read(struct drives_step *step, uint16_t index, uint8_t sub)
{
    *step = (struct drives_step){.object = SDO_OBJECT(index, sub)};
}

static void set_write(struct drives_step *step, unsigned index, uint8_t sub, uint8_t length,
                      uint32_t value)
{
    *step =
        (struct drives_step){.object = SDO_OBJECT(index, sub), .length = length, .value = value};
}

static void set_option(struct drives_step *step, uint16_t index, uint32_t value)
{
    set_write(step, index, 0, 2, value);
    step->optional = true;
}

/* Who it is: the parts of the identity that matter, device type, modes. */
#define IDENTITY_STEPS 6

static void identity_step(const struct drives_config_axis *config, unsigned number,
                          struct drives_step *step)
{
    if (number == 0) {
        set_read(step, OBJECT_DEVICE_TYPE, 0);
    } else if (number <= 4) {
        set_read(step, OBJECT_IDENTITY, (uint8_t)number);
        step->optional = *identity_of(&config->identity, number) == 0;
    } else {
        set_read(step, CIA402_SUPPORTED_MODES, 0);
    }
}

/*
 * Object 60C2: period = value * 10^exponent seconds, the value a byte. The largest unit that is exact; a period that
 * has none is rounded in the smallest unit that holds it.
 */
static void split_period(uint32_t cycle_us, uint32_t *value, int *exponent)
{
    *value = cycle_us;
    *exponent = -6;
    while (*value % 10 == 0 || *value > UINT8_MAX) {
        *value = (*value + 5) / 10;
        ++*exponent;
    }
}

/* Heartbeats, cycle, and that a drive brakes and switches off whatever ends its operation. */
#define HABIT_STEPS 8

static void habit_step(const struct drives *d, unsigned number, struct drives_step *step)
{
    uint32_t lost_ms = (uint32_t)d->heartbeat_ms * DRIVES_HEARTBEATS_LOST;
    uint32_t period;
    int exponent;
    split_period(d->cycle_us, &period, &exponent);
    switch (number) {
    case 0:
        set_write(step, OBJECT_PRODUCER_HEARTBEAT, 0, 2, d->heartbeat_ms);
        break;
    case 1:
        set_write(step, OBJECT_CONSUMER_HEARTBEAT, 1, 4,
                  (uint32_t)d->controller_node << 16 | lost_ms);
        break;
    case 2:
        set_write(step, OBJECT_SYNC_PERIOD, 0, 4, d->cycle_us);
        break;
    case 3:
        set_write(step, CIA402_INTERPOLATION_PERIOD, 1, 1, period);
        break;
    case 4:
        set_write(step, CIA402_INTERPOLATION_PERIOD, 2, 1, (uint8_t)exponent);
        break;
    case 5:
        set_option(step, CIA402_CONNECTION_OPTION, CIA402_CONNECTION_QUICK_STOP);
        break;
    case 6:
        set_option(step, CIA402_QUICK_STOP_OPTION, CIA402_OPTION_QUICK_STOP_RAMP);
        break;
    default:
        set_option(step, CIA402_FAULT_OPTION, CIA402_OPTION_QUICK_STOP_RAMP);
        break;
    }
    step->optional = number != 0;
}

struct process_data {
    uint16_t communication, mapping; /* objects */
    uint32_t flags;                  /* of its COB-ID */
    uint16_t event_ms;               /* 0: none */
    struct pdo pdo;
};

static void set_pdo(struct process_data *data, bool transmits, unsigned number, unsigned cob_id,
                    uint8_t type, uint32_t first, uint32_t second)
{
    uint32_t objects[2] = {first, second};
    data->communication = (uint16_t)((transmits ? OBJECT_TPDO : OBJECT_RPDO) + number);
    data->mapping = (uint16_t)((transmits ? OBJECT_TPDO_MAPPING : OBJECT_RPDO_MAPPING) + number);
    data->flags = transmits ? OBJECT_PDO_NO_RTR : 0;
    data->event_ms = transmits && type == PDO_EVENT ? DRIVES_EVENT_MS : 0;
    data->pdo.cob_id = (uint16_t)cob_id;
    data->pdo.transmission = type;
    (void)pdo_map(&data->pdo.mapping, objects, 2);
}

/* RPDO1, RPDO2, TPDO1, TPDO2. */
static void describe_pdo(const struct drives *d, unsigned index, unsigned which,
                         struct process_data *data)
{
    unsigned node = d->node[index];
    switch (which) {
    case 0:
        set_pdo(data, false, 0, PDO_RPDO1_FUNCTION + node, PDO_EVENT, CIA402_CONTROLWORD,
                CIA402_MODE);
        break;
    case 1:
        set_pdo(data, false, 1, 0, PDO_EVERY_SYNC, PDO_DUMMY_32, PDO_DUMMY_32);
        target_pdo_set(&data->pdo, d->node, d->count, index);
        break;
    case 2:
        set_pdo(data, true, 0, PDO_TPDO1_FUNCTION + node, PDO_EVERY_SYNC, CIA402_STATUSWORD,
                CIA402_POSITION_ACTUAL);
        break;
    default:
        set_pdo(data, true, 1, PDO_TPDO2_FUNCTION + node, PDO_EVENT, CIA402_ERROR_CODE,
                CIA402_FOLLOWING_ERROR);
        break;
    }
}

/* Steps around the entries of a mapping; with an event timer one more. */
#define PDO_STEPS 5

static unsigned pdo_step_count(const struct process_data *data)
{
    return PDO_STEPS + data->pdo.mapping.count + (data->event_ms != 0 ? 1u : 0u);
}

static void pdo_step(const struct process_data *data, unsigned number, struct drives_step *step)
{
    const struct pdo_mapping *mapping = &data->pdo.mapping;
    uint32_t cob_id = data->pdo.cob_id | data->flags;
    unsigned count = mapping->count;
    if (number == 0)
        set_write(step, data->communication, OBJECT_PDO_COB_ID, 4, cob_id | OBJECT_PDO_NOT_VALID);
    else if (number == 1)
        set_write(step, data->communication, OBJECT_PDO_TYPE, 1, data->pdo.transmission);
    else if (number == 2)
        set_write(step, data->mapping, 0, 1, 0);
    else if (number < 3 + count)
        set_write(step, data->mapping, (uint8_t)(number - 2), 4, mapping->object[number - 3]);
    else if (number == 3 + count)
        set_write(step, data->mapping, 0, 1, count);
    else if (number + 1 < pdo_step_count(data))
        set_write(step, data->communication, OBJECT_PDO_EVENT_TIMER, 2, data->event_ms);
    else
        set_write(step, data->communication, OBJECT_PDO_COB_ID, 4, cob_id);
}

/* PDOs 3 and 4 have default identifiers of the same row. */
static void unused_step(unsigned node, unsigned number, struct drives_step *step)
{
    bool transmits = number >= PDO_UNUSED;
    unsigned which = PDO_USED + number % PDO_UNUSED;
    unsigned base = (transmits ? PDO_TPDO1_FUNCTION : PDO_RPDO1_FUNCTION) + 0x100 * which;
    set_write(step, (transmits ? OBJECT_TPDO : OBJECT_RPDO) + which, OBJECT_PDO_COB_ID, 4,
              (base + node) | OBJECT_PDO_NOT_VALID | (transmits ? OBJECT_PDO_NO_RTR : 0));
    step->optional = true;
}

/* increments = round(value * increments_per_mm), at least 0. */
static uint32_t increments_of(const struct drives_config_axis *config, double value_mm)
{
    double increments = maths_round(value_mm * config->increments_per_mm);
    return (uint32_t)maths_clamp(increments, 0, UINT32_LIMIT);
}

#define HOMING_STEPS 5

/*
 * CiA 402: zero = home + home offset. So the offset is minus the coordinate that home is to have. There are drives whose
 * position at home is the offset.
 */
static double home_offset_mm(const struct drives_homing *homing)
{
    return homing->offset_is_position ? homing->offset_mm : -homing->offset_mm;
}

static void homing_step(const struct drives_config_axis *config, unsigned number,
                        struct drives_step *step)
{
    const struct drives_homing *homing = &config->homing;
    double offset_inc = maths_round(home_offset_mm(homing) * config->increments_per_mm);
    switch (number) {
    case 0:
        set_write(step, CIA402_HOMING_METHOD, 0, 1, homing->method);
        break;
    case 1:
        set_write(step, CIA402_HOMING_SPEEDS, 1, 4, increments_of(config, homing->velocity_mm_s));
        break;
    case 2:
        set_write(step, CIA402_HOMING_SPEEDS, 2, 4, increments_of(config, homing->zero_mm_s));
        break;
    case 3:
        set_write(step, CIA402_HOMING_ACCELERATION, 0, 4,
                  increments_of(config, homing->acceleration_mm_s2));
        break;
    default:
        set_write(step, CIA402_HOME_OFFSET, 0, 4,
                  (uint32_t)(int32_t)maths_clamp(offset_inc, -2147483647.0, 2147483647.0));
        break;
    }
}

/* Process data and homing. */
static bool late_step(const struct drives *d, unsigned index, unsigned number,
                      struct drives_step *step)
{
    for (unsigned which = 0; which < 2 * PDO_USED; which++) {
        struct process_data data;
        describe_pdo(d, index, which, &data);
        if (number < pdo_step_count(&data)) {
            pdo_step(&data, number, step);
            return true;
        }
        number -= pdo_step_count(&data);
    }
    if (number < 2 * PDO_UNUSED) {
        unused_step(d->node[index], number, step);
        return true;
    }
    number -= 2 * PDO_UNUSED;
    if (d->axis[index].config.homing.order == 0 || number >= HOMING_STEPS)
        return false;
    homing_step(&d->axis[index].config, number, step);
    return true;
}

bool drives_find_step(const struct drives *d, unsigned index, unsigned number,
                      struct drives_step *step)
{
    if (number < IDENTITY_STEPS)
        identity_step(&d->axis[index].config, number, step);
    else if (number < IDENTITY_STEPS + HABIT_STEPS)
        habit_step(d, number - IDENTITY_STEPS, step);
    else
        return late_step(d, index, number - IDENTITY_STEPS - HABIT_STEPS, step);
    return true;
}

static bool accept_identity(struct drives *d, unsigned index, uint8_t sub, uint32_t value)
{
    uint32_t expected = *identity_of(&d->axis[index].config.identity, sub);
    if (expected == 0 || expected == value)
        return true;
    drives_raise(d, index, TAKT_ERROR_DRIVE_IDENTITY, value, identity_texts[sub - 1]);
    return false;
}

static bool accept_mode(struct drives *d, unsigned index, uint32_t modes, unsigned mode,
                        const char *name)
{
    if (modes >> (mode - 1) & 1)
        return true;
    drives_raise(d, index, TAKT_ERROR_DRIVE_MODES, modes, name);
    return false;
}

static bool accept_modes(struct drives *d, unsigned index, uint32_t modes)
{
    return accept_mode(d, index, modes, CIA402_MODE_CYCLIC_SYNC_POSITION,
                       "cyclic synchronous position") &&
           (d->axis[index].config.homing.order == 0 ||
            accept_mode(d, index, modes, CIA402_MODE_HOMING, "homing"));
}

static bool accept_type(struct drives *d, unsigned index, uint32_t type)
{
    if ((type & OBJECT_DEVICE_PROFILE_MASK) == OBJECT_DEVICE_PROFILE_402)
        return true;
    drives_raise(d, index, TAKT_ERROR_DRIVE_TYPE, type, NULL);
    return false;
}

bool drives_accept(struct drives *d, unsigned index, const struct drives_step *step, uint32_t value)
{
    switch (sdo_index(step->object)) {
    case OBJECT_DEVICE_TYPE:
        return accept_type(d, index, value);
    case OBJECT_IDENTITY:
        return accept_identity(d, index, sdo_sub(step->object), value);
    default:
        return accept_modes(d, index, value);
    }
}

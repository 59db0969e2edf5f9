#include "base/assert.h"
#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/target_pdo.h"
#include "drive/drives_private.h"
#include "drive/word.h"

#include <string.h>

_Static_assert((DRIVES_HISTORY & (DRIVES_HISTORY - 1)) == 0, "the history is indexed by a mask");
_Static_assert(DRIVES_HISTORY > DRIVES_LATENCY_CYCLES, "the history is as long as the latency");

#define DEGREES_PER_RAD (180.0 / MATHS_PI)

static void init_axis(struct drives *d, unsigned index)
{
    struct drives_axis *axis = &d->axis[index];
    const unsigned bus = drives_bus_of(d, index);
    TAKT_ASSERT(index < d->count);
    axis->is_paired = takt_target_pdo_members(d->on_bus[bus], axis->place, d->group) > 1;
    axis->reported = d->cycle - 1;
    axis->heartbeat = d->cycle - 1;
    axis->follow_mode = axis->mode = CIA402_MODE_CYCLIC_SYNC_POSITION;
    axis->reset_pending = axis->hold_pending = true;
    takt_drives_forget_pdos(axis);
    d->axis_of_node[bus][d->node[index]] = (uint8_t)index;
}

/* Heartbeats come once a cycle at most: a shorter period is that, for all who are told of it. */
static uint16_t beat_ms(const struct drives_config *config)
{
    const uint32_t least_ms = (config->cycle_us + 999) / 1000;
    if (config->heartbeat_ms == 0 || config->heartbeat_ms > least_ms)
        return config->heartbeat_ms;
    return (uint16_t)least_ms;
}

static void take_times(struct drives *d, const struct drives_config *config)
{
    d->cycle_us = config->cycle_us;
    d->heartbeat_ms = beat_ms(config);
    const uint32_t lost_us = DRIVES_HEARTBEATS_LOST * 1000 * (uint32_t)d->heartbeat_ms;
    d->heartbeat_cycles = (uint32_t)d->heartbeat_ms * 1000 / d->cycle_us;
    d->heartbeat_age_max_cycles =
        lost_us > 0 ? (lost_us + d->cycle_us - 1) / d->cycle_us : UINT32_MAX;
    d->boot_timeout_cycles = config->boot_timeout_cycles;
    d->start_timeout_cycles = config->start_timeout_cycles;
    d->answer_timeout_cycles = config->answer_timeout_cycles;
    d->sdo_timeout_cycles = config->sdo_timeout_cycles;
    d->stop_timeout_cycles = config->stop_timeout_cycles;
    d->brake_timeout_cycles = config->brake_timeout_cycles;
}

/* Velocities get the sign of positions. */
static void take_config(struct drives *d, unsigned index, const struct drives_config_axis *config)
{
    struct drives_config_axis *own = &d->axis[index].config;
    const double units = config->velocity_units_per_mm_s;
    TAKT_ASSERT(config->node >= NODE_MIN && config->node <= NODE_MAX &&
                config->bus < CAN_BUSES_MAX);
    TAKT_ASSERT(index < d->count);
    *own = *config;
    d->node[index] = config->node;
    d->axis[index].place = d->on_bus[drives_bus_of(d, index)]++;
    if (units == 0)
        own->velocity_units_per_mm_s = config->increments_per_mm;
    else
        own->velocity_units_per_mm_s = config->increments_per_mm < 0 ? -units : units;
    if (own->following_error_max_mm <= 0)
        own->following_error_max_mm = MATHS_INFINITY; /* not watched */
}

static void check_load(struct drives *d, const struct drives_config *config)
{
    struct drives_load load;
    for (unsigned bus = 0; bus < drives_bus_count(d) && d->state != DRIVES_FAULTED; bus++) {
        const struct drives_traffic traffic = {.count = d->on_bus[bus],
                                               .bus = bus,
                                               .heartbeat_ms = d->heartbeat_ms,
                                               .wiring = config->wiring,
                                               .io_count = config->io_count,
                                               .rates = config->rates,
                                               .no_error_pdo = config->no_error_pdo};
        if (takt_drives_predict_whole_load(&traffic, config->cycle_us, &load))
            continue;
        d->state = DRIVES_FAULTED;
        takt_drives_set_overload(&load, bus, &d->fault);
    }
}

static void count_buses(struct drives *d)
{
    unsigned last = 0;
    for (unsigned i = 0; i < d->count; i++)
        last = drives_bus_of(d, i) > last ? drives_bus_of(d, i) : last;
    for (unsigned i = 0; i < d->io_count; i++)
        last = drives_io_bus_of(d, i) > last ? drives_io_bus_of(d, i) : last;
    d->bus_count = (uint8_t)(last + 1);
}

void takt_drives_init(struct drives *d, const struct drives_config *config)
{
    TAKT_ASSERT(config->count <= AXIS_COUNT && config->cycle_us > 0);
    memset(d, 0, sizeof *d);
    memset(d->axis_of_node, AXIS_COUNT, sizeof d->axis_of_node);
    d->count = config->count;
    d->controller_node = config->controller_node;
    d->rates = config->rates;
    d->frame_max = config->rates.data > 0 ? CAN_DATA_MAX : CAN_CLASSIC_MAX;
    d->group = (uint8_t)takt_drives_group_of(&config->rates);
    d->homed = config->homed;
    d->actual = config->at;
    d->no_error_pdo = config->no_error_pdo;
    d->position_gain_per_s = config->position_gain_per_s;
    take_times(d, config);
    takt_drives_io_init(d, config);
    takt_drives_gantry_init(d, config);
    for (unsigned i = 0; i < d->count; i++)
        take_config(d, i, &config->axis[i]);
    count_buses(d);
    for (unsigned i = 0; i < d->count; i++)
        init_axis(d, i);
    if (d->count == 0 && d->io_count == 0)
        d->state = DRIVES_ENABLED;
    check_load(d, config);
}

/*
 * Setpoints that do not get through any more, or are none, cannot be followed to rest; and where a
 * switch says stop, or a gantry is about to rack, rest comes before the path.
 */
static bool cuts_off(enum takt_error error)
{
    return error == TAKT_ERROR_DRIVE_RANGE || error == TAKT_ERROR_DRIVE_UNREACHABLE ||
           error == TAKT_ERROR_DRIVE_SKEW || error == TAKT_ERROR_IO_STOP ||
           error == TAKT_ERROR_IO_LIMIT;
}

void takt_drives_brake(struct drives *d)
{
    d->state = DRIVES_BRAKING;
    d->stop_cycles = 0;
    for (unsigned i = 0; i < d->count; i++)
        d->axis[i].rest_cycles = 0;
}

static void leave_operation(struct drives *d, enum takt_error error)
{
    if (d->state == DRIVES_STARTING || d->stop_timeout_cycles == 0 || cuts_off(error)) {
        takt_drives_brake(d);
        return;
    }
    d->state = DRIVES_STOPPING;
    d->stop_cycles = 0;
    d->rest_cycles = 0;
}

static void raise(struct drives *d, unsigned index, const struct word *word, enum takt_error error,
                  double value, const char *meaning)
{
    TAKT_ASSERT(error != TAKT_OK && index <= AXIS_COUNT);
    if (d->state == DRIVES_STOPPING && cuts_off(error))
        takt_drives_brake(d);
    if (d->state > DRIVES_ENABLED)
        return;
    d->fault_axis = index;
    takt_diagnostic_set(&d->fault, error, 0, 0, word->text, word->length, value);
    d->fault.meaning = meaning;
    leave_operation(d, error);
}

void takt_drives_name_node(struct word *word, unsigned bus, unsigned node)
{
    takt_word_add_text(word, "node ");
    if (bus > 0) {
        takt_word_add_number(word, bus);
        takt_word_add_text(word, ":");
    }
    takt_word_add_number(word, node);
}

/* "Y (node 2)", "Y2 (node 4)". */
static void name_axis(const struct drives *d, unsigned index, struct word *word)
{
    char letter[3] = {AXIS_LETTERS[d->axis[index].config.axis], '\0', '\0'};
    TAKT_ASSERT(index < d->count && d->axis[index].config.axis < AXIS_COUNT);
    if (drives_is_second(d, index))
        letter[1] = '2';
    word->length = 0;
    takt_word_add_text(word, letter);
    takt_word_add_text(word, " (");
    takt_drives_name_node(word, drives_bus_of(d, index), d->node[index]);
    takt_word_add_text(word, ")");
}

/* A drive that is only warned of, or only without a heartbeat, still follows its setpoints. */
static bool can_follow(const struct drives_axis *axis, enum takt_error error)
{
    return error == TAKT_ERROR_DRIVE_HEARTBEAT ||
           (error == TAKT_ERROR_DRIVE_FAULT && cia402_is_enabled(axis->statusword));
}

void takt_drives_raise(struct drives *d, unsigned index, enum takt_error error, double value,
                       const char *meaning)
{
    struct word word;

    TAKT_ASSERT(index < d->count);
    d->axis[index].lost = d->axis[index].lost || !can_follow(&d->axis[index], error);
    if (error == TAKT_ERROR_DRIVE_REBOOTED)
        takt_drives_doubt_home(d, index);
    if (error == TAKT_ERROR_DRIVE_ABSENT)
        d->homed = false;
    name_axis(d, index, &word);
    raise(d, index, &word, error, value, meaning);
}

void takt_drives_raise_named(struct drives *d, const struct word *name, enum takt_error error,
                             double value, const char *meaning)
{
    raise(d, AXIS_COUNT, name, error, value, meaning);
}

/* "Y (node 2), object 1600:01,". */
void takt_drives_raise_object(struct drives *d, unsigned index, uint32_t object,
                              enum takt_error error, double value, const char *meaning)
{
    struct word word;
    TAKT_ASSERT(index < d->count);
    name_axis(d, index, &word);
    takt_word_add_text(&word, ", object ");
    takt_word_add_hex(&word, sdo_index(object), 4);
    takt_word_add_text(&word, ":");
    takt_word_add_hex(&word, sdo_sub(object), 2);
    takt_word_add_text(&word, ",");
    raise(d, index, &word, error, value, meaning);
}

void takt_drives_complete_fault(struct drives *d, unsigned index, uint16_t code)
{
    TAKT_ASSERT(index < d->count);
    if (d->fault.code != TAKT_ERROR_DRIVE_FAULT || d->fault_axis != index || d->fault.value != 0 ||
        code == EMCY_NONE)
        return;
    d->fault.value = code;
    d->fault.meaning = takt_emcy_text(code);
}

bool takt_drives_axis_is_enabled(const struct drives_axis *axis)
{
    return axis->heard && cia402_is_enabled(axis->statusword);
}

bool takt_drives_are_watched(const struct drives *d)
{
    return d->state == DRIVES_ENABLED || (d->state == DRIVES_STARTING && d->phase >= DRIVES_SELECT);
}

double takt_drives_axis_shown(const struct drives_axis *axis, double value_mm)
{
    return axis->config.axis >= AXIS_LINEAR_COUNT ? value_mm * DEGREES_PER_RAD : value_mm;
}

double takt_drives_cycles_ms(const struct drives *d, uint32_t cycles)
{
    TAKT_ASSERT(d->cycle_us > 0);
    return 1e-3 * (double)d->cycle_us * cycles;
}

bool takt_drives_are_homed(const struct drives *d)
{
    return d->homed;
}

const struct diagnostic *takt_drives_get_fault(const struct drives *d)
{
    return &d->fault;
}

void takt_drives_stop_at_once(struct drives *d, enum takt_error reason)
{
    TAKT_ASSERT(reason != TAKT_OK);
    if (d->state > DRIVES_STOPPING)
        return;
    if (d->state < DRIVES_STOPPING)
        takt_diagnostic_set(&d->fault, reason, 0, 0, "", 0, 0);
    takt_drives_brake(d);
}

void takt_drives_stop_for(struct drives *d, const struct diagnostic *fault)
{
    TAKT_ASSERT(fault->code != TAKT_OK);
    if (d->state > DRIVES_STOPPING)
        return;
    if (d->state < DRIVES_STOPPING)
        d->fault = *fault;
    takt_drives_brake(d);
}

uint32_t takt_drives_get_given_up(const struct drives *d, enum axis axis)
{
    uint32_t given_up = 0;
    TAKT_ASSERT(axis < AXIS_COUNT);
    for (unsigned i = 0; i < d->count; i++)
        if (d->axis[i].config.axis == axis)
            given_up |= d->axis[i].given_up;
    return given_up;
}

void takt_drives_stop_on_path(struct drives *d, enum takt_error reason)
{
    TAKT_ASSERT(reason != TAKT_OK);
    if (d->state > DRIVES_ENABLED)
        return;
    takt_diagnostic_set(&d->fault, reason, 0, 0, "", 0, 0);
    leave_operation(d, reason);
}

uint32_t takt_drives_get_all_given_up(const struct drives *d)
{
    uint32_t given_up = 0;
    for (unsigned i = 0; i < d->count; i++)
        given_up |= d->axis[i].given_up;
    return given_up;
}

void takt_drives_get_statuswords(const struct drives *d, uint16_t statusword[AXIS_COUNT])
{
    memset(statusword, 0, AXIS_COUNT * sizeof statusword[0]);
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_is_second(d, i))
            statusword[d->axis[i].config.axis] = d->axis[i].statusword;
}

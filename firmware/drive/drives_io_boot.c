/*
 * The start of the I/O nodes: each is asked whether it is used as CiA 401 says it is at power-on
 * (drives_io.c), told how it is watched, and started. The order of the steps is that of enum step;
 * steps that nobody needs are left out.
 */
#include "base/assert.h"
#include "canopen/objects.h"
#include "drive/drives_private.h"

#define BITS_PER_BYTE 8
#define BITS_PER_WORD 16

/* "node 20, object 1017:00,". */
static void raise_object(struct drives *d, unsigned i, enum takt_error error, double value,
                         const char *meaning)
{
    struct word word = takt_drives_io_name(d, i);
    takt_word_add_text(&word, ", object ");
    takt_word_add_hex(&word, sdo_index(d->sdo.object), 4);
    takt_word_add_text(&word, ":");
    takt_word_add_hex(&word, sdo_sub(d->sdo.object), 2);
    takt_word_add_text(&word, ",");
    takt_drives_raise_named(d, &word, error, value, meaning);
}

static bool send_nmt(const struct drives *d, const struct can_port *port, unsigned i,
                     enum nmt_command command)
{
    TAKT_ASSERT(i < d->io_count && drives_io_bus_of(d, i) < CAN_BUSES_MAX);
    return takt_drives_send_nmt(&port[drives_io_bus_of(d, i)], command, d->wiring[i].node);
}

void takt_drives_io_send_resets(struct drives *d, const struct can_port *port)
{
    for (unsigned i = 0; i < d->io_count; i++)
        if (d->io[i].reset_pending && send_nmt(d, port, i, NMT_RESET_COMMUNICATION))
            d->io[i].reset_pending = false;
}

bool takt_drives_io_boot(struct drives *d)
{
    bool all = true;
    for (unsigned i = 0; i < d->io_count; i++) {
        all = all && d->io[i].booted;
        if (d->io[i].booted)
            continue;
        if (d->phase_cycles == d->boot_timeout_cycles)
            d->io[i].reset_pending = true;
        else if (d->phase_cycles > 2 * d->boot_timeout_cycles)
            takt_drives_io_raise(d, i, TAKT_ERROR_IO_ABSENT,
                                 2e-3 * takt_drives_cycles_ms(d, d->boot_timeout_cycles), NULL);
    }
    return all;
}

/* What a node is asked, and told where there is a length. */
enum step {
    STEP_TYPE,
    STEP_HEARTBEAT,
    STEP_WATCH,
    STEP_GUARD,
    STEP_LIFE,
    STEP_OUTPUT_BYTES,
    STEP_OUTPUTS,
    STEP_ANALOGUE_COUNT,
    STEP_ANALOGUES,
    STEP_INPUT_BYTES,
    STEP_INPUTS,
    STEP_BY_SYNC,
    STEP_COUNT
};
static const struct {
    uint32_t object;
    uint8_t length;
} steps[STEP_COUNT] = {
    {SDO_OBJECT(OBJECT_DEVICE_TYPE, 0), 0},        {SDO_OBJECT(OBJECT_PRODUCER_HEARTBEAT, 0), 2},
    {SDO_OBJECT(OBJECT_CONSUMER_HEARTBEAT, 1), 4}, {SDO_OBJECT(OBJECT_GUARD_TIME, 0), 2},
    {SDO_OBJECT(OBJECT_LIFE_TIME_FACTOR, 0), 1},   {SDO_OBJECT(OBJECT_RPDO_MAPPING, 0), 0},
    {SDO_OBJECT(OBJECT_RPDO_MAPPING, 1), 0},       {SDO_OBJECT(OBJECT_RPDO_MAPPING + 1, 0), 0},
    {SDO_OBJECT(OBJECT_RPDO_MAPPING + 1, 1), 0},   {SDO_OBJECT(OBJECT_TPDO_MAPPING, 0), 0},
    {SDO_OBJECT(OBJECT_TPDO_MAPPING, 1), 0},       {SDO_OBJECT(OBJECT_TPDO, OBJECT_PDO_TYPE), 1},
};

static uint32_t value_of(const struct drives *d)
{
    const uint32_t lost_ms = (uint32_t)d->heartbeat_ms * DRIVES_HEARTBEATS_LOST;
    switch (d->at_step) {
    case STEP_HEARTBEAT:
        return d->heartbeat_ms;
    case STEP_WATCH:
        return (uint32_t)d->controller_node << 16 | lost_ms;
    case STEP_GUARD:
        return takt_drives_guard_ms(d);
    case STEP_LIFE:
        return DRIVES_HEARTBEATS_LOST;
    default:
        return PDO_EVERY_SYNC;
    }
}

/*
 * Nothing is asked of outputs or inputs that nobody wants; only what has no heartbeat is guarded.
 */
static bool is_wanted(const struct io_wiring *wiring, const struct drives_io *io, unsigned step)
{
    if (step == STEP_GUARD || step == STEP_LIFE)
        return io->is_mute;
    if (step == STEP_OUTPUT_BYTES || step == STEP_OUTPUTS)
        return drives_io_bytes_of(wiring->output) > 0;
    if (step == STEP_ANALOGUE_COUNT || step == STEP_ANALOGUES)
        return io_wired_analogues(wiring) > 0;
    return step < STEP_INPUT_BYTES || drives_io_bytes_of(wiring->input) > 0;
}

/* False: all nodes have been asked. */
static bool ask_next(struct drives *d)
{
    while (d->at_axis < d->io_count) {
        const struct io_wiring *wiring = &d->wiring[d->at_axis];
        while (d->at_step < STEP_COUNT && !is_wanted(wiring, &d->io[d->at_axis], d->at_step))
            d->at_step++;
        if (d->at_step < STEP_COUNT) {
            const struct drives_step step = {steps[d->at_step].object, steps[d->at_step].length,
                                             value_of(d)};
            takt_drives_ask(d, drives_io_bus_of(d, d->at_axis), wiring->node, &step);
            return true;
        }
        d->at_axis++;
        d->at_step = 0;
    }
    return false;
}

/*
 * Without a heartbeat, and without guarding, nobody would know of a node that has failed; all else
 * that it refuses makes up for itself.
 */
static void take_refusal(struct drives *d, unsigned i)
{
    TAKT_ASSERT(i < d->io_count);
    d->io[i].is_mute = d->io[i].is_mute || (d->at_step == STEP_HEARTBEAT && d->heartbeat_ms > 0);
    if (d->at_step != STEP_WATCH && d->at_step != STEP_BY_SYNC && d->at_step != STEP_LIFE &&
        !(d->at_step == STEP_HEARTBEAT && d->io[i].is_mute))
        raise_object(d, i, TAKT_ERROR_IO_REFUSES, d->sdo.abort_code,
                     takt_sdo_abort_text(d->sdo.abort_code));
}

static void require(struct drives *d, unsigned i, bool is_so, uint32_t value)
{
    if (!is_so)
        raise_object(d, i, TAKT_ERROR_IO_UNMAPPED, value, NULL);
}

static void take_value(struct drives *d, unsigned i, uint32_t value)
{
    const struct io_wiring *wiring = &d->wiring[i];
    struct drives_io *io = &d->io[i];
    TAKT_ASSERT(i < d->io_count);
    switch ((enum step)d->at_step) {
    case STEP_TYPE:
        if ((value & OBJECT_DEVICE_PROFILE_MASK) != OBJECT_DEVICE_PROFILE_401)
            takt_drives_io_raise(d, i, TAKT_ERROR_IO_TYPE, value, NULL);
        break;
    case STEP_OUTPUT_BYTES:
        io->output_bytes = (uint8_t)value;
        require(d, i, value >= drives_io_bytes_of(wiring->output) && value <= d->frame_max, value);
        break;
    case STEP_OUTPUTS:
        require(d, i, value == PDO_MAPPED(OBJECT_IO_OUTPUTS, 1, BITS_PER_BYTE), value);
        break;
    case STEP_ANALOGUE_COUNT:
        io->analogues = (uint8_t)value;
        require(d, i, value >= io_wired_analogues(wiring) && value <= IO_ANALOGUE_MAX, value);
        break;
    case STEP_ANALOGUES:
        require(d, i, value == PDO_MAPPED(OBJECT_IO_ANALOGUE_OUTPUTS, 1, BITS_PER_WORD), value);
        break;
    case STEP_INPUT_BYTES:
        io->input_bytes = (uint8_t)value;
        require(d, i, value >= drives_io_bytes_of(wiring->input) && value <= d->frame_max, value);
        break;
    case STEP_INPUTS:
        require(d, i, value == PDO_MAPPED(OBJECT_IO_INPUTS, 1, BITS_PER_BYTE), value);
        break;
    case STEP_BY_SYNC:
        io->by_sync = true;
        break;
    case STEP_GUARD:
        io->guard.is_on = true;
        break;
    case STEP_HEARTBEAT:
    case STEP_WATCH:
    case STEP_LIFE:
    case STEP_COUNT:
        break;
    }
}

/* What has come of the last request; false: nothing yet, or not the end of it. */
static bool take_answer(struct drives *d)
{
    const unsigned i = d->at_axis;
    switch (d->sdo.result) {
    case SDO_BUSY:
        return false;
    case SDO_UNANSWERED:
        if (d->repeats++ >= DRIVES_SDO_REPEATS)
            raise_object(d, i, TAKT_ERROR_IO_UNANSWERED,
                         takt_drives_cycles_ms(d, d->sdo_timeout_cycles), NULL);
        return true;
    case SDO_DONE:
        take_value(d, i, takt_sdo_client_number(&d->sdo));
        break;
    case SDO_ABORTED:
        take_refusal(d, i);
        break;
    case SDO_IDLE:
        return true;
    }
    d->repeats = 0;
    d->at_step++;
    return true;
}

static bool all_work(const struct drives *d)
{
    bool all = true;
    for (unsigned i = 0; i < d->io_count; i++)
        all = all && d->io[i].started && (d->io[i].heard || d->io[i].input_bytes == 0);
    return all;
}

static void raise_silent(struct drives *d)
{
    for (unsigned i = 0; i < d->io_count; i++)
        if (!d->io[i].started || (!d->io[i].heard && d->io[i].input_bytes > 0))
            takt_drives_io_raise(d, i, TAKT_ERROR_IO_SILENT,
                                 takt_drives_cycles_ms(d, d->start_timeout_cycles), NULL);
}

void takt_drives_io_start(struct drives *d)
{
    if (d->at_axis < d->io_count) {
        if (take_answer(d) && d->state == DRIVES_STARTING && !ask_next(d))
            d->phase_cycles = 0;
    } else if (all_work(d)) {
        d->io_cycles = UINT32_MAX - 1; /* they are due */
        takt_drives_enter_phase(d, DRIVES_START);
    } else if (d->phase_cycles > d->start_timeout_cycles) {
        raise_silent(d);
    }
}

/* It has been started, and has said something since, unless that is just to come. */
static bool is_up(const struct drives *d, const struct drives_io *io)
{
    return io->started && (io->heard || io->input_bytes == 0 ||
                           d->cycle - io->reported <= d->answer_timeout_cycles);
}

/*
 * One node a cycle, once all have been asked; what one has sent before is history. A start may get
 * lost: it comes again.
 */
void takt_drives_io_send_start(struct drives *d, const struct can_port *port)
{
    for (unsigned i = 0; i < d->io_count && d->at_axis == d->io_count; i++) {
        struct drives_io *io = &d->io[i];
        if (is_up(d, io))
            continue;
        io->started = send_nmt(d, port, i, NMT_START);
        takt_drives_begin_guard(d, &io->guard);
        io->heard = false;
        io->reported = io->heartbeat = d->cycle;
        return;
    }
}

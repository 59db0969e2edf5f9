/*
 * The I/O nodes beside the drives (CiA 401): outputs to valves and contactors, inputs back, of
 * which some stop the axes.
 *
 * A node is used as CiA 401 says it is at power-on: its first RPDO has the outputs (6200), its
 * first TPDO the inputs (6000), eight a byte, and its second RPDO analogue outputs (6411). That is
 * checked and not changed; the inputs are asked for in every SYNC, so that one lost frame costs a
 * cycle, and a node that sends nothing is known within answer_timeout_cycles. A node that cannot do
 * so sends them when they change.
 *
 *     BOOT, with the drives; DRIVES_IO: asked and told, one node after the other; started, one a cycle; inputs have come
 *     (drives_io_boot.c)
 */
#include "base/assert.h"
#include "base/maths.h"
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/objects.h"
#include "drive/drives_private.h"

#include <string.h>

#define BITS_PER_BYTE 8
#define IO_KINDS      (IO_INVERTED - 1)
#define PERCENT       100.0

/* Index of node k in axis_of_node. */
#define INDEX_OF_IO(k) (AXIS_COUNT + 1U + (k))

/* The inputs whose byte is this under a mask. */
static uint16_t find_inputs(const struct io_wiring *wiring, unsigned mask, unsigned byte)
{
    unsigned found = 0;
    for (unsigned i = 0; i < IO_BITS_MAX; i++)
        if ((wiring->input[i] & mask) == byte)
            found |= 1u << i;
    return (uint16_t)found;
}

void takt_drives_io_init(struct drives *d, const struct drives_config *config)
{
    TAKT_ASSERT(config->io_count <= IO_NODES_MAX);
    d->io_count = (uint8_t)config->io_count;
    d->wiring = config->wiring;
    for (unsigned i = 0; i < d->io_count; i++) {
        const struct io_wiring *wiring = &d->wiring[i];
        struct drives_io *io = &d->io[i];
        io->inverted = find_inputs(wiring, IO_INVERTED, IO_INVERTED);
        io->stop_bits = find_inputs(wiring, IO_KINDS, IO_STOP);
        io->limit_bits = find_inputs(wiring, IO_KINDS, IO_LIMIT);
        io->reset_pending = true;
        d->axis_of_node[drives_io_bus_of(d, i)][wiring->node] = (uint8_t)INDEX_OF_IO(i);
    }
}

/* "node 20", "node 1:20". */
struct word takt_drives_io_name(const struct drives *d, unsigned i)
{
    struct word word = {.length = 0};
    TAKT_ASSERT(i < d->io_count);
    takt_drives_name_node(&word, drives_io_bus_of(d, i), d->wiring[i].node);
    return word;
}

void takt_drives_io_raise(struct drives *d, unsigned i, enum takt_error error, double value,
                          const char *meaning)
{
    const struct word word = takt_drives_io_name(d, i);
    takt_drives_raise_named(d, &word, error, value, meaning);
}

/* "bit 4 of I/O node 20", of the first of these bits. */
static void raise_bit(struct drives *d, unsigned i, enum takt_error error, unsigned bits)
{
    struct word word = {.length = 0};
    unsigned bit = 0;
    TAKT_ASSERT(bits != 0);
    while (!(bits >> bit & 1))
        bit++;
    takt_word_add_text(&word, "bit ");
    takt_word_add_number(&word, bit);
    takt_word_add_text(&word, " of I/O ");
    takt_drives_name_node(&word, drives_io_bus_of(d, i), d->wiring[i].node);
    takt_drives_raise_named(d, &word, error, bit, NULL);
}

static bool are_watched(const struct drives *d)
{
    return d->state == DRIVES_STARTING ? d->phase > DRIVES_IO : d->state <= DRIVES_STOPPING;
}

static void take_inputs(struct drives *d, struct drives_io *io, const struct can_frame *frame)
{
    if (!io->started || io->input_bytes == 0 || frame->length < io->input_bytes)
        return;
    const unsigned high = io->input_bytes > 1 ? frame->data[1] : 0;
    io->levels = (uint16_t)((frame->data[0] | high << BITS_PER_BYTE) ^ io->inverted);
    io->reported = d->cycle;
    if (!io->heard)
        io->low_limits = io->limit_bits & (uint16_t)~io->levels;
    io->heard = true;
}

/* A node that boots while the drives are started has forgotten what it was told. */
static void take_heartbeat(struct drives *d, unsigned i, const struct can_frame *frame)
{
    struct drives_io *io = &d->io[i];
    enum nmt_state state;
    TAKT_ASSERT(i < d->io_count);
    if (!nmt_read_state(frame, &state))
        return;
    if (drives_takes_beat(&io->guard, frame))
        io->heartbeat = d->cycle;
    if (state == NMT_BOOTED && d->state == DRIVES_STARTING && d->phase < DRIVES_IO)
        io->booted = !io->reset_pending;
    else if (state == NMT_BOOTED || (state != NMT_OPERATIONAL && are_watched(d)))
        takt_drives_io_raise(d, i, TAKT_ERROR_IO_LEFT, state, drives_nmt_text(state));
}

static void take_emergency(struct drives *d, unsigned i, const struct can_frame *frame)
{
    struct emcy emcy;
    TAKT_ASSERT(i < d->io_count);
    if (takt_emcy_read(frame, &emcy) && emcy.code != EMCY_NONE && are_watched(d))
        takt_drives_io_raise(d, i, TAKT_ERROR_IO_FAULT, emcy.code, takt_emcy_text(emcy.code));
}

void takt_drives_io_take(struct drives *d, unsigned index, const struct can_frame *frame)
{
    if (index == AXIS_COUNT)
        return;
    const unsigned i = index - INDEX_OF_IO(0);
    TAKT_ASSERT(i < d->io_count);
    switch (node_function(frame->id)) {
    case PDO_TPDO1_FUNCTION:
        take_inputs(d, &d->io[i], frame);
        break;
    case SDO_RESPONSE_FUNCTION:
        drives_take_sdo(d, drives_io_bus_of(d, i), frame);
        break;
    case NMT_HEARTBEAT_FUNCTION:
        take_heartbeat(d, i, frame);
        break;
    case EMCY_FUNCTION:
        take_emergency(d, i, frame);
        break;
    default:
        break;
    }
}

static void check_silence(struct drives *d, unsigned i)
{
    const struct drives_io *io = &d->io[i];
    const uint32_t silent = d->cycle - io->reported, heartbeat_age = d->cycle - io->heartbeat;
    TAKT_ASSERT(i < d->io_count);
    if (io->by_sync && silent > d->answer_timeout_cycles)
        takt_drives_io_raise(d, i, TAKT_ERROR_IO_SILENT, takt_drives_cycles_ms(d, silent), NULL);
    if (heartbeat_age > d->heartbeat_age_max_cycles)
        takt_drives_io_raise(d, i, TAKT_ERROR_IO_HEARTBEAT, takt_drives_cycles_ms(d, heartbeat_age),
                             NULL);
}

/*
 * Limit inputs stop when they become low, so that an axis can be driven off; and not while drives
 * look for home there.
 */
static void check_inputs(struct drives *d, unsigned i)
{
    struct drives_io *io = &d->io[i];
    const unsigned low = ~(unsigned)io->levels;
    const unsigned opened = low & io->limit_bits & ~(unsigned)io->low_limits;
    TAKT_ASSERT(i < d->io_count);
    io->low_limits = (uint16_t)(low & io->limit_bits);
    if (low & io->stop_bits)
        raise_bit(d, i, TAKT_ERROR_IO_STOP, low & io->stop_bits);
    else if (opened != 0 && d->state != DRIVES_STARTING)
        raise_bit(d, i, TAKT_ERROR_IO_LIMIT, opened);
}

/* Silence counts from when that of drives does: nothing has torque before. */
void takt_drives_io_check(struct drives *d)
{
    for (unsigned i = 0; i < d->io_count && are_watched(d); i++) {
        if (d->state != DRIVES_STARTING || takt_drives_are_watched(d))
            check_silence(d, i);
        check_inputs(d, i);
    }
}

void takt_drives_add_inputs(const struct drives *d, struct inputs *inputs)
{
    for (unsigned i = 0; i < d->io_count; i++) {
        for (unsigned k = 0; k < IO_BITS_MAX; k++) {
            const unsigned kind = io_kind(d->wiring[i].input[k]);
            if (kind < IO_PROGRAM || kind >= IO_FLOOD)
                continue;
            const uint32_t line = UINT32_C(1) << (kind - IO_PROGRAM);
            inputs->digital &= ~line;
            if (d->io[i].levels >> k & 1)
                inputs->digital |= line;
        }
    }
}

bool takt_drives_find_input(const struct drives *d, enum io_bit kind, bool *is_high)
{
    for (unsigned i = 0; i < d->io_count; i++) {
        const uint16_t bits = find_inputs(&d->wiring[i], IO_KINDS, kind);
        *is_high = (d->io[i].levels & bits) != 0;
        if (bits != 0)
            return true;
    }
    return false;
}

/* ---- Outputs ---- */

static bool level_of(const struct outputs *outputs, unsigned kind)
{
    switch (kind) {
    case IO_FREE:
        return false;
    case IO_FLOOD:
        return outputs->flood;
    case IO_MIST:
        return outputs->mist;
    case IO_SPINDLE:
        return outputs->spindle_speed_rpm > 0 || outputs->spindle_speed_rpm < 0 ||
               outputs->spindle_orient;
    case IO_SPINDLE_CCW:
        return outputs->spindle_speed_rpm < 0;
    case IO_TOOL_CHANGE:
        return outputs->tool_change;
    default:
        if (kind >= IO_TOOL)
            return outputs->tool_asked >> (kind - IO_TOOL) & 1;
        return outputs->digital >> (kind - IO_PROGRAM) & 1;
    }
}

static unsigned levels_of(const struct io_wiring *wiring, const struct outputs *outputs)
{
    unsigned levels = 0;
    for (unsigned k = 0; k < IO_BITS_MAX; k++) {
        const bool is_inverted = wiring->output[k] & IO_INVERTED;
        if (level_of(outputs, io_kind(wiring->output[k])) != is_inverted)
            levels |= 1u << k;
    }
    return levels;
}

static void send_levels(struct drives *d, unsigned i, const struct can_port *port, unsigned levels)
{
    struct can_frame frame = {.id = (uint16_t)(PDO_RPDO1_FUNCTION + d->wiring[i].node),
                              .length = d->io[i].output_bytes};
    TAKT_ASSERT(i < d->io_count);
    little_endian_write16(frame.data, (uint16_t)levels);
    if (drives_send_frame(&port[drives_io_bus_of(d, i)], &frame))
        d->io[i].sent = (uint16_t)levels;
}

/* Per cent of the whole range. */
static int16_t analogue_of(const struct outputs *outputs, unsigned wired)
{
    const double percent = wired > 0 ? outputs->analogue[wired - 1] : 0;
    TAKT_ASSERT(wired <= OUTPUTS_ANALOGUE_MAX);
    return (int16_t)takt_maths_round(maths_clamp(percent, -PERCENT, PERCENT) *
                                     (INT16_MAX / PERCENT));
}

/* In every cycle: a controlled laser follows the path as closely as that. */
static void send_analogues(const struct drives *d, unsigned i, const struct can_port *port,
                           const struct outputs *outputs)
{
    const unsigned count = d->io[i].analogues;
    struct can_frame frame = {.id = (uint16_t)(PDO_RPDO2_FUNCTION + d->wiring[i].node),
                              .length = (uint8_t)(2 * count)};
    TAKT_ASSERT(i < d->io_count);
    for (unsigned k = 0; k < count; k++)
        little_endian_write16(frame.data + (size_t)2 * k,
                              (uint16_t)analogue_of(outputs, io_get_analogue(&d->wiring[i], k)));
    (void)drives_send_frame(&port[drives_io_bus_of(d, i)],
                            &frame); /* a refused one is followed by the next */
}

/* When they change, and all again as often as drives tell their errors: a frame may get lost. */
void takt_drives_send_outputs(struct drives *d, const struct can_port *port,
                              const struct outputs *outputs)
{
    const bool is_due = ++d->io_cycles >= DRIVES_EVENT_MS * 1000U / d->cycle_us;
    for (unsigned i = 0; i < d->io_count; i++) {
        const unsigned levels = levels_of(&d->wiring[i], outputs);
        if (d->io[i].started && d->io[i].output_bytes > 0 && (is_due || levels != d->io[i].sent))
            send_levels(d, i, port, levels);
        if (d->io[i].started && d->io[i].analogues > 0)
            send_analogues(d, i, port, outputs);
    }
    if (is_due)
        d->io_cycles = 0;
}

/*
 * Load of a bus: inputs and analogue outputs of every node, and the longest outputs: they do not
 * change every cycle.
 */
struct io_load {
    uint32_t cyclic_bits, output_bits;
};

static uint32_t bits_of(const struct drives_rates *rates, unsigned bytes)
{
    return bytes > 0 ? takt_drives_frame_bits(rates, bytes) : 0;
}

static void add_load(struct io_load *load, const struct drives_rates *rates, unsigned input_bytes,
                     unsigned output_bytes, unsigned analogues)
{
    const uint32_t output_bits = bits_of(rates, output_bytes);
    load->cyclic_bits += bits_of(rates, input_bytes) + bits_of(rates, 2 * analogues);
    load->output_bits = output_bits > load->output_bits ? output_bits : load->output_bits;
}

uint32_t takt_drives_io_bits(const struct drives *d, unsigned bus)
{
    struct io_load load = {0};
    for (unsigned i = 0; i < d->io_count; i++)
        if (drives_io_bus_of(d, i) == bus)
            add_load(&load, &d->rates, d->io[i].input_bytes, d->io[i].output_bytes,
                     d->io[i].analogues);
    return load.cyclic_bits + load.output_bits;
}

uint32_t takt_drives_io_wired_bits(const struct io_wiring *wiring, unsigned count, unsigned bus,
                                   const struct drives_rates *rates)
{
    struct io_load load = {0};
    for (unsigned i = 0; i < count; i++)
        if (wiring[i].bus == bus)
            add_load(&load, rates, drives_io_bytes_of(wiring[i].input),
                     drives_io_bytes_of(wiring[i].output), io_wired_analogues(&wiring[i]));
    return load.cyclic_bits + load.output_bits;
}

/* The frames of a cycle, and how much of the bus they take. */
#include "base/assert.h"
#include "canopen/target_pdo.h"
#include "drive/drives_private.h"
#include "drive/word.h"

#include <stddef.h>

#define HEARTBEAT_LENGTH 1

unsigned takt_drives_group_of(const struct drives_rates *rates)
{
    return rates->data > 0 ? TARGET_PDO_FD : TARGET_PDO_PAIR;
}

unsigned takt_drives_cycle_frames(unsigned count, unsigned group, bool has_errors,
                                  uint8_t length[DRIVES_CYCLE_FRAMES_MAX])
{
    unsigned frames = 0;
    TAKT_ASSERT(group > 0);
    if (count > AXIS_COUNT)
        count = AXIS_COUNT;
    length[frames++] = 0;
    for (unsigned i = 0; i < count; i += group)
        length[frames++] = (uint8_t)(4 * takt_target_pdo_members(count, i, group));
    for (unsigned i = 0; i < count; i++)
        length[frames++] = DRIVES_STATUS_LENGTH;
    if (has_errors)
        length[frames++] = DRIVES_STATUS_LENGTH;
    length[frames++] = HEARTBEAT_LENGTH;
    return frames;
}

/*
 * Bits of a data frame with an 11-bit identifier and n bytes, intermission included: 47 + 8 n, and
 * the most that can be stuffed into its first 34 + 8 n bits, one after the first five and one after
 * every four more:
 *     C = 47 + 8 n + floor((34 + 8 n - 1) / 4)
 * Davis, Burns, Bril, Lukkien: Controller Area Network schedulability analysis, Real-Time Systems
 * 35 (2007), eq. 1.
 */
static uint32_t classical_bits(uint32_t n)
{
    TAKT_ASSERT(n <= CAN_CLASSIC_MAX);
    return 47 + 8 * n + (34 + 8 * n - 1) / 4;
}

/*
 * The same of CAN FD (ISO 11898-1:2015), in bits of the nominal rate, rounded up: 32 of these, and
 * at the data rate
 *     D = 33 + 10 n,  n <= 16;  38 + 10 n above
 * The derivation is in host/bus/frame_bits.c.
 */
uint32_t takt_drives_frame_bits(const struct drives_rates *rates, uint32_t n)
{
    if (rates->data == 0)
        return classical_bits(n);
    const uint32_t data_bits = (n <= 16 ? 33 : 38) + 10 * n;
    return 32 + (uint32_t)(((uint64_t)data_bits * rates->nominal + rates->data - 1) / rates->data);
}

uint32_t takt_drives_remote_bits(void)
{
    return classical_bits(0);
}

/* True: the bus carries it. */
static bool set_share(struct drives_load *load, uint32_t bitrate, uint32_t cycle_us)
{
    double capacity_bits = 1e-6 * (double)cycle_us * (double)bitrate;
    TAKT_ASSERT(capacity_bits >= 0.0);
    load->capacity_bits = (uint32_t)capacity_bits;
    load->percent = 100.0 * load->bits / capacity_bits;
    return load->percent <= 100.0;
}

uint32_t takt_drives_beats(uint32_t nodes, uint32_t heartbeat_ms, uint32_t cycle_us)
{
    TAKT_ASSERT(nodes > 0 && cycle_us > 0);
    const uint32_t between = (uint32_t)(1000 * (uint64_t)heartbeat_ms / cycle_us);
    if (heartbeat_ms == 0)
        return 1;
    return between > 0 ? (nodes + between - 1) / between : nodes;
}

/* Beside the first one: drives, I/O nodes and the controller. */
static uint32_t more_beats(const struct drives_traffic *traffic, uint32_t cycle_us)
{
    uint32_t nodes = traffic->count + 1;
    for (unsigned i = 0; i < traffic->io_count; i++)
        nodes += traffic->wiring[i].bus == traffic->bus;
    return takt_drives_beats(nodes, traffic->heartbeat_ms, cycle_us) - 1;
}

bool takt_drives_predict_whole_load(const struct drives_traffic *traffic, uint32_t cycle_us,
                                    struct drives_load *load)
{
    const struct drives_rates *rates = &traffic->rates;
    uint8_t length[DRIVES_CYCLE_FRAMES_MAX];
    unsigned frames = takt_drives_cycle_frames(traffic->count, takt_drives_group_of(rates),
                                               !traffic->no_error_pdo, length);
    load->bits = takt_drives_io_wired_bits(traffic->wiring, traffic->io_count, traffic->bus, rates);
    for (unsigned i = 0; i < frames; i++)
        load->bits += takt_drives_frame_bits(rates, length[i]);
    load->bits += more_beats(traffic, cycle_us) * takt_drives_frame_bits(rates, HEARTBEAT_LENGTH);
    return set_share(load, rates->nominal, cycle_us);
}

bool takt_drives_predict_load(unsigned count, const struct drives_rates *rates, uint32_t cycle_us,
                              struct drives_load *load)
{
    const struct drives_traffic traffic = {.count = count, .rates = *rates};
    return takt_drives_predict_whole_load(&traffic, cycle_us, load);
}

/*
 * Length at most of a TPDO with something that ends at this byte: one that the drive keeps may hold
 * more.
 */
static uint8_t length_at_most(const struct drives *d, unsigned i, unsigned end)
{
    const struct drives_axis *axis = &d->axis[i];
    bool is_kept = axis->config.keeps_settings || drives_has_given_up(axis, DRIVES_NO_MAPPING);
    return (uint8_t)(is_kept ? d->frame_max : end);
}

static uint32_t beats_on(const struct drives *d, unsigned bus)
{
    uint32_t nodes = 1;
    for (unsigned i = 0; i < d->count; i++)
        nodes += drives_bus_of(d, i) == bus;
    for (unsigned i = 0; i < d->io_count; i++)
        nodes += drives_io_bus_of(d, i) == bus;
    return takt_drives_beats(nodes, d->heartbeat_ms, d->cycle_us);
}

void takt_drives_get_load(const struct drives *d, unsigned bus, struct drives_load *load)
{
    unsigned error_length = 0;
    bool has_error = false;
    TAKT_ASSERT(bus < CAN_BUSES_MAX);
    load->bits = drives_bits(d, 0) + beats_on(d, bus) * drives_bits(d, HEARTBEAT_LENGTH) +
                 takt_drives_io_bits(d, bus) + takt_drives_guard_bits(d, bus);
    for (unsigned i = 0; i < d->count; i++) {
        if (drives_bus_of(d, i) != bus)
            continue;
        const unsigned length = length_at_most(d, i, DRIVES_STATUS_LENGTH);
        load->bits += d->axis[i].bits;
        if (drives_has_given_up(&d->axis[i], DRIVES_NO_ERROR_PDO))
            continue;
        has_error = true;
        error_length = length > error_length ? length : error_length;
    }
    load->bits += has_error ? drives_bits(d, error_length) : 0;
    (void)set_share(load, d->rates.nominal, d->cycle_us);
}

static unsigned add_pdo(struct drives_pdo pdo[], unsigned count, unsigned id, unsigned length,
                        enum drives_pdo_kind kind)
{
    TAKT_ASSERT(count < DRIVES_CYCLE_PDOS_MAX);
    pdo[count] = (struct drives_pdo){(uint16_t)id, (uint8_t)length, kind};
    return count + (length > 0);
}

static unsigned add_axis(const struct drives *d, unsigned i, struct drives_pdo pdo[],
                         unsigned count)
{
    const struct drives_axis *axis = &d->axis[i];
    const struct drives_frame *target = &axis->target_frame;
    bool is_one = axis->status_id == axis->position_id;
    uint8_t status = length_at_most(d, i, axis->status_end);
    uint8_t position = length_at_most(d, i, axis->position_end);
    TAKT_ASSERT(i < d->count);
    if (!is_one)
        count = add_pdo(pdo, count, axis->status_id, status, DRIVES_PDO_REPORT);
    count = add_pdo(pdo, count, axis->position_id, is_one && status > position ? status : position,
                    DRIVES_PDO_REPORT);
    if (!axis->is_paired || drives_ends_group(d, i))
        count = add_pdo(pdo, count, target->cob_id, target->length, DRIVES_PDO_TARGET);
    if (!drives_has_given_up(axis, DRIVES_NO_ERROR_PDO))
        count = add_pdo(pdo, count, axis->error_id, length_at_most(d, i, DRIVES_STATUS_LENGTH),
                        DRIVES_PDO_ERROR);
    return count;
}

static unsigned add_io(const struct drives *d, unsigned i, struct drives_pdo pdo[], unsigned count)
{
    const struct drives_io *io = &d->io[i];
    const unsigned node = d->wiring[i].node;
    TAKT_ASSERT(i < d->io_count);
    count = add_pdo(pdo, count, PDO_TPDO1_FUNCTION + node, io->input_bytes, DRIVES_PDO_INPUTS);
    count = add_pdo(pdo, count, PDO_RPDO1_FUNCTION + node, io->output_bytes, DRIVES_PDO_OUTPUTS);
    return add_pdo(pdo, count, PDO_RPDO2_FUNCTION + node, 2U * io->analogues, DRIVES_PDO_OUTPUTS);
}

unsigned takt_drives_get_pdos(const struct drives *d, unsigned bus,
                              struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX])
{
    unsigned count = 0;
    TAKT_ASSERT(bus < CAN_BUSES_MAX);
    for (unsigned i = 0; i < d->count; i++)
        if (drives_bus_of(d, i) == bus)
            count = add_axis(d, i, pdo, count);
    for (unsigned i = 0; i < d->io_count; i++)
        if (drives_io_bus_of(d, i) == bus)
            count = add_io(d, i, pdo, count);
    return count;
}

unsigned takt_drives_get_report(const struct drives *d, unsigned bus, uint16_t id)
{
    unsigned report = 0;
    for (unsigned i = 0; i < d->count; i++) {
        if (drives_bus_of(d, i) != bus)
            continue;
        if (d->axis[i].status_id == id)
            report |= DRIVES_REPORTS_STATUS;
        if (d->axis[i].position_id == id)
            report |= DRIVES_REPORTS_POSITION;
    }
    return report;
}

/* "1310 of 1000 bits", "1310 of 1000 bits of can1". */
void takt_drives_set_overload(const struct drives_load *load, unsigned bus,
                              struct diagnostic *fault)
{
    struct word word = {.length = 0};
    takt_word_add_number(&word, load->bits);
    takt_word_add_text(&word, " of ");
    takt_word_add_number(&word, load->capacity_bits);
    takt_word_add_text(&word, " bits");
    if (bus > 0) {
        takt_word_add_text(&word, " of can");
        takt_word_add_number(&word, bus);
    }
    takt_diagnostic_set(fault, TAKT_ERROR_BUS_OVERLOAD, 0, 0, word.text, word.length,
                        load->percent);
}

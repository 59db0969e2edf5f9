/* The frames of a cycle, and how much of the bus they take. */
#include "drive/drives_private.h"
#include "drive/word.h"

#include <stddef.h>

#define HEARTBEAT_LENGTH 1

unsigned drives_cycle_frames(unsigned count, uint8_t length[DRIVES_CYCLE_FRAMES_MAX])
{
    unsigned frames = 0;
    if (count > AXIS_COUNT)
        count = AXIS_COUNT;
    length[frames++] = 0;
    for (unsigned i = 0; i < count; i += 2)
        length[frames++] = i + 1 < count ? 8 : 4;
    for (unsigned i = 0; i < count; i++)
        length[frames++] = DRIVES_STATUS_LENGTH;
    length[frames++] = DRIVES_STATUS_LENGTH;
    length[frames++] = HEARTBEAT_LENGTH;
    return frames;
}

/*
 * Bits of a data frame with an 11-bit identifier and n bytes, intermission included: 47 + 8 n, and the most that can
 * be stuffed into its first 34 + 8 n bits, one after the first five and one after every four more:
 *     C = 47 + 8 n + floor((34 + 8 n - 1) / 4)
 * Davis, Burns, Bril, Lukkien: Controller Area Network schedulability analysis, Real-Time Systems 35 (2007), eq. 1.
 */
uint32_t drives_frame_bits(uint32_t n)
{
    return 47 + 8 * n + (34 + 8 * n - 1) / 4;
}

/* True: the bus carries it. */
static bool set_share(struct drives_load *load, uint32_t bitrate, uint32_t cycle_us)
{
    double capacity_bits = 1e-6 * (double)cycle_us * (double)bitrate;
    load->capacity_bits = (uint32_t)capacity_bits;
    load->percent = 100.0 * load->bits / capacity_bits;
    return load->percent <= 100.0;
}

bool drives_predict_whole_load(unsigned count, const struct io_wiring *wiring, unsigned io_count,
                               uint32_t bitrate, uint32_t cycle_us, struct drives_load *load)
{
    uint8_t length[DRIVES_CYCLE_FRAMES_MAX];
    unsigned frames = drives_cycle_frames(count, length);
    load->bits = drives_io_wired_bits(wiring, io_count);
    for (unsigned i = 0; i < frames; i++)
        load->bits += drives_frame_bits(length[i]);
    return set_share(load, bitrate, cycle_us);
}

bool drives_predict_load(unsigned count, uint32_t bitrate, uint32_t cycle_us,
                         struct drives_load *load)
{
    return drives_predict_whole_load(count, NULL, 0, bitrate, cycle_us, load);
}

/* Of a TPDO with something that ends at this byte: one that the drive keeps may hold more. */
static uint8_t length_at_most(const struct drives_axis *axis, unsigned end)
{
    bool is_kept = axis->config.keeps_settings || drives_has_given_up(axis, DRIVES_NO_MAPPING);
    return (uint8_t)(is_kept ? CAN_DATA_MAX : end);
}

static uint32_t longer(uint32_t bits, unsigned length)
{
    const uint32_t other = drives_frame_bits(length);
    return bits > other ? bits : other;
}

void drives_get_load(const struct drives *d, struct drives_load *load)
{
    uint32_t error_bits = 0;
    load->bits = drives_frame_bits(0) + drives_frame_bits(HEARTBEAT_LENGTH) + drives_io_bits(d) +
                 drives_guard_bits(d);
    for (unsigned i = 0; i < d->count; i++) {
        load->bits += d->axis[i].bits;
        if (!drives_has_given_up(&d->axis[i], DRIVES_NO_ERROR_PDO))
            error_bits = longer(error_bits, length_at_most(&d->axis[i], DRIVES_STATUS_LENGTH));
    }
    load->bits += error_bits;
    (void)set_share(load, d->bitrate, d->cycle_us);
}

static unsigned add_pdo(struct drives_pdo pdo[], unsigned count, unsigned id, unsigned length,
                        enum drives_pdo_kind kind)
{
    pdo[count] = (struct drives_pdo){(uint16_t)id, (uint8_t)length, kind};
    return count + (length > 0);
}

static unsigned add_axis(const struct drives *d, unsigned i, struct drives_pdo pdo[],
                         unsigned count)
{
    const struct drives_axis *axis = &d->axis[i];
    const struct drives_frame *target = &axis->target_frame;
    bool is_one = axis->status_id == axis->position_id;
    uint8_t status = length_at_most(axis, axis->status_end);
    uint8_t position = length_at_most(axis, axis->position_end);
    if (!is_one)
        count = add_pdo(pdo, count, axis->status_id, status, DRIVES_PDO_REPORT);
    count = add_pdo(pdo, count, axis->position_id, is_one && status > position ? status : position,
                    DRIVES_PDO_REPORT);
    if (!axis->is_paired || i & 1)
        count = add_pdo(pdo, count, target->cob_id, target->length, DRIVES_PDO_TARGET);
    if (!drives_has_given_up(axis, DRIVES_NO_ERROR_PDO))
        count = add_pdo(pdo, count, axis->error_id, length_at_most(axis, DRIVES_STATUS_LENGTH),
                        DRIVES_PDO_ERROR);
    return count;
}

static unsigned add_io(const struct drives *d, unsigned i, struct drives_pdo pdo[], unsigned count)
{
    const struct drives_io *io = &d->io[i];
    const unsigned node = d->wiring[i].node;
    count = add_pdo(pdo, count, PDO_TPDO1_FUNCTION + node, io->input_bytes, DRIVES_PDO_INPUTS);
    count = add_pdo(pdo, count, PDO_RPDO1_FUNCTION + node, io->output_bytes, DRIVES_PDO_OUTPUTS);
    return add_pdo(pdo, count, PDO_RPDO2_FUNCTION + node, 2U * io->analogues, DRIVES_PDO_OUTPUTS);
}

unsigned drives_get_pdos(const struct drives *d, struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX])
{
    unsigned count = 0;
    for (unsigned i = 0; i < d->count; i++)
        count = add_axis(d, i, pdo, count);
    for (unsigned i = 0; i < d->io_count; i++)
        count = add_io(d, i, pdo, count);
    return count;
}

unsigned drives_get_report(const struct drives *d, uint16_t id)
{
    unsigned report = 0;
    for (unsigned i = 0; i < d->count; i++) {
        if (d->axis[i].status_id == id)
            report |= DRIVES_REPORTS_STATUS;
        if (d->axis[i].position_id == id)
            report |= DRIVES_REPORTS_POSITION;
    }
    return report;
}

/* "1310 of 1000 bits". */
void drives_set_overload(const struct drives_load *load, struct diagnostic *fault)
{
    struct word word = {.length = 0};
    word_add_number(&word, load->bits);
    word_add_text(&word, " of ");
    word_add_number(&word, load->capacity_bits);
    word_add_text(&word, " bits");
    diagnostic_set(fault, TAKT_ERROR_BUS_OVERLOAD, 0, 0, word.text, word.length, load->percent);
}

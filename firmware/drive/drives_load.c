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

void drives_get_load(const struct drives *d, struct drives_load *load)
{
    bool has_error = false;
    load->bits = drives_frame_bits(0) + drives_frame_bits(HEARTBEAT_LENGTH) + drives_io_bits(d) +
                 drives_guard_bits(d);
    for (unsigned i = 0; i < d->count; i++) {
        load->bits += d->axis[i].bits;
        has_error = has_error || !drives_has_given_up(&d->axis[i], DRIVES_NO_ERROR_PDO);
    }
    if (has_error)
        load->bits += drives_frame_bits(DRIVES_STATUS_LENGTH);
    (void)set_share(load, d->bitrate, d->cycle_us);
}

/* Of a TPDO with something that ends at this byte: one that the drive keeps may hold more. */
static uint8_t length_at_most(const struct drives_axis *axis, unsigned end)
{
    bool is_kept = axis->config.keeps_settings || drives_has_given_up(axis, DRIVES_NO_MAPPING);
    return (uint8_t)(is_kept ? CAN_DATA_MAX : end);
}

unsigned drives_get_pdos(const struct drives *d, struct drives_pdo pdo[DRIVES_CYCLE_PDOS_MAX])
{
    unsigned count = 0;
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_axis *axis = &d->axis[i];
        bool is_one = axis->status_id == axis->position_id;
        uint8_t status = length_at_most(axis, axis->status_end);
        uint8_t position = length_at_most(axis, axis->position_end);
        if (!is_one)
            pdo[count++] = (struct drives_pdo){axis->status_id, status, false};
        pdo[count++] = (struct drives_pdo){axis->position_id,
                                           is_one && status > position ? status : position, false};
        if (!axis->is_paired || i & 1)
            pdo[count++] =
                (struct drives_pdo){axis->target_frame.cob_id, axis->target_frame.length, true};
    }
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

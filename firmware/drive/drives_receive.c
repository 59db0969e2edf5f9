/* What drives and I/O nodes send: positions, statuswords, heartbeats, emergencies, answers. */
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/node.h"
#include "drive/drives_private.h"

/*
 * Frames taken of a bus in one cycle at most, so that a babbling bus cannot hold the control cycle.
 */
#define FRAMES_PER_CYCLE_MAX 256

static inline void set_position(struct drives *d, struct drives_axis *axis, uint32_t raw)
{
    axis->actual_inc = (int32_t)raw;
    axis->actual_mm = axis->actual_inc / axis->config.increments_per_mm;
    axis->reported = d->cycle;
    d->actual.at[axis->config.axis] = axis->actual_mm;
}

/*
 * The plain form, which nearly all reports have: the statusword, then the position, and nothing
 * else to be done.
 */
static inline void take_status(struct drives *d, struct drives_axis *axis,
                               const struct can_frame *frame)
{
    if (frame->length < DRIVES_STATUS_LENGTH || !axis->started)
        return;
    axis->statusword = little_endian_read16(frame->data);
    axis->heard = true;
    set_position(d, axis, little_endian_read32(frame->data + 2));
}

/*
 * A report of any form: statusword, position or both; a frame too short for its position counts for
 * nothing.
 */
static void take_report(struct drives *d, struct drives_axis *axis, const struct can_frame *frame)
{
    bool has_position = frame->id == axis->position_id;
    if (!axis->started || (has_position && frame->length < axis->position_end))
        return;
    if (frame->id == axis->status_id && frame->length >= axis->status_end) {
        axis->statusword = little_endian_read16(frame->data + axis->status_end - 2);
        axis->heard = true;
        if (axis->beats_by_status)
            axis->heartbeat = d->cycle;
    }
    if (has_position)
        set_position(d, axis, little_endian_read32(frame->data + axis->position_end - 4));
}

/* "All errors are gone" may come in the same cycle as the error, which counts nevertheless. */
static void take_emergency(struct drives *d, unsigned index, const struct can_frame *frame)
{
    struct emcy emcy;
    if (!takt_emcy_read(frame, &emcy))
        return;
    d->axis[index].emcy_code = emcy.code;
    if (emcy.code != EMCY_NONE && takt_drives_are_watched(d))
        takt_drives_raise_reported(d, index, emcy.code);
    takt_drives_complete_fault(d, index, emcy.code);
}

/* Object 603F comes first. It is of use when the emergency has been lost. */
static void take_error_code(struct drives *d, unsigned index, const struct can_frame *frame)
{
    if (frame->length >= 2)
        takt_drives_complete_fault(d, index, little_endian_read16(frame->data));
}

static void take_heartbeat(struct drives *d, unsigned index, const struct can_frame *frame)
{
    struct drives_axis *axis = &d->axis[index];
    enum nmt_state state;
    if (!nmt_read_state(frame, &state))
        return;
    if (drives_takes_beat(&axis->guard, frame))
        axis->heartbeat = d->cycle;
    if (state == NMT_BOOTED && d->state == DRIVES_STARTING)
        takt_drives_start_again(d, index);
    else if (state == NMT_BOOTED)
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_REBOOTED, 0, NULL);
    else if (state != NMT_OPERATIONAL && takt_drives_are_watched(d))
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_NMT, state, drives_nmt_text(state));
}

/* Whatever does not come in every cycle. */
static void take_seldom(struct drives *d, unsigned index, const struct can_frame *frame)
{
    switch (node_function(frame->id)) {
    case EMCY_FUNCTION:
        take_emergency(d, index, frame);
        break;
    case SDO_RESPONSE_FUNCTION:
        drives_take_sdo(d, drives_bus_of(d, index), frame);
        break;
    case NMT_HEARTBEAT_FUNCTION:
        take_heartbeat(d, index, frame);
        break;
    default:
        if (frame->id == d->axis[index].error_id)
            take_error_code(d, index, frame);
        else if (frame->id == d->axis[index].status_id || frame->id == d->axis[index].position_id)
            take_report(d, &d->axis[index], frame);
        break;
    }
}

static void take_frame(struct drives *d, unsigned bus, const struct can_frame *frame)
{
    unsigned index = d->axis_of_node[bus][node_id(frame->id)];
    if (index >= AXIS_COUNT) {
        takt_drives_io_take(d, index, frame);
        return;
    }
    struct drives_axis *axis = &d->axis[index];
    if (frame->id == axis->report_id)
        take_status(d, axis, frame);
    else
        take_seldom(d, index, frame);
}

static void take_frames(struct drives *d, unsigned bus, const struct can_port *port)
{
    struct can_frame frame;
    for (unsigned n = 0; n < FRAMES_PER_CYCLE_MAX && port->receive(port->context, &frame); n++)
        take_frame(d, bus, &frame);
}

void takt_drives_receive(struct drives *d, const struct can_port *port)
{
    for (unsigned bus = 0; bus < drives_bus_count(d); bus++)
        take_frames(d, bus, &port[bus]);
    if (d->io_count > 0)
        takt_drives_io_check(d);
    if (d->gantry_count > 0)
        takt_drives_place_gantries(d);
    switch (d->state) {
    case DRIVES_STARTING:
        takt_drives_start(d);
        break;
    case DRIVES_ENABLED:
        if (drives_probe_is_busy(d))
            takt_drives_probe_next(d);
        takt_drives_check_operation(d);
        break;
    case DRIVES_STOPPING:
        takt_drives_check_operation(d);
        break;
    case DRIVES_BRAKING:
        takt_drives_watch_brakes(d);
        break;
    case DRIVES_FAULTED:
        takt_drives_doubt_homes(d);
        break;
    }
}

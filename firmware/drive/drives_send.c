#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/sync.h"
#include "drive/drives_private.h"

#define INCREMENTS_MAX 2147483647.0

/* RPDO1: controlword and mode of operation. */
#define CONTROL_LENGTH 3

static bool send_frame(const struct can_port *port, const struct can_frame *frame)
{
    return port->send(port->context, frame);
}

void drives_sync(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    (void)d; /* a SYNC that is refused shows as drives that do not answer */
    sync_write(&frame);
    (void)send_frame(port, &frame);
}

static void send_nmt_start(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    nmt_write_command(&frame, NMT_START, NMT_ALL_NODES);
    if (send_frame(port, &frame))
        d->nmt_start_pending = false;
}

/* A controlword that is refused counts as not sent, and comes again in the next cycle. */
static void send_controlword(struct drives_axis *axis, const struct can_port *port,
                             uint16_t controlword)
{
    struct can_frame frame;
    frame.id = (uint16_t)(PDO_RPDO1_FUNCTION + axis->config.node);
    frame.length = CONTROL_LENGTH;
    little_endian_write16(frame.data, controlword);
    frame.data[2] = CIA402_MODE_CYCLIC_SYNC_POSITION;
    if (send_frame(port, &frame))
        axis->controlword = controlword;
}

/*
 * The drives of a pair write into one frame; it is sent when its last drive has written. While
 * drives are being enabled nothing is lost by a refused frame, in operation a setpoint is.
 */
static void send_targets(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_axis *axis = &d->axis[i];
        little_endian_write32(frame.data + axis->target_offset, (uint32_t)axis->target_inc);
        if (i + 1 < d->count && d->axis[i + 1].target_cob_id == axis->target_cob_id)
            continue;
        frame.id = axis->target_cob_id;
        frame.length = (uint8_t)(axis->target_offset + 4);
        if (!send_frame(port, &frame) && d->state == DRIVES_ENABLED)
            drives_raise(d, i, TAKT_ERROR_DRIVE_UNREACHABLE, 0);
    }
}

/*
 * A drive that is not enabled yet is told to be where it is, so that it does not jump when it is.
 * One drive a cycle gets its controlword, in turn and repeatedly: the load stays that of a normal
 * cycle and a frame may get lost.
 */
static void send_starting(struct drives *d, const struct can_port *port)
{
    struct drives_axis *turn = &d->axis[d->cycle % d->count];
    if (d->nmt_start_pending)
        send_nmt_start(d, port);
    if (turn->heard)
        send_controlword(turn, port, cia402_step_to_enabled(cia402_state(turn->statusword)));
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_axis_is_enabled(&d->axis[i]))
            d->axis[i].target_inc = d->axis[i].actual_inc;
    send_targets(d, port);
}

/* increments = round(setpoint increments_per_mm), half away from zero. NaN fails the comparison. */
static void set_target(struct drives *d, unsigned index, double set_mm)
{
    struct drives_axis *axis = &d->axis[index];
    double increments = maths_round(set_mm * axis->config.increments_per_mm);
    if (maths_abs(increments) <= INCREMENTS_MAX)
        axis->target_inc = (int32_t)increments;
    else
        drives_raise(d, index, TAKT_ERROR_DRIVE_RANGE, set_mm);
    axis->sent_mm[d->cycle & (DRIVES_HISTORY - 1)] = set_mm;
}

static void send_operation(struct drives *d, const struct can_port *port,
                           const struct point *setpoint)
{
    for (unsigned i = 0; i < d->count; i++)
        set_target(d, i, setpoint->at[d->axis[i].config.axis]);
    if (d->state == DRIVES_ENABLED)
        send_targets(d, port);
}

/* Drives whose axes have lost a companion leave the path: every one brakes by itself, at once. */
static void send_quick_stop(struct drives *d, const struct can_port *port)
{
    for (unsigned i = 0; i < d->count; i++)
        if (d->axis[i].controlword != CIA402_QUICK_STOP_NOW)
            send_controlword(&d->axis[i], port, CIA402_QUICK_STOP_NOW);
}

void drives_send(struct drives *d, const struct can_port *port, const struct point *setpoint)
{
    switch (d->state) {
    case DRIVES_STARTING:
        send_starting(d, port);
        break;
    case DRIVES_ENABLED:
        send_operation(d, port, setpoint);
        break;
    case DRIVES_FAULTED:
        break;
    }
    if (d->state == DRIVES_FAULTED)
        send_quick_stop(d, port);
    d->cycle++;
}

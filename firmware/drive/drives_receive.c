#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/node.h"
#include "drive/drives_private.h"

/* Frames taken in one cycle at most, so that a babbling bus cannot hold the control cycle. */
#define FRAMES_PER_CYCLE_MAX 256

static void take_status(struct drives_axis *axis, const struct can_frame *frame)
{
    if (frame->length < DRIVES_STATUS_LENGTH)
        return;
    axis->statusword = little_endian_read16(frame->data);
    axis->actual_inc = (int32_t)little_endian_read32(frame->data + 2);
    axis->heard = true;
    axis->silent_cycles = 0;
}

/* An emergency may come after the statusword that told of it: then it completes the diagnostic. */
static void take_emergency(struct drives *d, unsigned index, const struct can_frame *frame)
{
    struct emcy emcy;
    if (!emcy_read(frame, &emcy))
        return;
    d->axis[index].emcy_code = emcy.code;
    if (d->state == DRIVES_FAULTED && d->fault.code == TAKT_ERROR_DRIVE_FAULT &&
        d->fault_axis == index && d->fault.value == 0)
        d->fault.value = emcy.code;
}

/* A drive that boots has forgotten everything: it is not enabled and waits to be started. */
static void take_heartbeat(struct drives *d, struct drives_axis *axis,
                           const struct can_frame *frame)
{
    uint8_t node;
    enum nmt_state state;
    if (!nmt_read_heartbeat(frame, &node, &state) || state != NMT_BOOTED)
        return;
    axis->heard = false;
    axis->statusword = 0;
    d->nmt_start_pending = true;
}

static void take_frame(struct drives *d, const struct can_frame *frame)
{
    unsigned index = d->axis_of_node[node_id(frame->id)];
    if (index == AXIS_COUNT)
        return;
    switch (node_function(frame->id)) {
    case PDO_TPDO1_FUNCTION:
        take_status(&d->axis[index], frame);
        break;
    case EMCY_FUNCTION:
        take_emergency(d, index, frame);
        break;
    case NMT_HEARTBEAT_FUNCTION:
        take_heartbeat(d, &d->axis[index], frame);
        break;
    default:
        break;
    }
}

static bool all_enabled(const struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_axis_is_enabled(&d->axis[i]))
            return false;
    return true;
}

static void raise_not_enabled(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    if (axis->heard)
        drives_raise(d, index, TAKT_ERROR_DRIVE_FAULT, axis->emcy_code);
    else
        drives_raise(d, index, TAKT_ERROR_DRIVE_SILENT, 0);
}

/* The drives stand where they are: as if that had been the setpoint for long. */
static void enter_operation(struct drives *d)
{
    d->state = DRIVES_ENABLED;
    for (unsigned i = 0; i < d->count; i++)
        for (unsigned k = 0; k < DRIVES_HISTORY; k++)
            d->axis[i].sent_mm[k] = drives_axis_actual_mm(&d->axis[i]);
}

static void check_start(struct drives *d)
{
    if (all_enabled(d)) {
        enter_operation(d);
        return;
    }
    if (d->start_cycles++ < d->start_timeout_cycles)
        return;
    for (unsigned i = 0; i < d->count; i++)
        if (!drives_axis_is_enabled(&d->axis[i]))
            raise_not_enabled(d, i);
}

/*
 * lag = setpoint of DRIVES_LATENCY_CYCLES ago - actual position. Without a report this cycle the
 * two do not belong together.
 */
static void check_following(struct drives *d, unsigned index)
{
    const struct drives_axis *axis = &d->axis[index];
    double limit_mm = axis->config.following_error_max_mm;
    if (limit_mm <= 0 || axis->silent_cycles != 0)
        return;
    double set_mm = axis->sent_mm[(d->cycle - DRIVES_LATENCY_CYCLES) & (DRIVES_HISTORY - 1)];
    double lag_mm = maths_abs(set_mm - drives_axis_actual_mm(axis));
    if (lag_mm > limit_mm)
        drives_raise(d, index, TAKT_ERROR_DRIVE_FOLLOWING, lag_mm);
}

static void check_operation(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_axis *axis = &d->axis[i];
        if (cia402_state(axis->statusword) != CIA402_ENABLED)
            drives_raise(d, i, TAKT_ERROR_DRIVE_FAULT, axis->emcy_code);
        else if (axis->silent_cycles > d->answer_timeout_cycles)
            drives_raise(d, i, TAKT_ERROR_DRIVE_SILENT, axis->silent_cycles);
        else
            check_following(d, i);
    }
}

void drives_receive(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    for (unsigned i = 0; i < d->count; i++)
        d->axis[i].silent_cycles++;
    for (unsigned n = 0; n < FRAMES_PER_CYCLE_MAX && port->receive(port->context, &frame); n++)
        take_frame(d, &frame);
    switch (d->state) {
    case DRIVES_STARTING:
        check_start(d);
        break;
    case DRIVES_ENABLED:
        check_operation(d);
        break;
    case DRIVES_FAULTED:
        break;
    }
}

/* What each cycle sends: SYNC, then controlwords and target positions. */
#include "base/assert.h"
#include "base/maths.h"
#include "canopen/cia402.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/sync.h"
#include "drive/drives_private.h"

#include <stddef.h>
#include <string.h>

#define INCREMENTS_MAX 2147483647.0

void takt_drives_sync(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    takt_sync_write(&frame);
    for (unsigned bus = 0; bus < drives_bus_count(d); bus++)
        (void)drives_send_frame(&port[bus],
                                &frame); /* a refused one shows as drives that do not answer */
}

bool takt_drives_send_nmt(const struct can_port *port, enum nmt_command command, uint8_t node)
{
    struct can_frame frame;
    takt_nmt_write_command(&frame, command, node);
    return drives_send_frame(port, &frame);
}

/* A heartbeat that is refused is due again in the next cycle. */
static void send_heartbeat(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    if (d->heartbeat_cycles == 0)
        return;
    takt_nmt_write_heartbeat(&frame, d->controller_node, NMT_OPERATIONAL);
    for (unsigned bus = 0; bus < drives_bus_count(d); bus++)
        if (++d->beat_cycles[bus] >= d->heartbeat_cycles && drives_send_frame(&port[bus], &frame))
            d->beat_cycles[bus] = 0;
}

/* Everything that is in it, as it is now. */
static void fill(struct can_frame *frame, const struct drives_frame *as,
                 const struct drives_axis *axis, uint16_t controlword)
{
    frame->id = as->cob_id;
    frame->length = as->length;
    memcpy(frame->data, as->data, sizeof frame->data);
    if (as->control != DRIVES_NOWHERE)
        little_endian_write16(frame->data + as->control, controlword);
    if (as->mode != DRIVES_NOWHERE)
        frame->data[as->mode] = axis->mode;
    if (as->target != DRIVES_NOWHERE)
        little_endian_write32(frame->data + as->target, (uint32_t)axis->target_inc);
}

/*
 * port: of every bus. A controlword that is refused counts as not sent, and comes again in the next
 * cycle. One that has no PDO is told by SDO while the drives are started; after a fault nobody
 * waits for an answer.
 */
static void send_controlword(struct drives_axis *axis, const struct can_port *port,
                             uint16_t controlword, bool is_urgent)
{
    struct can_frame frame;
    if (axis->control_frame.length > 0)
        fill(&frame, &axis->control_frame, axis, controlword);
    else if (is_urgent)
        takt_sdo_write_word(&frame, axis->config.node, CIA402_CONTROLWORD, controlword);
    else
        return;
    if (drives_send_frame(&port[drives_axis_bus(axis)], &frame))
        axis->controlword = controlword;
}

/*
 * The drives of a group write into one frame of their bus; it is sent when the last of them has
 * written. While drives are being enabled nothing is lost by a refused frame, in operation a
 * setpoint is.
 */
static void send_targets(struct drives *d, const struct can_port *port)
{
    struct can_frame frames[CAN_BUSES_MAX];
    for (unsigned i = 0; i < d->count; i++) {
        const struct drives_axis *axis = &d->axis[i];
        const struct drives_frame *as = &axis->target_frame;
        const unsigned bus = drives_bus_of(d, i);
        struct can_frame *frame = &frames[bus];
        little_endian_write32(frame->data + as->target, (uint32_t)axis->target_inc);
        if (axis->sends == DRIVES_WAITS)
            continue;
        if (axis->sends == DRIVES_SENDS_MIXED)
            fill(frame, as, axis, axis->controlword);
        frame->id = as->cob_id;
        frame->length = as->length;
        if (!drives_send_frame(&port[bus], frame) && d->state != DRIVES_STARTING)
            takt_drives_raise(d, i, TAKT_ERROR_DRIVE_UNREACHABLE, 0, NULL);
    }
}

static bool send_nmt(const struct drives *d, const struct can_port *port, unsigned index,
                     enum nmt_command command)
{
    return takt_drives_send_nmt(&port[drives_bus_of(d, index)], command, d->node[index]);
}

static void send_resets(struct drives *d, const struct can_port *port)
{
    for (unsigned i = 0; i < d->count; i++)
        if (d->axis[i].reset_pending && send_nmt(d, port, i, NMT_RESET_COMMUNICATION))
            d->axis[i].reset_pending = false;
}

/*
 * Many drives take a mapping in this state alone, and some leave it by themselves when they have
 * booted.
 */
static void send_holds(struct drives *d, const struct can_port *port)
{
    for (unsigned i = 0; i < d->count; i++)
        if (d->axis[i].hold_pending && send_nmt(d, port, i, NMT_ENTER_PREOPERATIONAL))
            d->axis[i].hold_pending = false;
}

static void send_request(struct drives *d, const struct can_port *port)
{
    struct can_frame frame;
    if (takt_sdo_client_next(&d->sdo, &frame) && drives_send_frame(&port[d->sdo_bus], &frame))
        takt_sdo_client_sent(&d->sdo);
}

/* The one with the highest node id that has not been started; NULL: none. */
static struct drives_axis *next_to_start(struct drives *d)
{
    struct drives_axis *next = NULL;
    for (unsigned i = 0; i < d->count; i++) {
        struct drives_axis *axis = &d->axis[i];
        if (!axis->started && (next == NULL || axis->config.node > next->config.node))
            next = axis;
    }
    return next;
}

/*
 * One node a cycle, so that event timers run out in different cycles; from the highest id down,
 * since there are drives whose first period is shorter by their id in ms. What a drive has sent
 * before is history, and silence counts from now.
 */
static void send_start(struct drives *d, const struct can_port *port)
{
    struct drives_axis *axis = next_to_start(d);
    if (axis == NULL)
        return;
    axis->started =
        takt_drives_send_nmt(&port[drives_axis_bus(axis)], NMT_START, axis->config.node);
    takt_drives_begin_guard(d, &axis->guard);
    axis->heard = false;
    axis->reported = d->cycle;
    axis->heartbeat = d->cycle;
}

/* Of so many turns one. */
#define START_AGAIN_US 100000U

static bool is_start_due(const struct drives *d)
{
    const uint32_t turns = START_AGAIN_US / d->cycle_us + 1;
    TAKT_ASSERT(d->count > 0);
    return d->phase_cycles / d->count % turns == turns - 1;
}

/*
 * A drive that does not follow setpoints is told to be where it is, so that it does not jump when
 * it does. One drive a cycle gets its controlword, in turn and repeatedly: the load stays that of a
 * normal cycle and a frame may get lost. So may NMT start: one that says nothing gets it again.
 */
static void send_enabling(struct drives *d, const struct can_port *port)
{
    if (d->count == 0)
        return;
    struct drives_axis *turn = &d->axis[d->cycle % d->count];
    if (turn->heard)
        send_controlword(turn, port, takt_drives_controlword(d, turn), false);
    else if (is_start_due(d))
        (void)takt_drives_send_nmt(&port[drives_axis_bus(turn)], NMT_START, turn->config.node);
    for (unsigned i = 0; i < d->count; i++)
        if (!takt_drives_axis_is_enabled(&d->axis[i]) || d->axis[i].mode == CIA402_MODE_HOMING)
            takt_drives_rest(&d->axis[i]);
    send_targets(d, port);
}

static void send_starting(struct drives *d, const struct can_port *port)
{
    switch (d->phase) {
    case DRIVES_BOOT:
        send_resets(d, port);
        takt_drives_io_send_resets(d, port);
        break;
    case DRIVES_CONFIGURE:
        send_holds(d, port);
        send_request(d, port);
        break;
    case DRIVES_IO:
        send_request(d, port);
        takt_drives_io_send_start(d, port);
        break;
    case DRIVES_START:
        send_start(d, port);
        break;
    case DRIVES_ENABLE:
    case DRIVES_SELECT:
    case DRIVES_HOME:
    case DRIVES_FOLLOW:
    case DRIVES_SQUARE:
        send_request(d, port);
        send_enabling(d, port);
        break;
    }
}

/* increments = round(setpoint increments_per_mm). NaN fails the comparison. */
static inline void set_target(struct drives *d, unsigned index, double set_mm)
{
    struct drives_axis *axis = &d->axis[index];
    const double increments = set_mm * axis->config.increments_per_mm;
    if (maths_abs(increments) < INCREMENTS_MAX + 0.5)
        axis->target_inc = maths_nearest(increments);
    else
        takt_drives_raise(d, index, TAKT_ERROR_DRIVE_RANGE, takt_drives_axis_shown(axis, set_mm),
                          NULL);
}

/*
 * The lag is that of the setpoint to which the last report belongs; without a report in this cycle
 * it is not known.
 */
static void steer(struct drives *d, unsigned i)
{
    const struct drives_axis *axis = &d->axis[i];
    const bool is_new = drives_silent_cycles(d, axis) == 0;
    const double lag_mm = drives_sent(d, DRIVES_LATENCY_CYCLES)[i] - axis->actual_mm;
    takt_drives_steer(d, i, drives_sent(d, 0)[i] - drives_sent(d, 1)[i], is_new ? lag_mm : 0);
}

static void steer_all(struct drives *d)
{
    for (unsigned i = 0; i < d->count; i++)
        if (drives_is_by_velocity(&d->axis[i]))
            steer(d, i);
}

static void send_operation(struct drives *d, const struct can_port *port,
                           const struct point *setpoint)
{
    double *sent_mm = d->sent_mm[d->cycle & (DRIVES_HISTORY - 1)];
    for (unsigned i = 0; i < d->count; i++) {
        sent_mm[i] = setpoint->at[d->axis[i].config.axis];
        set_target(d, i, sent_mm[i]);
    }
    if (d->steers)
        steer_all(d);
    if (d->state == DRIVES_STOPPING)
        takt_drives_watch_stop(d);
    if (d->state == DRIVES_ENABLED || d->state == DRIVES_STOPPING)
        send_targets(d, port);
    if (drives_probe_is_busy(d))
        send_request(d, port);
}

/*
 * All at once; then, one a cycle, again to those whose statusword does not show it, for a frame may
 * get lost. One that stays in quick stop, with torque (605A: 5 ... 8), is switched off when its
 * time to brake is over: CiA 402, transition 12. Not when it stands, for its position may be stuck.
 */
static void send_quick_stop(struct drives *d, const struct can_port *port)
{
    unsigned turn = d->count > 0 ? d->cycle % d->count : 0;
    for (unsigned i = 0; i < d->count; i++) {
        struct drives_axis *axis = &d->axis[i];
        bool is_off =
            d->state == DRIVES_FAULTED && takt_cia402_state(axis->statusword) == CIA402_QUICK_STOP;
        uint16_t word = is_off ? CIA402_DISABLE_VOLTAGE : CIA402_QUICK_STOP_NOW;
        bool is_shown = !is_off && !takt_drives_axis_is_enabled(axis);
        if (axis->controlword != word ||
            (i == turn && (!is_shown || drives_silent_cycles(d, axis) > 1)))
            send_controlword(axis, port, word, true);
    }
}

void takt_drives_send(struct drives *d, const struct can_port *port, const struct point *setpoint)
{
    send_heartbeat(d, port);
    if (d->guards)
        takt_drives_send_guard(d, port);
    switch (d->state) {
    case DRIVES_STARTING:
        send_starting(d, port);
        break;
    case DRIVES_ENABLED:
    case DRIVES_STOPPING:
        send_operation(d, port, setpoint);
        break;
    case DRIVES_BRAKING:
    case DRIVES_FAULTED:
        break;
    }
    if (d->state == DRIVES_BRAKING || d->state == DRIVES_FAULTED)
        send_quick_stop(d, port);
    d->cycle++;
}

/*
 * One drive a call, in turn: the steps to "operation enabled" without the last one. Bit 7, fault
 * reset, and bit 3, enable operation, stay 0. What the drives have been told to stop by is not
 * forgotten.
 */
void takt_drives_switch_on_at_rest(struct drives *d, const struct can_port *port)
{
    struct drives_axis turn = d->axis[d->cycle % d->count];
    const uint16_t step = takt_cia402_step_to_enabled(takt_cia402_state(turn.statusword));
    send_controlword(&turn, port, step & CIA402_SWITCH_ON, true);
}

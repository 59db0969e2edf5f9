/*
 * CiA 301: the node's state, and who watches whom: heartbeats that are sent and heard, and node
 * guarding.
 */
#include "canopen/nmt.h"
#include "base/assert.h"
#include "canopen/node.h"
#include "servo/servo_private.h"

#define LAST_COMMUNICATION 0x1FFF
#define MICROSECOND_NS     1000u

void takt_servo_send_heartbeat(struct servo *drive, enum nmt_state state)
{
    struct can_frame frame;
    takt_nmt_write_heartbeat(&frame, drive->config.node, state);
    (void)takt_servo_send(drive, SERVO_FRAME_HEARTBEAT, &frame);
}

/* The first one comes at once. */
void takt_servo_restart_heartbeat(struct servo *drive)
{
    bool produces = drive->objects.communication.producer_heartbeat_ms != 0;
    drive->heartbeat_ns = produces ? drive->now_ns : DRIVE_NEVER;
    takt_servo_look_soon(drive);
}

/* A heartbeat is watched from the first that comes (CiA 301, 7.2.8.3.2.2). */
void takt_servo_restart_consumer(struct servo *drive, unsigned i)
{
    TAKT_ASSERT(i < sizeof drive->consumer_ns / sizeof drive->consumer_ns[0]);
    drive->consumer_ns[i] = DRIVE_NEVER;
    takt_servo_set_filter(drive);
    takt_servo_look_soon(drive);
}

/* The node that an entry of 1016 watches; 0: none. */
static uint32_t watched_node(uint32_t entry)
{
    return (entry & 0xFFFF) != 0 ? entry >> 16 : 0;
}

/* No node is watched by two entries: which of the times would count? */
uint32_t takt_servo_check_consumer(const struct servo *drive, const struct object_row *row,
                                   uint32_t value)
{
    const uint32_t node = watched_node(value);
    if (value >> 16 > NODE_MAX)
        return SDO_ABORT_VALUE;
    for (unsigned i = 0; i < DRIVE_CONSUMERS && node != 0; i++)
        if (i + 1 != row->sub &&
            watched_node(drive->objects.communication.consumer_heartbeat[i]) == node)
            return SDO_ABORT_PARAMETERS;
    return SDO_ABORT_NONE;
}

static void restart_communication(struct servo *drive)
{
    takt_servo_forget_communication_error(drive);
    drive->emcy_count = 0;
    drive->emcy_ns = 0;
    drive->sync_lost_ns = drive->guard_lost_ns = DRIVE_NEVER;
    drive->guard_toggle = 0;
    takt_sdo_server_reset(&drive->sdo);
    takt_servo_update_pdos(drive);
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++)
        takt_servo_restart_consumer(drive, i);
    takt_servo_restart_heartbeat(drive);
}

static void enter_nmt_state(struct servo *drive, enum nmt_state next)
{
    if (next != drive->nmt)
        takt_servo_tell(drive, DRIVE_EVENT_NMT, (uint32_t)next, 0);
    bool starts = next == NMT_OPERATIONAL && drive->nmt != NMT_OPERATIONAL;
    drive->nmt = next;
    if (starts)
        takt_servo_start_pdos(drive);
    if (next != NMT_OPERATIONAL)
        takt_servo_lose_connection(drive);
}

void takt_servo_boot(struct servo *drive)
{
    drive->nmt = NMT_BOOTED;
    drive->boot_ns = 0;
    restart_communication(drive);
    takt_servo_send_heartbeat(drive, NMT_BOOTED);
    if (drive->lss.is_nameless)
        return; /* it stays as it has booted */
    takt_servo_tell(drive, DRIVE_EVENT_BOOT, 0, 0);
    drive->nmt = NMT_PREOPERATIONAL;
}

/* What has been set and not stored is forgotten. */
static void reset(struct servo *drive, bool whole_node)
{
    takt_servo_lose_connection(drive);
    takt_servo_apply_lss(drive, whole_node);
    takt_servo_restore(drive, whole_node ? UINT16_MAX : LAST_COMMUNICATION);
    if (whole_node) {
        takt_servo_clear_history(drive);
        takt_servo_reset_profile(drive);
    }
    drive->nmt = NMT_BOOTED;
    drive->requests.count = 0;
    drive->boot_ns = drive->now_ns + drive->config.boot_us * (uint64_t)MICROSECOND_NS;
    if (drive->boot_ns == drive->now_ns)
        takt_servo_boot(drive);
    takt_servo_look_soon(drive);
}

void takt_servo_reboot(struct servo *drive)
{
    reset(drive, true);
}

void takt_servo_take_nmt(struct servo *drive, const struct can_frame *frame)
{
    enum nmt_command command;
    uint8_t node;
    if (!takt_nmt_read_command(frame, &command, &node))
        return;
    if (node != NMT_ALL_NODES && (node != drive->config.node || drive->lss.is_nameless))
        return;
    if (command == NMT_RESET_NODE || command == NMT_RESET_COMMUNICATION)
        reset(drive, command == NMT_RESET_NODE);
    else if (!drive->lss.is_nameless)
        enter_nmt_state(drive, takt_nmt_next_state(command));
}

void takt_servo_take_heartbeat(struct servo *drive, const struct can_frame *frame)
{
    uint8_t node;
    enum nmt_state state;
    if (!takt_nmt_read_heartbeat(frame, &node, &state))
        return;
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++) {
        uint32_t watched = drive->objects.communication.consumer_heartbeat[i];
        if ((watched >> 16 & NODE_ID_MASK) != node || (watched & 0xFFFF) == 0)
            continue;
        drive->consumer_ns[i] = drive->now_ns + (uint64_t)(watched & 0xFFFF) * MILLISECOND_NS;
        takt_servo_look_soon(drive);
        if (drive->communication_error == EMCY_HEARTBEAT)
            takt_servo_set_communication_error(drive, EMCY_NONE);
    }
}

uint32_t takt_servo_life_ms(const struct servo *drive)
{
    const struct drive_communication *c = &drive->objects.communication;
    return c->producer_heartbeat_ms == 0 ? (uint32_t)c->guard_ms * c->life_factor : 0;
}

static bool can_be_guarded(const struct servo *drive)
{
    bool has_index;
    return drive->objects.communication.producer_heartbeat_ms == 0 &&
           takt_dictionary_find(drive->dictionary, 0x100C, 0, &has_index) != NULL;
}

/*
 * A guarding master asks for the state, and is watched from its first question on (CiA 301,
 * 7.2.8.3.2.1). A node has either that or a heartbeat.
 */
void takt_servo_take_guard(struct servo *drive)
{
    const uint32_t life_ms = takt_servo_life_ms(drive);
    struct can_frame frame;
    if (!can_be_guarded(drive))
        return;
    takt_nmt_write_heartbeat(&frame, drive->config.node, drive->nmt);
    frame.data[0] |= drive->guard_toggle;
    drive->guard_toggle ^= NMT_TOGGLE;
    (void)takt_servo_send(drive, SERVO_FRAME_HEARTBEAT, &frame);
    drive->guard_lost_ns =
        life_ms != 0 ? drive->now_ns + (uint64_t)life_ms * MILLISECOND_NS : DRIVE_NEVER;
    takt_servo_look_soon(drive);
    if (drive->communication_error == EMCY_HEARTBEAT)
        takt_servo_set_communication_error(drive, EMCY_NONE);
}

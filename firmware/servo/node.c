/*
 * CiA 301: what the node does with frames and with time.
 */
#include "canopen/node.h"
#include "base/assert.h"
#include "canopen/sync.h"
#include "servo/servo_private.h"

#include <string.h>

#define MICROSECOND_NS 1000u

/* Object 1012. */

/* SYNC counts as lost after this many of its periods (object 1006). */
#define SYNC_LOST_PERIODS 3

/* Without a node id there is nothing to be said but by LSS. */
static bool is_dumb(const struct servo *drive, const struct can_frame *frame)
{
    return drive->lss.is_nameless && frame->id != LSS_ANSWER_COB_ID;
}

/* A refused frame is lost, as in a node whose transmit buffers are full; the bus counts it. */
bool takt_servo_send(struct servo *drive, enum servo_frame kind, const struct can_frame *frame)
{
    const struct servo_meddler *m = &drive->meddler;
    if (is_dumb(drive, frame) || (m->holds_back != NULL && m->holds_back(m->context, kind)))
        return true;
    return drive->port.send(drive->port.context, frame);
}

static bool send_sdo(void *context, const struct can_frame *frame)
{
    return takt_servo_send(context, SERVO_FRAME_SDO, frame);
}

void takt_servo_tell(const struct servo *drive, enum drive_event_kind kind, uint32_t first,
                     uint32_t second)
{
    const struct drive_event event = {.kind = kind,
                                      .time_ns = drive->now_ns,
                                      .node = drive->config.node,
                                      .first = first,
                                      .second = second};
    if (drive->observer.on_event)
        drive->observer.on_event(drive->observer.context, &event);
}

/* Identifier in an object that says more about it in its upper bits. */
static unsigned identifier_of(uint32_t cob_id)
{
    return cob_id & CAN_ID_MASK;
}

static void accept(struct servo *drive, uint32_t cob_id)
{
    unsigned id = identifier_of(cob_id);
    drive->accepts[id >> 5] |= 1u << (id & 31);
}

void takt_servo_set_filter(struct servo *drive)
{
    const struct drive_communication *c = &drive->objects.communication;
    memset(drive->accepts, 0, sizeof drive->accepts);
    accept(drive, LSS_REQUEST_COB_ID);
    accept(drive, NMT_COMMAND_COB_ID);
    accept(drive, c->sync_cob_id);
    if (c->time_cob_id & TIME_CONSUMED)
        accept(drive, c->time_cob_id);
    accept(drive, SDO_REQUEST_FUNCTION + drive->config.node);
    accept(drive, NMT_HEARTBEAT_FUNCTION + drive->config.node);
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++)
        if (c->consumer_heartbeat[i])
            accept(drive, NMT_HEARTBEAT_FUNCTION + (c->consumer_heartbeat[i] >> 16 & NODE_ID_MASK));
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        if (drive->rpdo[i].is_valid)
            accept(drive, drive->rpdo[i].cob_id);
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        if (drive->remote >> i & 1)
            accept(drive, drive->tpdo[i].cob_id);
}

static void set_target_pdo(struct servo *drive, const struct pdo *target)
{
    struct drive_communication *c = &drive->objects.communication;
    c->rpdo[1].cob_id = target->cob_id;
    c->rpdo[1].transmission = target->transmission;
    c->rpdo_mapping[1].count = target->mapping.count;
    for (unsigned i = 0; i < target->mapping.count; i++)
        c->rpdo_mapping[1].entry[i] = target->mapping.object[i];
}

static void init_loop(struct servo *drive)
{
    const struct motor_port axis = takt_compensation_get_port(&drive->compensation);
    takt_servo_loop_init(&drive->loop, &drive->config.loop, &axis);
}

void takt_servo_init(struct servo *drive, const struct servo_config *config,
                     const struct pdo *target, const struct can_port *port,
                     const struct motor_port *motor)
{
    const struct sdo_server_owner owner = {.read = takt_servo_read_sdo,
                                           .may_write = takt_servo_may_write_sdo,
                                           .write = takt_servo_write_sdo,
                                           .send = send_sdo,
                                           .context = drive};
    TAKT_ASSERT(config->node <= NODE_MAX || config->node == LSS_NO_NODE);
    memset(drive, 0, sizeof *drive);
    drive->config = *config;
    drive->port = *port;
    drive->dictionary = config->is_io ? &takt_dictionary_io : &takt_dictionary_own;
    if (config->dictionary != NULL)
        drive->dictionary = config->dictionary;
    drive->nmt = NMT_BOOTED;
    drive->number = config->node;
    drive->lss.node = drive->lss.stored = config->is_nameless ? LSS_NO_NODE : config->node;
    drive->lss.is_nameless = config->is_nameless;
    takt_compensation_init(&drive->compensation, motor);
    if (!config->is_io)
        init_loop(drive);
    takt_sdo_server_init(&drive->sdo, config->node, &owner);
    takt_servo_init_objects(drive);
    if (target && drive->dictionary == &takt_dictionary_own)
        set_target_pdo(drive, target);
    drive->initial = drive->stored = drive->objects;
    takt_servo_derive(drive);
    drive->homing.is_homed = config->is_absolute;
    takt_servo_derive_compensation(drive);
    takt_servo_update_pdos(drive);
    takt_servo_reset_profile(drive);
}

void takt_servo_observe(struct servo *drive, const struct drive_observer *observer)
{
    drive->observer = *observer;
}

void takt_servo_set_eds(struct servo *drive, const char *eds, size_t length)
{
    drive->eds = eds;
    drive->eds_length = length;
}

void takt_servo_meddle(struct servo *drive, const struct servo_meddler *meddler)
{
    drive->meddler = *meddler;
}

void takt_servo_keep(struct servo *drive, const struct drive_keeper *keeper)
{
    drive->keeper = *keeper;
}

void takt_servo_look_soon(struct servo *drive)
{
    drive->due_ns = 0;
}

/*
 * SYNC: what was received before it takes effect, and the synchronous TPDOs are sampled and sent.
 */
static void take_sync(struct servo *drive, const struct can_frame *frame)
{
    uint64_t period_ns = (uint64_t)drive->objects.communication.sync_period_us * MICROSECOND_NS;
    if (frame->length > 1)
        return;
    drive->sync_ns = drive->heard_ns;
    if (drive->communication_error == EMCY_SYNC)
        takt_servo_set_communication_error(drive, EMCY_NONE);
    if (period_ns != 0)
        drive->sync_lost_ns = drive->now_ns + SYNC_LOST_PERIODS * period_ns;
    if (drive->nmt != NMT_OPERATIONAL)
        return;
    takt_servo_apply_held(drive);
    takt_servo_send_synchronous(drive, frame);
}

/* Requests wait in a row; those for which there is no room are lost. */
static void take_request(struct servo *drive, const struct can_frame *frame)
{
    struct drive_requests *r = &drive->requests;
    if (drive->config.sdo_us == 0) {
        takt_sdo_server_take(&drive->sdo, frame, drive->now_ns);
        if (drive->sdo.state != SDO_SERVER_IDLE)
            takt_servo_look_soon(drive);
        return;
    }
    if (r->count == SERVO_REQUESTS)
        return;
    if (r->count == 0)
        r->due_ns = drive->now_ns + drive->config.sdo_us * (uint64_t)MICROSECOND_NS;
    r->frame[r->count++] = *frame;
    takt_servo_look_soon(drive);
}

static void answer_request(struct servo *drive)
{
    struct drive_requests *r = &drive->requests;
    if (r->count == 0 || drive->now_ns < r->due_ns)
        return;
    takt_sdo_server_take(&drive->sdo, &r->frame[0], drive->now_ns);
    r->count--;
    memmove(r->frame, r->frame + 1, r->count * sizeof r->frame[0]);
    r->due_ns = drive->now_ns + drive->config.sdo_us * (uint64_t)MICROSECOND_NS;
}

/* A client whose request waits is not silent. A stopped node has no SDO, for an abort neither. */
static void watch_client(struct servo *drive)
{
    if (drive->requests.count > 0 || drive->now_ns < takt_sdo_server_due_ns(&drive->sdo))
        return;
    if (drive->nmt == NMT_STOPPED) {
        takt_sdo_server_reset(&drive->sdo);
        return;
    }
    takt_servo_tell(drive, DRIVE_EVENT_SDO_ABORT, drive->sdo.object, SDO_ABORT_TIMEOUT);
    takt_sdo_server_give_up(&drive->sdo);
}

/* ---- Clocks ---- */

static void take_time(struct servo *drive, const struct can_frame *frame)
{
    struct time_stamp time;
    if (drive->nmt == NMT_STOPPED || !takt_time_stamp_read(frame, &time))
        return;
    drive->time = time;
    drive->time_ns = drive->now_ns;
    takt_servo_tell(drive, DRIVE_EVENT_TIME, time.ms, time.days);
}

struct time_stamp takt_servo_time_of_day(const struct servo *drive)
{
    return takt_time_stamp_add(drive->time, (drive->now_ns - drive->time_ns) / MILLISECOND_NS);
}

uint32_t takt_servo_high_resolution_us(const struct servo *drive)
{
    return (uint32_t)(drive->now_ns / MICROSECOND_NS) + drive->clock_us;
}

void takt_servo_set_high_resolution_us(struct servo *drive, uint32_t now_us)
{
    drive->clock_us = now_us - (uint32_t)(drive->now_ns / MICROSECOND_NS);
}

/* ---- Frames ---- */

static bool is_time(const struct servo *drive, const struct can_frame *frame)
{
    uint32_t id = drive->objects.communication.time_cob_id;
    return id & TIME_CONSUMED && frame->id == identifier_of(id);
}

static void take_other(struct servo *drive, const struct can_frame *frame)
{
    if (frame->id == NMT_COMMAND_COB_ID)
        takt_servo_take_nmt(drive, frame);
    else if (frame->id == SDO_REQUEST_FUNCTION + drive->config.node) {
        if (drive->nmt != NMT_STOPPED)
            take_request(drive, frame);
    } else {
        takt_servo_take_heartbeat(drive, frame);
    }
}

static void take_remote(struct servo *drive, const struct can_frame *frame)
{
    if (drive->lss.is_nameless)
        return;
    if (nmt_is_guard(frame, drive->config.node))
        takt_servo_take_guard(drive);
    else if (drive->nmt == NMT_OPERATIONAL)
        takt_servo_take_remote(drive, frame);
}

void takt_servo_on_frame(struct servo *drive, const struct can_frame *frame)
{
    if (!servo_accepts(drive, frame) || drive->boot_ns != 0)
        return;
    if (can_is_remote(frame)) {
        take_remote(drive, frame);
        return;
    }
    if (frame->id > CAN_ID_MASK)
        return;
    if (drive->lss.is_nameless && frame->id != LSS_REQUEST_COB_ID &&
        frame->id != NMT_COMMAND_COB_ID)
        return;
    if (frame->id == identifier_of(drive->objects.communication.sync_cob_id))
        take_sync(drive, frame);
    else if (frame->id == LSS_REQUEST_COB_ID)
        takt_servo_take_lss(drive, frame);
    else if (is_time(drive, frame))
        take_time(drive, frame);
    else if (node_function(frame->id) == SDO_REQUEST_FUNCTION || frame->id == NMT_COMMAND_COB_ID ||
             node_function(frame->id) == NMT_HEARTBEAT_FUNCTION)
        take_other(drive, frame);
    else if (drive->nmt == NMT_OPERATIONAL)
        takt_servo_take_rpdo(drive, frame);
}

void takt_servo_on_frame_at(struct servo *drive, const struct can_frame *frame, uint64_t time_ns)
{
    drive->heard_ns = time_ns;
    takt_servo_on_frame(drive, frame);
}

static uint64_t earlier(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

static void watch_connection(struct servo *drive)
{
    if (drive->now_ns >= drive->sync_lost_ns) {
        drive->sync_lost_ns = DRIVE_NEVER;
        takt_servo_set_communication_error(drive, EMCY_SYNC);
    }
    if (drive->now_ns >= drive->guard_lost_ns) {
        drive->guard_lost_ns = DRIVE_NEVER;
        takt_servo_set_communication_error(drive, EMCY_HEARTBEAT);
    }
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++) {
        if (drive->now_ns < drive->consumer_ns[i])
            continue;
        drive->consumer_ns[i] = DRIVE_NEVER;
        takt_servo_set_communication_error(drive, EMCY_HEARTBEAT);
    }
}

static uint64_t next_due_ns(const struct servo *drive)
{
    const struct drive_requests *r = &drive->requests;
    uint64_t due_ns = earlier(drive->heartbeat_ns, takt_servo_next_pdo_ns(drive));
    due_ns = earlier(due_ns, drive->guard_lost_ns);
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++)
        due_ns = earlier(due_ns, drive->consumer_ns[i]);
    due_ns = earlier(due_ns, r->count > 0 ? r->due_ns : takt_sdo_server_due_ns(&drive->sdo));
    return drive->emcy_count > 0 ? earlier(due_ns, drive->emcy_ns) : due_ns;
}

/* Everything that waits for a time; notes when the next of it comes. */
static void run_timers(struct servo *drive)
{
    uint16_t heartbeat_ms = drive->objects.communication.producer_heartbeat_ms;
    if (drive->boot_ns != 0) {
        if (drive->now_ns >= drive->boot_ns)
            takt_servo_boot(drive);
        else
            drive->due_ns = drive->boot_ns;
        return;
    }
    answer_request(drive);
    watch_client(drive);
    if (drive->now_ns >= drive->heartbeat_ns) {
        takt_servo_send_heartbeat(drive, drive->nmt);
        drive->heartbeat_ns = drive->now_ns + (uint64_t)heartbeat_ms * MILLISECOND_NS;
    }
    watch_connection(drive);
    takt_servo_send_waiting_emergencies(drive);
    takt_servo_send_due(drive);
    drive->due_ns = next_due_ns(drive);
}

/* Something that is an event may have changed. */
static bool may_have_event(const struct servo *drive)
{
    const struct drive_process *p = &drive->objects.process;
    return p->error_code != drive->seen_error_code || p->mode_display != drive->seen_mode ||
           drive->watched & (DRIVE_GROUP_STATUS | DRIVE_GROUP_INPUTS);
}

static void run_motor(struct servo *drive, uint32_t cycle_ns)
{
    takt_servo_begin_probe(drive);
    takt_servo_move(drive, cycle_ns);
    takt_servo_note_way(drive);
    takt_servo_run_probe(drive);
}

void takt_servo_step(struct servo *drive, uint32_t cycle_ns)
{
    if (drive->config.is_io)
        takt_servo_run_io(drive);
    else
        run_motor(drive, cycle_ns);
    drive->now_ns += cycle_ns;
    if (may_have_event(drive))
        takt_servo_note_events(drive);
    if (drive->now_ns >= earlier(drive->due_ns, drive->sync_lost_ns))
        run_timers(drive);
    if (drive->sdo.state == SDO_SERVER_SENDING)
        takt_sdo_server_go_on(&drive->sdo, drive->now_ns);
}

enum nmt_state takt_servo_get_nmt_state(const struct servo *drive)
{
    return drive->nmt;
}

/* A drive that cannot be told has the time between targets, once it is to follow them. */
uint32_t takt_servo_get_sync_period_us(const struct servo *drive)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(drive->dictionary, 0x1006, 0, &has_index);
    if (row != NULL && row->access == OBJECT_RW)
        return drive->objects.communication.sync_period_us;
    return drive->nmt == NMT_OPERATIONAL ? (uint32_t)(drive->interpolation_ns / MICROSECOND_NS) : 0;
}

uint32_t takt_servo_get_watched_ms(const struct servo *drive)
{
    uint32_t shortest_ms = drive->guard_lost_ns != DRIVE_NEVER ? takt_servo_life_ms(drive) : 0;
    for (unsigned i = 0; i < DRIVE_CONSUMERS; i++) {
        uint32_t watched_ms = drive->objects.communication.consumer_heartbeat[i] & 0xFFFF;
        if (watched_ms != 0 && (shortest_ms == 0 || watched_ms < shortest_ms))
            shortest_ms = watched_ms;
    }
    return shortest_ms;
}

bool takt_servo_is_sync(const struct servo *drive, const struct can_frame *frame)
{
    return frame->id == identifier_of(drive->objects.communication.sync_cob_id) &&
           frame->length <= 1;
}

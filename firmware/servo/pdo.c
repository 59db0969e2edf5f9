/*
 * Process data objects with live mapping (CiA 301, 7.2.2 and 7.5.2.35 ... 38).
 */
#include "canopen/little_endian.h"
#include "canopen/node.h"
#include "servo/servo_private.h"

#include <string.h>

#define TICK_100US_NS 100000u

unsigned takt_servo_longest_frame(const struct servo *drive)
{
    return drive->config.is_fd ? CAN_DATA_MAX : CAN_CLASSIC_MAX;
}

/* Data types as indices: places an RPDO skips. */
static bool is_dummy(const struct servo *drive, uint16_t index)
{
    return index >= OBJECT_INTEGER8 && index <= OBJECT_UNSIGNED32 &&
           drive->dictionary->dummies >> index & 1;
}

bool takt_servo_find_mapped(const struct servo *drive, uint32_t entry, enum object_flag direction,
                            const struct object_row **row, uint32_t *code)
{
    uint16_t index = (uint16_t)(entry >> 16);
    uint8_t sub = (uint8_t)(entry >> 8);
    unsigned bits = entry & 0xFF;
    bool has_index;
    *row = NULL;
    *code = SDO_ABORT_NOT_MAPPABLE;
    if (is_dummy(drive, index))
        return direction == OBJECT_TO_RPDO && sub == 0 &&
               bits == 8 * takt_object_type_bytes((enum object_type)index);
    *row = takt_dictionary_find(drive->dictionary, index, sub, &has_index);
    if (!*row)
        *code = has_index ? SDO_ABORT_NO_SUB_INDEX : SDO_ABORT_NO_OBJECT;
    return *row && (*row)->flags & direction && bits == 8 * takt_object_type_bytes((*row)->type);
}

static uint8_t touches_of(const struct object_row *row)
{
    switch (row->index) {
    case 0x1013:
        return DRIVE_TOUCH_CLOCK;
    case 0x6040:
        return DRIVE_TOUCH_CONTROLWORD;
    case 0x6060:
        return DRIVE_TOUCH_MODE;
    case 0x6072:
        return DRIVE_TOUCH_TORQUE;
    case 0x60B8:
        return DRIVE_TOUCH_PROBE;
    default:
        return 0;
    }
}

static uint8_t group_of(const struct object_row *row)
{
    switch (row->index) {
    case 0x603F:
        return DRIVE_GROUP_ERROR;
    case 0x6041:
        return DRIVE_GROUP_STATUS;
    case 0x6061:
        return DRIVE_GROUP_MODE;
    case 0x6064:
        return DRIVE_GROUP_POSITION;
    case 0x60F4:
        return DRIVE_GROUP_FOLLOWING;
    case 0x60FD:
        return DRIVE_GROUP_INPUTS;
    case 0x1001:
        return 0;
    default:
        return DRIVE_GROUP_REST;
    }
}

static void add_mapped(struct servo *drive, struct drive_pdo *pdo, uint32_t entry,
                       enum object_flag direction)
{
    const struct object_row *row;
    uint32_t code;
    if (!takt_servo_find_mapped(drive, entry, direction, &row, &code) ||
        pdo->length + (entry & 0xFF) / 8 > takt_servo_longest_frame(drive))
        return;
    pdo->row[pdo->count] = row;
    if (row && !(row->flags & OBJECT_FIXED))
        pdo->field[pdo->count] = (char *)&drive->objects + row->field;
    pdo->bytes[pdo->count] = (uint8_t)((entry & 0xFF) / 8);
    pdo->length = (uint8_t)(pdo->length + pdo->bytes[pdo->count]);
    pdo->count++;
    if (!row)
        return;
    if (direction == OBJECT_TO_RPDO)
        pdo->touches |= touches_of(row);
    else
        pdo->groups |= group_of(row);
    if (row->flags & OBJECT_EVENT)
        pdo->events |= group_of(row);
}

static void update_pdo(struct servo *drive, struct drive_pdo *pdo,
                       const struct drive_pdo_parameters *parameters,
                       const struct drive_pdo_mapping *mapping, enum object_flag direction)
{
    memset(pdo, 0, sizeof *pdo);
    pdo->is_valid = !(parameters->cob_id & COB_NOT_VALID);
    pdo->cob_id = (uint16_t)(parameters->cob_id & CAN_ID_MASK);
    pdo->transmission = parameters->transmission;
    pdo->event_ns = DRIVE_NEVER;
    for (unsigned i = 0; i < mapping->count; i++)
        add_mapped(drive, pdo, mapping->entry[i], direction);
}

static bool is_event_driven(const struct drive_pdo *pdo)
{
    return pdo->transmission >= TYPE_EVENT_MIN;
}

static void watch_events(struct servo *drive)
{
    drive->watched = 0;
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++) {
        const struct drive_pdo *pdo = &drive->tpdo[i];
        if (pdo->is_valid && (is_event_driven(pdo) || pdo->transmission == 0))
            drive->watched |= pdo->events;
    }
}

/*
 * The nodes' event timers are shifted by a millisecond each, so that their frames do not come all
 * at once.
 */
static void start_tpdo(struct servo *drive, unsigned i)
{
    struct drive_pdo *pdo = &drive->tpdo[i];
    const struct drive_pdo_parameters *parameters = &drive->objects.communication.tpdo[i];
    uint64_t period_ns = (uint64_t)parameters->event_ms * MILLISECOND_NS;
    uint64_t shift_ns = (uint64_t)drive->config.node * MILLISECOND_NS;
    pdo->is_due = false;
    pdo->syncs = 0;
    pdo->waits_for_start = parameters->sync_start != 0;
    pdo->inhibit_ns = 0;
    pdo->event_ns = DRIVE_NEVER;
    if (period_ns != 0 && is_event_driven(pdo))
        pdo->event_ns = drive->now_ns + period_ns - shift_ns % period_ns;
    takt_servo_look_soon(drive);
}

static void update_rpdo(struct servo *drive, unsigned i)
{
    const struct drive_communication *c = &drive->objects.communication;
    const struct drive_pdo *pdo = &drive->rpdo[i];
    update_pdo(drive, &drive->rpdo[i], &c->rpdo[i], &c->rpdo_mapping[i], OBJECT_TO_RPDO);
    drive->rpdo_id[i] = pdo->is_valid ? pdo->cob_id : DRIVE_NO_ID;
    drive->held = (uint8_t)(drive->held & ~(1u << i));
    takt_servo_set_filter(drive);
}

static void update_tpdo(struct servo *drive, unsigned i)
{
    const struct drive_communication *c = &drive->objects.communication;
    const struct drive_pdo *pdo = &drive->tpdo[i];
    update_pdo(drive, &drive->tpdo[i], &c->tpdo[i], &c->tpdo_mapping[i], OBJECT_TO_TPDO);
    const unsigned bit = pdo->is_valid && pdo->transmission <= TYPE_SYNC_MAX && pdo->count > 0;
    const unsigned remote = pdo->is_valid && !(c->tpdo[i].cob_id & COB_NO_RTR) && pdo->count > 0;
    drive->synchronous = (uint8_t)((drive->synchronous & ~(1u << i)) | bit << i);
    drive->remote = (uint8_t)((drive->remote & ~(1u << i)) | remote << i);
    takt_servo_set_filter(drive);
    start_tpdo(drive, i);
    watch_events(drive);
}

void takt_servo_update_pdo(struct servo *drive, uint16_t index)
{
    const struct drive_communication *c = &drive->objects.communication;
    unsigned i = index & 0xFFu;
    if (i >= DRIVE_PDO_COUNT)
        return;
    if (index >= TPDO_PARAMETERS)
        update_tpdo(drive, i);
    else
        update_rpdo(drive, i);
    takt_servo_tell(drive, DRIVE_EVENT_PDO, index,
                    index >= TPDO_PARAMETERS ? c->tpdo[i].cob_id : c->rpdo[i].cob_id);
}

void takt_servo_update_pdos(struct servo *drive)
{
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++) {
        update_rpdo(drive, i);
        update_tpdo(drive, i);
    }
}

void takt_servo_start_pdos(struct servo *drive)
{
    drive->held = 0;
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        start_tpdo(drive, i);
}

/* A field has the width of its object; NULL: data that nobody wants. */
static void take_value(void *field, unsigned count, const uint8_t *bytes)
{
    if (!field)
        return;
    if (count == 4)
        *(uint32_t *)field = little_endian_read32(bytes);
    else if (count == 2)
        *(uint16_t *)field = little_endian_read16(bytes);
    else
        *(uint8_t *)field = bytes[0];
}

static uint32_t value_of(const void *field, unsigned count)
{
    if (count == 4)
        return *(const uint32_t *)field;
    return count == 2 ? *(const uint16_t *)field : *(const uint8_t *)field;
}

static void write_bytes(uint8_t *bytes, unsigned count, uint32_t value)
{
    if (count == 4)
        little_endian_write32(bytes, value);
    else if (count == 2)
        little_endian_write16(bytes, (uint16_t)value);
    else
        bytes[0] = (uint8_t)value;
}

/* All values are written before the first takes effect: they belong together. */
static void apply(struct servo *drive, const struct drive_pdo *pdo, const struct can_frame *frame)
{
    const uint8_t *bytes = frame->data;
    for (unsigned i = 0; i < pdo->count; i++) {
        take_value(pdo->field[i], pdo->bytes[i], bytes);
        bytes += pdo->bytes[i];
    }
    if (pdo->touches)
        takt_servo_apply_touches(drive, pdo->touches);
}

/* Object 1007: what is synchronous counts only so long after SYNC. */
static bool is_too_late(const struct servo *drive)
{
    uint64_t window_ns = (uint64_t)drive->objects.communication.sync_window_us * 1000;
    return window_ns != 0 && drive->heard_ns - drive->sync_ns > window_ns;
}

static void take(struct servo *drive, unsigned i, const struct can_frame *frame)
{
    struct drive_pdo *pdo = &drive->rpdo[i];
    if (pdo->count == 0)
        return;
    if (frame->length < pdo->length) {
        takt_servo_send_emergency(drive, EMCY_PDO_LENGTH,
                                  EMCY_REGISTER_GENERIC | EMCY_REGISTER_COMMUNICATION);
    } else if (pdo->transmission > TYPE_SYNC_MAX) {
        apply(drive, pdo, frame);
    } else if (!is_too_late(drive)) {
        can_copy(&pdo->held, frame);
        drive->held = (uint8_t)(drive->held | 1u << i);
    }
}

void takt_servo_take_rpdo(struct servo *drive, const struct can_frame *frame)
{
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        if (frame->id == drive->rpdo_id[i])
            take(drive, i, frame);
}

void takt_servo_apply_held(struct servo *drive)
{
    for (unsigned i = 0; drive->held >> i != 0; i++) {
        if (!(drive->held >> i & 1))
            continue;
        drive->held = (uint8_t)(drive->held & ~(1u << i));
        apply(drive, &drive->rpdo[i], &drive->rpdo[i].held);
    }
}

static void send_pdo(struct servo *drive, struct drive_pdo *pdo)
{
    struct can_frame frame = {.id = pdo->cob_id, .length = pdo->length};
    uint8_t *bytes = frame.data;
    bool is_meddled = drive->meddler.overrides != NULL;
    takt_servo_refresh_groups(drive, pdo->groups);
    for (unsigned i = 0; i < pdo->count; i++) {
        /* What never changes has no field. */
        uint32_t value = is_meddled || pdo->field[i] == NULL
                             ? takt_servo_read_row(drive, pdo->row[i])
                             : value_of(pdo->field[i], pdo->bytes[i]);
        write_bytes(bytes, pdo->bytes[i], value);
        bytes += pdo->bytes[i];
    }
    (void)takt_servo_send(drive, SERVO_FRAME_TPDO, &frame);
    pdo->is_due = false;
}

/* Type 0: at the SYNC after an event; n: at every n-th SYNC. */
static bool is_due_at_sync(struct servo *drive, unsigned i, const struct can_frame *sync)
{
    struct drive_pdo *pdo = &drive->tpdo[i];
    if (pdo->waits_for_start && sync->length == 1) {
        if (sync->data[0] != drive->objects.communication.tpdo[i].sync_start)
            return false;
        pdo->syncs = (uint8_t)(pdo->transmission - 1);
    }
    pdo->waits_for_start = false;
    if (pdo->transmission == 0)
        return pdo->is_due;
    pdo->syncs++;
    if (pdo->syncs < pdo->transmission)
        return false;
    pdo->syncs = 0;
    return true;
}

/*
 * The first TPDO, which has the statusword, is the last to be sent: then all of this SYNC is said.
 */
void takt_servo_send_synchronous(struct servo *drive, const struct can_frame *sync)
{
    for (unsigned i = DRIVE_PDO_COUNT; i-- > 0;)
        if (drive->synchronous >> i & 1 && is_due_at_sync(drive, i, sync))
            send_pdo(drive, &drive->tpdo[i]);
}

void takt_servo_note_events(struct servo *drive)
{
    const struct drive_process *p = &drive->objects.process;
    uint8_t changed = 0;
    takt_servo_refresh_groups(drive, drive->watched & (DRIVE_GROUP_STATUS | DRIVE_GROUP_INPUTS));
    if (p->error_code != drive->seen_error_code)
        changed |= DRIVE_GROUP_ERROR;
    if (p->mode_display != drive->seen_mode)
        changed |= DRIVE_GROUP_MODE;
    if (drive->watched & DRIVE_GROUP_STATUS && p->statusword != drive->seen_statusword)
        changed |= DRIVE_GROUP_STATUS;
    if (drive->watched & DRIVE_GROUP_INPUTS && p->digital_inputs != drive->seen_inputs)
        changed |= DRIVE_GROUP_INPUTS;
    if (!changed)
        return;
    drive->seen_error_code = p->error_code;
    drive->seen_mode = p->mode_display;
    drive->seen_statusword = p->statusword;
    drive->seen_inputs = p->digital_inputs;
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        drive->tpdo[i].is_due = drive->tpdo[i].is_due || drive->tpdo[i].events & changed;
    takt_servo_look_soon(drive);
}

static void send_if_due(struct servo *drive, unsigned i)
{
    struct drive_pdo *pdo = &drive->tpdo[i];
    const struct drive_pdo_parameters *parameters = &drive->objects.communication.tpdo[i];
    bool is_time = drive->now_ns >= pdo->event_ns;
    if (!pdo->is_valid || pdo->count == 0 || !is_event_driven(pdo))
        return;
    if (!(pdo->is_due || is_time) || drive->now_ns < pdo->inhibit_ns)
        return;
    send_pdo(drive, pdo);
    pdo->inhibit_ns = drive->now_ns + (uint64_t)parameters->inhibit_100us * TICK_100US_NS;
    if (is_time)
        pdo->event_ns += (uint64_t)parameters->event_ms * MILLISECOND_NS;
    else if (pdo->event_ns != DRIVE_NEVER)
        pdo->event_ns = drive->now_ns + (uint64_t)parameters->event_ms * MILLISECOND_NS;
}

void takt_servo_send_due(struct servo *drive)
{
    if (drive->nmt != NMT_OPERATIONAL)
        return;
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        send_if_due(drive, i);
}

/*
 * With the values of now. One that events send is an event more, and keeps its inhibit time; one of
 * type 0 that has an event goes out at the next SYNC all the same.
 */
static void answer_remote(struct servo *drive, unsigned i)
{
    struct drive_pdo *pdo = &drive->tpdo[i];
    const bool has_event = pdo->is_due;
    if (is_event_driven(pdo)) {
        pdo->is_due = true;
        send_if_due(drive, i);
        takt_servo_look_soon(drive);
    } else {
        send_pdo(drive, pdo);
        pdo->is_due = has_event;
    }
}

void takt_servo_take_remote(struct servo *drive, const struct can_frame *frame)
{
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++)
        if (drive->remote >> i & 1 && drive->tpdo[i].cob_id == (frame->id & CAN_ID_MASK))
            answer_remote(drive, i);
}

uint64_t takt_servo_next_pdo_ns(const struct servo *drive)
{
    uint64_t next_ns = DRIVE_NEVER;
    if (drive->nmt != NMT_OPERATIONAL)
        return next_ns;
    for (unsigned i = 0; i < DRIVE_PDO_COUNT; i++) {
        const struct drive_pdo *pdo = &drive->tpdo[i];
        if (!pdo->is_valid || !is_event_driven(pdo))
            continue;
        uint64_t at_ns = pdo->is_due ? pdo->inhibit_ns : pdo->event_ns;
        if (at_ns < next_ns)
            next_ns = at_ns;
    }
    return next_ns;
}

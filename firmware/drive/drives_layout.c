#include "drive/drives_layout.h"

#include "base/assert.h"
#include "canopen/cia402.h"
#include "canopen/target_pdo.h"

#include <stddef.h>

uint32_t takt_drives_target_of(const struct drives_axis *axis)
{
    if (drives_is_by_velocity(axis))
        return CIA402_TARGET_VELOCITY;
    return axis->follow_mode == CIA402_MODE_INTERPOLATED_POSITION ? CIA402_INTERPOLATION
                                                                  : CIA402_TARGET_POSITION;
}

/* Byte at which an object begins. */
uint8_t takt_drives_byte_of(const struct pdo *pdo, uint32_t object)
{
    int offset = takt_pdo_offset(&pdo->mapping, object);
    return offset < 0 ? DRIVES_NOWHERE : (uint8_t)offset;
}

void takt_drives_forget_pdos(struct drives_axis *axis)
{
    axis->control_frame.length = axis->target_frame.length = 0;
    axis->control_frame.mode = axis->target_frame.mode = DRIVES_NOWHERE;
    axis->report_id = axis->status_id = axis->position_id = axis->error_id = NO_TPDO;
    axis->bits = 0;
}

bool takt_drives_uses(const struct drives_axis *axis, const struct pdo *pdo)
{
    return (axis->control_frame.length > 0 && axis->control_frame.cob_id == pdo->cob_id) ||
           (axis->target_frame.length > 0 && axis->target_frame.cob_id == pdo->cob_id) ||
           axis->status_id == pdo->cob_id || axis->position_id == pdo->cob_id ||
           axis->error_id == pdo->cob_id;
}

/* Than a target, and dummies. */
static bool has_more(const struct drives_axis *axis, const struct pdo *pdo)
{
    const struct pdo_mapping *mapping = &pdo->mapping;
    unsigned i = 0;
    while (i < mapping->count && (mapping->object[i] == PDO_DUMMY_32 ||
                                  mapping->object[i] == takt_drives_target_of(axis)))
        i++;
    return i < mapping->count;
}

void takt_drives_set_target_pdo(const struct drives *d, struct pdo *pdo)
{
    const unsigned bus = drives_bus_of(d, d->at_axis);
    uint8_t node[AXIS_COUNT];
    TAKT_ASSERT(d->at_axis < d->count);
    for (unsigned i = 0; i < d->count; i++)
        if (drives_bus_of(d, i) == bus)
            node[d->axis[i].place] = d->node[i];
    takt_target_pdo_set(pdo, node, d->on_bus[bus], d->axis[d->at_axis].place, d->group);
}

static void add(struct pdo *pdo, uint32_t object, bool is_wanted)
{
    TAKT_ASSERT(!is_wanted || pdo->mapping.count < PDO_MAPPED_MAX);
    if (is_wanted)
        pdo->mapping.object[pdo->mapping.count++] = object;
}

static void want_target(const struct drives *d, struct pdo *pdo)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    TAKT_ASSERT(d->at_axis < d->count);
    if (!axis->is_paired || d->mapping.pass == PASS_AGAIN) {
        add(pdo, takt_drives_target_of(axis), true);
        return;
    }
    takt_drives_set_target_pdo(d, pdo);
    pdo->mapping.object[axis->place % d->group] = takt_drives_target_of(axis);
}

static void want_received(const struct drives *d, struct pdo *pdo)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    unsigned pass = d->mapping.pass;
    bool has_target = axis->target_frame.length > 0;
    bool has_control = pass == PASS_TARGET || axis->control_frame.length > 0;
    if (pass > 0 && !has_target) {
        pdo->transmission = PDO_EVERY_SYNC;
        want_target(d, pdo);
        add(pdo, CIA402_CONTROLWORD, pass == PASS_AGAIN);
    } else if (pass != PASS_AGAIN && !has_control) {
        add(pdo, CIA402_CONTROLWORD, true);
        add(pdo, CIA402_MODE, true);
    }
}

static void want_transmitted(const struct drives *d, struct pdo *pdo)
{
    const struct drives_axis *axis = &d->axis[d->at_axis];
    bool has_room = d->mapping.pass < PASS_APART || axis->status_id == axis->position_id;
    bool has_no_error = axis->error_id == NO_TPDO && has_room && !d->no_error_pdo;
    add(pdo, CIA402_STATUSWORD, axis->status_id == NO_TPDO);
    add(pdo, CIA402_POSITION_ACTUAL, axis->position_id == NO_TPDO);
    if (pdo->mapping.count > 0) {
        pdo->transmission = PDO_EVERY_SYNC;
    } else {
        add(pdo, CIA402_ERROR_CODE, has_no_error);
        add(pdo, CIA402_FOLLOWING_ERROR, has_no_error);
    }
}

void takt_drives_want(const struct drives *d, struct pdo *pdo)
{
    if (drives_is_transmitted(&d->mapping))
        want_transmitted(d, pdo);
    else
        want_received(d, pdo);
}

static void take_received(struct drives *d)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    const struct pdo *pdo = &d->mapping.pdo;
    const struct drives_frame frame = {.cob_id = pdo->cob_id,
                                       .length = pdo->mapping.length,
                                       .control = takt_drives_byte_of(pdo, CIA402_CONTROLWORD),
                                       .mode = takt_drives_byte_of(pdo, CIA402_MODE),
                                       .is_mixed = has_more(axis, pdo),
                                       .target =
                                           takt_drives_byte_of(pdo, takt_drives_target_of(axis))};
    bool is_better = axis->control_frame.length == 0 ||
                     (axis->control_frame.mode == DRIVES_NOWHERE && frame.mode != DRIVES_NOWHERE);
    TAKT_ASSERT(d->at_axis < d->count);
    if (frame.control != DRIVES_NOWHERE && is_better)
        axis->control_frame = frame;
    if (frame.target == DRIVES_NOWHERE || axis->target_frame.length > 0)
        return;
    axis->target_frame = frame;
    if (pdo->transmission > PDO_SYNC_MAX)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_SYNC_TARGET);
}

void takt_drives_count_bits(struct drives *d, unsigned length)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    TAKT_ASSERT(d->at_axis < d->count);
    axis->bits = (uint16_t)(axis->bits + drives_bits(d, length));
}

/* An unwanted TPDO stays. */
void takt_drives_suffer(struct drives *d)
{
    takt_drives_give_up(d, d->at_axis, DRIVES_NO_SILENCE);
    if (d->mapping.pdo.transmission <= PDO_SYNC_MAX || d->mapping.is_timed)
        takt_drives_count_bits(d, d->mapping.pdo.mapping.length);
}

static void take_transmitted(struct drives *d)
{
    struct drives_axis *axis = &d->axis[d->at_axis];
    const struct drives_mapping *m = &d->mapping;
    const struct pdo *pdo = &m->pdo;
    uint8_t status = takt_drives_byte_of(pdo, CIA402_STATUSWORD),
            position = takt_drives_byte_of(pdo, CIA402_POSITION_ACTUAL);
    bool has_both = status != DRIVES_NOWHERE && position != DRIVES_NOWHERE;
    bool is_timed = m->pass >= PASS_APART && pdo->transmission >= PDO_EVENT_MIN && m->is_timed;
    bool is_cyclic = pdo->transmission == PDO_EVERY_SYNC || is_timed;
    bool is_taken = is_cyclic && (has_both || m->pass >= PASS_APART);
    TAKT_ASSERT(d->at_axis < d->count);
    if (node_id(pdo->cob_id) != axis->config.node)
        return;
    if (is_taken && status != DRIVES_NOWHERE && axis->status_id == NO_TPDO) {
        axis->status_id = pdo->cob_id;
        axis->status_end = (uint8_t)(status + 2);
    }
    if (is_taken && position != DRIVES_NOWHERE && axis->position_id == NO_TPDO) {
        axis->position_id = pdo->cob_id;
        axis->position_end = (uint8_t)(position + 4);
    }
    if (!is_cyclic && takt_drives_byte_of(pdo, CIA402_ERROR_CODE) == 0)
        axis->error_id = pdo->cob_id;
    if (!is_cyclic || !takt_drives_uses(axis, pdo))
        return;
    takt_drives_count_bits(d, pdo->mapping.length);
    if (is_timed)
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_SYNC_REPORT);
}

/*
 * Bytes of all entries. 0: more than a frame holds, which a drive may have mapped only by mistake.
 */
static uint8_t length_of(const struct pdo_mapping *mapping, unsigned most)
{
    unsigned bits = 0;
    for (unsigned i = 0; i < mapping->count; i++)
        bits += mapping->object[i] & 0xFF;
    return (uint8_t)(bits <= 8 * most ? bits / 8 : 0);
}

void takt_drives_take_layout(struct drives *d)
{
    struct drives_mapping *m = &d->mapping;
    m->pdo.mapping.length = length_of(&m->pdo.mapping, d->frame_max);
    if (m->pdo.mapping.length == 0)
        m->pdo.mapping.count = 0;
    else if (drives_is_transmitted(m))
        take_transmitted(d);
    else
        take_received(d);
    m->entry = 0;
}

void takt_drives_store_rest(struct drives_frame *frame, const struct pdo *pdo, uint32_t object,
                            uint32_t value)
{
    unsigned at = takt_drives_byte_of(pdo, object), bytes = (object & 0xFF) / 8;
    for (unsigned i = 0; i < bytes && i < 4 && frame->length > 0 && frame->cob_id == pdo->cob_id;
         i++)
        frame->data[at + i] = (uint8_t)(value >> 8 * i);
}

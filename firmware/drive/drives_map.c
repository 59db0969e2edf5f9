/*
 * The process data of a drive: told as takt would have them, and taken as the drive has them.
 *
 *     pass   PDO     wanted                                            type
 *     0      RPDO1   controlword, mode                                 at once
 *     1      RPDO2   target, and dummies for those of its group        SYNC
 *     2, 3   RPDO3,4 what has found no place so far, else not valid
 *     4      RPDO1   again, if the target has found no place: target, controlword
 *     5      TPDO1   statusword, position                              every SYNC
 *     6 - 8  TPDO2-4 the same; error code, following error             event, 100 ms
 *     9 - 12 TPDO1-4 anew, each in one of its own                      timer, once a cycle
 *
 * A PDO is told as CiA 301, 7.5.2.36 has it: not valid, type, no mapping, entries, number, inhibit
 * time, valid. A refused entry is left out, and the last one as long as their number is refused.
 * What is in it counts else: fixed PDOs need no case of their own. From 6 on: what has no place.
 */
#include "base/assert.h"
#include "canopen/cia402.h"
#include "canopen/objects.h"
#include "drive/drives_layout.h"

#include <string.h>

/* RPDOs, and as many TPDOs, that are used or made not valid. */
#define PDOS 4

#define PASSES 13

#define MAPPING_OFFSET (OBJECT_RPDO_MAPPING - OBJECT_RPDO)

enum step {
    BEGIN,
    OFF,
    TYPE,
    CLEAR,
    ENTRY,
    COUNT,
    INHIBIT,
    TIMER,
    ON,
    TOLD,
    READ_ID,
    READ_TYPE,
    READ_COUNT,
    READ_ENTRY,
    SET_TYPE,   /* by what has been found in it */
    READ_TIMER, /* of a report that does not come by SYNC */
    FOUND,
    READ_REST, /* values of what takt does not know */
    SILENCE,   /* a TPDO with nothing that is wanted */
    DONE
};

/* From 0. */
static unsigned number_of(const struct drives_mapping *m)
{
    return (drives_is_transmitted(m) ? (unsigned)m->pass - PASS_STATUS : (unsigned)m->pass) % PDOS;
}

static unsigned parameters_of(const struct drives_mapping *m)
{
    return (drives_is_transmitted(m) ? OBJECT_TPDO : OBJECT_RPDO) + number_of(m);
}

/* ---- What is wanted ---- */

static bool has_reports(const struct drives_axis *axis)
{
    return axis->status_id != NO_TPDO && axis->position_id != NO_TPDO;
}

static void begin(struct drives *d)
{
    struct drives_mapping *m = &d->mapping;
    unsigned first = drives_is_transmitted(m) ? PDO_TPDO1_FUNCTION : PDO_RPDO1_FUNCTION;
    struct drives_axis *axis = &d->axis[d->at_axis];
    bool keeps = axis->config.keeps_settings;
    TAKT_ASSERT(d->at_axis < d->count);
    memset(&m->pdo, 0, sizeof m->pdo);
    m->pdo.transmission = PDO_EVENT;
    m->pdo.cob_id = (uint16_t)(first + number_of(m) * PDO_NEXT_FUNCTION + d->node[d->at_axis]);
    takt_drives_want(d, &m->pdo);
    m->id = m->pdo.cob_id | (drives_is_transmitted(m) ? OBJECT_PDO_NO_RTR : 0);
    m->entry = 0;
    m->is_taken = !keeps;
    m->is_timed = false;
    m->step = keeps ? READ_ID : OFF;
    if (m->pass == PASS_AGAIN && (m->pdo.mapping.count == 0 || keeps)) {
        m->step = DONE;
    } else if (m->pass == PASS_AGAIN) {
        axis->control_frame.length = 0;
        axis->control_frame.mode = DRIVES_NOWHERE;
    } else if (m->pass == PASS_APART && has_reports(axis)) {
        m->pass = PASSES;
    } else if (m->pass == PASS_APART) {
        axis->bits = 0;
        axis->error_id = NO_TPDO;
        axis->given_up &= ~(1u << DRIVES_NO_SILENCE);
    }
}

/* ---- Telling and reading it ---- */

static bool set_write(struct drives_step *step, unsigned index, unsigned sub, uint8_t length,
                      uint32_t value)
{
    *step = (struct drives_step){SDO_OBJECT(index, sub), length, value};
    return true;
}

static bool set_read(struct drives_step *step, unsigned index, unsigned sub)
{
    return set_write(step, index, sub, 0, 0);
}

static bool has(const struct pdo *pdo, uint32_t object)
{
    return takt_drives_byte_of(pdo, object) != DRIVES_NOWHERE;
}

static bool is_report(const struct pdo *pdo)
{
    return has(pdo, CIA402_STATUSWORD) || has(pdo, CIA402_POSITION_ACTUAL);
}

static bool is_event_driven(const struct drives_mapping *m)
{
    return drives_is_transmitted(m) && m->pdo.transmission >= PDO_EVENT_MIN;
}

/* A report without SYNC comes once a cycle; a following error is not to be told so often. */
static uint32_t event_ms_of(const struct drives *d)
{
    return is_report(&d->mapping.pdo) ? (d->cycle_us + 999) / 1000 : DRIVES_EVENT_MS;
}

/* Reports of every SYNC are not held back; others come no more often than their timer has it. */
static uint32_t inhibit_of(const struct drives *d)
{
    return is_event_driven(&d->mapping) ? event_ms_of(d) * OBJECT_PDO_INHIBIT_PER_MS : 0;
}

static bool find_telling(const struct drives *d, struct drives_step *step)
{
    const struct drives_mapping *m = &d->mapping;
    const unsigned parameters = parameters_of(m), mapping = parameters + MAPPING_OFFSET;
    const struct pdo *pdo = &m->pdo;
    const unsigned count = pdo->mapping.count;
    switch (m->step) {
    case OFF:
        return set_write(step, parameters, OBJECT_PDO_COB_ID, 4, m->id | OBJECT_PDO_NOT_VALID);
    case TYPE:
        return set_write(step, parameters, OBJECT_PDO_TYPE, 1, pdo->transmission) && count > 0;
    case CLEAR:
        return set_write(step, mapping, 0, 1, 0) &&
               (count > 0 || (drives_is_transmitted(m) && !m->is_taken));
    case ENTRY:
        return m->entry < count &&
               set_write(step, mapping, m->entry + 1u, 4, pdo->mapping.object[m->entry]);
    case COUNT:
        return set_write(step, mapping, 0, 1, count) && count > 0;
    case INHIBIT:
        return set_write(step, parameters, OBJECT_PDO_INHIBIT, 2, inhibit_of(d)) && count > 0 &&
               drives_is_transmitted(m);
    case TIMER:
        return set_write(step, parameters, OBJECT_PDO_EVENT_TIMER, 2, event_ms_of(d)) &&
               count > 0 && is_event_driven(m);
    default:
        return set_write(step, parameters, OBJECT_PDO_COB_ID, 4, m->id) && count > 0;
    }
}

static uint8_t type_for(const struct drives *d)
{
    const struct pdo *pdo = &d->mapping.pdo;
    bool has_cyclic = drives_is_transmitted(&d->mapping)
                          ? is_report(pdo)
                          : has(pdo, takt_drives_target_of(&d->axis[d->at_axis]));
    return has_cyclic ? PDO_EVERY_SYNC : PDO_EVENT;
}

/* What a frame holds beside that: dummies have no value. */
static bool is_rest(const struct drives_axis *axis, uint32_t object)
{
    return object >> 16 >= OBJECT_DEVICE_TYPE && object != CIA402_CONTROLWORD &&
           object != CIA402_MODE && object != takt_drives_target_of(axis);
}

static bool is_unwanted(const struct drives *d)
{
    const struct drives_mapping *m = &d->mapping;
    return drives_is_transmitted(m) && m->pdo.mapping.count > 0 &&
           !takt_drives_uses(&d->axis[d->at_axis], &m->pdo);
}

static bool find_reading(const struct drives *d, struct drives_step *step)
{
    const struct drives_mapping *m = &d->mapping;
    const struct drives_axis *axis = &d->axis[d->at_axis];
    const unsigned parameters = parameters_of(m), mapping = parameters + MAPPING_OFFSET;
    const uint32_t object = m->pdo.mapping.object[m->entry & (PDO_MAPPED_MAX - 1)];
    bool is_entry = m->entry < m->pdo.mapping.count;
    switch (m->step) {
    case READ_ID:
        return set_read(step, parameters, OBJECT_PDO_COB_ID);
    case READ_TYPE:
        return set_read(step, parameters, OBJECT_PDO_TYPE);
    case READ_COUNT:
        return set_read(step, mapping, 0);
    case READ_ENTRY:
        return is_entry && set_read(step, mapping, m->entry + 1u);
    case SET_TYPE:
        return m->pdo.transmission != type_for(d) && m->pdo.mapping.count > 0 &&
               !axis->config.keeps_settings &&
               set_write(step, parameters, OBJECT_PDO_TYPE, 1, type_for(d));
    case READ_TIMER:
        return m->pass >= PASS_APART && is_event_driven(m) && is_report(&m->pdo) && !m->is_timed &&
               set_read(step, parameters, OBJECT_PDO_EVENT_TIMER);
    case READ_REST:
        return is_entry && !drives_is_transmitted(m) && takt_drives_uses(axis, &m->pdo) &&
               is_rest(axis, object) && set_read(step, object >> 16, object >> 8 & 0xFF);
    default:
        return is_unwanted(d) && !axis->config.keeps_settings &&
               set_write(step, parameters, OBJECT_PDO_COB_ID, 4, m->id | OBJECT_PDO_NOT_VALID);
    }
}

/* ---- What is made of it ---- */

/* Everything that could be told has been. */
static void take_told(struct drives *d)
{
    struct drives_mapping *m = &d->mapping;
    m->step = m->is_taken ? SILENCE : READ_ID;
    if (m->is_taken)
        takt_drives_take_layout(d);
}

/* ---- Answers ---- */

static void remove_entry(struct pdo_mapping *mapping, unsigned entry)
{
    for (unsigned i = entry + 1; i < mapping->count; i++)
        mapping->object[i - 1] = mapping->object[i];
    mapping->count--;
}

/* Some drives have no bit for that, and refuse it. */
static bool drop_no_rtr(struct drives_mapping *m)
{
    bool is_set = m->id & OBJECT_PDO_NO_RTR;
    m->id &= ~OBJECT_PDO_NO_RTR;
    return is_set;
}

/* What follows from a refusal. True: the next step is due. */
static bool take_refusal(struct drives *d, uint32_t abort_code)
{
    struct drives_mapping *m = &d->mapping;
    struct pdo_mapping *mapping = &m->pdo.mapping;
    d->read[0] = abort_code;
    switch (m->step) {
    case OFF:
        if (sdo_says_absent(abort_code)) {
            mapping->count = 0;
            m->step = ON;
            return true;
        }
        if (drop_no_rtr(m))
            return false;
        break;
    case ON:
        if (drop_no_rtr(m))
            return false;
        break;
    case TYPE: /* without SYNC, then */
        if (m->pass >= PASS_APART && m->pdo.transmission == PDO_EVERY_SYNC) {
            m->pdo.transmission = PDO_EVENT;
            return false;
        }
        break;
    case CLEAR:
        if (mapping->count > 0)
            takt_drives_give_up(d, d->at_axis, DRIVES_NO_MAPPING);
        m->step = COUNT;
        break;
    case ENTRY:
        remove_entry(mapping, m->entry);
        return false;
    case COUNT:
        mapping->count--;
        return mapping->count == 0;
    case INHIBIT:
        return true; /* it has none, or keeps it */
    case TIMER:
        if (is_report(&m->pdo))
            break;
        takt_drives_give_up(d, d->at_axis, DRIVES_NO_EVENT_TIMER);
        return true;
    default:
        break;
    }
    m->is_taken = false;
    return true;
}

static bool has_what_was_told(const struct drives *d, uint32_t value)
{
    struct drives_step told = {0};
    (void)find_telling(d, &told);
    return value == told.value;
}

/* What is refused is read: it may be so already. */
static bool looks(struct drives *d, uint32_t abort_code)
{
    if (d->is_looking || abort_code == SDO_ABORT_NONE || sdo_says_absent(abort_code))
        return false;
    d->read[0] = abort_code;
    d->is_looking = true;
    return true;
}

static void take_telling(struct drives *d, const struct drives_answer *answer)
{
    struct drives_mapping *m = &d->mapping;
    if (looks(d, answer->abort_code))
        return;
    bool is_good = answer->abort_code == SDO_ABORT_NONE &&
                   (!d->is_looking || has_what_was_told(d, answer->value));
    bool is_done = is_good || take_refusal(d, d->is_looking ? d->read[0] : answer->abort_code);
    d->is_looking = false;
    m->is_timed = m->is_timed || (m->step == TIMER && is_good && is_report(&m->pdo));
    if (m->step == ENTRY)
        m->entry = (uint8_t)(m->entry + is_done);
    else
        m->step = (uint8_t)(m->step + is_done);
    if (m->step == ENTRY && m->pdo.mapping.count == 0 && is_good)
        m->is_taken = true; /* it cannot be made not valid, but is empty */
}

static void take_rest(struct drives *d, const struct drives_answer *answer)
{
    struct drives_mapping *m = &d->mapping;
    struct drives_axis *axis = &d->axis[d->at_axis];
    uint32_t object = m->pdo.mapping.object[m->entry++];
    if (answer->abort_code != SDO_ABORT_NONE)
        return;
    takt_drives_store_rest(&axis->control_frame, &m->pdo, object, answer->value);
    takt_drives_store_rest(&axis->target_frame, &m->pdo, object, answer->value);
}

/* A PDO that is not valid, or not of this kind of identifiers, is none. */
static bool is_usable(uint32_t id)
{
    return (id & ~(uint32_t)OBJECT_PDO_NO_RTR) <= CAN_ID_MASK;
}

static void take_reading(struct drives *d, const struct drives_answer *answer)
{
    struct drives_mapping *m = &d->mapping;
    struct pdo_mapping *mapping = &m->pdo.mapping;
    bool is_good = answer->abort_code == SDO_ABORT_NONE;
    uint8_t step = m->step++;
    switch (step) {
    case READ_ID:
        m->id = answer->value;
        m->pdo.cob_id = (uint16_t)(answer->value & CAN_ID_MASK);
        mapping->count = 0;
        if (!is_good || !is_usable(answer->value))
            m->step = DONE;
        break;
    case READ_TYPE:
        m->pdo.transmission = is_good ? (uint8_t)answer->value : PDO_EVENT;
        break;
    case READ_COUNT:
        m->entry = 0;
        mapping->count = (uint8_t)(is_good && answer->value <= PDO_MAPPED_MAX ? answer->value : 0);
        break;
    case READ_ENTRY:
        mapping->object[m->entry++] = is_good ? answer->value : 0;
        m->step = READ_ENTRY;
        break;
    case SET_TYPE:
        m->pdo.transmission = is_good ? type_for(d) : m->pdo.transmission;
        break;
    case READ_TIMER:
        m->is_timed = is_good && answer->value > 0 && answer->value <= event_ms_of(d);
        break;
    case READ_REST:
        m->step = READ_REST;
        take_rest(d, answer);
        break;
    default:
        if (!is_good)
            takt_drives_suffer(d);
        break;
    }
}

void takt_drives_take_map(struct drives *d, const struct drives_answer *answer)
{
    if (d->mapping.step < TOLD)
        take_telling(d, answer);
    else
        take_reading(d, answer);
}

/* Steps without a request. */
static void pass_step(struct drives *d)
{
    struct drives_mapping *m = &d->mapping;
    switch (m->step) {
    case BEGIN:
        begin(d);
        break;
    case TOLD:
        take_told(d);
        break;
    case FOUND:
        takt_drives_take_layout(d);
        m->step++;
        break;
    case READ_REST:
        if (++m->entry >= m->pdo.mapping.count)
            m->step++;
        break;
    case SILENCE:
        if (is_unwanted(d))
            takt_drives_suffer(d);
        m->step++;
        break;
    case DONE:
        m->pass++;
        m->step = BEGIN;
        break;
    default:
        m->step++;
        break;
    }
}

static bool find_request(const struct drives *d, struct drives_step *step)
{
    switch (d->mapping.step) {
    case BEGIN:
    case TOLD:
    case FOUND:
    case DONE:
        return false;
    default:
        return d->mapping.step < TOLD ? find_telling(d, step) : find_reading(d, step);
    }
}

bool takt_drives_next_map(struct drives *d, struct drives_step *step)
{
    do {
        while (d->mapping.pass < PASSES && d->at_part == DRIVES_MAP) {
            if (find_request(d, step)) {
                step->length = d->is_looking ? 0 : step->length;
                return true;
            }
            pass_step(d);
        }
    } while (d->at_part == DRIVES_MAP && takt_drives_finish_map(d));
    return false;
}

/*
 * Layer setting services (CiA 305), the slave's end: a master finds a node by its identity (1018)
 * and gives it its node id, which is in force from the next reset on. Bit timing cannot be set.
 *
 *     WAITING --switch global 1, switch selective, fastscan--> CONFIGURATION --switch global 0--> WAITING
 */
#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"
#include "servo/servo_private.h"

#include <string.h>

#define LSS_SWITCH_GLOBAL    0x04
#define LSS_CONFIGURE_NODE   0x11
#define LSS_CONFIGURE_TIMING 0x13
#define LSS_STORE            0x17
#define LSS_SWITCH_SELECTIVE 0x40 /* and 3 more: the four parts of the identity, in their order */
#define LSS_SELECTED         0x44
#define LSS_IDENTIFY                                                                               \
    0x46 /* and 5 more: vendor, product, revision from and to, serial from and to */
#define LSS_IDENTIFY_NAMELESS   0x4C
#define LSS_IDENTIFIED          0x4F
#define LSS_IDENTIFIED_NAMELESS 0x50
#define LSS_FASTSCAN            0x51
#define LSS_INQUIRE             0x5A /* and 3 more: the four parts of the identity */
#define LSS_INQUIRE_NODE        0x5E

#define IDENTITY_PARTS 4

#define LSS_DONE         0
#define LSS_INADMISSIBLE 1 /* a value that cannot be, a service that is not there */
#define LSS_NOT_STORED   2

#define FASTSCAN_BEGINS 0x80

static uint32_t identity(struct servo *drive, unsigned part)
{
    uint32_t value = 0;
    TAKT_ASSERT(part < 4);
    (void)takt_servo_read_object(drive, 0x10180020u | (part + 1) << 8, &value);
    return value;
}

static void answer(struct servo *drive, unsigned command, uint32_t value)
{
    struct can_frame frame = {.id = LSS_ANSWER_COB_ID, .length = CAN_CLASSIC_MAX};
    frame.data[0] = (uint8_t)command;
    little_endian_write32(frame.data + 1, value);
    (void)takt_servo_send(drive, SERVO_FRAME_SDO, &frame);
}

/* The parts must come one after the other, and be those of this node. */
static void select_by(struct servo *drive, unsigned part, uint32_t value)
{
    struct drive_lss *lss = &drive->lss;
    bool is_next = part == lss->matched && value == identity(drive, part);
    TAKT_ASSERT(part < IDENTITY_PARTS);
    lss->matched = (uint8_t)(is_next ? part + 1 : part == 0 && value == identity(drive, 0));
    if (lss->matched < IDENTITY_PARTS)
        return;
    lss->matched = 0;
    lss->configures = true;
    answer(drive, LSS_SELECTED, 0);
}

/* Vendor, product, least and most of the revision, least and most of the serial number. */
static void identify_by(struct servo *drive, unsigned step, uint32_t value)
{
    struct drive_lss *lss = &drive->lss;
    unsigned part = step < 2 ? step : 2 + (step - 2) / 2;
    uint32_t own = identity(drive, part);
    bool fits = step < 2 ? value == own : step % 2 == 0 ? own >= value : own <= value;
    TAKT_ASSERT(step < 6);
    lss->identified = (uint8_t)(fits && step == lss->identified ? step + 1 : 0);
    if (lss->identified == 6) {
        lss->identified = 0;
        answer(drive, LSS_IDENTIFIED, 0);
    }
}

/*
 * Nodes without an id say whether the upper bits of a part of their identity are these, down to bit
 * `check`; who has all bits of a part goes on to the next. After the last one there is one node
 * left.
 */
static void fastscan(struct servo *drive, uint32_t value, uint8_t check, uint8_t part, uint8_t next)
{
    struct drive_lss *lss = &drive->lss;
    if (!lss->is_nameless || lss->configures)
        return;
    if (check == FASTSCAN_BEGINS) {
        lss->scanned = 0;
        answer(drive, LSS_IDENTIFIED, 0);
        return;
    }
    if (check > 31 || part != lss->scanned || part >= IDENTITY_PARTS ||
        identity(drive, part) >> check != value >> check)
        return;
    if (check == 0) {
        lss->configures = next < part;
        lss->scanned = next;
    }
    answer(drive, LSS_IDENTIFIED, 0);
}

static void configure_node(struct servo *drive, uint8_t node)
{
    bool is_one = (node >= NODE_MIN && node <= NODE_MAX) || node == LSS_NO_NODE;
    if (is_one)
        drive->lss.node = node;
    answer(drive, LSS_CONFIGURE_NODE, is_one ? LSS_DONE : LSS_INADMISSIBLE);
}

/* The node id is kept with what object 1010 has stored. */
static void store(struct servo *drive)
{
    const uint8_t before = drive->lss.stored;
    bool is_kept;
    drive->lss.stored = drive->lss.node;
    is_kept = drive->keeper.keep == NULL || drive->keeper.keep(drive->keeper.context, drive);
    if (!is_kept)
        drive->lss.stored = before;
    answer(drive, LSS_STORE, is_kept ? LSS_DONE : LSS_NOT_STORED);
}

static void take_configuration(struct servo *drive, unsigned command, uint8_t value)
{
    switch (command) {
    case LSS_CONFIGURE_NODE:
        configure_node(drive, value);
        break;
    case LSS_CONFIGURE_TIMING:
        answer(drive, command, LSS_INADMISSIBLE);
        break;
    case LSS_STORE:
        store(drive);
        break;
    case LSS_INQUIRE_NODE:
        answer(drive, command, drive->lss.is_nameless ? LSS_NO_NODE : drive->config.node);
        break;
    default:
        if (command >= LSS_INQUIRE && command < LSS_INQUIRE + IDENTITY_PARTS)
            answer(drive, command, identity(drive, command - LSS_INQUIRE));
        break;
    }
}

void takt_servo_take_lss(struct servo *drive, const struct can_frame *frame)
{
    const uint8_t *data = frame->data;
    const uint32_t value = little_endian_read32(data + 1);
    const unsigned command = data[0];
    if (frame->length != CAN_CLASSIC_MAX)
        return;
    if (command == LSS_SWITCH_GLOBAL)
        drive->lss.configures = data[1] == 1;
    else if (command >= LSS_SWITCH_SELECTIVE && command < LSS_SELECTED)
        select_by(drive, command - LSS_SWITCH_SELECTIVE, value);
    else if (command >= LSS_IDENTIFY && command < LSS_IDENTIFY_NAMELESS)
        identify_by(drive, command - LSS_IDENTIFY, value);
    else if (command == LSS_IDENTIFY_NAMELESS && drive->lss.is_nameless)
        answer(drive, LSS_IDENTIFIED_NAMELESS, 0);
    else if (command == LSS_FASTSCAN)
        fastscan(drive, value, data[5], data[6], data[7]);
    else if (drive->lss.configures)
        take_configuration(drive, command, data[1]);
}

/*
 * What counts from the node id counts from the new one, where it has not been set to something
 * else.
 */
static void renumber(const struct servo *drive, struct drive_objects *objects, uint8_t to)
{
    const struct dictionary *dictionary = drive->dictionary;
    for (unsigned i = 0; i < dictionary->count; i++) {
        const struct object_row *row = &dictionary->row[i];
        uint32_t initial = (uint32_t)row->initial;
        if (row->flags & OBJECT_NODE_ID &&
            takt_object_read(row, objects) == initial + drive->config.node)
            takt_object_write(row, objects, initial + to);
    }
}

/*
 * A reset: the node id that has been configured, or at one of the whole node the one that has been
 * stored.
 */
void takt_servo_apply_lss(struct servo *drive, bool whole_node)
{
    struct drive_lss *lss = &drive->lss;
    const uint8_t node = whole_node ? lss->stored : lss->node;
    *lss =
        (struct drive_lss){.node = node, .stored = lss->stored, .is_nameless = node == LSS_NO_NODE};
    if (lss->is_nameless || node == drive->config.node)
        return;
    renumber(drive, &drive->objects, node);
    renumber(drive, &drive->stored, node);
    renumber(drive, &drive->initial, node);
    drive->config.node = drive->sdo.node = node;
}

/*
 * What may be written to the objects of PDOs (CiA 301, 7.5.2.35 ... 38): told before it takes
 * effect.
 */
#include "canopen/node.h"
#include "servo/servo_private.h"

#define COB_EXTENDED 0x20000000u

/* Identifiers CiA 301 keeps for NMT, SYNC's neighbours, SDO and heartbeats (7.3.5). */
static bool is_restricted(uint32_t id)
{
    return id <= 0x07F || (id >= 0x101 && id <= 0x180) || (id >= 0x581 && id <= 0x5FF) ||
           (id >= 0x601 && id <= 0x67F) || (id >= 0x6E0 && id <= 0x6FF) || id >= 0x701;
}

/* A valid PDO keeps its identifier; it is changed by way of "not valid". */
static uint32_t check_cob_id(const struct drive_pdo *pdo, uint32_t value)
{
    uint32_t id = value & ~(COB_NOT_VALID | COB_NO_RTR);
    if (id > CAN_ID_MASK || value & COB_EXTENDED)
        return SDO_ABORT_VALUE;
    if (value & COB_NOT_VALID)
        return SDO_ABORT_NONE;
    if (is_restricted(id) || (pdo->is_valid && id != pdo->cob_id))
        return SDO_ABORT_VALUE;
    return SDO_ABORT_NONE;
}

static uint32_t check_type(uint32_t value)
{
    return value > TYPE_SYNC_MAX && value < TYPE_EVENT_MIN ? SDO_ABORT_VALUE : SDO_ABORT_NONE;
}

static uint32_t check_parameters(const struct drive_pdo *pdo, uint8_t sub, uint32_t value)
{
    switch (sub) {
    case 1:
        return check_cob_id(pdo, value);
    case 2:
        return check_type(value);
    case 3:
    case 6:
        return pdo->is_valid ? SDO_ABORT_STATE : SDO_ABORT_NONE;
    default:
        return SDO_ABORT_NONE;
    }
}

static uint32_t check_entry(const struct servo *drive, uint32_t entry, enum object_flag direction)
{
    const struct object_row *row;
    uint32_t code;
    return entry == 0 || takt_servo_find_mapped(drive, entry, direction, &row, &code)
               ? SDO_ABORT_NONE
               : code;
}

/* Sub-index 0 makes the entries below it valid: do all of them exist, and fit into a frame? */
static uint32_t check_count(const struct servo *drive, const struct drive_pdo_mapping *mapping,
                            uint32_t count, enum object_flag direction)
{
    unsigned bits = 0;
    for (unsigned i = 0; i < count; i++) {
        uint32_t code = mapping->entry[i] == 0 ? (uint32_t)SDO_ABORT_NOT_MAPPABLE
                                               : check_entry(drive, mapping->entry[i], direction);
        if (code != SDO_ABORT_NONE)
            return code;
        bits += mapping->entry[i] & 0xFF;
    }
    return bits > 8 * takt_servo_longest_frame(drive) ? SDO_ABORT_PDO_LENGTH : SDO_ABORT_NONE;
}

/* A PDO whose identifier cannot be written is always valid. */
static bool is_fixed(const struct servo *drive, uint16_t mapping_index)
{
    bool has_index;
    const struct object_row *row = takt_dictionary_find(
        drive->dictionary, (uint16_t)(mapping_index - RPDO_MAPPING + RPDO_PARAMETERS), 1,
        &has_index);
    return row != NULL && row->access != OBJECT_RW;
}

/*
 * The mapping changes only while the PDO is not valid, where it may be that; its entries only while
 * none is in use.
 */
static uint32_t check_mapping(const struct servo *drive, const struct object_row *row,
                              const struct drive_pdo *pdo, const struct drive_pdo_mapping *mapping,
                              enum object_flag direction, uint32_t value)
{
    bool is_in_use = pdo->is_valid && !is_fixed(drive, row->index);
    if (is_in_use || (row->sub != 0 && mapping->count != 0))
        return SDO_ABORT_ACCESS;
    return row->sub == 0 ? check_count(drive, mapping, value, direction)
                         : check_entry(drive, value, direction);
}

uint32_t takt_servo_check_pdo_write(const struct servo *drive, const struct object_row *row,
                                    uint32_t value)
{
    const struct drive_communication *c = &drive->objects.communication;
    unsigned i = row->index & 0xFFu;
    if (i >= DRIVE_PDO_COUNT)
        return SDO_ABORT_NONE; /* a PDO of a data sheet that is only memory */
    switch (row->index & 0xFF00) {
    case RPDO_PARAMETERS:
        return check_parameters(&drive->rpdo[i], row->sub, value);
    case TPDO_PARAMETERS:
        return check_parameters(&drive->tpdo[i], row->sub, value);
    case RPDO_MAPPING:
        return check_mapping(drive, row, &drive->rpdo[i], &c->rpdo_mapping[i], OBJECT_TO_RPDO,
                             value);
    case TPDO_MAPPING:
        return check_mapping(drive, row, &drive->tpdo[i], &c->tpdo_mapping[i], OBJECT_TO_TPDO,
                             value);
    default:
        return SDO_ABORT_NONE;
    }
}

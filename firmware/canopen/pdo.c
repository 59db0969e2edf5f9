#include "canopen/pdo.h"
#include "base/assert.h"
#include "canopen/little_endian.h"

static unsigned object_bytes(uint32_t object)
{
    return (object & 0xFF) / 8;
}

static bool is_mappable(uint32_t object)
{
    unsigned bits = object & 0xFF;
    return bits == 8 || bits == 16 || bits == 32;
}

bool takt_pdo_map(struct pdo_mapping *mapping, const uint32_t *objects, unsigned count)
{
    unsigned length = 0;
    mapping->count = 0;
    mapping->length = 0;
    if (count > PDO_MAPPED_MAX)
        return false;
    for (unsigned i = 0; i < count; i++) {
        length += object_bytes(objects[i]);
        if (!is_mappable(objects[i]) || length > CAN_DATA_MAX)
            return false;
        mapping->object[i] = objects[i];
    }
    mapping->count = (uint8_t)count;
    mapping->length = (uint8_t)length;
    return true;
}

static void write_value(uint8_t *bytes, unsigned count, uint32_t value)
{
    TAKT_ASSERT(count == 1 || count == 2 || count == 4);
    switch (count) {
    case 1:
        bytes[0] = (uint8_t)value;
        break;
    case 2:
        little_endian_write16(bytes, (uint16_t)value);
        break;
    default:
        little_endian_write32(bytes, value);
        break;
    }
}

static uint32_t read_value(const uint8_t *bytes, unsigned count)
{
    TAKT_ASSERT(count == 1 || count == 2 || count == 4);
    switch (count) {
    case 1:
        return bytes[0];
    case 2:
        return little_endian_read16(bytes);
    default:
        return little_endian_read32(bytes);
    }
}

void takt_pdo_pack(const struct pdo *pdo, const uint32_t value[], struct can_frame *frame)
{
    const struct pdo_mapping *mapping = &pdo->mapping;
    uint8_t *bytes = frame->data;
    TAKT_ASSERT(mapping->count <= PDO_MAPPED_MAX && mapping->length <= CAN_DATA_MAX);
    frame->id = pdo->cob_id;
    frame->length = mapping->length;
    for (unsigned i = 0; i < mapping->count; i++) {
        unsigned count = object_bytes(mapping->object[i]);
        write_value(bytes, count, value[i]);
        bytes += count;
    }
}

void takt_pdo_unpack(const struct pdo_mapping *mapping, const uint8_t *data, uint32_t value[])
{
    TAKT_ASSERT(mapping->count <= PDO_MAPPED_MAX);
    for (unsigned i = 0; i < mapping->count; i++) {
        unsigned count = object_bytes(mapping->object[i]);
        value[i] = read_value(data, count);
        data += count;
    }
}

int takt_pdo_offset(const struct pdo_mapping *mapping, uint32_t object)
{
    unsigned offset = 0;
    for (unsigned i = 0; i < mapping->count; i++) {
        if (mapping->object[i] == object)
            return (int)offset;
        offset += object_bytes(mapping->object[i]);
    }
    return -1;
}

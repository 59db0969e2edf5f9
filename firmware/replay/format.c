#include "replay/format.h"

#include "base/assert.h"
#include "base/crc32.h"
#include "base/maths.h"

#include <string.h>

static const uint8_t magic[8] = {'T', 'A', 'K', 'T', 'P', 'L', 'A', 'N'};

/* Where things are in the header. */
enum {
    AT_VERSION = 8,
    AT_CYCLE = 12,
    AT_STEP = 16,
    AT_QUANTUM = 20,
    AT_CEILING = 24,
    AT_BLOCKS = 28,
    AT_SECTIONS = 32,
    AT_INTERVALS = 36,
    AT_PROGRAM = 44,
    AT_KEPT = 52,
    AT_LIMITS = 60,
    AT_TEXT_SIZE = AT_LIMITS + 3 * 24,
    AT_TEXT_CRC = AT_TEXT_SIZE + 4,
    AT_CRC = REPLAY_HEADER_BYTES - 4
};

#define QUANTUM_BITS_MAX 40
#define CEILING_MIN      100
#define CEILING_MAX      120

void takt_replay_put(uint8_t *bytes, uint64_t value, unsigned size)
{
    TAKT_ASSERT(size <= sizeof value);
    for (unsigned i = 0; i < size; i++) {
        bytes[i] = (uint8_t)(value >> (8 * i));
    }
}

uint64_t takt_replay_get(const uint8_t *bytes, unsigned size)
{
    uint64_t value = 0;

    TAKT_ASSERT(size <= sizeof(uint64_t));
    for (unsigned i = 0; i < size; i++) {
        value |= (uint64_t)bytes[i] << (8 * i);
    }
    return value;
}

void takt_replay_put_bits(struct replay_bits *b, unsigned value, unsigned count)
{
    TAKT_ASSERT(count <= 32);
    for (unsigned i = 0; i < count; i++, b->at++) {
        if (b->at / 8 < b->size) {
            b->bytes[b->at / 8] |= (uint8_t)((value >> i & 1U) << b->at % 8);
        }
    }
}

unsigned takt_replay_get_bits(struct replay_bits *b, unsigned count)
{
    unsigned value = 0;

    TAKT_ASSERT(count <= 32);
    for (unsigned i = 0; i < count; i++, b->at++) {
        if (b->at / 8 < b->size) {
            value |= ((unsigned)b->bytes[b->at / 8] >> b->at % 8 & 1U) << i;
        }
    }
    return value;
}

static void put_double(uint8_t *bytes, double value)
{
    uint64_t bits;

    memcpy(&bits, &value, sizeof(bits));
    takt_replay_put(bytes, bits, 8);
}

static double get_double(const uint8_t *bytes)
{
    const uint64_t bits = takt_replay_get(bytes, 8);
    double value;

    memcpy(&value, &bits, sizeof(value));
    return value;
}

void takt_replay_header_write(const struct replay_header *h, uint8_t bytes[REPLAY_HEADER_BYTES])
{
    TAKT_ASSERT(h->cycle_us > 0 && h->step_cycles > 0);
    memset(bytes, 0, REPLAY_HEADER_BYTES);
    memcpy(bytes, magic, sizeof(magic));
    takt_replay_put(bytes + AT_VERSION, REPLAY_VERSION, 4);
    takt_replay_put(bytes + AT_CYCLE, h->cycle_us, 4);
    takt_replay_put(bytes + AT_STEP, h->step_cycles, 4);
    takt_replay_put(bytes + AT_QUANTUM, h->quantum_bits, 4);
    takt_replay_put(bytes + AT_CEILING, h->ceiling_percent, 4);
    takt_replay_put(bytes + AT_BLOCKS, h->blocks, 4);
    takt_replay_put(bytes + AT_SECTIONS, h->sections, 4);
    takt_replay_put(bytes + AT_INTERVALS, h->intervals, 8);
    takt_replay_put(bytes + AT_PROGRAM, h->program, 8);
    takt_replay_put(bytes + AT_TEXT_SIZE, h->text_size, 4);
    takt_replay_put(bytes + AT_TEXT_CRC, h->text_crc, 4);
    put_double(bytes + AT_KEPT, h->kept);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        put_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i, h->velocity_mm_s[i]);
        put_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i + 8, h->acceleration_mm_s2[i]);
        put_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i + 16, h->jerk_mm_s3[i]);
    }
    takt_replay_put(bytes + AT_CRC, takt_crc32_add(CRC32_START, bytes, AT_CRC), 4);
}

static bool is_sound(const struct replay_header *h)
{
    return h->cycle_us > 0 && h->step_cycles > 0 && h->quantum_bits <= QUANTUM_BITS_MAX &&
           h->ceiling_percent >= CEILING_MIN && h->ceiling_percent <= CEILING_MAX &&
           h->kept > 0.0 && h->kept < 1.0;
}

enum replay_fault takt_replay_header_read(struct replay_header *h,
                                          const uint8_t bytes[REPLAY_HEADER_BYTES])
{
    memset(h, 0, sizeof(*h));
    if (memcmp(bytes, magic, sizeof(magic)) != 0) {
        return REPLAY_FOREIGN;
    }
    if (takt_replay_get(bytes + AT_VERSION, 4) != REPLAY_VERSION) {
        return REPLAY_OTHER_VERSION;
    }
    if (takt_replay_get(bytes + AT_CRC, 4) != takt_crc32_add(CRC32_START, bytes, AT_CRC)) {
        return REPLAY_DAMAGED;
    }
    h->cycle_us = (uint32_t)takt_replay_get(bytes + AT_CYCLE, 4);
    h->step_cycles = (uint32_t)takt_replay_get(bytes + AT_STEP, 4);
    h->quantum_bits = (uint32_t)takt_replay_get(bytes + AT_QUANTUM, 4);
    h->ceiling_percent = (uint32_t)takt_replay_get(bytes + AT_CEILING, 4);
    h->blocks = (uint32_t)takt_replay_get(bytes + AT_BLOCKS, 4);
    h->sections = (uint32_t)takt_replay_get(bytes + AT_SECTIONS, 4);
    h->intervals = takt_replay_get(bytes + AT_INTERVALS, 8);
    h->program = takt_replay_get(bytes + AT_PROGRAM, 8);
    h->text_size = (uint32_t)takt_replay_get(bytes + AT_TEXT_SIZE, 4);
    h->text_crc = (uint32_t)takt_replay_get(bytes + AT_TEXT_CRC, 4);
    h->kept = get_double(bytes + AT_KEPT);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        h->velocity_mm_s[i] = get_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i);
        h->acceleration_mm_s2[i] = get_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i + 8);
        h->jerk_mm_s3[i] = get_double(bytes + AT_LIMITS + (size_t)24 * (size_t)i + 16);
    }
    return is_sound(h) ? REPLAY_GOOD : REPLAY_DAMAGED;
}

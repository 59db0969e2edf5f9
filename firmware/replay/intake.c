#include "replay/intake.h"

#include "base/crc32.h"

#include <string.h>

/* Ends of no block: an interval longer than any. */
#define END_SHIFT_MAX 28

void intake_open(struct intake *s, const struct replay_source *source)
{
    memset(s, 0, sizeof(*s));
    s->source = *source;
    s->crc = CRC32_START;
}

/* Has so much of the next record come? */
static bool has(struct intake *s, size_t length)
{
    if (s->length < length) {
        s->length += s->source.read(s->source.context, s->bytes + s->length, length - s->length);
    }
    return s->length >= length;
}

static void damaged(struct intake *s)
{
    s->fault = REPLAY_DAMAGED;
}

static bool read_header(struct intake *s)
{
    if (!has(s, REPLAY_HEADER_BYTES)) {
        return false;
    }
    s->fault = replay_header_read(&s->header, s->bytes);
    s->length = 0;
    s->has_header = s->fault == REPLAY_GOOD;
    return s->has_header;
}

static void take_section(struct intake *s, const uint8_t *bytes, size_t length)
{
    struct intake_section *section = &s->section[s->sections_came % INTAKE_SECTIONS_MAX];

    if (length != REPLAY_SECTION_BYTES) {
        damaged(s);
        return;
    }
    section->first_block = (uint32_t)replay_get(bytes, 4);
    section->blocks = (uint32_t)replay_get(bytes + 4, 4);
    section->intervals = (uint32_t)replay_get(bytes + 8, 4);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        section->start[i] = (int64_t)replay_get(bytes + 12 + (size_t)8 * (size_t)i, 8);
    }
    s->intervals += section->intervals;
    s->sections_came++;
}

/* Ends, 7 bits a byte. */
static void take_ends(struct intake *s, const uint8_t *bytes, size_t length)
{
    const unsigned count = bytes[0];
    size_t at = 1;

    for (unsigned i = 0; i < count; i++) {
        uint32_t value = 0;
        unsigned shift = 0;
        bool more = true;

        for (; more && at < length && shift <= END_SHIFT_MAX; shift += 7) {
            value |= (uint32_t)(bytes[at] & 0x7fU) << shift;
            more = (bytes[at++] & 0x80U) != 0;
        }
        if (more) {
            damaged(s);
            return;
        }
        s->end[s->ends_came % INTAKE_ENDS_MAX] = value;
        s->ends_came++;
    }
    if (at != length) {
        damaged(s);
    }
}

static void take_knots(struct intake *s, const uint8_t *bytes, size_t length)
{
    const unsigned count = length > 0 ? bytes[0] : 0;
    const size_t ends_at = 1 + (size_t)count * 2 * AXIS_LINEAR_COUNT;

    if (ends_at >= length || count > REPLAY_RECORD_INTERVALS ||
        bytes[ends_at] > REPLAY_RECORD_ENDS) {
        damaged(s);
        return;
    }
    take_ends(s, bytes + ends_at, length - ends_at);
    for (unsigned i = 0; i < count; i++) {
        int16_t *third = s->third[s->intervals_came % INTAKE_INTERVALS_MAX];

        for (unsigned axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
            third[axis] = (int16_t)(uint16_t)replay_get(
                bytes + 1 + (size_t)2 * ((size_t)AXIS_LINEAR_COUNT * (size_t)i + (size_t)axis), 2);
        }
        s->intervals_came++;
    }
}

static void take_record(struct intake *s, size_t length)
{
    const uint8_t *bytes = s->bytes + REPLAY_RECORD_HEAD;

    switch (s->bytes[0]) {
    case REPLAY_SECTION:
        take_section(s, bytes, length);
        break;
    case REPLAY_KNOTS:
        take_knots(s, bytes, length);
        break;
    case REPLAY_END:
        s->ended = true;
        if (s->intervals != s->header.intervals) {
            damaged(s);
        }
        break;
    default:
        damaged(s);
        break;
    }
}

bool intake_has_room(const struct intake *s)
{
    return s->intervals_came - s->intervals_taken + REPLAY_RECORD_INTERVALS <=
               INTAKE_INTERVALS_MAX &&
           s->ends_came - s->ends_taken + REPLAY_RECORD_ENDS <= INTAKE_ENDS_MAX &&
           s->sections_came - s->sections_taken < INTAKE_SECTIONS_MAX;
}

static bool read_record(struct intake *s)
{
    size_t length;
    size_t whole;

    if (!intake_has_room(s) || !has(s, REPLAY_RECORD_HEAD)) {
        return false;
    }
    length = (size_t)replay_get(s->bytes + 1, 2);
    whole = REPLAY_RECORD_HEAD + length;
    if (whole + REPLAY_RECORD_TAIL > REPLAY_RECORD_MAX) {
        damaged(s);
        return false;
    }
    if (!has(s, whole + REPLAY_RECORD_TAIL)) {
        return false;
    }
    s->crc = crc32_add(s->crc, s->bytes, whole);
    if (s->crc != (uint32_t)replay_get(s->bytes + whole, REPLAY_RECORD_TAIL)) {
        damaged(s);
        return false;
    }
    take_record(s, length);
    s->length = 0;
    return s->fault == REPLAY_GOOD;
}

void intake_read(struct intake *s)
{
    if (s->fault != REPLAY_GOOD || (!s->has_header && !read_header(s))) {
        return;
    }
    while (!s->ended && read_record(s)) {
    }
}

#include "replay/intake.h"

#include "base/assert.h"
#include "base/crc32.h"
#include "base/handoff.h"

#include <string.h>

void takt_intake_open(struct intake *s, const struct replay_source *source)
{
    memset(s, 0, sizeof(*s));
    s->source = *source;
    s->crc = CRC32_START;
}

/* Has so much of the next record come? */
static bool has(struct intake *s, size_t length)
{
    TAKT_ASSERT(length <= sizeof s->bytes);
    if (s->length < length) {
        s->length += s->source.read(s->source.context, s->bytes + s->length, length - s->length);
    }
    TAKT_ASSERT(s->length <= sizeof s->bytes); /* the source gives no more than is asked for */
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
    s->fault = takt_replay_header_read(&s->header, s->bytes);
    s->length = 0;
    s->next = s->fault == REPLAY_GOOD ? INTAKE_RECORD : INTAKE_HEADER;
    return s->next == INTAKE_RECORD;
}

static void take_section(struct intake *s, const uint8_t *bytes, size_t length)
{
    struct intake_section *section = &s->section[s->sections_came % INTAKE_SECTIONS_MAX];

    if (length != REPLAY_SECTION_BYTES) {
        damaged(s);
        return;
    }
    section->first_block = (uint32_t)takt_replay_get(bytes, 4);
    section->blocks = (uint32_t)takt_replay_get(bytes + 4, 4);
    section->intervals = (uint32_t)takt_replay_get(bytes + 8, 4);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        section->start[i] = (int64_t)takt_replay_get(bytes + 12 + (size_t)8 * (size_t)i, 8);
    }
    s->intervals += section->intervals;
    s->place = 0;
    s->last_end = 0;
    handoff_set_count(&s->sections_came, s->sections_came + 1U);
}

/* A block ends at a place. Ends come in order, or the record is damaged. */
static void take_end(struct intake *s, uint64_t place)
{
    TAKT_ASSERT(s->ends_came - s->ends_taken < INTAKE_ENDS_MAX);
    if (place < s->last_end) {
        damaged(s);
        return;
    }
    s->end[s->ends_came % INTAKE_ENDS_MAX] = (uint32_t)(place - s->last_end);
    s->last_end = place;
    handoff_set_count(&s->ends_came, s->ends_came + 1U);
}

/* The part of an interval, from 1, that bits tell. */
static unsigned get_part(struct replay_bits *b, unsigned bits)
{
    TAKT_ASSERT(bits <= REPLAY_END_BITS);
    return (takt_replay_get_bits(b, bits) + 1U) << (REPLAY_END_BITS - bits);
}

/* How many blocks end in an interval: no more than a record holds, or the record is damaged. */
static unsigned get_count(struct replay_bits *b, unsigned k)
{
    unsigned high = 0;

    while (high <= REPLAY_RECORD_ENDS && takt_replay_get_bits(b, 1) == 1U) {
        high++;
    }
    return (high << k) + takt_replay_get_bits(b, k);
}

/* count ends, the last in a part of the interval that is coming, evenly. */
static void take_even_ends(struct intake *s, unsigned count, unsigned last)
{
    for (unsigned i = 1; i <= count; i++) {
        take_end(s, s->place + last * i / count);
    }
}

static void take_interval_ends(struct intake *s, struct replay_bits *b, unsigned count)
{
    if (count >= REPLAY_ENDS_CROWD) {
        take_even_ends(s, count, REPLAY_END_PARTS);
    } else if (count > 2) {
        take_even_ends(s, count, get_part(b, REPLAY_END_BITS_COARSE));
    } else if (count == 2) {
        take_end(s, s->place + get_part(b, REPLAY_END_BITS_COARSE));
        take_end(s, s->place + get_part(b, REPLAY_END_BITS_COARSE));
    } else if (count == 1) {
        take_end(s, s->place + get_part(b, REPLAY_END_BITS));
    }
}

/* The ends of all intervals of a record. */
static void take_ends(struct intake *s, struct replay_bits *b, unsigned intervals)
{
    const unsigned k = takt_replay_get_bits(b, REPLAY_RICE_BITS);
    unsigned left = REPLAY_RECORD_ENDS;

    for (unsigned i = 0; i < intervals; i++) {
        const unsigned count = get_count(b, k);

        if (count > left || b->at > 8 * b->size) {
            damaged(s);
            return;
        }
        left -= count;
        take_interval_ends(s, b, count);
        s->place += REPLAY_END_PARTS;
    }
    if ((b->at + 7) / 8 != b->size) {
        damaged(s);
    }
}

static void take_third(struct intake *s, const uint8_t *bytes)
{
    int16_t *third = s->third[s->intervals_came % INTAKE_INTERVALS_MAX];

    TAKT_ASSERT(s->intervals_came - s->intervals_taken < INTAKE_INTERVALS_MAX);
    for (unsigned axis = 0; axis < AXIS_LINEAR_COUNT; axis++) {
        third[axis] = (int16_t)(uint16_t)takt_replay_get(bytes + (size_t)2 * axis, 2);
    }
    handoff_set_count(&s->intervals_came, s->intervals_came + 1U);
}

static void take_knots(struct intake *s, uint8_t *bytes, size_t length)
{
    const unsigned count = length > 0 ? bytes[0] : 0;
    const size_t ends_at = 1 + (size_t)count * 2 * AXIS_LINEAR_COUNT;
    struct replay_bits bits;

    if (ends_at >= length || count > REPLAY_RECORD_INTERVALS) {
        damaged(s);
        return;
    }
    bits = (struct replay_bits){.bytes = bytes + ends_at, .size = length - ends_at};
    take_ends(s, &bits, count);
    for (unsigned i = 0; i < count; i++) {
        take_third(s, bytes + 1 + (size_t)2 * AXIS_LINEAR_COUNT * i);
    }
}

static void take_more(struct intake *s, const uint8_t *bytes, size_t length)
{
    if (length != 1 || bytes[0] > REPLAY_RECORD_ENDS) {
        damaged(s);
        return;
    }
    for (unsigned i = 0; i < bytes[0]; i++) {
        take_end(s, s->place);
    }
}

static void take_record(struct intake *s, size_t length)
{
    uint8_t *bytes = s->bytes + REPLAY_RECORD_HEAD;

    switch (s->bytes[0]) {
    case REPLAY_SECTION:
        take_section(s, bytes, length);
        break;
    case REPLAY_KNOTS:
        take_knots(s, bytes, length);
        break;
    case REPLAY_MORE:
        take_more(s, bytes, length);
        break;
    case REPLAY_END:
        s->next = INTAKE_NOTHING;
        if (s->intervals != s->header.intervals) {
            damaged(s);
        }
        break;
    default:
        damaged(s);
        break;
    }
}

bool takt_intake_has_room(const struct intake *s)
{
    TAKT_ASSERT(s->intervals_came - s->intervals_taken <= INTAKE_INTERVALS_MAX);
    TAKT_ASSERT(s->ends_came - s->ends_taken <= INTAKE_ENDS_MAX);
    TAKT_ASSERT(s->sections_came - s->sections_taken <= INTAKE_SECTIONS_MAX);
    return s->intervals_came - s->intervals_taken + REPLAY_RECORD_INTERVALS <=
               INTAKE_INTERVALS_MAX &&
           s->ends_came - s->ends_taken + REPLAY_RECORD_ENDS <= INTAKE_ENDS_MAX &&
           s->sections_came - s->sections_taken < INTAKE_SECTIONS_MAX;
}

static bool read_record(struct intake *s)
{
    size_t length;
    size_t whole;

    if (!takt_intake_has_room(s) || !has(s, REPLAY_RECORD_HEAD)) {
        return false;
    }
    length = (size_t)takt_replay_get(s->bytes + 1, 2);
    whole = REPLAY_RECORD_HEAD + length;
    if (whole + REPLAY_RECORD_TAIL > REPLAY_RECORD_MAX) {
        damaged(s);
        return false;
    }
    if (!has(s, whole + REPLAY_RECORD_TAIL)) {
        return false;
    }
    s->crc = takt_crc32_add(s->crc, s->bytes, whole);
    if (s->crc != (uint32_t)takt_replay_get(s->bytes + whole, REPLAY_RECORD_TAIL)) {
        damaged(s);
        return false;
    }
    take_record(s, length);
    s->length = 0;
    return s->fault == REPLAY_GOOD;
}

void takt_intake_read(struct intake *s)
{
    if (s->fault != REPLAY_GOOD || (s->next == INTAKE_HEADER && !read_header(s))) {
        return;
    }
    while (s->next == INTAKE_RECORD && read_record(s)) {
    }
}

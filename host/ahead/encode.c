#include "ahead/encode.h"

#include "base/crc32.h"
#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

/* Largest third difference, with room for the rounding of four control points. */
#define THIRD_MAX 32700.0

#define QUANTUM_BITS_MAX 40

/* A record that is being filled. */
struct record {
    uint8_t bytes[REPLAY_RECORD_MAX];
    size_t length;
};

/* The interval and the part of it, in 1/256, at which a place is passed. */
struct passing {
    const struct trail *trail;
    size_t site; /* half knots before it */
};

void encoder_begin(struct encoder *e, FILE *stream, const struct replay_header *h)
{
    static const uint8_t nothing[REPLAY_HEADER_BYTES];

    *e = (struct encoder){.stream = stream, .header = *h, .crc = CRC32_START};
    e->failed = fwrite(nothing, sizeof nothing, 1, stream) != 1;
    e->bytes = sizeof nothing;
}

uint32_t encoder_quantum_bits(double third_mm)
{
    double third = third_mm;
    uint32_t bits = 0;

    for (; bits < QUANTUM_BITS_MAX && 2 * third <= THIRD_MAX; bits++)
        third *= 2;
    return bits;
}

static void begin_record(struct record *r, enum replay_kind kind)
{
    r->bytes[0] = (uint8_t)kind;
    r->length = REPLAY_RECORD_HEAD;
}

static void put(struct record *r, uint64_t value, unsigned size)
{
    takt_replay_put(r->bytes + r->length, value, size);
    r->length += size;
}

static void write_record(struct encoder *e, struct record *r)
{
    takt_replay_put(r->bytes + 1, r->length - REPLAY_RECORD_HEAD, 2);
    e->crc = takt_crc32_add(e->crc, r->bytes, r->length);
    put(r, e->crc, REPLAY_RECORD_TAIL);
    e->failed = fwrite(r->bytes, r->length, 1, e->stream) != 1 || e->failed;
    e->bytes += r->length;
}

static int64_t quanta(const struct encoder *e, double mm)
{
    return (int64_t)takt_maths_round(mm * (double)(UINT64_C(1) << e->header.quantum_bits));
}

static void write_section(struct encoder *e, const struct ahead_path *path, const struct trail *t)
{
    struct record r;

    begin_record(&r, REPLAY_SECTION);
    put(&r, path->element[0].block, 4);
    put(&r, path->count, 4);
    put(&r, t->intervals, 4);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
        put(&r, (uint64_t)quanta(e, t->motor[0][i]), 8);
    write_record(e, &r);
}

/* c3 - 3 c2 + 3 c1 - c0 of the rounded control points. */
static int64_t third_of(const struct encoder *e, double (*c)[3], int axis)
{
    return quanta(e, c[3][axis]) - 3 * (quanta(e, c[2][axis]) - quanta(e, c[1][axis])) -
           quanta(e, c[0][axis]);
}

/* When a place is passed, in 1/256 intervals from the section's start; places come in order. */
static uint64_t pass(struct passing *p, double place_mm)
{
    const double *at = p->trail->place_mm;
    double part;

    while (p->site + 1 < 2 * p->trail->intervals && at[p->site + 1] < place_mm)
        p->site++;
    part = at[p->site + 1] > at[p->site]
               ? (place_mm - at[p->site]) / (at[p->site + 1] - at[p->site])
               : 0;
    return (uint64_t)takt_maths_ceil(((double)p->site + maths_clamp(part, 0, 1)) *
                                     REPLAY_END_PARTS / 2);
}

/* The interval in which a place lies, its end included. */
static size_t takt_interval_of(uint64_t end)
{
    return end > 0 ? (size_t)((end - 1) / REPLAY_END_PARTS) : 0;
}

/* Blocks of a section and how many of their ends have been written. */
struct endings {
    const uint64_t *end;
    size_t count; /* the last block's is not among them */
    size_t next;
};

/* Ends within an interval that are still to be written. */
static size_t ends_in(const struct endings *ends, size_t from, size_t interval)
{
    size_t count = 0;

    while (from + count < ends->count && takt_interval_of(ends->end[from + count]) <= interval)
        count++;
    return count;
}

/*
 * The part of its interval that an end is in, from 0; an end of an interval before counts as its
 * begin.
 */
static unsigned part_of(uint64_t end, size_t interval, unsigned bits)
{
    const uint64_t from = (uint64_t)interval * REPLAY_END_PARTS;
    const uint64_t parts = end > from ? end - from - 1 : 0;

    return (unsigned)(parts >> (REPLAY_END_BITS - bits));
}

static void put_count(struct replay_bits *b, size_t count, unsigned k)
{
    for (size_t i = 0; i < count >> k; i++)
        takt_replay_put_bits(b, 1, 1);
    takt_replay_put_bits(b, 0, 1);
    takt_replay_put_bits(b, (unsigned)count, k);
}

static void put_interval_ends(struct replay_bits *b, const uint64_t *end, size_t count,
                              size_t interval)
{
    if (count == 1) {
        takt_replay_put_bits(b, part_of(end[0], interval, REPLAY_END_BITS), REPLAY_END_BITS);
        return;
    }
    if (count == 2)
        takt_replay_put_bits(b, part_of(end[0], interval, REPLAY_END_BITS_COARSE),
                             REPLAY_END_BITS_COARSE);
    if (count >= 2 && count < REPLAY_ENDS_CROWD)
        takt_replay_put_bits(b, part_of(end[count - 1], interval, REPLAY_END_BITS_COARSE),
                             REPLAY_END_BITS_COARSE);
}

/* All ends of some intervals, with the parameter k; returns the bytes. */
static size_t put_ends(struct record *r, const struct endings *ends, size_t first, size_t count,
                       unsigned k)
{
    struct replay_bits b = {.bytes = r->bytes + r->length,
                            .size = sizeof r->bytes - r->length - REPLAY_RECORD_TAIL};
    size_t next = ends->next;

    memset(b.bytes, 0, b.size);
    takt_replay_put_bits(&b, k, REPLAY_RICE_BITS);
    for (size_t i = first; i < first + count; i++) {
        const size_t here = ends_in(ends, next, i);

        put_count(&b, here, k);
        put_interval_ends(&b, ends->end + next, here, i);
        next += here;
    }
    return (b.at + 7) / 8;
}

static unsigned best_k(struct record *r, const struct endings *ends, size_t first, size_t count)
{
    unsigned best = 0;
    size_t least = SIZE_MAX;

    for (unsigned k = 0; k < 1U << REPLAY_RICE_BITS; k++) {
        const size_t bytes = put_ends(r, ends, first, count, k);

        if (bytes < least) {
            least = bytes;
            best = k;
        }
    }
    return best;
}

/* More ends in one interval than a record holds: as if at its begin. */
static void write_crowd(struct encoder *e, struct endings *ends, size_t interval)
{
    while (ends_in(ends, ends->next, interval) > REPLAY_RECORD_ENDS) {
        struct record r;

        begin_record(&r, REPLAY_MORE);
        put(&r, REPLAY_RECORD_ENDS, 1);
        write_record(e, &r);
        ends->next += REPLAY_RECORD_ENDS;
    }
}

/* Intervals from first on that fit into one record with their ends. */
static size_t fitting(const struct endings *ends, size_t first, size_t intervals)
{
    size_t count = 0;
    size_t next = ends->next;

    while (count < REPLAY_RECORD_INTERVALS && first + count < intervals) {
        next += ends_in(ends, next, first + count);
        if (next - ends->next > REPLAY_RECORD_ENDS)
            break;
        count++;
    }
    return count;
}

/*
 * Everything of a section from interval first on that fits into one record; returns the intervals.
 */
static size_t write_knots(struct encoder *e, const struct trail *t, size_t first,
                          struct endings *ends)
{
    struct record r;
    size_t count;

    write_crowd(e, ends, first);
    count = fitting(ends, first, t->intervals);
    begin_record(&r, REPLAY_KNOTS);
    put(&r, count, 1);
    for (size_t i = first; i < first + count; i++) {
        for (int axis = 0; axis < AXIS_LINEAR_COUNT; axis++)
            put(&r, (uint64_t)third_of(e, t->motor + i, axis) & 0xffff, 2);
    }
    r.length += put_ends(&r, ends, first, count, best_k(&r, ends, first, count));
    for (size_t i = first; i < first + count; i++)
        ends->next += ends_in(ends, ends->next, i);
    write_record(e, &r);
    return count;
}

static void find_ends(const struct ahead_path *path, const struct trail *t, uint64_t *ends)
{
    struct passing p = {.trail = t};

    for (size_t k = 0; k + 1 < path->count; k++)
        ends[k] = pass(&p, path->element[k + 1].start_mm);
}

void encoder_add(struct encoder *e, const struct ahead_path *path, const struct trail *t)
{
    uint64_t *end = calloc(path->count, sizeof *end);
    struct endings ends = {.end = end, .count = path->count - 1};
    size_t first = 0;

    if (end == NULL) {
        e->failed = true;
        return;
    }
    find_ends(path, t, end);
    write_section(e, path, t);
    while (first < t->intervals && !e->failed)
        first += write_knots(e, t, first, &ends);
    e->header.blocks += (uint32_t)path->count;
    e->header.intervals += t->intervals;
    e->header.sections++;
    free(end);
}

bool encoder_end(struct encoder *e, uint64_t program)
{
    uint8_t bytes[REPLAY_HEADER_BYTES];
    struct record r;

    begin_record(&r, REPLAY_END);
    write_record(e, &r);
    e->header.program = program;
    takt_replay_header_write(&e->header, bytes);
    return !e->failed && fseek(e->stream, 0, SEEK_SET) == 0 &&
           fwrite(bytes, sizeof bytes, 1, e->stream) == 1 && fseek(e->stream, 0, SEEK_END) == 0;
}

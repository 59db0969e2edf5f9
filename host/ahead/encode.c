#include "ahead/encode.h"

#include "base/crc32.h"
#include "base/maths.h"

#include <stdlib.h>

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

uint32_t encoder_quantum_bits(double jerk_mm_s3, double step_s)
{
    double third = jerk_mm_s3 * step_s * step_s * step_s;
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
    replay_put(r->bytes + r->length, value, size);
    r->length += size;
}

static void write_record(struct encoder *e, struct record *r)
{
    replay_put(r->bytes + 1, r->length - REPLAY_RECORD_HEAD, 2);
    e->crc = crc32_add(e->crc, r->bytes, r->length);
    put(r, e->crc, REPLAY_RECORD_TAIL);
    e->failed = fwrite(r->bytes, r->length, 1, e->stream) != 1 || e->failed;
    e->bytes += r->length;
}

static int64_t quanta(const struct encoder *e, double mm)
{
    return (int64_t)maths_round(mm * (double)(UINT64_C(1) << e->header.quantum_bits));
}

static void write_section(struct encoder *e, const struct ahead_path *path, const struct trail *t)
{
    struct record r;

    begin_record(&r, REPLAY_SECTION);
    put(&r, path->element[0].block, 4);
    put(&r, path->count, 4);
    put(&r, t->intervals, 4);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
        put(&r, (uint64_t)quanta(e, t->control[0][i]), 8);
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
    return (uint64_t)maths_ceil(((double)p->site + maths_clamp(part, 0, 1)) * REPLAY_END_PARTS / 2);
}

static void put_end(struct record *r, uint64_t value)
{
    for (; value >= 0x80; value >>= 7)
        put(r, (value & 0x7f) | 0x80, 1);
    put(r, value, 1);
}

/* Everything of a section from interval first and block end *end on that fits into one record; returns the intervals. */
static size_t write_knots(struct encoder *e, const struct ahead_path *path, const struct trail *t,
                          size_t first, const uint64_t *ends, size_t *end)
{
    const size_t left = t->intervals - first;
    size_t count = left < REPLAY_RECORD_INTERVALS ? left : REPLAY_RECORD_INTERVALS;
    struct record r;
    size_t last = *end;

    while (last + 1 < path->count && last - *end < REPLAY_RECORD_ENDS &&
           ends[last] < (first + count) * REPLAY_END_PARTS)
        last++;
    if (last - *end == REPLAY_RECORD_ENDS) /* the intervals behind them come in the next record */
        count = (size_t)(ends[last - 1] / REPLAY_END_PARTS) - first;
    begin_record(&r, REPLAY_KNOTS);
    put(&r, count, 1);
    for (size_t i = first; i < first + count; i++) {
        for (int axis = 0; axis < AXIS_LINEAR_COUNT; axis++)
            put(&r, (uint64_t)third_of(e, t->control + i, axis) & 0xffff, 2);
    }
    put(&r, last - *end, 1);
    for (; *end < last; (*end)++)
        put_end(&r, ends[*end] - (*end > 0 ? ends[*end - 1] : 0));
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
    uint64_t *ends = calloc(path->count, sizeof *ends);
    size_t first = 0;
    size_t end = 0;

    if (ends == NULL) {
        e->failed = true;
        return;
    }
    find_ends(path, t, ends);
    write_section(e, path, t);
    while (first < t->intervals && !e->failed)
        first += write_knots(e, path, t, first, ends, &end);
    e->header.blocks += (uint32_t)path->count;
    e->header.intervals += t->intervals;
    e->header.sections++;
    free(ends);
}

bool encoder_end(struct encoder *e, uint64_t program)
{
    uint8_t bytes[REPLAY_HEADER_BYTES];
    struct record r;

    begin_record(&r, REPLAY_END);
    write_record(e, &r);
    e->header.program = program;
    replay_header_write(&e->header, bytes);
    return !e->failed && fseek(e->stream, 0, SEEK_SET) == 0 &&
           fwrite(bytes, sizeof bytes, 1, e->stream) == 1 && fseek(e->stream, 0, SEEK_END) == 0;
}

#include "plan/record.h"

#include "base/assert.h"
#include "base/maths.h"
#include "plan/bytes.h"
#include "plan/record_parts.h"

#include <string.h>

/* Where the parts of the head are. */
#define AT_LINE   0 /* the lower half of it */
#define AT_NUMBER 2 /* likewise */
#define AT_KIND   4 /* and the governor above it */
#define AT_FLAGS  5
#define AT_MODES  6
#define AT_END    7 /* which coordinates of the end there are; else of the control point */
#define HEAD_SIZE 8

#define KIND_BITS 5U
#define KIND_MASK 0x1fU

#define FLAG_START          0x01U /* a start follows */
#define FLAG_REVOLUTION     0x02U /* the feed per revolution follows */
#define FLAG_PROBE_AWAY     0x04U
#define FLAG_PROBE_OPTIONAL 0x08U
#define FLAG_SPLINE         0x10U /* a piece of a smoothed curve */
#define FLAG_CHAINED        0x20U /* the last control point alone */
#define FLAG_MOVE_END       0x40U /* of a piece: it ends where the move does */
#define FLAG_TURNS          0x80U /* the turns of an arc follow: they are not 1 */

_Static_assert(sizeof(struct record_modes) == 48, "no padding that could differ");
_Static_assert(MOVE_END <= KIND_MASK && GOVERNOR_RAMP < 8, "both fit into a byte");

/* -- numbers -- */

bool takt_record_is_same(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

static bool is_same_point(const struct point *a, const struct point *b)
{
    return takt_record_is_same(a, b, sizeof(*a));
}

/* A point that is not known. */
static const struct point nowhere = {{MATHS_INFINITY, MATHS_INFINITY, MATHS_INFINITY,
                                      MATHS_INFINITY, MATHS_INFINITY, MATHS_INFINITY}};

_Static_assert(AXIS_COUNT == 6, "nowhere along each of them");

void takt_record_begin_chain(struct record_chain *chain)
{
    chain->end = nowhere;
    chain->control[0] = nowhere;
}

/* -- modes -- */

void takt_record_modes_of(const struct block *b, bool smooth, struct record_modes *modes)
{
    const struct move *move = &b->move;

    *modes = (struct record_modes){
        .piece_mm = smooth ? b->curve.length_mm : 0.0,
        .tool = move->tool,
        .line_high = (uint16_t)(move->line >> 16),
        .number_high = (uint16_t)(b->number >> 16),
        .overrides = (uint8_t)move->overrides,
        .path = (uint8_t)move->path,
        .plane = (uint8_t)move->plane,
        .correction_off = move->correction_off,
        .contour_side = move->contour_side,
    };
    memcpy(modes->work_mm, move->work_mm, sizeof(modes->work_mm));
    memcpy(modes->overhang_mm, move->overhang_mm, sizeof(modes->overhang_mm));
}

static void take_modes(const struct record_modes *modes, struct move *move)
{
    move->tool = modes->tool;
    move->overrides = modes->overrides;
    move->path = (enum move_path)modes->path;
    move->plane = (enum plane)modes->plane;
    move->correction_off = modes->correction_off;
    move->contour_side = modes->contour_side;
    memcpy(move->work_mm, modes->work_mm, sizeof(modes->work_mm));
    memcpy(move->overhang_mm, modes->overhang_mm, sizeof(modes->overhang_mm));
}

/* -- writing -- */
static unsigned flags_of(const struct block *b, bool spline, const struct record_chain *chain)
{
    const struct move *m = &b->move;
    const bool has_start =
        block_is_motion(b) && !spline && !is_same_point(&b->curve.start, &chain->end);

    return (has_start ? FLAG_START : 0U) | (m->feed_rev_mm != 0.0 ? FLAG_REVOLUTION : 0U) |
           (record_is_round(m) && m->turns != 1 ? FLAG_TURNS : 0U) |
           (m->probe_away ? FLAG_PROBE_AWAY : 0U) | (m->probe_optional ? FLAG_PROBE_OPTIONAL : 0U) |
           (spline ? FLAG_SPLINE : 0U);
}

/*
 * Control points of a piece of a smoothed curve. Which coordinates of a last one alone there are is
 * said in place of those of an end, unless there is one.
 */
static unsigned put_spline(uint8_t *bytes, uint8_t **to, const struct point control[4],
                           struct record_chain *chain, bool has_end)
{
    const bool chained = takt_record_is_same(chain->control, control, sizeof(chain->control));

    if (chained && !has_end) {
        bytes[AT_END] = (uint8_t)takt_record_put_coordinates(to, &control[3]);
    } else {
        for (unsigned i = chained ? 3 : 0; i < 4; i++) {
            takt_record_put_point(to, &control[i]);
        }
    }
    memcpy(chain->control, &control[1], sizeof(chain->control));
    return (chained ? FLAG_CHAINED : 0U) | (has_end ? FLAG_MOVE_END : 0U);
}

static void put_motion(uint8_t **to, const struct block *b, unsigned flags)
{
    if ((flags & FLAG_START) != 0) {
        takt_record_put_point(to, &b->curve.start);
    }
    if ((flags & FLAG_SPLINE) != 0) {
        return;
    }
    takt_record_put_shape(to, &b->move);
    if (b->curve.kind == CURVE_INVOLUTE) {
        takt_record_put_involute(to, b);
    }
}

/* Where the block ends; of a piece of a smoothed curve only when that is the end of its move. */
static const struct point *end_of(const struct block *b, bool spline,
                                  const struct record_chain *chain)
{
    if (!block_is_motion(b)) {
        return &chain->end;
    }
    return !spline || is_same_point(&b->curve.end, &b->move.end) ? &b->curve.end : &nowhere;
}

uint32_t takt_record_write(uint8_t bytes[RECORD_MAX], const struct block *b,
                           const struct point control[4], unsigned modes,
                           struct record_chain *chain)
{
    const bool spline = control != NULL;
    unsigned flags = flags_of(b, spline, chain);
    uint8_t *to = bytes;
    const struct point end = *end_of(b, spline, chain);
    const bool has_end = !is_same_point(&end, &nowhere);

    TAKT_ASSERT(modes < 256 && b->move.kind <= MOVE_END);
    bytes_put_half(&to, b->move.line);
    bytes_put_half(&to, b->number);
    to = bytes + HEAD_SIZE;
    bytes[AT_END] = has_end ? (uint8_t)takt_record_put_coordinates(&to, &end) : 0;
    if ((flags & FLAG_REVOLUTION) != 0) {
        bytes_put_double(&to, b->move.feed_rev_mm / b->scale);
    }
    if (block_is_motion(b)) {
        put_motion(&to, b, flags);
    } else {
        takt_record_put_event(&to, &b->move);
    }
    if (spline) {
        flags |= put_spline(bytes, &to, control, chain, has_end);
    }
    bytes[AT_KIND] = (uint8_t)b->move.kind;
    bytes[AT_FLAGS] = (uint8_t)flags;
    bytes[AT_MODES] = (uint8_t)modes;
    chain->control[0] = spline ? chain->control[0] : nowhere;
    chain->end = end;
    TAKT_ASSERT(to - bytes <= RECORD_MAX);
    return (uint32_t)(to - bytes);
}

/* -- reading -- */
enum move_kind takt_record_kind(const uint8_t *record)
{
    return (enum move_kind)(record[AT_KIND] & KIND_MASK);
}

unsigned takt_record_modes_number(const uint8_t *record)
{
    return record[AT_MODES];
}

void takt_record_set_governor(uint8_t *record, enum governor governor)
{
    record[AT_KIND] = (uint8_t)((record[AT_KIND] & KIND_MASK) | (unsigned)governor << KIND_BITS);
}

/* Has it a last control point alone, and no end? */
static bool has_control_alone(const uint8_t *record)
{
    return (record[AT_FLAGS] & (FLAG_CHAINED | FLAG_MOVE_END)) == FLAG_CHAINED;
}

/* Which coordinates of its end a record has. */
static unsigned end_axes(const uint8_t *record)
{
    return has_control_alone(record) ? 0 : record[AT_END];
}

static void read_end(const uint8_t *record, struct point *end)
{
    const uint8_t *from = record + HEAD_SIZE;

    takt_record_take_coordinates(&from, end_axes(record), end);
}

/* What follows the end. */
static const uint8_t *behind_end(const uint8_t *record)
{
    const uint8_t *from = record + HEAD_SIZE;

    for (unsigned axes = end_axes(record); axes != 0; axes &= axes - 1) {
        from += sizeof(double);
    }
    return from;
}

double takt_record_feed_rev(const uint8_t *record)
{
    const uint8_t *from = behind_end(record);

    return (record[AT_FLAGS] & FLAG_REVOLUTION) != 0 ? bytes_take_double(&from) : 0.0;
}

/* The head; returns what follows the feed per revolution. */
static const uint8_t *read_head(const uint8_t *record, const struct record_modes *modes,
                                struct move *move)
{
    const uint8_t *from = record + AT_LINE;
    const unsigned flags = record[AT_FLAGS];

    memset(move, 0, sizeof(*move));
    take_modes(modes, move);
    move->kind = takt_record_kind(record);
    move->line = (uint32_t)modes->line_high << 16 | bytes_take_half(&from);
    move->probe_away = (flags & FLAG_PROBE_AWAY) != 0;
    move->probe_optional = (flags & FLAG_PROBE_OPTIONAL) != 0;
    read_end(record, &move->end);
    from = behind_end(record);
    if ((flags & FLAG_REVOLUTION) != 0) {
        move->feed_rev_mm = bytes_take_double(&from);
    }
    return from;
}

void takt_record_read_move(const uint8_t *record, const struct record_modes *modes,
                           struct move *move)
{
    const uint8_t *from = read_head(record, modes, move);

    if (!move_is_motion(move)) {
        memset(&move->end, 0, sizeof(move->end));
        takt_record_take_event(&from, move);
    }
}

/*
 * Reads the last of count control points, as a record of a piece has them: one, or up to four.
 * Returns how many are still missing before those.
 */
static unsigned read_control(const uint8_t *record, struct point control[], unsigned count)
{
    const unsigned flags = record[AT_FLAGS];
    const bool chained = (flags & FLAG_CHAINED) != 0;
    const uint8_t *from = behind_end(record);

    if ((flags & FLAG_REVOLUTION) != 0) {
        (void)bytes_take_double(&from);
    }
    if (has_control_alone(record)) {
        takt_record_take_coordinates(&from, record[AT_END], &control[count - 1]);
        return count - 1;
    }
    for (unsigned i = chained ? 3 : 0; i < 4; i++) {
        takt_record_take_point(&from, &control[i + count > 4 ? i + count - 4 : 0]);
    }
    return chained ? count - 1 : 0;
}

/* What it has not itself is found in the records before, back to one that has all. */
void takt_record_control(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                         struct point control[4])
{
    unsigned missing = read_control(record, control, 4);

    for (unsigned i = 0; missing > 0 && before[i] != NULL; i++) {
        missing = read_control(before[i], control, missing);
    }
    TAKT_ASSERT(missing == 0);
}

static void read_spline(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                        struct block *b)
{
    struct point control[4];

    takt_record_control(record, before, control);
    takt_curve_set_spline(&b->curve, control, b->length_mm);
    if ((record[AT_FLAGS] & FLAG_MOVE_END) != 0) {
        b->curve.end = b->move.end;
    } else {
        b->move.end = nowhere; /* only the geometry knows where the motion ends */
    }
}

static void read_motion(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                        const uint8_t *from, struct block *b)
{
    const struct point end = b->move.end;
    struct point start = {{0.0}};

    if ((record[AT_FLAGS] & FLAG_START) != 0) {
        takt_record_take_point(&from, &start);
    } else if (before[0] != NULL) {
        read_end(before[0], &start);
    }
    takt_record_take_shape(&from, (record[AT_FLAGS] & FLAG_TURNS) != 0, &b->move);
    if (move_is_involute(&b->move)) {
        memset(&b->curve, 0, sizeof(b->curve));
        takt_record_take_involute(&from, b);
        b->curve.end = end;
    }
    b->curve.start = start;
}

const uint8_t *takt_record_begin(const uint8_t *record, const struct record_modes *modes,
                                 struct block *b)
{
    const uint8_t *number = record + AT_NUMBER;

    b->number = (uint32_t)modes->number_high << 16 | bytes_take_half(&number);
    b->length_mm = modes->piece_mm;
    b->cap = (enum governor)(record[AT_KIND] >> KIND_BITS);
    return read_head(record, modes, &b->move);
}

void takt_record_take(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                      const uint8_t *from, struct block *b)
{
    if (!move_is_motion(&b->move)) {
        memset(&b->move.end, 0, sizeof(b->move.end));
        memset(&b->curve, 0, sizeof(b->curve));
        takt_record_take_event(&from, &b->move);
    } else if ((record[AT_FLAGS] & FLAG_SPLINE) != 0) {
        read_spline(record, before, b);
    } else {
        read_motion(record, before, from, b);
    }
}

static bool is_arc(const uint8_t *record, const struct block *b)
{
    return (record[AT_FLAGS] & FLAG_SPLINE) == 0 && move_is_arc(&b->move);
}

bool takt_record_begin_curve(const uint8_t *record, struct block *b)
{
    const bool arc = is_arc(record, b);

    if (arc) {
        const struct point start = b->curve.start;

        takt_curve_begin_arc(&b->curve, &start, &b->move.end, b->move.plane, b->move.centre_mm);
    }
    return arc;
}

/* Motions of a spline's and involutes' shape have their curves already. */
void takt_record_finish(const uint8_t *record, struct block *b)
{
    if (is_arc(record, b)) {
        (void)takt_curve_end_arc(&b->curve, b->move.kind == MOVE_ARC_CW, b->move.turns);
    } else if ((record[AT_FLAGS] & FLAG_SPLINE) == 0 && move_is_motion(&b->move) &&
               !move_is_involute(&b->move)) {
        const struct point start = b->curve.start;

        (void)takt_move_curve(&b->move, &start, &b->curve);
    }
}

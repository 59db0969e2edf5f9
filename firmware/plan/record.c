#include "plan/record.h"

#include "base/maths.h"

#include <assert.h>
#include <string.h>

/* Where the parts of the head are. */
#define AT_LINE   0
#define AT_NUMBER 4
#define AT_KIND   8 /* and the governor above it */
#define AT_FLAGS  9
#define AT_MODES  10
#define AT_END    11 /* which coordinates of the end there are */
#define HEAD_SIZE 12

#define KIND_BITS 5U
#define KIND_MASK 0x1fU

#define FLAG_START          0x01U /* a start follows */
#define FLAG_REVOLUTION     0x02U /* the feed per revolution follows */
#define FLAG_PROBE_AWAY     0x04U
#define FLAG_PROBE_OPTIONAL 0x08U
#define FLAG_SPLINE         0x10U /* a piece of a smoothed curve */
#define FLAG_CHAINED        0x20U /* the last control point alone */
#define FLAG_MOVE_END       0x40U /* of a piece: it ends where the move does */

#define CURVE_OUTWARD    1U
#define CURVE_CUSP_START 2U
#define CURVE_CUSP_END   4U
#define CURVE_ROTARY     8U

/* Bits of an event's one. */
#define EVENT_MIST        0x01U
#define EVENT_FLOOD       0x02U
#define EVENT_TOOL_CHANGE 0x04U
#define EVENT_TOOL_LOADED 0x08U
#define EVENT_ANALOGUE    0x10U
#define EVENT_WITH_MOTION 0x20U
#define EVENT_OPTIONAL    0x40U

static_assert(sizeof(struct record_modes) == 64, "no padding that could differ");
static_assert(MOVE_END <= KIND_MASK && GOVERNOR_RAMP < 8, "both fit into a byte");

/* -- numbers -- */

static void put(uint8_t **to, const void *value, size_t size)
{
    memcpy(*to, value, size);
    *to += size;
}

static void take(const uint8_t **from, void *value, size_t size)
{
    memcpy(value, *from, size);
    *from += size;
}

static void put_double(uint8_t **to, double value)
{
    put(to, &value, sizeof(value));
}

static double take_double(const uint8_t **from)
{
    double value;

    take(from, &value, sizeof(value));
    return value;
}

static void put_word(uint8_t **to, uint32_t value)
{
    put(to, &value, sizeof(value));
}

static uint32_t take_word(const uint8_t **from)
{
    uint32_t value;

    take(from, &value, sizeof(value));
    return value;
}

static void put_byte(uint8_t **to, unsigned value)
{
    *(*to)++ = (uint8_t)value;
}

static unsigned take_byte(const uint8_t **from)
{
    return *(*from)++;
}

bool record_is_same(const void *a, const void *b, size_t size)
{
    const uint8_t *one = a;
    const uint8_t *other = b;

    for (size_t i = 0; i < size; i++) {
        if (one[i] != other[i]) {
            return false;
        }
    }
    return true;
}

static bool is_same_number(double a, double b)
{
    return record_is_same(&a, &b, sizeof(a));
}

static bool is_same_point(const struct point *a, const struct point *b)
{
    return record_is_same(a, b, sizeof(*a));
}

/* The coordinates that are not 0; returns which those are. */
static unsigned put_coordinates(uint8_t **to, const struct point *p)
{
    unsigned axes = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!is_same_number(p->at[i], 0.0)) {
            axes |= 1U << i;
            put_double(to, p->at[i]);
        }
    }
    return axes;
}

static void take_coordinates(const uint8_t **from, unsigned axes, struct point *p)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        p->at[i] = (axes >> i & 1U) != 0 ? take_double(from) : 0.0;
    }
}

static void put_point(uint8_t **to, const struct point *p)
{
    uint8_t *axes = (*to)++;

    *axes = (uint8_t)put_coordinates(to, p);
}

static void take_point(const uint8_t **from, struct point *p)
{
    const unsigned axes = take_byte(from);

    take_coordinates(from, axes, p);
}

/* -- modes -- */

void record_modes_of(const struct move *move, struct record_modes *modes)
{
    *modes = (struct record_modes){
        .tolerance_mm = move->tolerance_mm,
        .merge_mm = move->merge_mm,
        .cutter_radius_mm = move->cutter_radius_mm,
        .tool = move->tool,
        .overrides = (uint8_t)move->overrides,
        .path = (uint8_t)move->path,
        .plane = (uint8_t)move->plane,
        .cutter_side = (uint8_t)move->cutter_side,
        .cutter_orientation = move->cutter_orientation,
        .cutter_entry = move->cutter_entry,
        .correction_off = move->correction_off,
        .contour_side = move->contour_side,
    };
    memcpy(modes->work_mm, move->work_mm, sizeof(modes->work_mm));
    memcpy(modes->overhang_mm, move->overhang_mm, sizeof(modes->overhang_mm));
}

static void take_modes(const struct record_modes *modes, struct move *move)
{
    move->tolerance_mm = modes->tolerance_mm;
    move->merge_mm = modes->merge_mm;
    move->cutter_radius_mm = modes->cutter_radius_mm;
    move->tool = modes->tool;
    move->overrides = modes->overrides;
    move->path = (enum move_path)modes->path;
    move->plane = (enum plane)modes->plane;
    move->cutter_side = (enum cutter_side)modes->cutter_side;
    move->cutter_orientation = modes->cutter_orientation;
    move->cutter_entry = modes->cutter_entry != 0;
    move->correction_off = modes->correction_off;
    move->contour_side = modes->contour_side;
    memcpy(move->work_mm, modes->work_mm, sizeof(modes->work_mm));
    memcpy(move->overhang_mm, modes->overhang_mm, sizeof(modes->overhang_mm));
}

/* -- events -- */

static unsigned event_bits(const struct move *m)
{
    return (m->mist ? EVENT_MIST : 0U) | (m->flood ? EVENT_FLOOD : 0U) |
           (m->tool_change ? EVENT_TOOL_CHANGE : 0U) | (m->tool_loaded ? EVENT_TOOL_LOADED : 0U) |
           (m->analogue ? EVENT_ANALOGUE : 0U) | (m->with_motion ? EVENT_WITH_MOTION : 0U) |
           (m->optional ? EVENT_OPTIONAL : 0U);
}

/* The numbers of every kind lie where those of a spindle do (program/move.h), which has the most of them. */
static void put_event(uint8_t **to, const struct move *m)
{
    put_double(to, m->speed_rpm);
    put_double(to, m->surface_mm_s);
    put_double(to, m->surface_x_mm);
    put_word(to, m->channel);
    put_byte(to, (unsigned)m->direction);
    put_byte(to, (unsigned)m->orient_way);
    put_byte(to, (unsigned)m->input_wait);
    put_byte(to, event_bits(m));
}

static void take_event(const uint8_t **from, struct move *m)
{
    m->speed_rpm = take_double(from);
    m->surface_mm_s = take_double(from);
    m->surface_x_mm = take_double(from);
    m->channel = take_word(from);
    m->direction = (enum spindle_direction)take_byte(from);
    m->orient_way = (enum orient_way)take_byte(from);
    m->input_wait = (enum input_wait)take_byte(from);
    const unsigned bits = take_byte(from);

    m->mist = (bits & EVENT_MIST) != 0;
    m->flood = (bits & EVENT_FLOOD) != 0;
    m->tool_change = (bits & EVENT_TOOL_CHANGE) != 0;
    m->tool_loaded = (bits & EVENT_TOOL_LOADED) != 0;
    m->analogue = (bits & EVENT_ANALOGUE) != 0;
    m->with_motion = (bits & EVENT_WITH_MOTION) != 0;
    m->optional = (bits & EVENT_OPTIONAL) != 0;
}

/* -- what kinds of motion have beside their ends -- */

static void put_shape(uint8_t **to, const struct move *m)
{
    if (move_is_arc(m) || move_is_involute(m)) {
        put_double(to, m->centre_mm[0]);
        put_double(to, m->centre_mm[1]);
        put_word(to, m->turns);
    }
    if (move_is_involute(m)) {
        put_double(to, m->base_radius_mm);
    }
    if (m->kind == MOVE_TAP_OUT) {
        put_double(to, m->speed_ratio);
    }
}

static void take_shape(const uint8_t **from, struct move *m)
{
    if (move_is_arc(m) || move_is_involute(m)) {
        m->centre_mm[0] = take_double(from);
        m->centre_mm[1] = take_double(from);
        m->turns = take_word(from);
    }
    if (move_is_involute(m)) {
        m->base_radius_mm = take_double(from);
    }
    if (m->kind == MOVE_TAP_OUT) {
        m->speed_ratio = take_double(from);
    }
}

/* A piece of an involute, which is costly to cut again. */
static void put_involute(uint8_t **to, const struct block *b)
{
    const struct curve_involute *v = &b->curve.involute;
    const unsigned bits =
        (v->outward ? CURVE_OUTWARD : 0U) | (v->cusp_start ? CURVE_CUSP_START : 0U) |
        (v->cusp_end ? CURVE_CUSP_END : 0U) | (b->curve.rotary ? CURVE_ROTARY : 0U);

    put_point(to, &b->move.end);
    put_point(to, &b->curve.slope);
    put_double(to, b->curve.length_mm);
    put_byte(to, bits);
    put_byte(to, v->first);
    put_byte(to, v->second);
    put_double(to, v->centre_mm[0]);
    put_double(to, v->centre_mm[1]);
    put_double(to, v->radius_mm);
    put_double(to, v->hand);
    put_double(to, v->heading_rad);
    put_double(to, v->square_start_rad2);
    put_double(to, v->square_rate_rad2_mm);
    put_double(to, v->plane_ratio);
}

static void take_involute(const uint8_t **from, struct block *b)
{
    struct curve_involute *v = &b->curve.involute;

    take_point(from, &b->move.end);
    take_point(from, &b->curve.slope);
    b->curve.kind = CURVE_INVOLUTE;
    b->curve.length_mm = take_double(from);
    const unsigned bits = take_byte(from);

    b->curve.rotary = (bits & CURVE_ROTARY) != 0;
    v->outward = (bits & CURVE_OUTWARD) != 0;
    v->cusp_start = (bits & CURVE_CUSP_START) != 0;
    v->cusp_end = (bits & CURVE_CUSP_END) != 0;
    v->first = (unsigned char)take_byte(from);
    v->second = (unsigned char)take_byte(from);
    v->centre_mm[0] = take_double(from);
    v->centre_mm[1] = take_double(from);
    v->radius_mm = take_double(from);
    v->hand = take_double(from);
    v->heading_rad = take_double(from);
    v->square_start_rad2 = take_double(from);
    v->square_rate_rad2_mm = take_double(from);
    v->plane_ratio = take_double(from);
}

/* -- writing -- */

static unsigned flags_of(const struct block *b, bool spline, const struct record_chain *chain)
{
    const struct move *m = &b->move;
    const bool has_start = block_is_motion(b) && !spline &&
                           !(chain->has_end && is_same_point(&b->curve.start, &chain->end));

    return (has_start ? FLAG_START : 0U) | (m->feed_rev_mm != 0.0 ? FLAG_REVOLUTION : 0U) |
           (m->probe_away ? FLAG_PROBE_AWAY : 0U) | (m->probe_optional ? FLAG_PROBE_OPTIONAL : 0U) |
           (spline ? FLAG_SPLINE : 0U);
}

/* Of a piece of a smoothed curve: its control points, and its length last. */
static unsigned put_spline(uint8_t **to, const struct block *b, const struct point control[4],
                           struct record_chain *chain)
{
    const bool chained =
        chain->has_control && record_is_same(chain->control, control, sizeof(chain->control));

    for (unsigned i = chained ? 3 : 0; i < 4; i++) {
        put_point(to, &control[i]);
    }
    put_double(to, b->curve.length_mm);
    memcpy(chain->control, &control[1], sizeof(chain->control));
    return chained ? FLAG_CHAINED : 0U;
}

static void put_motion(uint8_t **to, const struct block *b, unsigned flags)
{
    if ((flags & FLAG_START) != 0) {
        put_point(to, &b->curve.start);
    }
    if ((flags & FLAG_SPLINE) != 0) {
        return;
    }
    put_shape(to, &b->move);
    if (b->curve.kind == CURVE_INVOLUTE) {
        put_involute(to, b);
    }
}

/* Where the block ends; of a piece of a smoothed curve only when that is the end of its move. */
static bool end_of(const struct block *b, bool spline, const struct record_chain *chain,
                   struct point *end)
{
    *end = block_is_motion(b) ? b->curve.end : chain->end;
    if (!block_is_motion(b)) {
        return chain->has_end;
    }
    return !spline || is_same_point(&b->curve.end, &b->move.end);
}

uint32_t record_write(uint8_t bytes[RECORD_MAX], const struct block *b,
                      const struct point control[4], unsigned modes, struct record_chain *chain)
{
    const bool spline = control != NULL;
    unsigned flags = flags_of(b, spline, chain);
    uint8_t *to = bytes;
    struct point end;
    const bool has_end = end_of(b, spline, chain, &end);

    put_word(&to, b->move.line);
    put_word(&to, b->number);
    to = bytes + HEAD_SIZE;
    bytes[AT_END] = has_end ? (uint8_t)put_coordinates(&to, &end) : 0;
    if ((flags & FLAG_REVOLUTION) != 0) {
        put_double(&to, b->move.feed_rev_mm);
    }
    if (block_is_motion(b)) {
        put_motion(&to, b, flags);
    } else {
        put_event(&to, &b->move);
    }
    if (spline) {
        flags |= put_spline(&to, b, control, chain) | (has_end ? FLAG_MOVE_END : 0U);
    }
    bytes[AT_KIND] = (uint8_t)b->move.kind;
    bytes[AT_FLAGS] = (uint8_t)flags;
    bytes[AT_MODES] = (uint8_t)modes;
    chain->has_control = spline;
    chain->has_end = has_end;
    chain->end = end;
    return (uint32_t)(to - bytes);
}

/* -- reading -- */

enum move_kind record_kind(const uint8_t *record)
{
    return (enum move_kind)(record[AT_KIND] & KIND_MASK);
}

unsigned record_modes_number(const uint8_t *record)
{
    return record[AT_MODES];
}

void record_set_governor(uint8_t *record, enum governor governor)
{
    record[AT_KIND] = (uint8_t)((record[AT_KIND] & KIND_MASK) | (unsigned)governor << KIND_BITS);
}

/* Where the block ends; returns what follows. */
static const uint8_t *read_end(const uint8_t *record, struct point *end)
{
    const uint8_t *from = record + HEAD_SIZE;

    take_coordinates(&from, record[AT_END], end);
    return from;
}

double record_feed_rev(const uint8_t *record)
{
    struct point end;
    const uint8_t *from = read_end(record, &end);

    return (record[AT_FLAGS] & FLAG_REVOLUTION) != 0 ? take_double(&from) : 0.0;
}

/* The head; returns what follows the feed per revolution. */
static const uint8_t *read_head(const uint8_t *record, const struct record_modes *modes,
                                struct move *move)
{
    const uint8_t *from = record + AT_LINE;
    const unsigned flags = record[AT_FLAGS];

    memset(move, 0, sizeof(*move));
    take_modes(modes, move);
    move->kind = record_kind(record);
    move->line = take_word(&from);
    move->probe_away = (flags & FLAG_PROBE_AWAY) != 0;
    move->probe_optional = (flags & FLAG_PROBE_OPTIONAL) != 0;
    from = read_end(record, &move->end);
    if ((flags & FLAG_REVOLUTION) != 0) {
        move->feed_rev_mm = take_double(&from);
    }
    return from;
}

/* Of a piece within a motion only the geometry knows where the motion ends. */
static void forget_end(struct move *move)
{
    for (int i = 0; i < AXIS_COUNT; i++) {
        move->end.at[i] = MATHS_INFINITY;
    }
}

void record_read_move(const uint8_t *record, const struct record_modes *modes, struct move *move)
{
    const uint8_t *from = read_head(record, modes, move);

    if (!move_is_motion(move)) {
        memset(&move->end, 0, sizeof(move->end));
        take_event(&from, move);
    }
}

/* The control points that a record of a piece has: the last one, or all four. Returns what follows. */
static const uint8_t *read_control(const uint8_t *record, struct point control[4])
{
    const unsigned flags = record[AT_FLAGS];
    struct point end;
    const uint8_t *from = read_end(record, &end);

    if ((flags & FLAG_REVOLUTION) != 0) {
        (void)take_double(&from);
    }
    for (unsigned i = (flags & FLAG_CHAINED) != 0 ? 3 : 0; i < 4; i++) {
        take_point(&from, &control[i]);
    }
    return from;
}

/* The others from the records before, back to one that has all. */
static void gather_control(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                           struct point control[4])
{
    unsigned missing = (record[AT_FLAGS] & FLAG_CHAINED) != 0 ? 3 : 0;

    for (unsigned i = 0; missing > 0 && before[i] != NULL; i++) {
        struct point its[4];

        (void)read_control(before[i], its);
        const bool has_all = (before[i][AT_FLAGS] & FLAG_CHAINED) == 0;

        for (unsigned k = 4; missing > 0 && k-- > (has_all ? 0U : 3U);) {
            control[--missing] = its[k];
        }
    }
}

static void read_spline(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                        struct block *b)
{
    struct point control[4];
    const uint8_t *from = read_control(record, control);

    gather_control(record, before, control);
    curve_set_spline(&b->curve, control, take_double(&from));
    if ((record[AT_FLAGS] & FLAG_MOVE_END) != 0) {
        b->curve.end = b->move.end;
    } else {
        forget_end(&b->move);
    }
}

static void read_motion(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                        const uint8_t *from, struct block *b)
{
    const struct point end = b->move.end;
    struct point start = {{0.0}};

    if ((record[AT_FLAGS] & FLAG_START) != 0) {
        take_point(&from, &start);
    } else if (before[0] != NULL) {
        (void)read_end(before[0], &start);
    }
    take_shape(&from, &b->move);
    if (move_is_involute(&b->move)) {
        memset(&b->curve, 0, sizeof(b->curve));
        take_involute(&from, b);
        b->curve.start = start;
        b->curve.end = end;
    } else {
        (void)move_curve(&b->move, &start, &b->curve);
    }
}

const uint8_t *record_begin(const uint8_t *record, const struct record_modes *modes,
                            struct block *b)
{
    const uint8_t *number = record + AT_NUMBER;

    b->number = take_word(&number);
    b->cap = (enum governor)(record[AT_KIND] >> KIND_BITS);
    return read_head(record, modes, &b->move);
}

void record_finish(const uint8_t *record, const uint8_t *const before[RECORD_BEFORE],
                   const uint8_t *from, struct block *b)
{
    if (!move_is_motion(&b->move)) {
        memset(&b->move.end, 0, sizeof(b->move.end));
        memset(&b->curve, 0, sizeof(b->curve));
        take_event(&from, &b->move);
    } else if ((record[AT_FLAGS] & FLAG_SPLINE) != 0) {
        read_spline(record, before, b);
    } else {
        read_motion(record, before, from, b);
    }
    b->length_mm = b->curve.length_mm;
    b->rotary = curve_is_rotary(&b->curve);
}

/*
 * The parts of a record, each written and read side by side: points, events, what kinds of motion
 * have beside their ends, and pieces of involutes.
 */
#include "plan/record_parts.h"

#include "plan/bytes.h"
#include "plan/record.h"

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

static bool is_same_number(double a, double b)
{
    return takt_record_is_same(&a, &b, sizeof(a));
}

unsigned takt_record_put_coordinates(uint8_t **to, const struct point *p)
{
    unsigned axes = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (!is_same_number(p->at[i], 0.0)) {
            axes |= 1U << i;
            bytes_put_double(to, p->at[i]);
        }
    }
    return axes;
}

void takt_record_take_coordinates(const uint8_t **from, unsigned axes, struct point *p)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        p->at[i] = (axes >> i & 1U) != 0 ? bytes_take_double(from) : 0.0;
    }
}

void takt_record_put_point(uint8_t **to, const struct point *p)
{
    uint8_t *axes = (*to)++;

    *axes = (uint8_t)takt_record_put_coordinates(to, p);
}

void takt_record_take_point(const uint8_t **from, struct point *p)
{
    const unsigned axes = bytes_take_byte(from);

    takt_record_take_coordinates(from, axes, p);
}

/* -- events -- */

static unsigned event_bits(const struct move *m)
{
    return (m->mist ? EVENT_MIST : 0U) | (m->flood ? EVENT_FLOOD : 0U) |
           (m->tool_change ? EVENT_TOOL_CHANGE : 0U) | (m->tool_loaded ? EVENT_TOOL_LOADED : 0U) |
           (m->analogue ? EVENT_ANALOGUE : 0U) | (m->with_motion ? EVENT_WITH_MOTION : 0U) |
           (m->optional ? EVENT_OPTIONAL : 0U);
}

/*
 * The numbers of every kind lie where those of a spindle do (program/move.h), which has the most of
 * them.
 */
void takt_record_put_event(uint8_t **to, const struct move *m)
{
    bytes_put_double(to, m->speed_rpm);
    bytes_put_double(to, m->surface_mm_s);
    bytes_put_double(to, m->surface_x_mm);
    bytes_put_word(to, m->channel);
    bytes_put_byte(to, (unsigned)m->direction);
    bytes_put_byte(to, (unsigned)m->orient_way);
    bytes_put_byte(to, (unsigned)m->input_wait);
    bytes_put_byte(to, event_bits(m));
}

void takt_record_take_event(const uint8_t **from, struct move *m)
{
    m->speed_rpm = bytes_take_double(from);
    m->surface_mm_s = bytes_take_double(from);
    m->surface_x_mm = bytes_take_double(from);
    m->channel = bytes_take_word(from);
    m->direction = (enum spindle_direction)bytes_take_byte(from);
    m->orient_way = (enum orient_way)bytes_take_byte(from);
    m->input_wait = (enum input_wait)bytes_take_byte(from);
    const unsigned bits = bytes_take_byte(from);

    m->mist = (bits & EVENT_MIST) != 0;
    m->flood = (bits & EVENT_FLOOD) != 0;
    m->tool_change = (bits & EVENT_TOOL_CHANGE) != 0;
    m->tool_loaded = (bits & EVENT_TOOL_LOADED) != 0;
    m->analogue = (bits & EVENT_ANALOGUE) != 0;
    m->with_motion = (bits & EVENT_WITH_MOTION) != 0;
    m->optional = (bits & EVENT_OPTIONAL) != 0;
}

/* -- what kinds of motion have beside their ends -- */

static void put_course(uint8_t **to, const struct move *m)
{
    for (unsigned i = 0; i < 2; i++) {
        bytes_put_double(to, m->heading_rad[i]);
        bytes_put_double(to, m->curvature_1_mm[i]);
    }
    bytes_put_double(to, m->spline_mm);
}

static void take_course(const uint8_t **from, struct move *m)
{
    for (unsigned i = 0; i < 2; i++) {
        m->heading_rad[i] = bytes_take_double(from);
        m->curvature_1_mm[i] = bytes_take_double(from);
    }
    m->spline_mm = bytes_take_double(from);
}

void takt_record_put_shape(uint8_t **to, const struct move *m)
{
    if (record_is_round(m)) {
        bytes_put_double(to, m->centre_mm[0]);
        bytes_put_double(to, m->centre_mm[1]);
        if (m->turns != 1) {
            bytes_put_word(to, m->turns);
        }
    }
    if (move_is_involute(m)) {
        bytes_put_double(to, m->base_radius_mm);
    }
    if (m->kind == MOVE_SPLINE) {
        put_course(to, m);
    }
    if (m->kind == MOVE_TAP_OUT) {
        bytes_put_double(to, m->speed_ratio);
    }
}

void takt_record_take_shape(const uint8_t **from, bool has_turns, struct move *m)
{
    if (record_is_round(m)) {
        m->centre_mm[0] = bytes_take_double(from);
        m->centre_mm[1] = bytes_take_double(from);
        m->turns = has_turns ? bytes_take_word(from) : 1;
    }
    if (move_is_involute(m)) {
        m->base_radius_mm = bytes_take_double(from);
    }
    if (m->kind == MOVE_SPLINE) {
        take_course(from, m);
    }
    if (m->kind == MOVE_TAP_OUT) {
        m->speed_ratio = bytes_take_double(from);
    }
}

/* A piece of an involute, which is costly to cut again. */
void takt_record_put_involute(uint8_t **to, const struct block *b)
{
    const struct curve_involute *v = &b->curve.involute;
    const unsigned bits =
        (v->outward ? CURVE_OUTWARD : 0U) | (v->cusp_start ? CURVE_CUSP_START : 0U) |
        (v->cusp_end ? CURVE_CUSP_END : 0U) | (b->curve.rotary ? CURVE_ROTARY : 0U);

    takt_record_put_point(to, &b->move.end);
    takt_record_put_point(to, &b->curve.slope);
    bytes_put_double(to, b->curve.length_mm);
    bytes_put_byte(to, bits);
    bytes_put_byte(to, v->first);
    bytes_put_byte(to, v->second);
    bytes_put_double(to, v->centre_mm[0]);
    bytes_put_double(to, v->centre_mm[1]);
    bytes_put_double(to, v->radius_mm);
    bytes_put_double(to, v->hand);
    bytes_put_double(to, v->heading_rad);
    bytes_put_double(to, v->square_start_rad2);
    bytes_put_double(to, v->square_rate_rad2_mm);
    bytes_put_double(to, v->plane_ratio);
}

void takt_record_take_involute(const uint8_t **from, struct block *b)
{
    struct curve_involute *v = &b->curve.involute;

    takt_record_take_point(from, &b->move.end);
    takt_record_take_point(from, &b->curve.slope);
    b->curve.kind = CURVE_INVOLUTE;
    b->curve.length_mm = bytes_take_double(from);
    const unsigned bits = bytes_take_byte(from);

    b->curve.rotary = (bits & CURVE_ROTARY) != 0;
    v->outward = (bits & CURVE_OUTWARD) != 0;
    v->cusp_start = (bits & CURVE_CUSP_START) != 0;
    v->cusp_end = (bits & CURVE_CUSP_END) != 0;
    v->first = (unsigned char)bytes_take_byte(from);
    v->second = (unsigned char)bytes_take_byte(from);
    v->centre_mm[0] = bytes_take_double(from);
    v->centre_mm[1] = bytes_take_double(from);
    v->radius_mm = bytes_take_double(from);
    v->hand = bytes_take_double(from);
    v->heading_rad = bytes_take_double(from);
    v->square_start_rad2 = bytes_take_double(from);
    v->square_rate_rad2_mm = bytes_take_double(from);
    v->plane_ratio = bytes_take_double(from);
}

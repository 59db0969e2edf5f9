#include "session/canon.h"

#include "base/decimal.h"
#include "base/maths.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define PLACES             6
#define DEGREES_PER_RAD    (180.0 / MATHS_PI)
#define SECONDS_PER_MINUTE 60.0
#define MM_PER_M           1000.0

struct line {
    char *text;
    size_t length;
};

static void add_text(struct line *l, const char *text)
{
    const size_t length = strlen(text);

    assert(l->length + length < CANON_TEXT_MAX);
    memcpy(l->text + l->length, text, length + 1);
    l->length += length;
}

static void add_word(struct line *l, char letter, double value)
{
    const char word[] = {' ', letter, '\0'};
    char number[DECIMAL_TEXT_MAX + 1];

    number[takt_decimal_write(number, value, PLACES)] = '\0';
    add_text(l, word);
    add_text(l, number);
}

static void add_whole(struct line *l, const char *before, uint32_t value)
{
    char number[16];

    (void)snprintf(number, sizeof(number), "%" PRIu32, value);
    add_text(l, before);
    add_text(l, number);
}

static void add_axes(struct line *l, unsigned axes, const struct point *point)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if ((axes & (1U << i)) != 0) {
            const double scale = i < AXIS_LINEAR_COUNT ? 1.0 : DEGREES_PER_RAD;

            add_word(l, AXIS_LETTERS[i], point->at[i] * scale);
        }
    }
}

static const char *const planes[] = {" G17", " G18", " G19"};

static void add_arc(struct line *l, const struct move *move, const struct point *at)
{
    struct point centre = *at;
    enum axis first;
    enum axis second;

    takt_plane_axes(move->plane, &first, &second);
    centre.at[first] = move->centre_mm[0];
    centre.at[second] = move->centre_mm[1];
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        add_word(l, (char)('I' + (char)i), centre.at[i]);
    }
    if (move_is_arc(move)) {
        add_whole(l, " P", move->turns);
    } else {
        add_word(l, 'R', move->base_radius_mm);
    }
    add_text(l, planes[move->plane]);
}

static void add_course(struct line *l, const struct move *move)
{
    add_word(l, 'I', move->heading_rad[0] * DEGREES_PER_RAD);
    add_word(l, 'J', move->heading_rad[1] * DEGREES_PER_RAD);
    add_word(l, 'P', move->curvature_1_mm[0]);
    add_word(l, 'Q', move->curvature_1_mm[1]);
    add_word(l, 'R', move->spline_mm);
    add_text(l, planes[move->plane]);
}

bool canon_is_rotary(const struct move *move, const struct point *at)
{
    struct curve curve;

    return takt_move_curve(move, at, &curve) && takt_curve_is_rotary(&curve);
}

static void add_feed(struct line *l, const struct move *move, const struct point *at)
{
    const double scale = canon_is_rotary(move, at) ? DEGREES_PER_RAD : 1.0;

    if (move->feed_rev_mm != 0.0) {
        add_word(l, 'F', move->feed_rev_mm * scale);
        add_text(l, "rev");
        return;
    }
    add_word(l, 'F', move->feed_mm_s * SECONDS_PER_MINUTE * scale);
}

static void add_spindle(struct line *l, const struct move *move)
{
    if (move->direction == SPINDLE_OFF) {
        add_text(l, "spindle_off");
        return;
    }
    add_text(l, move->direction == SPINDLE_CW ? "spindle_cw" : "spindle_ccw");
    if (move->surface_mm_s != 0.0) {
        add_word(l, 'V', move->surface_mm_s * SECONDS_PER_MINUTE / MM_PER_M);
    }
    if (move->surface_mm_s == 0.0 || move->speed_rpm != 0.0) {
        add_word(l, 'S', move->speed_rpm);
    }
}

static void add_orient(struct line *l, const struct move *move)
{
    add_text(l, "spindle_orient");
    add_word(l, 'R', move->orient_rad * DEGREES_PER_RAD);
    add_whole(l, " P", (uint32_t)move->orient_way);
    if (move->timeout_s != 0.0) {
        add_word(l, 'Q', move->timeout_s);
    }
}

static void add_tool(struct line *l, const struct move *move)
{
    const char *change = move->tool_loaded ? "tool_loaded" : "tool_change";

    add_text(l, move->tool_change || move->tool_loaded ? change : "tool_prepare");
    add_whole(l, " T", move->tool);
}

static void add_output(struct line *l, const struct move *move)
{
    add_text(l, move->with_motion ? "output_with_motion" : "output");
    add_whole(l, move->analogue ? " E" : " P", move->channel);
    add_word(l, 'Q', move->output);
}

static void add_input(struct line *l, const struct move *move)
{
    add_text(l, "input");
    add_whole(l, move->analogue ? " E" : " P", move->channel);
    add_whole(l, " L", (uint32_t)move->input_wait);
    if (move->timeout_s != 0.0) {
        add_word(l, 'Q', move->timeout_s);
    }
}

static const char *coolant_name(const struct move *move)
{
    if (move->mist) {
        return move->flood ? "coolant_mist_flood_on" : "coolant_mist_on";
    }
    return move->flood ? "coolant_flood_on" : "coolant_off";
}

static void add_wear(struct line *l, const struct move *move)
{
    add_text(l, "tool_wear");
    add_whole(l, " T", move->tool);
    add_word(l, 'I', move->wear_length_mm);
    add_word(l, 'J', move->wear_time_s);
}

static void add_setup(struct line *l, const struct move *move)
{
    const bool turn = move->channel >= AXIS_LINEAR_COUNT;

    add_text(l, "setup");
    add_word(l, "XYZIJKR"[move->channel], move -> setup *(turn ? DEGREES_PER_RAD : 1.0));
}

static void add_event(struct line *l, const struct move *move)
{
    if (move->kind == MOVE_DWELL) {
        add_text(l, "dwell");
        add_word(l, 'P', move->dwell_s);
    } else if (move->kind == MOVE_SPINDLE) {
        add_spindle(l, move);
    } else if (move->kind == MOVE_COOLANT) {
        add_text(l, coolant_name(move));
    } else if (move->kind == MOVE_TOOL) {
        add_tool(l, move);
    } else if (move->kind == MOVE_ORIENT) {
        add_orient(l, move);
    } else if (move->kind == MOVE_OUTPUT) {
        add_output(l, move);
    } else if (move->kind == MOVE_INPUT) {
        add_input(l, move);
    } else if (move->kind == MOVE_WEAR) {
        add_wear(l, move);
    } else if (move->kind == MOVE_SETUP) {
        add_setup(l, move);
    } else if (move->kind == MOVE_STOP) {
        add_text(l, move->optional ? "optional_stop" : "stop");
    } else {
        add_text(l, "end");
    }
}

static void add_motion(struct line *l, const struct move *move, unsigned axes,
                       const struct point *at)
{
    static const char *const kinds[] = {"rapid",       "feed",         "arc_cw", "arc_ccw",
                                        "involute_cw", "involute_ccw", "spline", "thread",
                                        "tap",         "tap_out",      "probe"};

    add_text(l, kinds[move->kind]);
    add_axes(l, axes, &move->end);
    if (move_is_arc(move) || move_is_involute(move)) {
        add_arc(l, move, at);
    }
    if (move->kind == MOVE_SPLINE) {
        add_course(l, move);
    }
    if (move->kind != MOVE_RAPID) {
        add_feed(l, move, at);
    }
    if (move->kind == MOVE_TAP_OUT) {
        add_word(l, 'S', move->speed_ratio);
    }
    if (move->kind == MOVE_PROBE) {
        add_whole(l, " G38.", 2U + (move->probe_optional ? 1U : 0U) + (move->probe_away ? 2U : 0U));
    }
}

size_t canon_format(const struct move *move, unsigned axes, const struct point *at, char *text)
{
    struct line l = {.length = 0};

    l.text = text;
    add_whole(&l, "", move->line);
    add_text(&l, " ");
    if (move_is_motion(move)) {
        add_motion(&l, move, axes, at);
    } else {
        add_event(&l, move);
    }
    return l.length;
}

#include "session/convert.h"

#include "base/decimal.h"
#include "base/maths.h"
#include "cli/axis_unit.h"
#include "session/canon.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#define PLACES      6
#define PLACES_INCH 8
#define MM_PER_INCH 25.4
/*
 * An arc's end may be so far off its circle (firmware/program/circular.c), and its centre must be
 * so far from its start.
 */
#define OFF_CIRCLE_MM      0.028
#define CENTRE_MIN_MM      0.0013
#define SECONDS_PER_MINUTE 60.0
#define MM_PER_M           1000.0
#define DEGREES_PER_RAD    (180.0 / MATHS_PI)

/* What a dialect has words for. */
enum ability {
    CAN_TOOL = 1,        /* T, M6 */
    CAN_REVOLUTION = 2,  /* G95 */
    CAN_PROBE = 4,       /* G38.2 to G38.5 */
    CAN_LINUXCNC = 8,    /* G33, G61, G64, G96, M19, M61 to M68, P of arcs, involutes */
    HAS_NUMBER = 16,     /* % and O0001 */
    HAS_CENTRE_MODE = 32 /* G91.1 */
};

static const unsigned abilities[DIALECT_COUNT] = {
    [DIALECT_LINUXCNC] = CAN_TOOL | CAN_REVOLUTION | CAN_PROBE | CAN_LINUXCNC | HAS_CENTRE_MODE,
    [DIALECT_GRBL] = CAN_PROBE | HAS_CENTRE_MODE,
    [DIALECT_FANUC] = CAN_TOOL | CAN_REVOLUTION | HAS_NUMBER,
    [DIALECT_HAAS] = CAN_TOOL | CAN_REVOLUTION | HAS_NUMBER,
    [DIALECT_MACH3] = CAN_TOOL | CAN_REVOLUTION | HAS_CENTRE_MODE,
    [DIALECT_MARLIN] = 0,
    [DIALECT_SIEMENS] = 0,
};

static bool can(const struct convert *c, unsigned what)
{
    return (abilities[c->dialect] & what) != 0;
}

/* ---- words ---- */

__attribute__((format(printf, 2, 3))) static void put(const struct convert *c, const char *format,
                                                      ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)vfprintf(c->out, format, arguments);
    va_end(arguments);
}

/* From here on takt_decimal_write puts an exponent, which controllers do not read. */
#define EXPONENT_MIN 1e9

/* No control goes so far, or so fast; what is beyond has no room in CONVERT_NUMBER_MAX. */
#define NUMBER_MOST 1e30

/* Fixed places, as every controller reads them; at least one behind the point. */
static void number_of(char text[CONVERT_NUMBER_MAX], double value, unsigned places)
{
    size_t length = fabs(value) < EXPONENT_MIN
                        ? takt_decimal_write(text, value, places)
                        : (size_t)snprintf(text, CONVERT_NUMBER_MAX, "%.1f",
                                           fmax(-NUMBER_MOST, fmin(value, NUMBER_MOST)));

    while (length > 2 && text[length - 1] == '0' && text[length - 2] != '.')
        length--;
    text[length] = '\0';
}

static void number(char text[CONVERT_NUMBER_MAX], double value)
{
    number_of(text, value, PLACES);
}

static void put_word(const struct convert *c, char letter, double value)
{
    char text[CONVERT_NUMBER_MAX];

    number_of(text, value, c->unit_mm == 1.0 ? PLACES : PLACES_INCH);
    put(c, " %c%s", letter, text);
}

/* The axes that go somewhere, and those of always even if they do not. True: there was one. */
static bool put_axes(struct convert *c, const struct point *end, unsigned always)
{
    bool some = false;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        char text[CONVERT_NUMBER_MAX];

        if ((c->axes & (1U << i)) == 0)
            continue;
        number_of(text,
                  end->at[i] * axis_unit_ratio(i) / (axis_unit_is_rotary(i) ? 1.0 : c->unit_mm),
                  c->unit_mm == 1.0 ? PLACES : PLACES_INCH);
        if (strcmp(text, c->axis[i]) == 0 && (always & (1U << i)) == 0)
            continue;
        (void)memcpy(c->axis[i], text, sizeof text);
        put(c, " %c%s", AXIS_LETTERS[i], text);
        some = true;
    }
    return some;
}

static bool goes_somewhere(const struct convert *c, const struct point *end)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        char text[CONVERT_NUMBER_MAX];

        number(text, end->at[i] * axis_unit_ratio(i));
        if ((c->axes & (1U << i)) != 0 && strcmp(text, c->axis[i]) != 0)
            return true;
    }
    return false;
}

/* ---- modes ---- */

static void put_plane(struct convert *c, enum plane plane)
{
    if (plane != c->plane)
        put(c, "G%u\n", 17U + (unsigned)plane);
    c->plane = plane;
}

static void put_path(struct convert *c, const struct move *m)
{
    const bool same =
        m->path == c->path && m->tolerance_mm == c->tolerance_mm && m->merge_mm == c->merge_mm;

    c->path = m->path;
    c->tolerance_mm = m->tolerance_mm;
    c->merge_mm = m->merge_mm;
    if (same || !can(c, CAN_LINUXCNC))
        return;
    if (m->path == PATH_BLEND) {
        put(c, "G64");
        put_word(c, 'P', m->tolerance_mm);
        put_word(c, 'Q', m->merge_mm);
        put(c, "\n");
    } else {
        put(c, m->path == PATH_EXACT ? "G61\n" : "G61.1\n");
    }
}

static void put_feed_mode(struct convert *c, bool per_revolution)
{
    if (per_revolution == c->per_revolution)
        return;
    put(c, per_revolution ? "G95\n" : "G94\n");
    c->per_revolution = per_revolution;
    c->feed[0] = '\0';
}

static void put_feed(struct convert *c, const struct move *m)
{
    const double scale = canon_is_rotary(m, &c->at) ? DEGREES_PER_RAD : 1.0;
    const double feed = c->per_revolution ? m->feed_rev_mm : m->feed_mm_s * SECONDS_PER_MINUTE;
    char text[CONVERT_NUMBER_MAX];

    number(text, feed * scale);
    if (strcmp(text, c->feed) != 0)
        put(c, " F%s", text);
    (void)memcpy(c->feed, text, sizeof text);
}

/* ---- motions ---- */

static const char *straight(struct convert *c, const struct move *m, const char *code)
{
    if (m->kind != MOVE_RAPID && m->kind != MOVE_PROBE)
        put_feed_mode(c, m->feed_rev_mm != 0.0);
    if (!goes_somewhere(c, &m->end))
        return NULL;
    put(c, "%s", code);
    (void)put_axes(c, &m->end, 0);
    if (m->kind != MOVE_RAPID)
        put_feed(c, m);
    put(c, "\n");
    return NULL;
}

/* How far the end is off the circle of the start. */
static double off_circle(const struct convert *c, const struct move *m, const enum axis axis[2],
                         double *radius_mm)
{
    double squared[2];

    for (unsigned i = 0; i < 2; i++) {
        const struct point *at = i == 0 ? &c->at : &m->end;
        const double first = at->at[axis[0]] - m->centre_mm[0];
        const double second = at->at[axis[1]] - m->centre_mm[1];

        squared[i] = first * first + second * second;
    }
    *radius_mm = maths_sqrt(squared[0]);
    return maths_abs(*radius_mm - maths_sqrt(squared[1]));
}

/*
 * R says which of two arcs: above 0 the one of less than half a turn, whose centre is on the side
 * it turns to.
 */
static void put_radius(const struct convert *c, const struct move *m, const enum axis axis[2],
                       double radius_mm)
{
    const double area =
        (m->end.at[axis[0]] - c->at.at[axis[0]]) * (m->centre_mm[1] - c->at.at[axis[1]]) -
        (m->end.at[axis[1]] - c->at.at[axis[1]]) * (m->centre_mm[0] - c->at.at[axis[0]]);
    const bool minor = (area >= 0.0) == (m->kind == MOVE_ARC_CCW);

    put_word(c, 'R', minor ? radius_mm : -radius_mm);
}

static void put_centre(const struct convert *c, const struct move *m, const enum axis axis[2],
                       double radius_mm)
{
    if (move_is_arc(m) && radius_mm < CENTRE_MIN_MM) {
        put_radius(c, m, axis, radius_mm);
        return;
    }
    for (unsigned i = 0; i < 2; i++)
        put_word(c, (char)('I' + (int)axis[i]), (m->centre_mm[i] - c->at.at[axis[i]]) / c->unit_mm);
}

/*
 * G2, G3 and, with the base circle's radius, G2.2, G3.2. Inches allow an end that is further off
 * its circle.
 */
static const char *curved(struct convert *c, const struct move *m)
{
    const bool clockwise = m->kind == MOVE_ARC_CW || m->kind == MOVE_INVOLUTE_CW;
    enum axis axis[2];
    double radius_mm = 0.0;

    takt_plane_axes(m->plane, &axis[0], &axis[1]);
    const bool inch = move_is_arc(m) && off_circle(c, m, axis, &radius_mm) > OFF_CIRCLE_MM;

    put_feed_mode(c, m->feed_rev_mm != 0.0);
    put_plane(c, m->plane);
    if (inch) {
        put_feed(c, m);
        put(c, "\nG20\n");
        c->unit_mm = MM_PER_INCH;
    }
    put(c, "G%c%s", clockwise ? '2' : '3', move_is_involute(m) ? ".2" : "");
    (void)put_axes(c, &m->end, 1U << axis[0] | 1U << axis[1]);
    put_centre(c, m, axis, radius_mm);
    if (move_is_involute(m))
        put_word(c, 'R', m->base_radius_mm);
    else if (m->turns > 1)
        put(c, " P%u", (unsigned)m->turns);
    if (!inch)
        put_feed(c, m);
    put(c, inch ? "\nG21\n" : "\n");
    c->unit_mm = 1.0;
    return NULL;
}

static const char *thread(struct convert *c, const struct move *m)
{
    put(c, "G33");
    if (!put_axes(c, &m->end, 0))
        return "a thread without length";
    put_word(c, 'K', m->feed_rev_mm);
    put(c, "\n");
    return NULL;
}

static const char *probe(struct convert *c, const struct move *m)
{
    static const char *const codes[] = {"G38.2", "G38.3", "G38.4", "G38.5"};

    put_feed_mode(c, false);
    return straight(c, m, codes[(m->probe_optional ? 1 : 0) + (m->probe_away ? 2 : 0)]);
}

static const char *motion(struct convert *c, const struct move *m)
{
    put_path(c, m);
    if (m->kind == MOVE_RAPID || m->kind == MOVE_FEED)
        return straight(c, m, m->kind == MOVE_RAPID ? "G0" : "G1");
    if (m->kind == MOVE_THREAD)
        return thread(c, m);
    return m->kind == MOVE_PROBE ? probe(c, m) : curved(c, m);
}

/* ---- what happens in between ---- */

static void spindle(struct convert *c, const struct move *m)
{
    static const char *const codes[] = {
        [SPINDLE_OFF] = "M5", [SPINDLE_CW] = "M3", [SPINDLE_CCW] = "M4"};

    if (m->direction == SPINDLE_OFF) {
        put(c, "M5\n");
        return;
    }
    if (m->surface_mm_s != 0.0) {
        put(c, "G96");
        if (m->speed_rpm != 0.0)
            put_word(c, 'D', m->speed_rpm);
        put_word(c, 'S', m->surface_mm_s * SECONDS_PER_MINUTE / MM_PER_M);
    } else {
        put(c, c->surface ? "G97" : "");
        put_word(c, 'S', m->speed_rpm);
    }
    c->surface = m->surface_mm_s != 0.0;
    put(c, " %s\n", codes[m->direction]);
}

static void orient(struct convert *c, const struct move *m)
{
    put(c, "M19");
    put_word(c, 'R', m->orient_rad * DEGREES_PER_RAD);
    put(c, " P%u", (unsigned)m->orient_way);
    if (m->timeout_s != 0.0)
        put_word(c, 'Q', m->timeout_s);
    put(c, "\n");
}

static void tool(struct convert *c, const struct move *m)
{
    if (m->tool_loaded)
        put(c, "M61 Q%u\n", (unsigned)m->tool);
    else if (m->tool_change)
        put(c, "M6\n");
    else
        put(c, "T%u\n", (unsigned)m->tool);
}

static void output(struct convert *c, const struct move *m)
{
    if (m->analogue) {
        put(c, m->with_motion ? "M67 E%u" : "M68 E%u", (unsigned)m->channel);
        put_word(c, 'Q', m->output);
        put(c, "\n");
        return;
    }
    put(c, "M%u P%u\n", (m->with_motion ? 62U : 64U) + (m->output != 0.0 ? 0U : 1U),
        (unsigned)m->channel);
}

static void input(struct convert *c, const struct move *m)
{
    put(c, "M66 %c%u L%u", m->analogue ? 'E' : 'P', (unsigned)m->channel, (unsigned)m->input_wait);
    if (m->timeout_s != 0.0)
        put_word(c, 'Q', m->timeout_s);
    put(c, "\n");
}

/*
 * What goes off takes everything with it. The last word gives the state that is wanted, even if it
 * is there already.
 */
static void coolant(struct convert *c, const struct move *m)
{
    const bool both = m->mist && m->flood;

    if ((c->mist && !m->mist) || (c->flood && !m->flood) || (!m->mist && !m->flood)) {
        put(c, "M9\n");
        c->mist = c->flood = false;
    }
    if (both && !c->mist && !c->flood)
        put(c, "M7\n");
    if (m->flood && !(both && c->flood && !c->mist))
        put(c, "M8\n");
    else if (m->mist)
        put(c, "M7\n");
    c->mist = m->mist;
    c->flood = m->flood;
}

static void dwell(struct convert *c, const struct move *m)
{
    put(c, "G4");
    put_word(c, 'P', m->dwell_s);
    put(c, "\n");
}

static void stop(struct convert *c, const struct move *m)
{
    put(c, m->optional ? "M1\n" : "M0\n");
}

static void end(struct convert *c, const struct move *m)
{
    (void)m;
    put(c, "M30\n");
}

static const char *event(struct convert *c, const struct move *m)
{
    static void (*const write[])(struct convert *, const struct move *) = {
        [MOVE_DWELL] = dwell,     [MOVE_SPINDLE] = spindle, [MOVE_ORIENT] = orient,
        [MOVE_COOLANT] = coolant, [MOVE_TOOL] = tool,       [MOVE_OUTPUT] = output,
        [MOVE_INPUT] = input,     [MOVE_STOP] = stop,       [MOVE_END] = end,
    };

    write[m->kind](c, m);
    return NULL;
}

/* ---- the whole ---- */

/* NULL: the dialect has it. */
static const char *lacks(const struct convert *c, const struct move *m)
{
    const bool all = can(c, CAN_LINUXCNC);

    if (m->kind == MOVE_SPLINE || m->kind == MOVE_TAP || m->kind == MOVE_TAP_OUT ||
        m->kind == MOVE_WEAR || m->kind == MOVE_SETUP)
        return m->kind == MOVE_SPLINE  ? "a spline"
               : m->kind == MOVE_WEAR  ? "wear"
               : m->kind == MOVE_SETUP ? "a set-up of the part"
                                       : "rigid tapping";
    if (move_is_involute(m) && !all)
        return "an involute";
    if (move_is_arc(m) && m->turns > 1 && !all)
        return "an arc of several turns";
    if (m->kind == MOVE_THREAD && !all)
        return "a thread";
    if (m->kind == MOVE_PROBE && !can(c, CAN_PROBE))
        return "probing";
    if (move_is_motion(m) && m->feed_rev_mm != 0.0 && m->kind != MOVE_THREAD &&
        !can(c, CAN_REVOLUTION))
        return "a feed per revolution";
    if (m->kind == MOVE_SPINDLE && m->surface_mm_s != 0.0 && !all)
        return "constant surface speed";
    if ((m->kind == MOVE_TOOL && !can(c, CAN_TOOL)) ||
        (m->kind == MOVE_TOOL && m->tool_loaded && !all))
        return "a tool change";
    if ((m->kind == MOVE_ORIENT || m->kind == MOVE_OUTPUT || m->kind == MOVE_INPUT) && !all)
        return m->kind == MOVE_ORIENT ? "an angle of the spindle" : "an output or input";
    return NULL;
}

void convert_open(struct convert *c, FILE *out, enum dialect dialect, unsigned axes,
                  const struct point *start)
{
    *c = (struct convert){.out = out,
                          .dialect = dialect,
                          .axes = axes,
                          .at = *start,
                          .plane = PLANE_XY,
                          .unit_mm = 1.0};
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        number(c->axis[i], start->at[i] * axis_unit_ratio(i));
    if (can(c, HAS_NUMBER))
        put(c, "%%\nO0001\n");
    put(c, "G17 G21 G40 G90 G94\n%s", can(c, HAS_CENTRE_MODE) ? "G91.1\n" : "");
}

const char *convert_move(struct convert *c, const struct move *move)
{
    const char *lacking = lacks(c, move);

    if (lacking != NULL)
        return lacking;
    if (!move_is_motion(move))
        return event(c, move);
    lacking = motion(c, move);
    c->at = move->end;
    return lacking;
}

void convert_close(struct convert *c)
{
    if (can(c, HAS_NUMBER))
        put(c, "%%\n");
}

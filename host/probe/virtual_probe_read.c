/*
 * The text of a virtual probe: words between spaces, a line a solid or a change of an input.
 */
#include "probe/virtual_probe.h"

#include "base/maths.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define RAD_PER_DEGREE (MATHS_PI / 180.0)
#define WORDS_MAX      24
#define SHOWN_MAX      20

struct word {
    const char *start;
    int length;
};

struct reading {
    struct virtual_probe *probe;
    struct virtual_probe_error *error;
    const char *line; /* its start */
    unsigned count, at;
    struct word word[WORDS_MAX];
};

__attribute__((format(printf, 3, 4))) static bool fail(struct reading *r, const char *place,
                                                       const char *format, ...)
{
    va_list arguments;

    r->error->column = (uint32_t)(place - r->line) + 1;
    va_start(arguments, format);
    (void)vsnprintf(r->error->text, sizeof r->error->text, format, arguments);
    va_end(arguments);
    return false;
}

/* The next word, or at the end of the line an empty one behind the last. */
static struct word peek(const struct reading *r)
{
    const struct word *last;

    if (r->at < r->count)
        return r->word[r->at];
    last = &r->word[r->count - 1];
    return (struct word){last->start + last->length, 0};
}

static bool is_word(struct word w, const char *text)
{
    return (size_t)w.length == strlen(text) && memcmp(w.start, text, strlen(text)) == 0;
}

static int shown(struct word w)
{
    return w.length < SHOWN_MAX ? w.length : SHOWN_MAX;
}

static bool fail_expected(struct reading *r, const char *what)
{
    struct word w = peek(r);

    if (w.length == 0)
        return fail(r, w.start, "%s is missing", what);
    return fail(r, w.start, "%s is expected, not '%.*s'", what, shown(w), w.start);
}

static bool to_number(const char *start, int length, double *value)
{
    char text[64];
    char end;

    if (length <= 0 || length >= (int)sizeof text)
        return false;
    memcpy(text, start, (size_t)length);
    text[length] = '\0';
    return strspn(text, "0123456789+-.eE") == (size_t)length &&
           sscanf(text, "%lf%c", value, &end) == 1 && isfinite(*value);
}

static bool take_number(struct reading *r, double *value)
{
    struct word w = peek(r);

    if (!to_number(w.start, w.length, value))
        return fail_expected(r, "a number");
    r->at++;
    return true;
}

/* A number, or * for no end in that direction. */
static bool take_bound(struct reading *r, double open, double unit, double *value)
{
    if (is_word(peek(r), "*")) {
        r->at++;
        *value = open;
        return true;
    }
    if (!take_number(r, value))
        return false;
    *value *= unit;
    return true;
}

/* -1: it is none. */
static int axis_of(struct word w)
{
    const char *found = w.length == 1 ? strchr("XYZABC", w.start[0]) : NULL;

    return found != NULL && *found != '\0' ? (int)(found - strchr("XYZABC", 'X')) : -1;
}

static bool read_side(struct reading *r, struct virtual_probe_solid *s, bool *given)
{
    struct word w = peek(r);
    int axis = axis_of(w);
    double unit = axis < AXIS_LINEAR_COUNT ? 1.0 : RAD_PER_DEGREE;

    if (axis < 0)
        return fail_expected(r, "an axis, X Y Z A B or C,");
    if (given[axis])
        return fail(r, w.start, "the axis %.*s is given twice", shown(w), w.start);
    given[axis] = true;
    r->at++;
    if (!take_bound(r, -MATHS_INFINITY, unit, &s->low[axis]) ||
        !take_bound(r, MATHS_INFINITY, unit, &s->high[axis]))
        return false;
    return s->low[axis] <= s->high[axis] ||
           fail(r, w.start, "the lower end of %.*s is above the upper one", shown(w), w.start);
}

static bool read_box(struct reading *r, struct virtual_probe_solid *s)
{
    bool given[AXIS_COUNT] = {false};

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        s->low[i] = -MATHS_INFINITY;
        s->high[i] = MATHS_INFINITY;
    }
    do {
        if (!read_side(r, s, given))
            return false;
    } while (r->at < r->count);
    return true;
}

static bool take_word(struct reading *r, const char *text)
{
    char what[8];

    if (is_word(peek(r), text)) {
        r->at++;
        return true;
    }
    (void)snprintf(what, sizeof what, "'%s'", text);
    return fail_expected(r, what);
}

static bool read_ball(struct reading *r, struct virtual_probe_solid *s)
{
    static const char *const names[] = {"X", "Y", "Z"};

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (!take_word(r, names[i]) || !take_number(r, &s->low[i]))
            return false;
    }
    if (!take_word(r, "R") || !take_number(r, &s->radius_mm))
        return false;
    return s->radius_mm > 0 || fail(r, r->word[r->at - 1].start, "a radius above 0 is expected");
}

/* kind: box, ball or hole, of which the last two are told alike. */
static bool read_solid(struct reading *r, struct word kind)
{
    struct virtual_probe_solid *s = &r->probe->solid[r->probe->solids];

    if (r->probe->solids == VIRTUAL_PROBE_SOLIDS_MAX)
        return fail(r, r->line, "more than %d solids", VIRTUAL_PROBE_SOLIDS_MAX);
    *s = (struct virtual_probe_solid){0};
    r->probe->solids++;
    s->is_hole = is_word(kind, "hole");
    return is_word(kind, "box") ? read_box(r, s) : read_ball(r, s);
}

/* P0 ... P31, E0 ... E3 */
static bool take_channel(struct reading *r, struct virtual_probe_change *c)
{
    struct word w = peek(r);
    double number;

    c->analogue = w.length > 0 && w.start[0] == 'E';
    if (w.length < 2 || (w.start[0] != 'P' && w.start[0] != 'E') ||
        !to_number(w.start + 1, w.length - 1, &number) || number < 0 || number != floor(number) ||
        number >= (c->analogue ? INPUTS_ANALOGUE_MAX : INPUTS_DIGITAL_MAX))
        return fail_expected(r, "an input, P0 to P31 or E0 to E3,");
    c->channel = (unsigned)number;
    r->at++;
    return true;
}

static bool check_change(struct reading *r, const struct virtual_probe_change *c)
{
    if (!c->analogue && c->value != 0 && c->value != 1)
        return fail(r, r->word[2].start, "a digital input is 0 or 1");
    return c->time_s >= 0 || fail(r, r->word[4].start, "a time is 0 or more");
}

/* After all that happen before it or at the same time. */
static void insert_change(struct virtual_probe *probe, const struct virtual_probe_change *c)
{
    unsigned at = probe->changes++;

    for (; at > 0 && probe->change[at - 1].time_s > c->time_s; at--)
        probe->change[at] = probe->change[at - 1];
    probe->change[at] = *c;
}

static bool read_input(struct reading *r)
{
    struct virtual_probe_change c = {0};

    if (r->probe->changes == VIRTUAL_PROBE_CHANGES_MAX)
        return fail(r, r->line, "more than %d changes of inputs", VIRTUAL_PROBE_CHANGES_MAX);
    if (!take_channel(r, &c) || !take_number(r, &c.value) || !take_word(r, "at") ||
        !take_number(r, &c.time_s) || !check_change(r, &c))
        return false;
    insert_change(r->probe, &c);
    return true;
}

/* Three numbers. */
static bool take_three(struct reading *r, double unit, double value[AXIS_LINEAR_COUNT])
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (!take_number(r, &value[i]))
            return false;
        value[i] *= unit;
    }
    return true;
}

/* part by X Y Z turned A B C about X Y Z, and perhaps: on C */
static bool read_part(struct reading *r)
{
    struct virtual_probe_part *part = &r->probe->part;
    double turned_rad[AXIS_LINEAR_COUNT];

    if (part->is_displaced)
        return fail(r, r->line, "the part is told twice");
    if (!take_word(r, "by") || !take_three(r, 1.0, part->offset_mm) || !take_word(r, "turned") ||
        !take_three(r, RAD_PER_DEGREE, turned_rad) || !take_word(r, "about") ||
        !take_three(r, 1.0, part->pivot_mm))
        return false;
    part->table = AXIS_COUNT;
    if (r->at < r->count) {
        if (!take_word(r, "on"))
            return false;
        if (axis_of(peek(r)) < AXIS_LINEAR_COUNT)
            return fail_expected(r, "a table, A, B or C,");
        part->table = (enum axis)axis_of(peek(r));
        r->at++;
    }
    virtual_probe_place(part, turned_rad);
    return true;
}

static bool read_words(struct reading *r)
{
    struct word kind = r->word[0];
    bool good;

    r->at = 1;
    if (is_word(kind, "box") || is_word(kind, "ball") || is_word(kind, "hole"))
        good = read_solid(r, kind);
    else if (is_word(kind, "input"))
        good = read_input(r);
    else if (is_word(kind, "part"))
        good = read_part(r);
    else
        return fail(r, kind.start, "box, ball, hole, part or input is expected, not '%.*s'",
                    shown(kind), kind.start);
    if (good && r->at < r->count)
        return fail(r, peek(r).start, "'%.*s' is too much here", shown(peek(r)), peek(r).start);
    return good;
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* False: more words than any line has. */
static bool split(struct reading *r, const char *end)
{
    const char *c = r->line;

    r->count = 0;
    for (;;) {
        const char *start;

        while (c < end && is_space(*c))
            c++;
        if (c == end || *c == '#')
            return true;
        if (r->count == WORDS_MAX)
            return fail(r, c, "the line has more than %d words", WORDS_MAX);
        start = c;
        while (c < end && !is_space(*c) && *c != '#')
            c++;
        r->word[r->count++] = (struct word){start, (int)(c - start)};
    }
}

bool virtual_probe_read(struct virtual_probe *probe, const char *text, size_t length,
                        struct virtual_probe_error *error)
{
    struct reading r = {.probe = probe, .error = error};
    const char *end = text + length;

    *probe = (struct virtual_probe){0};
    *error = (struct virtual_probe_error){0};
    while (text < end) {
        const char *line_end = memchr(text, '\n', (size_t)(end - text));

        if (line_end == NULL)
            line_end = end;
        error->line++;
        r.line = text;
        if (!split(&r, line_end) || (r.count > 0 && !read_words(&r)))
            return false;
        text = line_end < end ? line_end + 1 : end;
    }
    return true;
}

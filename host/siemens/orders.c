/*
 * Orders of Siemens' language (siemens.c): lines that are no moves.
 *
 *     TRANS X10      G92.1, G52 X[1*[10]] it takes the place of all that was shifted before
 *     ATRANS X10     G92 X[#<_x>-[10]]    and this is added to it
 *     TRANS          G92.1
 *     DEF REAL A     #<def_a>=[0]
 *     MSG("text")    (msg,text)
 *     G500           G59.3, if all of it is 0
 *     G4 F2, G4 S3   G4 P2, G4 P[3*60/#<_rpm>]
 */
#include "siemens/scan.h"
#include "siemens/siemens.h"

#include <stdio.h>
#include <string.h>

void scan_clear(struct scan *s)
{
    (void)line_read(&s->t->line, "", 0);
}

/* MSG("text"); without a text it takes the last one away. */
static void take_text(struct scan *s)
{
    const char *begin = strchr(s->at, '"');
    const char *end = begin != NULL ? strchr(begin + 1, '"') : NULL;

    scan_clear(s);
    if (end == NULL)
        return;
    translate_message(s->t, begin + 1, (size_t)(end - begin - 1));
}

/* ---- frames ---- */

/* X10, X=R1: the letter, and the value as [value]. */
static char take_axis(struct scan *s)
{
    const char letter = (char)(line_lower(*s->at) - 'a' + 'A');

    s->failed = s->failed || strchr("XYZABC", letter) == NULL;
    s->at += s->failed ? 0 : 1;
    s->length = 0;
    if (scan_take(s, "=")) {
        scan_brackets(s);
        return letter;
    }
    scan_put(s, "[");
    scan_single(s);
    scan_put(s, "]");
    return letter;
}

/* Also with DIAMON these X are radii. */
static void put_shift(struct scan *s, bool adds, char words[LINE_MAX_BYTES])
{
    size_t length = 0;

    for (scan_skip(s); !s->failed && !scan_is_end(s); scan_skip(s)) {
        const char letter = take_axis(s);
        const unsigned by = letter == 'X' && s->t->diameter ? 2 : 1;
        const size_t room = LINE_MAX_BYTES - length;

        if (adds)
            length += (size_t)snprintf(words + length, room, " %c[%u*[#<_%c>-%s]]", letter, by,
                                       line_lower(letter), s->out);
        else
            length += (size_t)snprintf(words + length, room, " %c[%u*%s]", letter, by, s->out);
        s->failed = s->failed || length >= LINE_MAX_BYTES;
    }
}

/* Frames that do more than shift are not known; without words all of them delete what is there. */
static bool take_frame(struct scan *s, const char *name)
{
    const bool adds = strcmp(name, "ATRANS") == 0;
    const bool shifts = adds || strcmp(name, "TRANS") == 0;
    char words[LINE_MAX_BYTES] = "";

    scan_skip(s);
    if (!shifts && !(scan_is_end(s) && (strcmp(name, "ROT") == 0 || strcmp(name, "SCALE") == 0 ||
                                        strcmp(name, "MIRROR") == 0)))
        return false;
    put_shift(s, adds, words);
    if (s->failed)
        return true;
    if (!adds)
        translate_add(&s->t->before, "G92.1");
    if (words[0] != '\0')
        translate_add(&s->t->before, "%s%s", adds ? "G92" : "G52", words);
    scan_clear(s);
    return true;
}

/* ---- definitions ---- */

void scan_define(struct scan *s, const char *name, char kind)
{
    struct translator *t = s->t;
    unsigned i = 0;

    while (i < t->variables && strcmp(t->variable[i], name) != 0)
        i++;
    s->failed = s->failed || i == TRANSLATE_NAMES_MAX;
    if (s->failed)
        return;
    (void)snprintf(t->variable[i], sizeof t->variable[0], "%s", name);
    t->kind[i] = kind;
    t->variables += i == t->variables ? 1 : 0;
}

/* DEF REAL A=1, B */
static void take_definitions(struct scan *s)
{
    struct translator *t = s->t;
    char name[NAME_MAX_];

    s->failed = s->failed || !scan_name(s, name);
    const char kind = strcmp(name, "INT") == 0 ? 'i' : ' ';

    do {
        s->failed = s->failed || !scan_name(s, name);
        scan_define(s, name, kind);
        if (s->failed)
            return;
        s->length = 0;
        scan_operand(s, name);
        scan_put(s, "=");
        if (scan_take(s, "="))
            scan_given(s, kind);
        else
            scan_put(s, "[0]");
        translate_add(&t->before, "%s", s->out);
    } while (!s->failed && scan_take(s, ","));
    scan_skip(s);
    s->failed = s->failed || !scan_is_end(s);
    scan_clear(s);
}

/* ---- codes ---- */

/* G4 F2 waits two seconds, G4 S10 ten turns of the spindle. */
static void translate_dwell(struct line *l)
{
    struct line_word *f = line_find(l, 'f', 0);
    struct line_word *s = line_find(l, 's', 0);
    char text[LINE_MAX_BYTES];

    if (line_find_code(l, 'g', 40) == NULL || line_find(l, 'p', 0) != NULL)
        return;
    struct line_word *w = f != NULL ? f : s;

    if (w == NULL)
        return;
    (void)snprintf(text, sizeof text, w == f ? "P%.*s" : "P[60*%.*s/#<_rpm>]",
                   (int)(w->end - w->value_begin), &l->text[w->value_begin]);
    (void)line_replace(l, w, text);
}

/* The last system stands for none, as long as it is none. */
static void translate_no_offset(struct translator *t)
{
    struct line_word *w = line_find_code(&t->line, 'g', 5000);
    const unsigned label = 98000000U + t->number % 1000000U;

    if (w == NULL)
        return;
    translate_add(&t->before,
                  "o%u if [ABS[#5381]+ABS[#5382]+ABS[#5383]+ABS[#5384]+ABS[#5385]+"
                  "ABS[#5386]+ABS[#5390] NE 0]",
                  label);
    translate_add(&t->before, "(abort,G500 is G59.3 here, whose offsets must be 0)");
    translate_add(&t->before, "o%u endif", label);
    (void)line_replace(&t->line, w, "G59.3");
}

/* DIAM90: X is a diameter with G90, a radius with G91. */
static void translate_diameter(struct translator *t)
{
    struct line *l = &t->line;
    const bool absolute = line_find_code(l, 'g', 900) != NULL;
    const bool incremental = line_find_code(l, 'g', 910) != NULL;

    if (t->diameter_follows && (absolute || incremental))
        (void)line_append(l, absolute ? "G7" : "G8");
    if (line_find_code(l, 'g', 70) != NULL)
        t->diameter = true;
    if (line_find_code(l, 'g', 80) != NULL)
        t->diameter = false;
}

/* With axis words of its own it is a frame of the 840D, and a system and a move of the 802D. */
static void refuse_system_with_axes(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *w = line_find_code(l, 'g', 580);
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    w = w != NULL ? w : line_find_code(l, 'g', 590);
    if (w != NULL && line_has_axis(l) && !motion)
        translate_wrong(t, w,
                        "'%.*s' beside axis words shifts, or selects a system and moves: write "
                        "TRANS, or G0 or G1",
                        (int)(w->end - w->begin), &l->text[w->begin]);
}

/*
 * A tool that has been changed has the length of its first edge; in a program without M6 the T
 * changes it, under a spindle that goes on turning.
 */
static void translate_change(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *tool = line_find(l, 't', 0);
    const bool turret = tool != NULL && !t->survey.changes && t->called == NULL;
    const bool none = tool != NULL && tool->is_number && tool->value == 0.0;
    bool told = line_find_code(l, 'm', 50) != NULL;

    for (unsigned code = 3; code <= 4; code++) {
        t->turns = line_find_code(l, 'm', 10 * code) != NULL ? code : t->turns;
        told = told || line_find_code(l, 'm', 10 * code) != NULL;
    }
    t->turns = line_find_code(l, 'm', 50) != NULL ? 0 : t->turns;
    if (!turret && line_find_code(l, 'm', 60) == NULL)
        return;
    if (turret)
        (void)line_append(l, "M6");
    if (line_find_code(l, 'g', 430) == NULL && line_find_code(l, 'g', 490) == NULL)
        (void)line_append(l, none ? "G49" : "G43");
    if (turret && t->turns != 0 && !told)
        (void)line_append(l, t->turns == 3 ? "M3" : "M4");
}

/* LIMS without G96, a D by now, holds for the next one. */
static void keep_limit(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *d = line_find(l, 'd', 0);

    if (d == NULL || line_find_code(l, 'g', 960) != NULL || line_find_code(l, 'g', 9610) != NULL ||
        line_find_code(l, 'g', 9620) != NULL ||
        (size_t)(d->end - d->begin) >= sizeof t->speed_limit)
        return;
    (void)snprintf(t->speed_limit, sizeof t->speed_limit, "%.*s", (int)(d->end - d->begin),
                   &l->text[d->begin]);
    line_blank(l, d);
}

void siemens_codes(struct translator *t)
{
    keep_limit(t);
    refuse_system_with_axes(t);
    translate_change(t);
    translate_dwell(&t->line);
    translate_no_offset(t);
    translate_diameter(t);
}

/* ---- a line ---- */

static bool take_order(struct scan *s, char *name)
{
    if (scan_flow(s, name) || scan_program(s, name))
        return true;
    if (strcmp(name, "MSG") == 0) {
        take_text(s);
        return true;
    }
    if (strcmp(name, "DEF") == 0) {
        take_definitions(s);
        return true;
    }
    return take_frame(s, name) || siemens_cycle(s, name) || (*s->at != '=' && scan_call(s, name));
}

static void take_line(struct scan *s, char *name)
{
    const char *before = s->at;

    if (scan_name(s, name) && take_order(s, name))
        return;
    s->at = before;
    scan_words(s);
    if (!s->failed)
        siemens_drill(s);
    if (!s->failed)
        (void)line_read(&s->t->line, s->out, s->length);
    if (!s->failed)
        siemens_codes(s->t);
}

void siemens_survey(struct survey *s, struct line *l)
{
    s->changes = s->changes || line_find_code(l, 'm', 60) != NULL;
}

void siemens_translate(struct translator *t)
{
    static _Thread_local struct line found;
    struct scan s = {.t = t, .at = found.text};
    const unsigned jumps = t->jumps;
    char name[NAME_MAX_] = "";

    found = t->line;
    if (scan_section(&s))
        return;
    if (*s.at == '/') {
        scan_put(&s, "%c", *s.at++);
        s.at += scan_is_digit(*s.at) ? 1 : 0; /* a level of its own: all are skipped, or none */
    }
    while (scan_label(&s))
        ;
    scan_skip(&s);
    const bool worded = !scan_is_end(&s) && *s.at != '%';

    if (worded)
        scan_begin_called(&s);
    const size_t begun = t->before.length;

    take_line(&s, name);
    t->worded = t->worded || worded;
    if (!s.failed)
        return;
    t->line = found;
    t->before.length = begun;
    t->behind.length = 0;
    t->jumps = jumps;
    scan_pass_block(&s, name);
}

/*
 * What words of one line mean for later ones: registers of tools, work systems, and the speed of
 * turning.
 */
#include "dialect/translate.h"
#include "lathe/lathe.h"

#include <stdio.h>
#include <string.h>

/*
 * The word's value for later lines, by the letter that it has there. False: it is too long, so that
 * the word stays where it is and is told as an error there.
 */
static bool keep(const struct line *l, const struct line_word *w, char letter, char *kept,
                 size_t size)
{
    const size_t length = w->end - w->value_begin;

    if (length + 2 > size)
        return false;
    (void)snprintf(kept, size, "%c%.*s", letter, (int)length, &l->text[w->value_begin]);
    return true;
}

/* D is that of the compensation that follows, of this line or of a later one. */
static void translate_radius(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *d = line_find(l, 'd', 0);
    const bool compensates =
        line_find_code(l, 'g', 410) != NULL || line_find_code(l, 'g', 420) != NULL;

    if (compensates && d == NULL)
        (void)line_append(l, t->radius);
    else if (compensates)
        (void)keep(l, d, 'D', t->radius, sizeof t->radius);
    else if (d != NULL && line_find_code(l, 'g', 430) != NULL &&
             keep(l, d, 'D', t->radius, sizeof t->radius))
        line_blank(l, d);
}

/* H alone is the length in use, or the one of the G43 that follows; on a lathe it is a way of C. */
static void translate_length(struct translator *t)
{
    static const uint16_t codes[] = {100, 370, 431, 432, 434, 650, 760};
    struct line *l = &t->line;
    struct line_word *h = line_find(l, 'h', 0);
    const bool begins = line_find_code(l, 'g', 430) != NULL;

    if (t->survey.lathe)
        return;
    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        if (line_find_code(l, 'g', codes[i]) != NULL)
            return;
    }
    t->has_length = (t->has_length || begins) && line_find_code(l, 'g', 490) == NULL;
    if (h != NULL && !begins && keep(l, h, 'H', t->length, sizeof t->length)) {
        if (t->has_length)
            (void)line_append(l, "G43");
        else
            line_blank(l, h);
    } else if (begins && h == NULL) {
        (void)line_append(l, t->length);
    }
}

/* A reference is gone to without compensation, which holds again behind it. */
static void translate_side(struct translator *t)
{
    struct line *l = &t->line;

    if (line_find_code(l, 'g', 410) != NULL || line_find_code(l, 'g', 420) != NULL)
        t->side = line_find_code(l, 'g', 410) != NULL ? 41 : 42;
    if (line_find_code(l, 'g', 400) != NULL)
        t->side = 0;
    if (t->side != 0 &&
        (line_find_code(l, 'g', 280) != NULL || line_find_code(l, 'g', 300) != NULL)) {
        translate_add(&t->before, "G40");
        translate_add(&t->behind, "G%u %s", t->side, t->radius);
    }
}

/* T1.1 is tool 1 with its first offset. */
static void translate_tool(struct translator *t)
{
    struct line_word *tool = line_find(&t->line, 't', 0);
    char text[16];

    if (tool == NULL || !tool->is_number || !tool->has_point)
        return;
    (void)snprintf(text, sizeof text, "T%u", (unsigned)line_whole(tool->value));
    (void)line_replace(&t->line, tool, text);
}

/* G54.1 P1 to P3 and G154 are the last three systems here. */
static void translate_system(struct translator *t)
{
    static const uint16_t codes[] = {541, 540, 1540};
    struct line *l = &t->line;
    struct line_word *p = line_find(l, 'p', 0);

    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        struct line_word *w = line_find_code(l, 'g', codes[i]);
        char text[16];

        if (w != NULL && p != NULL && p->is_number && p->value >= 1.0 && p->value <= 3.0) {
            (void)snprintf(text, sizeof text, "G59.%u", (unsigned)p->value);
            line_blank(l, p);
            (void)line_replace(l, w, text);
            return;
        }
    }
}

void registers_unshifted(char axis, char *text, size_t size)
{
    const unsigned index = (unsigned)(strchr(LINE_AXES, axis) - LINE_AXES);

    (void)snprintf(text, size, "%c[#<_%c>+#%u%s]", axis, axis, 5211U + index,
                   index < 3 ? TRANSLATE_IN_UNITS : "");
}

/* G50 X200 Z100, with a limit or without one, says where the tool is. */
static void translate_limit(struct line *l, struct line_word *w)
{
    if (line_code(w) == 500 && line_has_axis(l))
        (void)line_replace(l, w, "G92");
    else
        line_blank(l, w);
}

struct line_word *registers_speed_limit(struct line *l)
{
    struct line_word *w = line_find_code(l, 'g', 500);
    struct line_word *other = line_find_code(l, 'g', 920);

    return w == NULL && line_find(l, 's', 0) != NULL && !line_has_axis(l) ? other : w;
}

/* Is it a program of a lathe? */
void registers_survey(struct survey *s, struct line *l)
{
    const bool limit = registers_speed_limit(l) != NULL && line_find(l, 's', 0) != NULL;

    s->lathe = s->lathe || turning_tells(l) || (limit && line_find_code(l, 'g', 500) != NULL) ||
               (line_find_code(l, 'g', 280) != NULL && line_find(l, 'u', 0) != NULL);
    s->limits_speed = s->limits_speed || limit;
    s->lies_flat = s->lies_flat || line_find_code(l, 'g', 170) != NULL;
}

/* G92 S alone is of mills as well, which say G17. */
void registers_survey_end(struct survey *s)
{
    s->lathe = s->lathe || (s->limits_speed && !s->lies_flat);
}

/*
 * G50 S2000, of others G92 S2000, is the highest speed for the G96 that follows; G50 without S ends
 * a scale that is not there.
 */
void registers_translate_speed(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *w = registers_speed_limit(l);
    struct line_word *s = line_find(l, 's', 0);
    struct line_word *surface = line_find_code(l, 'g', 960);

    if (surface != NULL && s == NULL)
        line_blank(l, surface);
    if (surface == NULL && s != NULL && w == NULL && t->surface_is_owed)
        (void)line_append(l, "G96");
    t->surface_is_owed = (t->surface_is_owed || surface != NULL) && (s == NULL || w != NULL) &&
                         line_find_code(l, 'g', 970) == NULL;
    w = registers_speed_limit(l);
    s = line_find(l, 's', 0);
    if (w != NULL && s == NULL) {
        translate_limit(l, w);
    } else if (w != NULL && keep(l, s, 'D', t->speed_limit, sizeof t->speed_limit)) {
        line_blank(l, s);
        translate_limit(l, w);
    } else if (w == NULL && line_find_code(l, 'g', 960) != NULL && line_find(l, 'd', 0) == NULL) {
        (void)line_append(l, t->speed_limit);
    }
}

/* Inches and millimetres by other numbers; a lathe's G71 has words of its own. */
void registers_translate_unit(struct translator *t)
{
    struct line_word *unit = line_unit(&t->line);

    if (unit != NULL)
        (void)line_replace(&t->line, unit, line_code(unit) == 700 ? "G20" : "G21");
}

/*
 * G92.1 X0 Y0 Z0 takes shifts away, and moves nothing. On mills it does so of the axes that it
 * names:
 *
 *     G92.1 X0        G92 x[#<_x>+#5211]      where X is without its shift, in the units in effect
 */
static void translate_preset(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *code = line_find_code(l, 'g', 921);
    const bool all = line_find(l, 'x', 0) != NULL && line_find(l, 'y', 0) != NULL &&
                     line_find(l, 'z', 0) != NULL;
    const bool some = !t->survey.lathe && !all;

    if (code == NULL || !line_has_axis(l))
        return;
    if (some)
        (void)line_replace(l, code, "G92");
    for (unsigned axis = 0; axis < strlen(LINE_AXES); axis++) {
        struct line_word *w = line_find(l, LINE_AXES[axis], 0);
        char text[64];

        if (w == NULL)
            continue;
        registers_unshifted(LINE_AXES[axis], text, sizeof text);
        if (some)
            (void)line_replace(l, w, text);
        else
            line_blank(l, w);
    }
}

/* What a control has in registers. */
void registers_translate(struct translator *t)
{
    translate_preset(t);
    translate_system(t);
    translate_radius(t);
    translate_length(t);
    translate_side(t);
    translate_tool(t);
}

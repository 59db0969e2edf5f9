/*
 * G10 of Fanuc and Haas, whose L has other meanings than in LinuxCNC:
 *
 *     G91 G10 L2 P1 X1     G10 L2 P1 X[[1]+ G54's X]      G91 counts from the offset that there is
 *     G10 L2 P0 X0         nothing; another number displaces all systems: an error
 *     G10 L20 P1 X1        G10 L2 P7 X1                   of G54.1 P1
 *     G10 L10 P1 R80.      G10 L1 P1 Z80.                 length of tool 1
 *     G10 L12 P1 R5.       G10 L1 P1 R5.                  its radius (Fanuc)
 *     G10 L11 P1 R0        nothing; wear that is not 0 is an error
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

static bool is_zero(const struct line_word *w)
{
    return w->is_number && w->value == 0.0;
}

/* True: no axis word has a value but 0. */
static bool has_no_offset(struct line *l)
{
    for (const char *axis = LINE_AXES; *axis != '\0'; axis++) {
        const struct line_word *w = line_find(l, *axis, 0);

        if (w != NULL && !is_zero(w))
            return false;
    }
    return true;
}

static void leave_out(struct line *l)
{
    for (const char *letter = "lpr" LINE_AXES; *letter != '\0'; letter++) {
        struct line_word *w = line_find(l, *letter, 0);

        if (w != NULL)
            line_blank(l, w);
    }
    line_blank(l, line_find_code(l, 'g', 100));
}

/* Of a value or a P, which stand more than once in what is written for them. */
#define CALCULATION_MAX 64U

static bool is_short(struct translator *t, const struct line_word *w)
{
    const bool good = (size_t)(w->end - w->value_begin) < CALCULATION_MAX;

    if (!good)
        translate_wrong(t, w,
                        "this is too long for G10 L2, which adds in G91: work it out on a line of "
                        "its own");
    return good;
}

/* The offset that there is, in the units in effect, is added in G91. */
static void add_offset(struct translator *t, const char *mode)
{
    struct line *l = &t->line;
    const struct line_word *p = line_find(l, 'p', 0);
    char system[CALCULATION_MAX];

    if (p == NULL || !is_short(t, p))
        return;
    (void)snprintf(system, sizeof system, "%.*s", (int)(p->end - p->value_begin),
                   &l->text[p->value_begin]);
    for (unsigned axis = 0; axis < strlen(LINE_AXES); axis++) {
        struct line_word *w = line_find(l, LINE_AXES[axis], 0);
        char text[256];

        if (w == NULL || !is_short(t, w))
            continue;
        (void)snprintf(text, sizeof text, "%c[[%.*s]+%s*#[%u+20*[%s]]%s]", LINE_AXES[axis],
                       (int)(w->end - w->value_begin), &l->text[w->value_begin], mode, 5201U + axis,
                       system, axis < 3 ? TRANSLATE_IN_UNITS : "");
        (void)line_replace(l, w, text);
    }
}

static void translate_system(struct translator *t, const struct line_word *p)
{
    const char *mode = motion_distance_mode(&t->line);

    if (p != NULL && is_zero(p)) {
        if (!has_no_offset(&t->line))
            translate_wrong(t, p,
                            "G10 L2 P0 displaces all work offsets, which is not supported: "
                            "add it to those of P1 to P6");
        leave_out(&t->line);
    } else if (!t->survey.lathe && strcmp(mode, "0") != 0) {
        add_offset(t, mode);
    }
}

/* G54.1 P1 to P3 are the last three systems here. */
static void translate_more_systems(struct translator *t, struct line_word *code,
                                   struct line_word *p)
{
    char text[16];

    if (p == NULL || !p->is_number || p->value < 1.0 || p->value > 3.0) {
        translate_wrong(t, p, "G10 L20 sets G54.1 P1 to P3 here, and no others");
        return;
    }
    (void)snprintf(text, sizeof text, "P%u", 6U + (unsigned)p->value);
    (void)line_replace(&t->line, p, text);
    code = line_find(&t->line, 'l', 0);
    (void)line_replace(&t->line, code, "L2");
    translate_system(t, line_find(&t->line, 'p', 0));
}

static void translate_tool(struct translator *t, struct line_word *code, unsigned what)
{
    struct line *l = &t->line;
    struct line_word *r = line_find(l, 'r', 0);
    const bool adds = t->incremental || strcmp(motion_distance_mode(l), "1") == 0;
    const bool is_wear = what == 11 || what == 13;

    if (r != NULL && is_zero(r) && (is_wear || adds)) {
        leave_out(l);
        return;
    }
    if (t->survey.lathe) /* R is the radius of the nose there */
        translate_wrong(t, code, "G10 L%u of a lathe: use the tool table", what);
    else if (r == NULL || is_wear || (adds && line_find_code(l, 'g', 900) == NULL))
        translate_wrong(t, code,
                        "G10 L%u sets a value of a tool by R in G90; wear, and what is "
                        "added in G91, is not supported: set the sum",
                        what);
    else if (what == 12 && t->dialect == DIALECT_HAAS)
        translate_wrong(t, code,
                        "G10 L12: a setting of the control says whether R is a radius or "
                        "a diameter: use the tool table");
    else if (what == 10)
        l->text[r->begin] = 'Z';
    (void)line_replace(l, code, "L1");
}

void offsets_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *what = line_find(l, 'l', 0);

    if (line_find_code(l, 'g', 100) == NULL || what == NULL || !what->is_number)
        return;
    const unsigned number = (unsigned)line_whole(what->value);

    if (number == 2)
        translate_system(t, line_find(l, 'p', 0));
    else if (number == 20)
        translate_more_systems(t, what, line_find(l, 'p', 0));
    else if (number >= 10 && number <= 13)
        translate_tool(t, what, number);
}

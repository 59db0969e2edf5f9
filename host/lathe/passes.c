/*
 * Single passes of lathes of Fanuc and Haas (G-code system A), in plain moves. Each line with X, Z,
 * U or W is one, until another motion; it ends where it began.
 *
 *     G90 X45. Z-20. F0.2         rapid in X, along Z at the feed, back in X at the feed, back in Z at rapid
 *     X40.                        the same at another diameter
 *     G90 U-5. W-22. R-2.         from where the tool is; the cut begins R further in X than it ends
 *     G92 X29. Z-20. F1.5         the same as a thread of lead F, back at rapid
 *     G94 X10. Z-2.               rapid in Z, along X at the feed, back in Z at the feed, back in X at rapid
 *
 * G90 that is alone, or beside another motion, is one of system B: distances are absolute.
 */
#include "lathe/lathe.h"

#include <stdio.h>
#include <string.h>

/* What the lines so far have said. */
#define KNOWN_X    1U
#define KNOWN_Z    2U
#define KNOWN_LEAD 4U

static bool has_place(struct line *l)
{
    return line_find(l, 'x', 0) != NULL || line_find(l, 'z', 0) != NULL ||
           line_find(l, 'u', 0) != NULL || line_find(l, 'w', 0) != NULL;
}

/* Codes that say what the words of a line are for: none but modes may stand beside a pass. */
static bool has_other_code(const struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        const int number = l->word[i].letter == 'g' ? line_code(&l->word[i]) : -1;

        if (number >= 0 && number != 920 && !line_code_is_mode(number))
            return true;
    }
    return false;
}

static struct line_word *find_pass(struct line *l)
{
    for (unsigned code = 900; code <= 940; code += 20) {
        struct line_word *w = line_find_code(l, 'g', code);

        if (w != NULL)
            return w;
    }
    return NULL;
}

void passes_survey(struct survey *s, struct line *l)
{
    s->absolute =
        s->absolute || line_find_code(l, 'g', 910) != NULL || line_find_code(l, 'g', 950) != NULL;
}

/* Without a slope, of a line that may be left out too. */
static void begin(struct translator *t)
{
    const bool slash = t->behind.slash;

    t->pass_known = 0;
    t->behind.slash = false;
    translate_add(&t->behind, "#<_pass_r>=0");
    t->behind.slash = slash;
}

/* Who calls a program while a pass is in effect has it go on there. */
static void note_call(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *p = line_find(l, 'p', 0);
    const bool lines = line_find_code(l, 'm', 970) != NULL;
    unsigned at = 0;

    if (t->pass == 0 || (!lines && line_find_code(l, 'm', 980) == NULL))
        return;
    while (p != NULL && at < t->passed && t->passes[at].program != line_whole(p->value))
        at++;
    if (lines || p == NULL || !p->is_number || at == TRANSLATE_LINES_MAX) {
        translate_wrong(t, NULL, "G%u of a lathe goes on in this call, which is not supported",
                        t->pass);
        return;
    }
    t->passes[at] = (struct passed){line_whole(p->value), t->pass};
    t->passed += at == t->passed ? 1 : 0;
}

static void follow_programs(struct translator *t)
{
    const struct line_word *first = t->line.words > 0 ? &t->line.word[0] : NULL;

    note_call(t);
    if (first == NULL || first->letter != 'o' || !first->is_number)
        return;
    t->pass = 0;
    for (unsigned i = 0; i < t->passed; i++) {
        const uint32_t called = t->passes[i].program;

        if (called == line_whole(first->value) || called % 10000U == line_whole(first->value))
            t->pass = t->passes[i].pass;
    }
    t->pass_known = t->pass != 0 ? KNOWN_X | KNOWN_Z | KNOWN_LEAD : 0;
}

/* False: the line is no pass. */
static bool follow_motion(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *code = find_pass(l);
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    if (motion || line_find_code(l, 'g', 320) != NULL)
        t->pass = 0;
    if (has_other_code(l) || !has_place(l) || t->survey.absolute)
        return false;
    if (code == NULL)
        return t->pass != 0;
    if (t->pass == 0)
        begin(t);
    t->pass = (unsigned)line_code(code) / 10;
    line_blank(l, code);
    return true;
}

/* A word's value becomes that of a name, counted from a place, and leaves the line. */
static bool take(struct translator *t, char letter, const char *name, const char *from)
{
    struct line *l = &t->line;
    struct line_word *w = line_find(l, letter, 0);

    if (w == NULL)
        return false;
    translate_add(&t->behind, "#<_pass_%s>=[%s%.*s]", name, from, (int)(w->end - w->value_begin),
                  &l->text[w->value_begin]);
    line_blank(l, w);
    return true;
}

static void take_places(struct translator *t)
{
    const char slope = t->pass == 94 ? 'k' : 'i';

    translate_add(&t->behind, "#<_turning_x>=[2*#<_x>] #<_turning_z>=#<_z>");
    if (take(t, 'x', "x", "") || take(t, 'u', "x", "#<_turning_x>+"))
        t->pass_known |= KNOWN_X;
    if (take(t, 'z', "z", "") || take(t, 'w', "z", "#<_turning_z>+"))
        t->pass_known |= KNOWN_Z;
    if (!take(t, 'r', "r", ""))
        (void)take(t, slope, "r", "");
}

/*
 * F is measured along the axis in which the thread is longer, K along the thread:
 *
 *     K = F sqrt(z^2 + r^2) / max(z, r)
 */
static void put_thread(struct translator *t)
{
    const struct line_word *f = line_find(&t->line, 'f', 0);

    if (f != NULL)
        translate_add(&t->behind, "#<_pass_lead>=[%.*s]", (int)(f->end - f->value_begin),
                      &t->line.text[f->value_begin]);
    t->pass_known |= f != NULL ? KNOWN_LEAD : 0;
    if ((t->pass_known & KNOWN_LEAD) == 0)
        translate_wrong(t, NULL, "G92 on a lathe cuts a thread and needs F, its lead");
    translate_add(&t->behind, "#<_pass_w>=ABS[#<_pass_z>-#<_turning_z>]");
    translate_add(&t->behind,
                  "G33 X#<_pass_x> Z#<_pass_z> K[2*#<_pass_lead>*SQRT[#<_pass_w>**2+#<_pass_r>**2]/"
                  "[#<_pass_w>+ABS[#<_pass_r>]+ABS[#<_pass_w>-ABS[#<_pass_r>]]]]");
}

static void put_moves(struct translator *t)
{
    if (t->pass == 94) {
        translate_add(&t->behind, "G0 Z[#<_pass_z>+#<_pass_r>]");
        translate_add(&t->behind, "G1 X#<_pass_x> Z#<_pass_z>");
        translate_add(&t->behind, "Z#<_turning_z>");
        translate_add(&t->behind, "G0 X#<_turning_x>");
        return;
    }
    translate_add(&t->behind, "G0 X[#<_pass_x>+2*#<_pass_r>]");
    if (t->pass == 92)
        put_thread(t);
    else
        translate_add(&t->behind, "G1 X#<_pass_x> Z#<_pass_z>");
    translate_add(&t->behind, t->pass == 92 ? "G0 X#<_turning_x>" : "X#<_turning_x>");
    translate_add(&t->behind, "G0 Z#<_turning_z>");
}

void passes_translate(struct translator *t)
{
    follow_programs(t);
    if (!follow_motion(t))
        return;
    take_places(t);
    if ((t->pass_known & KNOWN_X) == 0 || (t->pass_known & KNOWN_Z) == 0)
        translate_wrong(t, NULL, "G%u on a lathe is a cycle and needs X or U, and Z or W", t->pass);
    put_moves(t);
}

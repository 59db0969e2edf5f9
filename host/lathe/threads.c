/*
 * Threads of lathes in one cut: G32 Z-20 F1.5 (of some G33 Z-20 F1.5) is G33 Z-20 K1.5. It holds
 * until another motion, and F with it. Along a cone F is measured along one of the axes and K along
 * the cone: those stay as they are, and are told.
 */
#include "lathe/lathe.h"

#include <stdio.h>

static bool moves_otherwise(struct line *l)
{
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    return motion || other;
}

static bool is_straight(struct line *l)
{
    return line_find(l, 'x', 0) == NULL || line_find(l, 'z', 0) == NULL;
}

static struct line_word *find_thread(struct line *l)
{
    struct line_word *w = line_find_code(l, 'g', 320);

    return w == NULL && line_find(l, 'k', 0) == NULL ? line_find_code(l, 'g', 330) : w;
}

static void keep_lead(struct translator *t)
{
    const struct line_word *f = line_find(&t->line, 'f', 0);
    const int length = f != NULL ? f->end - f->value_begin : 0;

    if (f != NULL && length + 2 <= (int)sizeof t->lead)
        (void)snprintf(t->lead, sizeof t->lead, "K%.*s", length, &t->line.text[f->value_begin]);
}

void threads_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *begin = find_thread(l);

    if (begin == NULL && moves_otherwise(l))
        t->cuts_thread = false;
    t->cuts_thread = t->cuts_thread || begin != NULL;
    if (!t->cuts_thread)
        return;
    keep_lead(t);
    if (!is_straight(l) || t->lead[0] == '\0')
        return;
    if (begin != NULL)
        (void)line_replace(l, begin, "G33");
    if (line_has_axis(l))
        (void)line_append(l, t->lead);
}

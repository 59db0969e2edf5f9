/*
 * An arc of a lathe of Fanuc without I, K and R is a straight line (parameter 3403, bit CIR), and
 * the arcs go on behind it:
 *
 *     G2 X20 Z-5 R5        G2 X20 Z-5 R5
 *     Z-9                  Z-9 G1
 *     X30 Z-14 R5          X30 Z-14 R5 G2
 */
#include "lathe/lathe.h"

#include <stdio.h>

static bool has_centre(struct line *l)
{
    return line_find(l, 'r', 0) != NULL || line_find(l, 'i', 0) != NULL ||
           line_find(l, 'k', 0) != NULL;
}

static struct line_word *find_arc(struct line *l)
{
    struct line_word *w = line_find_code(l, 'g', 20);

    return w != NULL ? w : line_find_code(l, 'g', 30);
}

static void make_straight(struct translator *t, struct line_word *arc)
{
    struct line *l = &t->line;
    const struct line_word *axis = line_find(l, 'x', 0);

    translate_note(t, axis != NULL ? axis : line_find(l, 'z', 0), "centre of an arc: straight");
    if (arc != NULL)
        (void)line_replace(l, arc, "G1");
    else
        (void)line_append(l, "G1");
}

void arcs_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *arc = find_arc(l);
    bool motion;
    bool other;
    char text[8];

    line_look_for_motion(l, &motion, &other);
    if (arc != NULL)
        t->arc = (unsigned)(line_code(arc) / 10);
    else if (motion)
        t->arc = 0;
    if (t->arc == 0 || other || (line_find(l, 'x', 0) == NULL && line_find(l, 'z', 0) == NULL))
        return;
    (void)snprintf(text, sizeof text, "G%u", t->arc);
    if (!has_centre(l))
        make_straight(t, arc);
    else if (arc == NULL)
        (void)line_append(l, text);
}

/*
 * Round pockets of Haas: G12 clockwise, G13 counterclockwise, from the centre and back to it.
 *
 *     G13 Z-1. I5. D1 F300            half a circle out to the radius, a whole one, half a one back
 *     G13 Z-1. I5. K20. Q4. D1 F300   and between them circles that grow by Q up to K
 *
 * With D the tool's radius is taken off.
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

#define POCKET_LABEL 96000000U

static void value(struct line *l, char letter, const char *otherwise, char text[48])
{
    const struct line_word *w = line_find(l, letter, 0);

    if (w != NULL && w->kind == WORD_VALUE)
        (void)snprintf(text, 48, "%.*s", (int)(w->end - w->value_begin), &l->text[w->value_begin]);
    else
        (void)snprintf(text, 48, "%s", otherwise);
}

/* F, which holds from here on, and Z. */
static void go_down(struct translator *t)
{
    struct line *l = &t->line;
    char z[48];
    char f[48];

    value(l, 'z', "", z);
    value(l, 'f', "", f);
    (void)line_read(l, "", 0);
    if (f[0] != '\0')
        translate_add(&t->behind, "F%s", f);
    if (z[0] != '\0')
        translate_add(&t->behind, "G1 Z%s", z);
}

void pocket_translate(struct translator *t)
{
    struct line *l = &t->line;
    const bool clockwise = line_find_code(l, 'g', 120) != NULL;
    const unsigned arc = clockwise ? 2 : 3;
    const unsigned label = POCKET_LABEL + t->number % 1000000U;
    const char *tool = line_find(l, 'd', 0) != NULL ? "#5410/2" : "0";
    char first[48];
    char last[48];
    char step[48];

    if ((!clockwise && line_find_code(l, 'g', 130) == NULL) || line_find(l, 'i', 0) == NULL ||
        line_find(l, 'l', 0) != NULL || t->across != 'k')
        return;
    value(l, 'i', "0", first);
    value(l, 'k', first, last);
    value(l, 'q', "0", step);
    if (line_find(l, 'k', 0) != NULL && line_find(l, 'q', 0) == NULL)
        return;
    go_down(t);
    translate_add(&t->behind, "#<_pocket>=[[%s]-%s] #<_pocket_last>=[[%s]-%s]", first, tool, last,
                  tool);
    translate_add(&t->behind, "G91 G91.1 G%u X#<_pocket> Y0 I[#<_pocket>/2] J0", arc);
    translate_add(&t->behind, "G%u I[-#<_pocket>] J0", arc);
    translate_add(&t->behind, "o%u while [#<_pocket> LT #<_pocket_last>]", label);
    translate_add(&t->behind, "#<_pocket_was>=#<_pocket>");
    translate_add(&t->behind, "#<_pocket>=[#<_pocket>+[%s]]", step);
    translate_add(&t->behind, "o%u if [#<_pocket> GT #<_pocket_last>]", label + 1000000U);
    translate_add(&t->behind, "#<_pocket>=#<_pocket_last>");
    translate_add(&t->behind, "o%u endif", label + 1000000U);
    translate_add(&t->behind, "G1 X[#<_pocket>-#<_pocket_was>]");
    translate_add(&t->behind, "G%u I[-#<_pocket>] J0", arc);
    translate_add(&t->behind, "o%u endwhile", label);
    translate_add(&t->behind, "G%u X[-#<_pocket>] Y0 I[-#<_pocket>/2] J0", arc);
    translate_add(&t->behind, t->incremental ? "G1 G91" : "G1 G90");
}

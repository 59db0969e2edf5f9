/*
 * Without a rotary axis in the whole program the tool stays upright, and leading its tip (G43.4) is
 * what G43 does; a plane that is tilted by nothing (G68.2) is no other plane, and G53.1 has nothing
 * to turn.
 */
#include "dialect/translate.h"

#include <string.h>

/* A rotary axis; arguments of macros have letters of their own. */
bool upright_turns(struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        if (l->word[i].kind == WORD_VALUE && strchr("abc", l->word[i].letter) != NULL)
            return line_find_code(l, 'g', 650) == NULL && line_find_code(l, 'g', 660) == NULL;
    }
    return false;
}

void upright_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *tip = line_find_code(l, 'g', 434);
    struct line_word *plane = line_find_code(l, 'g', 682);
    struct line_word *turn = line_find_code(l, 'g', 531);
    bool tilted = false;

    if (t->survey.rotary)
        return;
    if (tip != NULL)
        (void)line_replace(l, tip, "G43");
    if (turn != NULL)
        line_blank(l, turn);
    for (unsigned i = 0; i < l->words && plane != NULL; i++)
        tilted = tilted || (strchr("xyzijk", l->word[i].letter) != NULL &&
                            (!l->word[i].is_number || l->word[i].value != 0.0));
    if (plane != NULL && !tilted)
        (void)line_read(l, "", 0);
}

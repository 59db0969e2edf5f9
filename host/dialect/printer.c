/*
 * Of a program for a printer the way of the nozzle is left.
 */
#include "dialect/translate.h"

#include <string.h>

/* PRINT_START BED=60: a macro of the printer. PAUSE waits for somebody. */
void printer_leave_macro(struct translator *t)
{
    struct line *l = &t->line;
    const size_t length = line_macro_length(l);
    const struct line_word name = {.begin = 0, .end = (uint16_t)length};

    if (length == 0)
        return;
    if (length == strlen("pause") && line_begins(l->text, "pause")) {
        (void)line_read(l, "M0", 2);
        return;
    }
    translate_note(t, &name, "macro of the printer");
    (void)line_read(l, "", 0);
}

/* G0 goes at the feed in effect, as G1 does. */
static void translate_travel(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *rapid = line_find_code(l, 'g', 0);

    t->feeds = t->feeds || line_find(l, 'f', 0) != NULL;
    if (rapid != NULL && t->feeds)
        (void)line_replace(l, rapid, "G1");
}

/* G28 X: what G92 has said of an axis is taken away; an offset of its system stays. */
static void translate_home(struct translator *t)
{
    struct line *l = &t->line;
    bool named = false;
    char text[64];

    if (line_find_code(l, 'g', 280) == NULL)
        return;
    for (unsigned i = 0; i < l->words; i++) {
        const char letter = l->word[i].letter;

        if (l->word[i].kind > WORD_BARE || letter < 'x' || letter > 'z')
            continue;
        named = true;
        registers_unshifted(letter, text, sizeof text);
        translate_add(&t->behind, "G92 %s", text);
    }
    if (!named)
        translate_add(&t->behind, "G92.1");
}

void printer_translate(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *shift = line_find_code(l, 'g', 920);

    for (unsigned i = 0; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->letter == 'e' && (w->kind == WORD_VALUE || w->kind == WORD_BARE))
            line_blank(l, w);
    }
    if (shift != NULL && !line_has_axis(l))
        line_blank(l, shift);
    translate_travel(t);
    translate_home(t);
}

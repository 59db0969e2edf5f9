/*
 * Codes: what the machine file declares (declared.c), then what the table of differences has.
 */
#include "dialect/difference.h"
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

static void drop_words(struct translator *t, struct line_word *w, const char *letters)
{
    struct line *l = &t->line;
    unsigned i = (unsigned)(w - l->word);

    line_blank(l, w);
    for (i++;
         i < l->words && l->word[i].kind == WORD_VALUE && strchr("gm", l->word[i].letter) == NULL;
         i++) {
        if (strchr(letters, l->word[i].letter) != NULL)
            line_blank(l, &l->word[i]);
    }
}

void codes_drop(struct translator *t, struct line_word *w)
{
    drop_words(t, w, TRANSLATE_OWN_WORDS);
}

/* False: nothing is left of the line. */
static bool use_difference(struct translator *t, struct line_word *w, const struct difference *row)
{
    if (row->kind == DIFFERENCE_REPLACE) {
        (void)line_replace(&t->line, w, row->text);
        return true;
    }
    if (row->kind != DIFFERENCE_QUIET)
        translate_note(t, w, row->text);
    if (row->kind == DIFFERENCE_AXES) {
        drop_words(t, w, TRANSLATE_OWN_WORDS LINE_AXES);
        return true;
    }
    if (row->kind != DIFFERENCE_LINE) {
        codes_drop(t, w);
        return true;
    }
    if (line_code(w) == 1170) /* M117 shows the rest of its line */
        translate_message(t, &t->line.text[w->end], t->line.length - w->end);
    (void)line_read(&t->line, "", 0);
    return false;
}

static bool has_words(const struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        if (l->word[i].kind != WORD_COMMENT)
            return l->word[i].letter != '%';
    }
    return false;
}

/* F that the machine file declares: before the first words, and instead of F0. */
static void translate_feed(struct translator *t)
{
    const struct dialect_code *feed = NULL;
    struct line_word *f = line_find(&t->line, 'f', 0);

    for (unsigned i = 0; i < t->codes->count; i++)
        feed = t->codes->code[i].use == DIALECT_FEED ? &t->codes->code[i] : feed;
    if (feed == NULL)
        return;
    if (!t->feed_given && has_words(&t->line)) {
        t->feed_given = true;
        translate_add(&t->before, "F%u", feed->number);
    }
    if (f != NULL && f->is_number && f->value == 0.0)
        line_blank(&t->line, f);
}

void codes_translate(struct translator *t)
{
    struct line *l = &t->line;

    if (t->absolute && has_words(l)) {
        t->absolute = false;
        translate_add(&t->before, "G90.1");
    }
    translate_feed(t);
    for (unsigned i = 0; i < l->words; i++) {
        struct line_word *w = &l->word[i];
        const struct dialect_code *code = codes_find(t->codes, w);
        const int number = line_code(w);

        if (code != NULL) {
            declared_use(t, w, code);
            continue;
        }
        const struct difference *row =
            number >= 0 ? difference_find(t->dialect, w->letter, (unsigned)number) : NULL;

        if (row != NULL && !use_difference(t, w, row))
            return;
    }
}

/*
 * Codes: what the machine file declares, then what the table of differences has.
 */
#include "dialect/difference.h"
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/* Words that only the code in front of them can mean: not F, S, T and the axes. */
#define OWN_WORDS "dehijklpqruvw"

static void drop_code(struct translator *t, struct line_word *w)
{
    struct line *l = &t->line;
    unsigned i = (unsigned)(w - l->word);

    line_blank(l, w);
    for (i++;
         i < l->words && l->word[i].kind == WORD_VALUE && strchr("gm", l->word[i].letter) == NULL;
         i++) {
        if (strchr(OWN_WORDS, l->word[i].letter) != NULL)
            line_blank(l, &l->word[i]);
    }
}

static bool is_letter(const struct line_word *w)
{
    return w->kind == WORD_VALUE && strchr("uvw", w->letter) != NULL;
}

const struct dialect_code *codes_find(const struct dialect_codes *codes, const struct line_word *w)
{
    const int number = is_letter(w) ? 0 : line_code(w);

    for (unsigned i = 0; i < codes->count && number >= 0; i++) {
        if (codes->code[i].letter == w->letter && codes->code[i].number_x10 == number)
            return &codes->code[i];
    }
    return NULL;
}

/*
 * A letter whose axis bears another one. U V W are lengths: in inches where X is, while A B C count the same in all units.
 */
static void use_axis(struct translator *t, struct line_word *w, const struct dialect_code *code)
{
    struct line *l = &t->line;
    const bool converts = strchr("ABC", code->axis) != NULL;
    const char *inch = line_find_code(l, 'g', 200) != NULL   ? "1"
                       : line_find_code(l, 'g', 210) != NULL ? "0"
                                                             : "#<_imperial>";
    char text[LINE_MAX_BYTES];

    if (converts)
        (void)snprintf(text, sizeof text, "%c[[%.*s]*[1+24.4*%s]]", code->axis,
                       (int)(w->end - w->value_begin), &l->text[w->value_begin], inch);
    else
        (void)snprintf(text, sizeof text, "%c%.*s", code->axis, (int)(w->end - w->value_begin),
                       &l->text[w->value_begin]);
    (void)line_replace(l, w, text);
}

/* The value of a word behind the code, which the code has for itself. */
static void take_argument(struct line *l, unsigned from, char letter, char *text, size_t size)
{
    (void)snprintf(text, size, "0");
    for (unsigned i = from; i < l->words && strchr(OWN_WORDS, l->word[i].letter) != NULL; i++) {
        const struct line_word *w = &l->word[i];

        if (w->kind == WORD_VALUE && w->letter == letter)
            (void)snprintf(text, size, "%.*s", (int)(w->end - w->value_begin),
                           &l->text[w->value_begin]);
    }
}

static void call_subroutine(struct translator *t, struct line_word *w,
                            const struct dialect_code *code)
{
    const unsigned from = (unsigned)(w - t->line.word) + 1;
    char p[64];
    char q[64];
    char r[64];

    take_argument(&t->line, from, 'p', p, sizeof p);
    take_argument(&t->line, from, 'q', q, sizeof q);
    take_argument(&t->line, from, 'r', r, sizeof r);
    translate_add(&t->behind, "o<%s> call [%s] [%s] [%s]", code->subroutine, p, q, r);
}

static void use_declared(struct translator *t, struct line_word *w, const struct dialect_code *code)
{
    switch (code->use) {
    case DIALECT_IGNORE:
        break;
    case DIALECT_STOP:
        translate_add(&t->behind, "M0");
        break;
    case DIALECT_OUTPUT_ON:
    case DIALECT_OUTPUT_OFF:
        translate_add(&t->behind, "M%u P%u", code->use == DIALECT_OUTPUT_ON ? 64U : 65U,
                      code->number);
        break;
    case DIALECT_FEED:
    case DIALECT_HEIGHT:
    case DIALECT_DISTANCE:
        return;
    case DIALECT_SUBROUTINE:
        call_subroutine(t, w, code);
        break;
    case DIALECT_AXIS:
        use_axis(t, w, code);
        return;
    }
    if (is_letter(w))
        line_blank(&t->line, w);
    else
        drop_code(t, w);
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
    if (row->kind != DIFFERENCE_LINE) {
        drop_code(t, w);
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
            use_declared(t, w, code);
            continue;
        }
        const struct difference *row =
            number >= 0 ? difference_find(t->dialect, w->letter, (unsigned)number) : NULL;

        if (row != NULL && !use_difference(t, w, row))
            return;
    }
}

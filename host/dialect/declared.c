/* What becomes of a line by what the machine file declares its codes as. */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/*
 * A letter whose axis bears another one. U V W are lengths: in inches where X is, while A B C count
 * the same in all units.
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
    for (unsigned i = from; i < l->words && strchr(TRANSLATE_OWN_WORDS, l->word[i].letter) != NULL;
         i++) {
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

void declared_use(struct translator *t, struct line_word *w, const struct dialect_code *code)
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
    if (codes_is_letter(w))
        line_blank(&t->line, w);
    else
        codes_drop(t, w);
}

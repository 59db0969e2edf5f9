/*
 * Subprograms and macros of Fanuc and Haas in O-words.
 *
 *     G65 P1000 A1 B2             o1000 call [1] [2] ...; O1000 ... M99 is then o1000 sub ... o1000 endsub
 *     G65 P1000 L3 A1             the same three times
 *     G66 P1000 A1 ... G67        the same call behind each line that moves
 *     M97 P30                     M98 of a program that begins at N30, behind the end
 */
#include "dialect/translate.h"

#include <stdio.h>
#include <string.h>

/* Programs that begin at lines. */
#define LOCAL_FIRST  97000000U
#define REPEAT_LABEL 99000000U
/*
 * Arguments of G65: A to Z are #1 to #26, in Fanuc's order. I, J and K that come again are #7 and
 * on, up to what a call takes.
 */
#define LETTERS      26
#define ARGUMENTS    30
#define ARGUMENT_MAX 48

static bool has(const uint32_t *numbers, unsigned count, uint32_t number)
{
    for (unsigned i = 0; i < count; i++) {
        if (numbers[i] == number)
            return true;
    }
    return false;
}

static void remember(uint32_t *numbers, unsigned *count, double number)
{
    if (*count < TRANSLATE_PROGRAMS_MAX && !has(numbers, *count, line_whole(number)))
        numbers[(*count)++] = line_whole(number);
}

/* M98 Q300 without P calls a line: M97 P300. */
static void name_local(struct line *l)
{
    struct line_word *call = line_find_code(l, 'm', 980);
    const struct line_word *q = line_find(l, 'q', 0);

    if (call == NULL || q == NULL || line_find(l, 'p', 0) != NULL)
        return;
    l->text[q->begin] = 'P';
    (void)line_replace(l, call, "M97");
}

/* M97 calls a line; one behind the end of the program can be a program of its own. */
static void survey_locals(struct survey *s, struct line *l)
{
    name_local(l);
    const struct line_word *number = line_number(l);
    const struct line_word *p = line_find(l, 'p', 0);

    if (p != NULL && p->is_number && line_find_code(l, 'm', 970) != NULL)
        remember(s->call, &s->calls, p->value);
    if (number != NULL && s->ended && has(s->call, s->calls, line_whole(number->value)))
        remember(s->local, &s->locals, number->value);
    s->ended = s->ended || line_find_code(l, 'm', 20) != NULL ||
               line_find_code(l, 'm', 300) != NULL || line_find_code(l, 'm', 990) != NULL;
}

void calls_survey(struct survey *s, struct line *l)
{
    const struct line_word *first = l->words > 0 ? &l->word[0] : NULL;
    const struct line_word *p = line_find(l, 'p', 0);

    if (first != NULL && first->letter == 'o' && first->is_number)
        remember(s->program, &s->programs, first->value);
    if (p != NULL && p->is_number &&
        (line_find_code(l, 'g', 650) != NULL || line_find_code(l, 'g', 660) != NULL))
        remember(s->macro, &s->macros, p->value);
    survey_locals(s, l);
}

/* ---- arguments ---- */

/* Which of #1 to #26 a letter is; 0: none. */
static unsigned argument_of(char letter)
{
    static const char letters[] = "abcijkde.h..m...qrstuvwxyz";
    const char *at = strchr(letters, letter);

    return at != NULL && letter != '.' ? (unsigned)(at - letters) + 1 : 0;
}

static void write_call(char text[TRANSLATE_CALL_MAX], uint32_t program,
                       char arguments[ARGUMENTS][ARGUMENT_MAX])
{
    size_t length = (size_t)snprintf(text, TRANSLATE_CALL_MAX, "o%u call", (unsigned)program);
    unsigned count = ARGUMENTS;

    while (count > LETTERS && strcmp(arguments[count - 1], "0") == 0)
        count--;
    for (unsigned i = 0; i < count; i++)
        length +=
            (size_t)snprintf(text + length, TRANSLATE_CALL_MAX - length, " [%s]", arguments[i]);
}

/* I, J and K may come again: of each the next number behind the one before. 0: not one of them. */
static unsigned next_of_three(char letter, unsigned *before)
{
    const unsigned first = letter >= 'i' && letter <= 'k' ? 4U + (unsigned)(letter - 'i') : 0;
    unsigned number = first;

    while (first > 0 && number <= *before)
        number += 3;
    *before = first > 0 ? number : *before;
    return number;
}

/* What stands behind the code; what is not given is 0. */
static void read_arguments(struct translator *t, const struct line_word *code,
                           char arguments[ARGUMENTS][ARGUMENT_MAX])
{
    const struct line *l = &t->line;
    unsigned before = 0;

    for (unsigned i = 0; i < ARGUMENTS; i++)
        (void)snprintf(arguments[i], sizeof arguments[i], "0");
    for (const struct line_word *w = code + 1; w < l->word + l->words; w++) {
        const unsigned three = w->kind == WORD_VALUE ? next_of_three(w->letter, &before) : 0;
        const unsigned number = three > 0               ? three
                                : w->kind == WORD_VALUE ? argument_of(w->letter)
                                                        : 0;
        const int length = w->end - w->value_begin;

        if (number > ARGUMENTS || (number > 0 && length >= ARGUMENT_MAX))
            translate_wrong(t, w, "'%.40s': an argument as far as #%u, with %u characters at most",
                            &l->text[w->begin], ARGUMENTS, ARGUMENT_MAX - 1);
        else if (number > 0)
            (void)snprintf(arguments[number - 1], sizeof arguments[0], "%.*s", length,
                           &l->text[w->value_begin]);
    }
}

/* ---- calls ---- */

/* A call, as often as L says. */
static void put_call(struct translator *t, const char *call, const char *times)
{
    const unsigned label = REPEAT_LABEL + t->number % 1000000U;

    if (times[0] != '\0')
        translate_add(&t->behind, "o%u repeat [%s]", label, times);
    translate_add(&t->behind, "%s", call);
    if (times[0] != '\0')
        translate_add(&t->behind, "o%u endrepeat", label);
}

/* G65 P1000 A1, and G66, which calls from the next line on; what stands before is done before. */
static void take_macro_call(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *p = line_find(l, 'p', 0);
    const struct line_word *times = line_find(l, 'l', 0);
    const struct line_word *once = line_find_code(l, 'g', 650);
    const struct line_word *code = once != NULL ? once : line_find_code(l, 'g', 660);
    char arguments[ARGUMENTS][ARGUMENT_MAX];
    char text[TRANSLATE_CALL_MAX];
    char count[ARGUMENT_MAX] = "";

    if (code == NULL || p == NULL || !p->is_number)
        return;
    read_arguments(t, code, arguments);
    write_call(text, line_whole(p->value), arguments);
    if (times != NULL)
        (void)snprintf(count, sizeof count, "%.*s", (int)(times->end - times->value_begin),
                       &l->text[times->value_begin]);
    if (once != NULL) {
        put_call(t, text, count);
    } else {
        memcpy(t->modal_call, text, sizeof text);
        memcpy(t->modal_times, count, sizeof count);
    }
    (void)line_read(l, l->text, code->begin);
}

/* Between G66 and G67; the macro itself moves without calling itself. */
static void take_modal_call(struct translator *t)
{
    if (line_find_code(&t->line, 'g', 670) != NULL)
        t->modal_call[0] = '\0';
    else if (t->modal_call[0] != '\0' && t->macro == 0 && line_has_axis(&t->line))
        put_call(t, t->modal_call, t->modal_times);
}

/* M98 of a program that G65 calls too: it sees its caller's parameters. */
static void take_sub_call(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *p = line_find(l, 'p', 0);
    char arguments[ARGUMENTS][ARGUMENT_MAX];
    char call[TRANSLATE_CALL_MAX];
    char text[32];

    if (line_find_code(l, 'm', 980) == NULL || p == NULL || !p->is_number)
        return;
    const uint32_t number = line_whole(p->value);

    if (has(t->survey.macro, t->survey.macros, number)) {
        for (unsigned i = 0; i < ARGUMENTS; i++)
            (void)snprintf(arguments[i], sizeof arguments[i], "#%u", i + 1);
        write_call(call, number, arguments);
        translate_add(&t->behind, "%s", call);
        (void)line_read(l, "", 0);
    } else if (number > 9999 && line_find(l, 'l', 0) == NULL &&
               !has(t->survey.program, t->survey.programs, number) &&
               has(t->survey.program, t->survey.programs, number % 10000)) {
        (void)snprintf(text, sizeof text, "P%u L%u", (unsigned)(number % 10000),
                       (unsigned)(number / 10000));
        (void)line_replace(l, p, text);
    }
}

static void end_macro(struct translator *t)
{
    if (t->macro != 0)
        translate_add(&t->before, "o%u endsub", (unsigned)t->macro);
    t->macro = 0;
}

/* M97 P300 is M98 of a program that begins at N300. */
static void take_local(struct translator *t)
{
    struct line *l = &t->line;
    const struct survey *s = &t->survey;
    const struct line_word *number = line_number(l);

    name_local(l);
    struct line_word *call = line_find_code(l, 'm', 970);
    struct line_word *p = line_find(l, 'p', 0);
    char text[32];

    if (s->programs > 1)
        return;
    if (number != NULL && has(s->local, s->locals, line_whole(number->value))) {
        t->program++;
        translate_add(&t->before, "O%u", (unsigned)(LOCAL_FIRST + line_whole(number->value)));
    }
    if (call == NULL || p == NULL || !p->is_number ||
        !has(s->local, s->locals, line_whole(p->value)))
        return;
    (void)snprintf(text, sizeof text, "P%u", (unsigned)(LOCAL_FIRST + line_whole(p->value)));
    (void)line_replace(l, call, "M98");
    p = line_find(l, 'p', 0);
    if (p != NULL)
        (void)line_replace(l, p, text);
}

/* O1000, M99 and the second % */
static void take_program(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *first = l->words > 0 ? &l->word[0] : NULL;
    struct line_word *back = line_find_code(l, 'm', 990);
    char text[32];

    if (first != NULL && first->letter == 'o' && first->is_number) {
        end_macro(t);
        flow_end_program(t);
        t->program++;
        if (has(t->survey.macro, t->survey.macros, line_whole(first->value))) {
            t->macro = line_whole(first->value);
            (void)snprintf(text, sizeof text, "o%u sub", (unsigned)t->macro);
            (void)line_replace(l, first, text);
        }
    } else if (first != NULL && first->letter == '%') {
        end_macro(t);
    } else if (back != NULL && t->macro != 0) {
        line_blank(l, back);
        translate_add(&t->behind, "o%u return", (unsigned)t->macro);
    }
}

void calls_translate(struct translator *t)
{
    take_program(t);
    take_local(t);
    take_modal_call(t);
    take_macro_call(t);
    take_sub_call(t);
}

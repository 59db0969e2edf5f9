/*
 * Flow of Fanuc's macros in O-words.
 *
 *     WHILE [a] DO1 ... END1      o91000001 while [a] ... o91000001 endwhile
 *     IF [a] THEN x               o9200nnnn if [a] / x / o9200nnnn endif
 *     GOTO 10                     o<place> goto [line] [loops]: filled in when all lines have their places
 *     G65 P1000 A1 B2             o1000 call [1] [2] ...; O1000 ... M99 is then o1000 sub ... o1000 endsub
 *     G66 P1000 A1 ... G67        the same call behind each line that moves
 */
#include "dialect/translate.h"

#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOOP_LABEL 91000000U
#define IF_LABEL   92000000U
/* Programs that begin at lines. */
#define LOCAL_FIRST 97000000U
/* Arguments of G65: A to Z are #1 to #26, in Fanuc's order. */
#define ARGUMENTS 26
#define TEXT_MAX  1024

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
    const struct line_word *first = l->words > 0 ? &l->word[0] : NULL;

    name_local(l);
    const struct line_word *p = line_find(l, 'p', 0);

    if (p != NULL && p->is_number && line_find_code(l, 'm', 970) != NULL)
        remember(s->call, &s->calls, p->value);
    if (first != NULL && first->letter == 'n' && first->is_number && s->ended &&
        has(s->call, s->calls, line_whole(first->value)))
        remember(s->local, &s->locals, first->value);
    s->ended = s->ended || line_find_code(l, 'm', 20) != NULL ||
               line_find_code(l, 'm', 300) != NULL || line_find_code(l, 'm', 990) != NULL;
}

void flow_survey(struct survey *s, struct line *l)
{
    const struct line_word *first = l->words > 0 ? &l->word[0] : NULL;
    const struct line_word *p = line_find(l, 'p', 0);

    if (first != NULL && first->letter == 'o' && first->is_number)
        remember(s->program, &s->programs, first->value);
    if (p != NULL && p->is_number &&
        (line_find_code(l, 'g', 650) != NULL || line_find_code(l, 'g', 660) != NULL))
        remember(s->macro, &s->macros, p->value);
    survey_locals(s, l);
    for (unsigned i = 0; i < l->words; i++)
        s->jumps = s->jumps || line_is_keyword(l, &l->word[i], "goto");
}

static void copy(const struct line *l, const struct line_word *w, char *text, size_t size)
{
    (void)snprintf(text, size, "%.*s", (int)(w->end - w->begin), &l->text[w->begin]);
}

/* ---- loops and branches ---- */

/* The number behind GOTO is a word without a letter: digits among what is left of the line. */
static bool read_target(const struct line *l, const struct line_word *w, uint32_t *number)
{
    char *end;
    const char *begin = &l->text[w->end];

    *number = (uint32_t)strtoul(begin, &end, 10);
    return end != begin;
}

static void take_while(struct translator *t, unsigned at)
{
    struct line *l = &t->line;
    char condition[TEXT_MAX] = "[1]";
    uint32_t number = 0;

    for (unsigned i = at; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind == WORD_BRACKET)
            copy(l, w, condition, sizeof condition);
        if (line_is_keyword(l, w, "do"))
            (void)read_target(l, w, &number);
    }
    translate_add(&t->before, "o%u while %s", LOOP_LABEL + number, condition);
    t->depth++;
    line_read(l, "", 0);
}

static void take_end(struct translator *t, unsigned at)
{
    uint32_t number = 0;

    (void)read_target(&t->line, &t->line.word[at], &number);
    translate_add(&t->behind, "o%u endwhile", LOOP_LABEL + number);
    t->depth -= t->depth > 0 ? 1 : 0;
    line_read(&t->line, "", 0);
}

static void take_goto(struct translator *t, unsigned at)
{
    uint32_t number = 0;

    if (!read_target(&t->line, &t->line.word[at], &number))
        return;
    line_read(&t->line, "", 0);
    jumps_go_to(t, number, JUMP_ANYWHERE);
}

static void take_alarm(struct translator *t);

/* IF [a] GOTO 10; IF [a] THEN #1 = 2 */
static void take_if(struct translator *t, unsigned at)
{
    struct line *l = &t->line;
    const uint32_t label = IF_LABEL + t->number % 1000000U;
    char condition[TEXT_MAX];
    char rest[TEXT_MAX];
    unsigned then = at + 2;

    if (then >= l->words || l->word[at + 1].kind != WORD_BRACKET)
        return;
    copy(l, &l->word[at + 1], condition, sizeof condition);
    const bool jumps = line_is_keyword(l, &l->word[then], "goto");
    const size_t begin = jumps ? l->word[then].begin : l->word[then].end;

    (void)snprintf(rest, sizeof rest, "%s", &l->text[begin]);
    if (!jumps && !line_is_keyword(l, &l->word[then], "then"))
        return;
    translate_add(&t->before, "o%u if %s", label, condition);
    line_read(l, rest, strlen(rest));
    if (jumps)
        take_goto(t, 0);
    take_alarm(t);
    translate_add(&t->behind, "o%u endif", label);
}

/* #3000 = 1 (TEXT) is an alarm, #3006 = 1 (TEXT) a stop with a message. */
static void take_alarm(struct translator *t)
{
    struct line *l = &t->line;
    double number = 0.0;
    char text[TEXT_MAX] = "";

    for (unsigned i = 0; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind == WORD_COMMENT && w->letter == '(')
            (void)snprintf(text, sizeof text, "%.*s", (int)(w->end - w->begin) - 2,
                           &l->text[w->begin + 1]);
        if (w->kind == WORD_ASSIGNED)
            number = strtod(&l->text[w->begin + 1], NULL);
    }
    if (number != 3000.0 && number != 3006.0)
        return;
    line_read(l, "", 0);
    if (number == 3000.0) {
        translate_add(&t->behind, "(abort,%.200s)", text);
        return;
    }
    translate_message(t, text, strlen(text));
    translate_add(&t->behind, "M0");
}

/* ---- subprograms ---- */

/* Which of #1 to #26 a letter is; 0: none. */
static unsigned argument_of(char letter)
{
    static const char letters[] = "abcijkde.h..m...qrstuvwxyz";
    const char *at = strchr(letters, letter);

    return at != NULL && letter != '.' ? (unsigned)(at - letters) + 1 : 0;
}

static void write_call(char text[TRANSLATE_CALL_MAX], uint32_t program,
                       char arguments[ARGUMENTS][48])
{
    size_t length = (size_t)snprintf(text, TRANSLATE_CALL_MAX, "o%u call", (unsigned)program);

    for (unsigned i = 0; i < ARGUMENTS; i++)
        length +=
            (size_t)snprintf(text + length, TRANSLATE_CALL_MAX - length, " [%s]", arguments[i]);
}

/* A to Z of the line; what is not given is 0. */
static void read_arguments(const struct line *l, char arguments[ARGUMENTS][48])
{
    for (unsigned i = 0; i < ARGUMENTS; i++)
        (void)snprintf(arguments[i], sizeof arguments[i], "0");
    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];
        const unsigned number = w->kind == WORD_VALUE ? argument_of(w->letter) : 0;

        if (number > 0)
            (void)snprintf(arguments[number - 1], sizeof arguments[0], "%.*s",
                           (int)(w->end - w->value_begin), &l->text[w->value_begin]);
    }
}

/* G65 P1000 A1 B2, and G66, which calls from the next line on. */
static void take_macro_call(struct translator *t)
{
    struct line *l = &t->line;
    const struct line_word *p = line_find(l, 'p', 0);
    const bool once = line_find_code(l, 'g', 650) != NULL;
    char arguments[ARGUMENTS][48];
    char text[TRANSLATE_CALL_MAX];

    if ((!once && line_find_code(l, 'g', 660) == NULL) || p == NULL || !p->is_number)
        return;
    read_arguments(l, arguments);
    write_call(text, line_whole(p->value), arguments);
    if (once)
        translate_add(&t->behind, "%s", text);
    else
        memcpy(t->modal_call, text, sizeof text);
    (void)line_read(l, "", 0);
}

/* Between G66 and G67; the macro itself moves without calling itself. */
static void take_modal_call(struct translator *t)
{
    if (line_find_code(&t->line, 'g', 670) != NULL)
        t->modal_call[0] = '\0';
    else if (t->modal_call[0] != '\0' && t->macro == 0 && line_has_axis(&t->line))
        translate_add(&t->behind, "%s", t->modal_call);
}

/* M98 of a program that G65 calls too: it sees its caller's parameters. */
static void take_sub_call(struct translator *t)
{
    struct line *l = &t->line;
    struct line_word *p = line_find(l, 'p', 0);
    char arguments[ARGUMENTS][48];
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
    const struct line_word *first = l->words > 0 ? &l->word[0] : NULL;

    name_local(l);
    struct line_word *call = line_find_code(l, 'm', 970);
    struct line_word *p = line_find(l, 'p', 0);
    char text[32];

    if (s->programs > 1)
        return;
    if (first != NULL && first->letter == 'n' && first->is_number &&
        has(s->local, s->locals, line_whole(first->value))) {
        t->program++;
        translate_add(&t->before, "O%u", (unsigned)(LOCAL_FIRST + line_whole(first->value)));
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
        t->program++;
        t->depth = 0;
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

static bool has_keyword(const struct line *l, const char *keyword, unsigned *at)
{
    for (*at = 0; *at < l->words; (*at)++) {
        if (line_is_keyword(l, &l->word[*at], keyword))
            return true;
    }
    return false;
}

void flow_translate(struct translator *t)
{
    struct line *l = &t->line;
    unsigned at;

    take_program(t);
    take_local(t);
    take_modal_call(t);
    take_macro_call(t);
    take_sub_call(t);
    if (has_keyword(l, "if", &at))
        take_if(t, at);
    else if (has_keyword(l, "while", &at) || has_keyword(l, "do", &at))
        take_while(t, at);
    else if (has_keyword(l, "end", &at))
        take_end(t, at);
    else if (has_keyword(l, "goto", &at))
        take_goto(t, at);
    else
        take_alarm(t);
}

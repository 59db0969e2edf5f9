/*
 * Flow of Fanuc's macros in O-words.
 *
 *     WHILE [a] DO1 ... END1      o91000001 while [a] ... o91000001 endwhile
 *     IF [a] THEN x               o9200nnnn if [a] / x / o9200nnnn endif
 *     GOTO 10                     o<place> goto [line] [loops]: filled in when all lines have their places
 *     GOTO #1                     one of these for each N of the program, behind the question for it
 */
#include "dialect/translate.h"

#include "translation/jumps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOOP_LABEL 91000000U
#define IF_LABEL   92000000U
#define TEXT_MAX   (LINE_MAX_BYTES + 1)

/* Numbers that a jump may go to. */
static void survey_target(struct survey *s, uint32_t number)
{
    if (s->targets > TRANSLATE_TARGETS_MAX)
        return;
    for (unsigned i = 0; i < s->targets; i++) {
        if (s->target[i] == number)
            return;
    }
    if (s->targets < TRANSLATE_TARGETS_MAX)
        s->target[s->targets] = number;
    s->targets++;
}

void flow_survey(struct survey *s, const struct line *l)
{
    const struct line_word *number = line_number(l);

    if (number != NULL)
        survey_target(s, line_whole(number->value));
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

static void open_loop(struct translator *t, uint32_t number)
{
    if (t->depth < TRANSLATE_LINES_MAX)
        t->loop[t->depth++] = (struct loop){number, t->number};
    else
        translate_wrong(t, NULL, "DO%u: more than %u loops in one another", (unsigned)number,
                        TRANSLATE_LINES_MAX);
}

/* A loop ends before its program does. */
void flow_end_program(struct translator *t)
{
    const struct loop *open = t->depth > 0 ? &t->loop[t->depth - 1] : NULL;
    const uint32_t number = t->number;

    if (open != NULL) {
        t->number = open->line;
        translate_wrong(t, NULL, "DO%u has no END%u in this program", (unsigned)open->number,
                        (unsigned)open->number);
        t->number = number;
    }
    t->depth = 0;
}

static void take_while(struct translator *t, unsigned at)
{
    struct line *l = &t->line;
    char condition[TEXT_MAX] = "";
    uint32_t number = 0;

    for (unsigned i = at; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind == WORD_BRACKET)
            copy(l, w, condition, sizeof condition);
        if (line_is_keyword(l, w, "do"))
            (void)read_target(l, w, &number);
    }
    if (condition[0] == '\0' && line_is_keyword(l, &l->word[at], "while"))
        translate_wrong(t, &l->word[at], "WHILE needs a condition in brackets");
    translate_add(&t->before, "o%u while %s", LOOP_LABEL + number,
                  condition[0] != '\0' ? condition : "[1]");
    open_loop(t, number);
    line_read(l, "", 0);
}

static void take_end(struct translator *t, unsigned at)
{
    uint32_t number = 0;

    (void)read_target(&t->line, &t->line.word[at], &number);
    if (t->depth == 0)
        translate_wrong(t, &t->line.word[at], "END%u: no DO%u is open here", (unsigned)number,
                        (unsigned)number);
    else if (t->loop[t->depth - 1].number != number)
        translate_wrong(t, &t->line.word[at], "END%u stands inside DO%u, which line %u begins",
                        (unsigned)number, (unsigned)t->loop[t->depth - 1].number,
                        (unsigned)t->loop[t->depth - 1].line);
    translate_add(&t->behind, "o%u endwhile", LOOP_LABEL + number);
    t->depth -= t->depth > 0 ? 1 : 0;
    line_read(&t->line, "", 0);
}

static void take_goto(struct translator *t, unsigned at)
{
    struct line *l = &t->line;
    const size_t begin = l->word[at].end;
    char expression[TEXT_MAX];
    uint32_t number = 0;

    if (read_target(l, &l->word[at], &number)) {
        line_read(l, "", 0);
        jumps_go_to(t, number, JUMP_ANYWHERE);
        return;
    }
    (void)snprintf(expression, sizeof expression, "%.*s", (int)strcspn(&l->text[begin], "(;\r"),
                   &l->text[begin]);
    line_read(l, "", 0);
    jumps_go_to_any(t, expression);
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

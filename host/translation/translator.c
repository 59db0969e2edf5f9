#include "translation/translator.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define LINE_TEXT_MAX 2304
/*
 * So much of a message is shown: with its parentheses it is a comment of a line that every control
 * reads.
 */
#define MESSAGE_MAX 201

void translate_add(struct dialect_text *t, const char *format, ...)
{
    static const char begin[] = {DIALECT_GOES_ON, '/'};
    char text[LINE_TEXT_MAX];
    va_list arguments;

    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);

    va_end(arguments);
    output_add(t, begin, t->slash ? 2 : 1);
    output_add(t, text, length < (int)sizeof text ? (size_t)length : sizeof text - 1);
    output_add(t, "\n", 1);
}

void translate_note(struct translator *t, const struct line_word *w, const char *meaning)
{
    struct dialect_result *r = t->result;
    struct dialect_note note = {.line = t->number, .column = w->begin + 1U, .meaning = meaning};

    (void)snprintf(note.word, sizeof note.word, "%.*s", (int)(w->end - w->begin),
                   &t->line.text[w->begin]);
    for (unsigned i = 0; i < r->notes; i++) {
        if (strcmp(r->note[i].word, note.word) == 0)
            return;
    }
    if (r->notes < DIALECT_NOTES_MAX)
        r->note[r->notes++] = note;
}

void translate_wrong(struct translator *t, const struct line_word *w, const char *format, ...)
{
    struct dialect_result *r = t->result;
    va_list arguments;

    if (r->wrong_line != 0)
        return;
    r->wrong_line = t->number;
    r->wrong_column = w != NULL ? w->begin + 1U : 1;
    va_start(arguments, format);
    (void)vsnprintf(r->wrong, sizeof r->wrong, format, arguments);
    va_end(arguments);
}

void translate_message(struct translator *t, const char *text, size_t length)
{
    char shown[MESSAGE_MAX];

    (void)snprintf(shown, sizeof shown, "%.*s", (int)length, text);
    for (char *c = shown; *c != '\0'; c++)
        *c = (char)(*c == '(' ? '[' : *c == ')' ? ']' : *c);
    translate_add(&t->behind, "(msg,%s)", shown);
}

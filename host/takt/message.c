#include "takt/message.h"

#include "takt/hint.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Length of a line shown below a message: more would not fit on a screen. */
#define MESSAGE_SHOWN_MAX    100
#define MESSAGE_SHOWN_BEFORE 60
/* Length of a line in which a word is looked for. */
#define MESSAGE_LINE_MAX 2048

static char message_command[32] = "takt";

void message_set_command(const char *name)
{
    (void)snprintf(message_command, sizeof message_command, "takt %s", name);
}

__attribute__((format(printf, 5, 0))) static void message_print(const char *kind, const char *file,
                                                                uint32_t line, uint32_t column,
                                                                const char *format,
                                                                va_list arguments)
{
    (void)fprintf(stderr, "%s:%u:%u: %s: ", file, (unsigned)line, (unsigned)column, kind);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
}

void message_error(const char *file, uint32_t line, uint32_t column, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_print("error", file, line, column, format, arguments);
    va_end(arguments);
}

void message_warning(const char *file, uint32_t line, uint32_t column, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_print("warning", file, line, column, format, arguments);
    va_end(arguments);
}

void message_command_error(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)fprintf(stderr, "%s: error: ", message_command);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
}

void message_command_warning(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)fprintf(stderr, "%s: warning: ", message_command);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
}

void message_command_note(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    (void)fprintf(stderr, "%s: note: ", message_command);
    (void)vfprintf(stderr, format, arguments);
    (void)fputc('\n', stderr);
    va_end(arguments);
}

const char *message_did_you_mean(const char *prefix, const char *word)
{
    static char text[96];

    if (word == NULL)
        return "";
    (void)snprintf(text, sizeof text, "; did you mean %s%s?", prefix, word);
    return text;
}

/* Bytes that a terminal would not print as one character are shown as a dot, so that the caret stays in place. */
static void message_show_line(const struct program_text *program, uint32_t line, uint32_t column)
{
    char text[MESSAGE_SHOWN_MAX];
    size_t at = column > 0 ? column - 1 : 0;
    size_t first = at > MESSAGE_SHOWN_BEFORE ? at - MESSAGE_SHOWN_BEFORE : 0;
    size_t length = program_text_line(program, line, first, text, sizeof text);

    if (length == 0)
        return;
    (void)fputs("    ", stderr);
    for (size_t i = 0; i < length; i++)
        (void)fputc(text[i] >= ' ' && text[i] <= '~' ? text[i]
                    : text[i] == '\t'                ? ' '
                                                     : '.',
                    stderr);
    (void)fputc('\n', stderr);
    if (column > 0)
        (void)fprintf(stderr, "    %*s^\n", (int)(at - first), "");
}

static char message_lower(char c)
{
    return (char)(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
}

/* Does a line go on with a word, whatever spaces and case? */
static bool message_goes_on(const char *line, size_t length, const char *word)
{
    size_t at = 0;

    for (; *word != '\0'; word++) {
        while (at < length && (line[at] == ' ' || line[at] == '\t'))
            at++;
        if (at == length || message_lower(line[at++]) != message_lower(*word))
            return false;
    }
    return true;
}

/* In a line that has been translated a word may stand elsewhere than where it was found; 0: it is not there at all. */
static uint32_t message_column(const struct program_text *program, const struct diagnostic *d)
{
    char line[MESSAGE_LINE_MAX];
    const size_t length = program->pieces > 0 && d->line > 0
                              ? program_text_line(program, d->line, 0, line, sizeof line)
                              : 0;
    const size_t at = d->column > 0 ? d->column - 1 : 0;

    if (length == 0 || (at < length && message_goes_on(line + at, length - at, d->word)))
        return d->column;
    for (size_t i = 0; i < length && d->word[0] != '\0'; i++) {
        if (line[i] != ' ' && message_goes_on(line + i, length - i, d->word))
            return (uint32_t)i + 1;
    }
    return 0;
}

static void message_diagnostic(const char *kind, const struct program_text *program,
                               const struct diagnostic *diagnostic)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    uint32_t line = diagnostic->line;
    const char *name = program_text_place(program, &line);
    const uint32_t column = message_column(program, diagnostic);

    diagnostic_text(diagnostic, text);
    /* Column 0 is the whole line, which begins at 1. */
    (void)fprintf(stderr, "%s:%u:%u: %s: %s\n", name, (unsigned)line,
                  (unsigned)(line > 0 && column == 0 ? 1 : column), kind, text);
    if (diagnostic->line > 0)
        message_show_line(program, diagnostic->line, column);
}

/* What to do about it. */
static void message_hint(const struct program_text *program, const struct diagnostic *d)
{
    char line[MESSAGE_LINE_MAX];
    char hint[HINT_MAX];
    const size_t length =
        d->line > 0 ? program_text_line(program, d->line, 0, line, sizeof line) : 0;
    const uint32_t column = message_column(program, d);

    hint_write(d, line, length, column > 0 ? column - 1 : length, hint);
    (void)fputs(hint, stderr);
}

void message_program_error(const struct program_text *program, const struct diagnostic *diagnostic)
{
    message_diagnostic("error", program, diagnostic);
    message_hint(program, diagnostic);
}

void message_program_warning(const struct program_text *program,
                             const struct diagnostic *diagnostic)
{
    message_diagnostic("warning", program, diagnostic);
}

void message_from_program(const struct program_text *program, uint32_t line, const char *text)
{
    const char *name = program_text_place(program, &line);

    (void)fprintf(stderr, "%s:%u:1: message: %s\n", name, (unsigned)line, text);
}

void message_controller_warning(const struct controller *controller)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    if (controller_get_warning(controller)->code == TAKT_OK)
        return;
    (void)diagnostic_text(controller_get_warning(controller), text);
    message_command_warning("%s", text);
}

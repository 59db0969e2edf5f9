#include "takt/message.h"

#include <stdarg.h>
#include <stdio.h>

/* Length of a line shown below a message: more would not fit on a screen. */
#define MESSAGE_SHOWN_MAX    100
#define MESSAGE_SHOWN_BEFORE 60

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

static void message_diagnostic(const char *kind, const struct program_text *program,
                               const struct diagnostic *diagnostic)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    diagnostic_text(diagnostic, text);
    /* Column 0 is the whole line, which begins at 1. */
    (void)fprintf(
        stderr, "%s:%u:%u: %s: %s\n", program->name, (unsigned)diagnostic->line,
        (unsigned)(diagnostic->line > 0 && diagnostic->column == 0 ? 1 : diagnostic->column), kind,
        text);
    if (diagnostic->line > 0)
        message_show_line(program, diagnostic->line, diagnostic->column);
}

void message_program_error(const struct program_text *program, const struct diagnostic *diagnostic)
{
    message_diagnostic("error", program, diagnostic);
}

void message_program_warning(const struct program_text *program,
                             const struct diagnostic *diagnostic)
{
    message_diagnostic("warning", program, diagnostic);
}

void message_from_program(const struct program_text *program, uint32_t line, const char *text)
{
    (void)fprintf(stderr, "%s:%u:1: message: %s\n", program->name, (unsigned)line, text);
}

void message_controller_warning(const struct controller *controller)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    if (controller_get_warning(controller)->code == TAKT_OK)
        return;
    (void)diagnostic_text(controller_get_warning(controller), text);
    message_command_warning("%s", text);
}

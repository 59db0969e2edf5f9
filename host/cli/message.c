#include "cli/message.h"

#include "cli/found_word.h"
#include "cli/hint.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Length of a line shown below a message: more would not fit on a screen. */
#define MESSAGE_SHOWN_MAX    100
#define MESSAGE_SHOWN_BEFORE 60
/* Length of a line in which a word is looked for. */
#define MESSAGE_LINE_MAX 2048

/* Length of a message that is not of a program. */
#define MESSAGE_TEXT_MAX 8192

static _Thread_local char message_command[32] = "takt";

static _Thread_local struct {
    void (*hear)(void *listener, const struct message *m);
    void *listener;
} message_listener;

void message_listen(void (*hear)(void *listener, const struct message *m), void *listener)
{
    message_listener.hear = hear;
    message_listener.listener = listener;
}

void message_set_command(const char *name)
{
    (void)snprintf(message_command, sizeof message_command, "takt %s", name);
}

static _Thread_local unsigned message_warnings;

unsigned message_count_warnings(void)
{
    return message_warnings;
}

static void message_tell(const struct message *m)
{
    message_warnings += strcmp(m->kind, "warning") == 0 ? 1U : 0U;
    if (message_listener.hear != NULL)
        message_listener.hear(message_listener.listener, m);
    else if (m->file == NULL)
        (void)fprintf(stderr, "%s: %s: %s\n", message_command, m->kind, m->text);
    else
        (void)fprintf(stderr, "%s:%u:%u: %s: %s\n", m->file, (unsigned)m->line, (unsigned)m->column,
                      m->kind, m->text);
}

__attribute__((format(printf, 5, 0))) static void message_format(const char *kind, const char *file,
                                                                 uint32_t line, uint32_t column,
                                                                 const char *format,
                                                                 va_list arguments)
{
    char text[MESSAGE_TEXT_MAX];

    (void)vsnprintf(text, sizeof text, format, arguments);
    message_tell(&(struct message){kind, file, line, column, text, ""});
}

void message_error(const char *file, uint32_t line, uint32_t column, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_format("error", file, line, column, format, arguments);
    va_end(arguments);
}

void message_warning(const char *file, uint32_t line, uint32_t column, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_format("warning", file, line, column, format, arguments);
    va_end(arguments);
}

void message_command_error(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_format("error", NULL, 0, 0, format, arguments);
    va_end(arguments);
}

void message_command_warning(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_format("warning", NULL, 0, 0, format, arguments);
    va_end(arguments);
}

void message_command_note(const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    message_format("note", NULL, 0, 0, format, arguments);
    va_end(arguments);
}

const char *message_did_you_mean(const char *prefix, const char *word)
{
    static _Thread_local char text[96];

    if (word == NULL)
        return "";
    (void)snprintf(text, sizeof text, "; did you mean %s%s?", prefix, word);
    return text;
}

/*
 * Bytes that a terminal would not print as one character are shown as a dot, so that the caret
 * stays in place.
 */
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
        if (*word == ' ')
            continue;
        while (at < length && (line[at] == ' ' || line[at] == '\t'))
            at++;
        if (at == length || message_lower(line[at++]) != message_lower(*word))
            return false;
    }
    return true;
}

/*
 * In a line that has been translated a word may stand elsewhere than where it was found; 0: it is
 * not there at all.
 */
static uint32_t message_column(const struct program_text *program, const struct diagnostic *d)
{
    char line[MESSAGE_LINE_MAX];
    const size_t length = program->pieces > 0 && d->line > 0
                              ? program_text_line(program, d->line, 0, line, sizeof line)
                              : 0;
    const size_t at = d->column > 0 ? d->column - 1 : 0;

    /* A word that is missing stands nowhere: the place is that of its code. */
    if (length == 0 || (d->code == TAKT_ERROR_WORD_MISSING && at < length) ||
        (at < length && message_goes_on(line + at, length - at, d->word)))
        return d->column;
    for (size_t i = 0; i < length && d->word[0] != '\0'; i++) {
        if (line[i] != ' ' && message_goes_on(line + i, length - i, d->word))
            return (uint32_t)i + 1;
    }
    return 0;
}

/* What to do about it. */
static void message_cure(const struct program_text *program, const struct diagnostic *d,
                         uint32_t column, char cure[HINT_MAX])
{
    char line[MESSAGE_LINE_MAX];
    const size_t length =
        d->line > 0 ? program_text_line(program, d->line, 0, line, sizeof line) : 0;

    hint_write(d, line, length, column > 0 ? column - 1 : length, cure);
}

static void message_diagnostic(const char *kind, const struct program_text *program,
                               const struct diagnostic *diagnostic, const char *cure)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    uint32_t line = diagnostic->line;
    const char *name = program_text_place(program, &line);
    const uint32_t column = message_column(program, diagnostic);
    const char *meaning = hint_meaning(diagnostic);

    if (meaning != NULL)
        (void)snprintf(text, sizeof text, "'%s' is not supported: %s", diagnostic->word, meaning);
    else
        takt_diagnostic_text(diagnostic, text);
    /* Column 0 is the whole line, which begins at 1. */
    message_tell(
        &(struct message){kind, name, line, line > 0 && column == 0 ? 1 : column, text, cure});
    if (message_listener.hear != NULL)
        return;
    if (diagnostic->line > 0)
        message_show_line(program, diagnostic->line, column);
    (void)fputs(cure, stderr);
}

/* In the words of the program as it is found. */
static struct diagnostic message_restore(const struct program_text *program,
                                         const struct diagnostic *diagnostic)
{
    struct diagnostic d = *diagnostic;
    char line[MESSAGE_LINE_MAX];

    if (program->pieces > 0 && d.line > 0)
        found_word_restore(line, program_text_line(program, d.line, 0, line, sizeof line), &d);
    return d;
}

void message_program_error(const struct program_text *program, const struct diagnostic *diagnostic)
{
    const struct diagnostic d = message_restore(program, diagnostic);
    char cure[HINT_MAX];

    message_cure(program, &d, message_column(program, &d), cure);
    message_diagnostic("error", program, &d, cure);
}

void message_program_warning(const struct program_text *program,
                             const struct diagnostic *diagnostic)
{
    const struct diagnostic d = message_restore(program, diagnostic);

    message_diagnostic("warning", program, &d, "");
}

void message_from_program(const struct program_text *program, uint32_t line, const char *text)
{
    const char *name = program_text_place(program, &line);

    message_tell(&(struct message){"message", name, line, 1, text, ""});
}

void message_controller_warning(const struct controller *controller)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    if (takt_controller_get_warning(controller)->code == TAKT_OK)
        return;
    (void)takt_diagnostic_text(takt_controller_get_warning(controller), text);
    message_command_warning("%s", text);
}

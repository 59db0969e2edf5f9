#include "simulation/announcer.h"

#include "cli/message.h"
#include "program/comment_text.h"

#include <stdio.h>

/* Axes of a line about a contact, as LinuxCNC writes it: those takt does not have are 0. */
#define CONTACT_AXES 9

void announcer_init(struct announcer *a, const struct program_text *program)
{
    *a = (struct announcer){.program = program};
}

static void close_file(struct announcer *a, struct announcer_file *f)
{
    if (f->is_open)
        a->failed = !(output_file_finish(&f->file) && output_file_place(&f->file)) || a->failed;
    f->is_open = false;
}

static void open_file(struct announcer *a, struct announcer_file *f, const char *path)
{
    close_file(a, f);
    f->is_open = output_file_open(&f->file, path);
    a->failed = a->failed || !f->is_open;
}

/* What is in the file already comes first. */
static void append_file(struct announcer *a, struct announcer_file *f, const char *path)
{
    FILE *before;
    int byte;

    open_file(a, f, path);
    before = f->is_open ? fopen(path, "rb") : NULL;
    if (before == NULL)
        return;
    while ((byte = fgetc(before)) != EOF)
        (void)fputc(byte, f->file.stream);
    (void)fclose(before);
}

void announcer_say(void *announcer, const struct program *p)
{
    struct announcer *a = announcer;
    char text[COMMENT_TEXT_MAX];

    if (p->approach.pending || p->lexer.comment_length == 0)
        return;
    switch (takt_comment_read(p, text)) {
    case COMMENT_MESSAGE:
    case COMMENT_ABORT:
        message_from_program(a->program, p->lexer.line, text);
        break;
    case COMMENT_LOG_OPEN:
        open_file(a, &a->log, text);
        break;
    case COMMENT_LOG_APPEND:
        append_file(a, &a->log, text);
        break;
    case COMMENT_LOG:
        if (a->log.is_open)
            (void)fprintf(a->log.file.stream, "%s\n", text);
        break;
    case COMMENT_LOG_CLOSE:
        close_file(a, &a->log);
        break;
    case COMMENT_PROBE_OPEN:
        open_file(a, &a->probe, text);
        break;
    case COMMENT_PROBE_CLOSE:
        close_file(a, &a->probe);
        break;
    case COMMENT_PLAIN:
        break;
    }
}

void announcer_add_contact(struct announcer *a, const struct parameters *parameters)
{
    if (!a->probe.is_open)
        return;
    for (unsigned i = 0; i < CONTACT_AXES; i++) {
        const double at = i < AXIS_COUNT ? takt_parameters_get(parameters, PARAMETER_PROBE + i) : 0;

        (void)fprintf(a->probe.file.stream, "%s%.6f", i > 0 ? " " : "", at);
    }
    (void)fputc('\n', a->probe.file.stream);
}

bool announcer_finish(struct announcer *a)
{
    close_file(a, &a->log);
    close_file(a, &a->probe);
    return !a->failed;
}

void announcer_close(struct announcer *a)
{
    if (a->log.is_open)
        output_file_discard(&a->log.file);
    if (a->probe.is_open)
        output_file_discard(&a->probe.file);
    a->log.is_open = a->probe.is_open = false;
}

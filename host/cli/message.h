/*
 * What users read when something is wrong, always on stderr:
 *
 *     FILE:LINE:COLUMN: error: TEXT        0:0 when it is about the file as a whole
 *     takt run: error: TEXT                about the command line or the environment
 */
#ifndef TAKT_HOST_MESSAGE_H
#define TAKT_HOST_MESSAGE_H

#include "base/error.h"
#include "cli/program_text.h"
#include "controller/controller.h"

#include <stdint.h>

/* A message as it is told to who listens. */
struct message {
    const char *kind;      /* error, warning, message, note */
    const char *file;      /* NULL: about the command line or the environment */
    uint32_t line, column; /* from 1; 0: the file as a whole */
    const char *text;
    const char *cure; /* lines that say what to do; "" for none */
};

/* From now on messages of this thread go to hear instead of stderr; NULL: to stderr again. */
void message_listen(void (*hear)(void *listener, const struct message *m), void *listener);

/* Warnings of this thread so far, heard or printed. */
unsigned message_count_warnings(void);

/* The sub-command, for messages about the command line. */
void message_set_command(const char *name);

__attribute__((format(printf, 4, 5))) void message_error(const char *file, uint32_t line,
                                                         uint32_t column, const char *format, ...);
__attribute__((format(printf, 4, 5))) void
message_warning(const char *file, uint32_t line, uint32_t column, const char *format, ...);
/* About the command line, or what the machine it runs on refuses. */
__attribute__((format(printf, 1, 2))) void message_command_error(const char *format, ...);
__attribute__((format(printf, 1, 2))) void message_command_warning(const char *format, ...);
__attribute__((format(printf, 1, 2))) void message_command_note(const char *format, ...);

/* What the program itself says in a comment of a line. */
void message_from_program(const struct program_text *program, uint32_t line, const char *text);
/* What a controller has to say at its start, if it has. */
void message_controller_warning(const struct controller *controller);

/*
 * "; did you mean PREFIXWORD?", or "" when word is NULL: for the end of a message. Valid until the
 * next call.
 */
const char *message_did_you_mean(const char *prefix, const char *word);

/*
 * Errors and warnings of a part program, with the line they are about and a caret under the column.
 */
void message_program_error(const struct program_text *program, const struct diagnostic *diagnostic);
void message_program_warning(const struct program_text *program,
                             const struct diagnostic *diagnostic);

#endif

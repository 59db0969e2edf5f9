/* What a translation comes to: a text that grows, and notes. */
#ifndef TAKT_HOST_TRANSLATION_RESULT_H
#define TAKT_HOST_TRANSLATION_RESULT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What ends a text under DOS: nothing of its line counts from there on. */
#define DIALECT_TEXT_END '\x1a'

/* As in firmware/program/lexer.h. */
#define DIALECT_GOES_ON '\x1f'

/* A growing text. */
struct dialect_text {
    char *bytes; /* NULL: empty */
    size_t length, room;
    bool failed; /* out of memory */
    bool slash;  /* lines that are added may be left out, as the one that they come of */
};

void dialect_text_free(struct dialect_text *t);

/* Something a line asks for and does not get: told once for each code. */
struct dialect_note {
    uint32_t line, column; /* from 1 */
    char word[16];
    const char *meaning; /* what it is for; NULL: the machine file says so */
};
#define DIALECT_NOTES_MAX 32

struct dialect_result {
    struct dialect_text text;
    struct dialect_note note[DIALECT_NOTES_MAX];
    unsigned notes;
    /* the first thing that cannot be translated; line 0: there is none */
    uint32_t wrong_line, wrong_column;
    char wrong[128];
};

void output_add(struct dialect_text *t, const char *bytes, size_t length);
__attribute__((format(printf, 2, 3))) void output_print(struct dialect_text *t, const char *format,
                                                        ...);

#endif

/*
 * A line of Siemens' language as it is read and written; values and words of it (siemens.c).
 */
#ifndef TAKT_HOST_SIEMENS_SCAN_H
#define TAKT_HOST_SIEMENS_SCAN_H

#include "translation/translator.h"

#define NAME_MAX_ 32
/* Of a cycle or a subprogram. */
#define SCAN_ARGUMENTS 20

struct scan {
    struct translator *t;
    const char *at;
    char out[LINE_MAX_BYTES + 1];
    size_t length;
    bool failed; /* it is left as it was, for the interpreter to say what is wrong */
};

static inline bool scan_is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Behind its last word? */
static inline bool scan_is_end(const struct scan *s)
{
    return *s->at == '\0' || *s->at == ';';
}

__attribute__((format(printf, 2, 3))) void scan_put(struct scan *s, const char *format, ...);
void scan_skip(struct scan *s);
/* A text that stands here is passed. */
bool scan_take(struct scan *s, const char *text);
/* Letters, then letters and digits; in upper case. False: there is none, and nothing is read. */
bool scan_name(struct scan *s, char name[NAME_MAX_]);

/* R12, a variable, a function, or a constant. */
void scan_operand(struct scan *s, const char *name);
/* A value, as [value]; one without operators. */
void scan_brackets(struct scan *s);
void scan_single(struct scan *s);
/* ( 1, , R2+3 ) as expressions, those that are left out empty; how many. */
unsigned scan_arguments(struct scan *s, char argument[SCAN_ARGUMENTS][48]);
/* A word that is alone in saying something; false: it is none. */
bool scan_keyword(struct scan *s, const char *name);
/* NAME = has been passed; NAME is R12 or a variable. */
void scan_assign(struct scan *s, const char *name);
/* L100, which a line may have beside other words: it is called behind them. False: NAME is none. */
bool siemens_call(struct scan *s, char *name);
/*
 * CYCLE81 to CYCLE83 here, or from the next line on (MCALL), where each line that moves is then a
 * hole. False: it is another word.
 */
bool siemens_cycle(struct scan *s, const char *name);
void siemens_drill(struct scan *s);
/* The words of the rest of the line. */
void scan_words(struct scan *s);

#endif

/*
 * A line of Siemens' language as it is read and written, and what the sources of this room do to
 * it.
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
/* A value; the same as [value]; ( value ) as [value]; one without operators; a plain number. */
void scan_value(struct scan *s);
void scan_brackets(struct scan *s);
void scan_bracketed(struct scan *s);
void scan_single(struct scan *s);
void scan_number(struct scan *s);
/* A name of DEF. */
bool scan_is_variable(const struct scan *s, const char *name);
/* What kind of variable it is (struct translator); '\0': none. */
char scan_kind(const struct scan *s, const char *name);
/* A value in brackets, as a variable of this kind takes it. */
void scan_given(struct scan *s, char kind);
/* ( 1, , R2+3 ) as expressions, those that are left out empty; how many. */
unsigned scan_arguments(struct scan *s, char argument[SCAN_ARGUMENTS][48]);
/* A word that is alone in saying something; false: it is none. */
bool scan_keyword(struct scan *s, const char *name);
/* NAME = has been passed; NAME is R12 or a variable. */
void scan_assign(struct scan *s, const char *name);
/* A name of DEF from here on. */
void scan_define(struct scan *s, const char *name, char kind);
/* N100 and NAME:, where jumps go to. False: there is none. */
bool scan_label(struct scan *s);
/* Nothing is left of the line itself. */
void scan_clear(struct scan *s);
/* IF, FOR, GOTOF ... False: it is another word. */
bool scan_flow(struct scan *s, const char *name);
/* What a line opens that is not understood is passed over: its end belongs to something. */
void scan_pass_block(struct scan *s, const char *name);
/* %_N_L100_SPF, and the same of a main program. False: it is another line. */
bool scan_section(struct scan *s);
/* PROC. False: it is another word. */
bool scan_program(struct scan *s, const char *order);
/* A text that is called and says no name is a subprogram from its first line on. */
void scan_begin_called(struct scan *s);
/* M17 and RET of a subprogram. False: it is another word, or the end of a main program. */
bool scan_return(struct scan *s, const char *name);
/* L100 P2, NAME, NAME(1, 2): the whole line. */
bool scan_call(struct scan *s, char *name);
/* L100, which a line may have beside other words: it is called behind them. False: NAME is none. */
bool siemens_call(struct scan *s, char *name);
/*
 * CYCLE81 to CYCLE83 here, or from the next line on (MCALL), where each line that moves is then a
 * hole. False: it is another word.
 */
bool siemens_cycle(struct scan *s, const char *name);
void siemens_drill(struct scan *s);
/* Codes that mean something else here, and words of them. */
void siemens_codes(struct translator *t);
/* The words of the rest of the line. */
void scan_words(struct scan *s);

#endif

#include "program/report.h"

#include "base/assert.h"
#include "program/lexer.h"

static char capital(char c)
{
    if (c >= 'a' && c <= 'z') {
        c = (char)(c - 'a' + 'A');
    }
    return c;
}

static void describe(const struct program *p, struct diagnostic *d, enum takt_error code,
                     struct program_span span, double value)
{
    char word[DIAGNOSTIC_WORD_MAX];
    size_t length = 0;

    TAKT_ASSERT(code != TAKT_OK && span.begin <= span.end);
    for (unsigned i = span.begin; i < span.end && length < sizeof(word); i++) {
        word[length++] = capital(p->lexer.text[i]);
    }
    takt_diagnostic_set(d, code, p->lexer.line, takt_lexer_column(&p->lexer, span.begin), word,
                        length, value);
}

bool takt_report_error(struct program *p, enum takt_error code, struct program_span span,
                       double value)
{
    describe(p, &p->error, code, span, value);
    return false;
}

bool takt_report_error_at(struct program *p, enum takt_error code, unsigned at, double value)
{
    const unsigned end = at < p->lexer.length ? at + 1 : at;

    return takt_report_error(p, code, (struct program_span){(uint16_t)at, (uint16_t)end}, value);
}

bool takt_report_error_code(struct program *p, enum takt_error code, enum step step, double value)
{
    TAKT_ASSERT(step < STEP_COUNT);
    return takt_report_error(p, code, p->words.code_span[step], value);
}

bool takt_report_error_letter(struct program *p, enum takt_error code, char letter, double value)
{
    TAKT_ASSERT(letter >= 'a' && letter <= 'z');
    return takt_report_error(p, code, p->words.span[LETTER_INDEX(letter)], value);
}

bool takt_report_missing(struct program *p, enum step step, char letter)
{
    const char name = capital(letter);

    TAKT_ASSERT(step < STEP_COUNT && letter >= 'a' && letter <= 'z');
    takt_diagnostic_set(&p->error, TAKT_ERROR_WORD_MISSING, p->lexer.line,
                        takt_lexer_column(&p->lexer, p->words.code_span[step].begin), &name, 1,
                        0.0);
    return false;
}

void takt_report_warning(struct program *p, enum takt_error code, struct program_span span,
                         double value)
{
    if (p->warnings < PROGRAM_WARNINGS_MAX) {
        describe(p, &p->warning[p->warnings++], code, span, value);
    }
}

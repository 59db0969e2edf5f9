#include "program/comment_text.h"

#include "base/assert.h"
#include "base/decimal.h"
#include "program/comment.h"
#include "program/expression.h"
#include "program/lexer.h"
#include "program/system_parameters.h"

/* Places of a value without a format, and of %f. */
#define PLACES       6
#define PLACES_SHORT 4

struct keyword {
    const char *word;
    enum comment_kind kind;
    bool has_values;
};

static const struct keyword keywords[] = {
    {"msg,", COMMENT_MESSAGE, false},
    {"debug,", COMMENT_MESSAGE, true},
    {"print,", COMMENT_MESSAGE, true},
    {"abort,", COMMENT_ABORT, true},
    {"log,", COMMENT_LOG, true},
    {"logopen,", COMMENT_LOG_OPEN, false},
    {"logappend,", COMMENT_LOG_APPEND, false},
    {"logclose", COMMENT_LOG_CLOSE, false},
    {"probeopen", COMMENT_PROBE_OPEN, false},
    {"probeclose", COMMENT_PROBE_CLOSE, false},
};

/* A comment on its way to a text. */
struct reading {
    const struct program *p;
    unsigned at;     /* next character of the comment */
    unsigned places; /* of the values that follow */
    char *text;
    size_t length;
};

static char next(const struct reading *r, unsigned ahead)
{
    return takt_lexer_comment(&r->p->lexer, r->at + ahead);
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static void add(struct reading *r, const char *bytes, size_t length)
{
    TAKT_ASSERT(r->length < COMMENT_TEXT_MAX);
    for (size_t i = 0; i < length && r->length < COMMENT_TEXT_MAX - 1; i++) {
        r->text[r->length++] = bytes[i];
    }
}

/* %d, %f or %.2f; false: it is none. */
static bool read_format(struct reading *r)
{
    if (next(r, 1) == 'd') {
        r->places = 0;
        r->at += 2;
    } else if (next(r, 1) == 'f') {
        r->places = PLACES_SHORT;
        r->at += 2;
    } else if (next(r, 1) == '.' && is_digit(next(r, 2)) && next(r, 3) == 'f') {
        r->places = (unsigned)(next(r, 2) - '0');
        r->at += 4;
    } else {
        return false;
    }
    return true;
}

/* <name>, whose '<' is next: without spaces, in lower case. */
static bool read_named(struct reading *r, double *value)
{
    char name[PROGRAM_LINE_MAX];
    size_t length = 0;

    for (r->at++; next(r, 0) != '>' && next(r, 0) != '\0'; r->at++) {
        const char c = next(r, 0);

        if (c != ' ' && c != '\t') {
            name[length++] = takt_comment_lower(c);
        }
    }
    r->at += next(r, 0) == '>' ? 1 : 0;
    return length > 0 && length <= PROGRAM_NAME_MAX &&
           takt_expression_find_named(r->p, name, length, value);
}

static bool read_numbered(struct reading *r, double *value)
{
    unsigned number = 0;

    for (; is_digit(next(r, 0)); r->at++) {
        number =
            number <= PARAMETER_NUMBER_MAX ? number * 10 + (unsigned)(next(r, 0) - '0') : number;
    }
    if (number == 0 || number > PARAMETER_NUMBER_MAX) {
        return false;
    }
    *value = takt_system_parameter_get(r->p, number);
    return true;
}

/* #1 or #<name>, whose '#' is next. */
static void read_value(struct reading *r)
{
    char digits[DECIMAL_TEXT_MAX];
    double value;

    r->at++;
    if (next(r, 0) != '<' && !is_digit(next(r, 0))) {
        add(r, "#", 1);
    } else if (next(r, 0) == '<' ? read_named(r, &value) : read_numbered(r, &value)) {
        add(r, digits, takt_decimal_write(digits, value, r->places));
    } else {
        add(r, "######", 6);
    }
}

static void read_text(struct reading *r, bool has_values)
{
    while (next(r, 0) == ' ') {
        r->at++;
    }
    while (next(r, 0) != '\0') {
        const char c = next(r, 0);

        if (has_values && c == '#') {
            read_value(r);
        } else if (!has_values || c != '%' || !read_format(r)) {
            add(r, &c, 1);
            r->at++;
        }
    }
    r->text[r->length] = '\0';
}

enum comment_kind takt_comment_read(const struct program *p, char text[COMMENT_TEXT_MAX])
{
    struct reading r = {.p = p, .places = PLACES};

    r.text = text;
    for (unsigned i = 0; i < sizeof(keywords) / sizeof(keywords[0]); i++) {
        r.at = takt_comment_match(&p->lexer, keywords[i].word);
        if (r.at > 0) {
            read_text(&r, keywords[i].has_values);
            return keywords[i].kind;
        }
    }
    read_text(&r, false);
    return COMMENT_PLAIN;
}

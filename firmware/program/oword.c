#include "program/oword.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/expression.h"
#include "program/lexer.h"
#include "program/names.h"
#include "program/report.h"

struct keyword {
    const char *text;
    enum oword_kind kind;
};

/* One that begins another stands behind it. */
static const struct keyword keywords[] = {
    {"sub", OWORD_SUB},
    {"endsub", OWORD_ENDSUB},
    {"return", OWORD_RETURN},
    {"call", OWORD_CALL},
    {"if", OWORD_IF},
    {"elseif", OWORD_ELSEIF},
    {"else", OWORD_ELSE},
    {"endif", OWORD_ENDIF},
    {"while", OWORD_WHILE},
    {"endwhile", OWORD_ENDWHILE},
    {"do", OWORD_DO},
    {"repeat", OWORD_REPEAT},
    {"endrepeat", OWORD_ENDREPEAT},
    {"break", OWORD_BREAK},
    {"continue", OWORD_CONTINUE},
    {"goto", OWORD_GOTO},
};

#define KEYWORDS (sizeof(keywords) / sizeof(keywords[0]))

bool takt_oword_begins(struct program *p)
{
    struct program_lexer *l = &p->lexer;
    unsigned at = l->at;

    if (l->text[at] == 'n') {
        do {
            at++;
        } while ((l->text[at] >= '0' && l->text[at] <= '9') || l->text[at] == '.');
    }
    if (l->text[at] != 'o') {
        return false;
    }
    l->at = (uint16_t)(at + 1);
    return true;
}

bool takt_oword_keep(struct program *p, struct oword *o)
{
    uint16_t place = (uint16_t)o->label.id;

    if (o->label.id < PROGRAM_LABEL_NAME) {
        return true;
    }
    const bool kept = takt_names_keep(p, &place);

    o->label.id = PROGRAM_LABEL_NAME | place;
    return kept || takt_oword_error(p, TAKT_ERROR_PROGRAM_FULL, o, 0.0);
}

static bool wrong_label(struct program *p, unsigned begin)
{
    const struct program_span span = {(uint16_t)begin, p->lexer.at};

    return takt_report_error(p, TAKT_ERROR_OWORD_LABEL, span, PROGRAM_NAME_MAX);
}

/* The number a name is, as it would be written: <100> is 100. PROGRAM_LABEL_NAME: it is none. */
static uint32_t number_of(const char *name, unsigned length)
{
    uint32_t number = 0;

    if (name[0] == '0' && length > 1) {
        return PROGRAM_LABEL_NAME;
    }
    for (unsigned i = 0; i < length; i++) {
        if (name[i] < '0' || name[i] > '9' || number > PROGRAM_LABEL_MAX / 10) {
            return PROGRAM_LABEL_NAME;
        }
        number = number * 10 + (uint32_t)(name[i] - '0');
    }
    return number;
}

static bool read_name(struct program *p, struct program_label *label)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;
    const char *name = &l->text[begin];

    while (l->text[l->at] != '>' && l->text[l->at] != '\0' && l->at < begin + PROGRAM_NAME_MAX) {
        l->at++;
    }
    const unsigned length = l->at - begin;

    if (length == 0 || !takt_lexer_accept(l, '>')) {
        return wrong_label(p, begin - 2);
    }
    label->id = number_of(name, length);
    if (label->id == PROGRAM_LABEL_NAME) {
        label->id |= takt_names_place(&p->names, name, length);
    }
    return true;
}

/* <name>, or a number, which may be worked out: O100, O#1, O[#1+1]. */
static bool read_label(struct program *p, struct program_label *label)
{
    const unsigned begin = p->lexer.at;
    double value;
    double number;

    if (takt_lexer_accept(&p->lexer, '<')) {
        return read_name(p, label);
    }
    if (!takt_expression_read(p, &value)) {
        return false;
    }
    if (!takt_expression_whole(value, &number) || number < 0.0 || number > PROGRAM_LABEL_MAX) {
        return wrong_label(p, begin - 1);
    }
    label->id = (uint32_t)number;
    return true;
}

/* The length of a keyword that text begins with, else 0. */
static unsigned match(const char *text, const char *keyword)
{
    unsigned length = 0;

    while (keyword[length] != '\0' && text[length] == keyword[length]) {
        length++;
    }
    return keyword[length] == '\0' ? length : 0;
}

static bool read_keyword(struct program *p, enum oword_kind *kind)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;

    for (unsigned i = 0; i < KEYWORDS; i++) {
        const unsigned length = match(l->text + l->at, keywords[i].text);

        if (length > 0) {
            l->at = (uint16_t)(l->at + length);
            *kind = keywords[i].kind;
            return true;
        }
    }
    if (l->text[begin] == '\0') {
        *kind = OWORD_PROGRAM;
        return true;
    }
    do {
        l->at++;
    } while (l->text[l->at] >= 'a' && l->text[l->at] <= 'z');
    return takt_report_error(p, TAKT_ERROR_OWORD_UNKNOWN,
                             (struct program_span){(uint16_t)begin, l->at}, 0.0);
}

bool takt_oword_read(struct program *p, struct oword *o)
{
    o->line = p->lexer.line;
    o->column = takt_lexer_column(&p->lexer, p->lexer.at - 1U);
    return read_label(p, &o->label) && read_keyword(p, &o->kind);
}

bool takt_oword_finish(struct program *p, const struct oword *o)
{
    return p->lexer.at == p->lexer.length || takt_oword_error(p, TAKT_ERROR_OWORD_ALONE, o, 0.0);
}

/* Adds text in capitals, cut at the end of the word's room. */
static size_t add(char *word, size_t length, const char *text)
{
    while (*text != '\0' && length < DIAGNOSTIC_WORD_MAX) {
        char c = *text++;

        if (c >= 'a' && c <= 'z') {
            c = (char)(c - 'a' + 'A');
        }
        word[length++] = c;
    }
    return length;
}

static const char *keyword_text(enum oword_kind kind)
{
    for (unsigned i = 0; i < KEYWORDS; i++) {
        if (keywords[i].kind == kind) {
            return keywords[i].text;
        }
    }
    return "";
}

/* The digits of a number, at the end of a text. */
static const char *number_text(char text[12], uint32_t number)
{
    char *at = text + 11;

    *at = '\0';
    do {
        *--at = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    return at;
}

/* "O100 IF", "O<NAME> CALL", "O100", "M98 P100", "M99" */
static size_t describe(const struct program *p, char *word, const struct oword *o)
{
    char digits[12];
    const char *label = o->label.id < PROGRAM_LABEL_NAME
                            ? number_text(digits, o->label.id)
                            : &p->names.text[o->label.id - PROGRAM_LABEL_NAME];
    const bool number = label[0] >= '0' && label[0] <= '9';
    const char *keyword = keyword_text(o->kind);

    if (o->kind == OWORD_M99) {
        return add(word, 0, "m99");
    }
    size_t length = add(word, 0, o->kind == OWORD_M98 ? "m98 p" : number ? "o" : "o<");

    length = add(word, length, label);
    length = add(word, length, number ? "" : ">");
    length = add(word, length, keyword[0] == '\0' ? "" : " ");
    return add(word, length, keyword);
}

bool takt_oword_error(struct program *p, enum takt_error code, const struct oword *o, double value)
{
    char word[DIAGNOSTIC_WORD_MAX];

    TAKT_ASSERT(code != TAKT_OK);
    takt_diagnostic_set(&p->error, code, o->line, o->column, word, describe(p, word, o), value);
    return false;
}

#include "program/oword.h"

#include "base/maths.h"
#include "program/expression.h"
#include "program/lexer.h"
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
};

#define KEYWORDS (sizeof(keywords) / sizeof(keywords[0]))

bool oword_begins(struct program *p)
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

void oword_label(struct program_label *label, uint32_t number)
{
    char digits[10];
    unsigned count = 0;
    unsigned length = 0;

    do {
        digits[count++] = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    while (count > 0) {
        label->text[length++] = digits[--count];
    }
    label->text[length] = '\0';
}

bool oword_same_label(const struct program_label *a, const struct program_label *b)
{
    unsigned i = 0;

    while (a->text[i] == b->text[i] && a->text[i] != '\0') {
        i++;
    }
    return a->text[i] == b->text[i];
}

static bool wrong_label(struct program *p, unsigned begin)
{
    const struct program_span span = {(uint16_t)begin, p->lexer.at};

    return report_error(p, TAKT_ERROR_OWORD_LABEL, span, PROGRAM_NAME_MAX);
}

static bool read_name(struct program *p, struct program_label *label)
{
    struct program_lexer *l = &p->lexer;
    const unsigned begin = l->at;
    unsigned length = 0;

    while (l->text[l->at] != '>' && l->text[l->at] != '\0' && length < PROGRAM_NAME_MAX) {
        label->text[length++] = l->text[l->at++];
    }
    label->text[length] = '\0';
    return (length > 0 && lexer_accept(l, '>')) || wrong_label(p, begin - 2);
}

/* <name>, or a number, which may be worked out: O100, O#1, O[#1+1]. */
static bool read_label(struct program *p, struct program_label *label)
{
    const unsigned begin = p->lexer.at;
    double value;
    double number;

    if (lexer_accept(&p->lexer, '<')) {
        return read_name(p, label);
    }
    if (!expression_read(p, &value)) {
        return false;
    }
    if (!expression_whole(value, &number) || number < 0.0 || number > PROGRAM_LABEL_MAX) {
        return wrong_label(p, begin - 1);
    }
    oword_label(label, (uint32_t)number);
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
    return report_error(p, TAKT_ERROR_OWORD_UNKNOWN, (struct program_span){(uint16_t)begin, l->at},
                        0.0);
}

bool oword_read(struct program *p, struct oword *o)
{
    o->line = p->lexer.line;
    o->column = p->lexer.column[p->lexer.at - 1];
    return read_label(p, &o->label) && read_keyword(p, &o->kind);
}

bool oword_finish(struct program *p, const struct oword *o)
{
    return p->lexer.at == p->lexer.length || oword_error(p, TAKT_ERROR_OWORD_ALONE, o, 0.0);
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

/* "O100 IF", "O<NAME> CALL", "O100", "M98 P100", "M99" */
static size_t describe(char *word, const struct oword *o)
{
    const bool number = o->label.text[0] >= '0' && o->label.text[0] <= '9';
    const char *keyword = keyword_text(o->kind);

    if (o->kind == OWORD_M99) {
        return add(word, 0, "m99");
    }
    size_t length = add(word, 0, o->kind == OWORD_M98 ? "m98 p" : number ? "o" : "o<");

    length = add(word, length, o->label.text);
    length = add(word, length, number ? "" : ">");
    length = add(word, length, keyword[0] == '\0' ? "" : " ");
    return add(word, length, keyword);
}

bool oword_error(struct program *p, enum takt_error code, const struct oword *o, double value)
{
    char word[DIAGNOSTIC_WORD_MAX];

    diagnostic_set(&p->error, code, o->line, o->column, word, describe(word, o), value);
    return false;
}

/*
 * What a program is written for. Only what LinuxCNC cannot read counts, so that a program that it reads is never read as
 * another dialect; names in comments choose where that leaves several.
 */
#include "dialect/dialect.h"
#include "dialect/difference.h"
#include "dialect/line.h"

#include <string.h>

#define BIT(dialect) (1U << (dialect))
#define INDUSTRY     (BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS) | BIT(DIALECT_MACH3))

struct look {
    struct dialect_detector *d;
    struct line line;
};

/* What a terminal would not print as it stands becomes a dot. */
static void show(char shown[32], const char *text, int length)
{
    for (int i = 0; i < length; i++)
        shown[i] = (char)(text[i] >= ' ' && text[i] <= '~' ? text[i] : '.');
    shown[length] = '\0';
}

static void note(struct look *k, unsigned dialects, const struct line_word *w)
{
    const int length = w != NULL ? w->end - w->begin : (int)strcspn(k->line.text, "\r");
    const char *text = w != NULL ? &k->line.text[w->begin] : k->line.text;

    for (unsigned i = 0; i < DIALECT_COUNT; i++) {
        if ((dialects & BIT(i)) != 0 && k->d->found_line[i] == 0) {
            k->d->found_line[i] = k->d->line;
            show(k->d->found[i], text, length < 24 ? length : 24);
        }
    }
}

static bool contains(const char *text, size_t length, const char *name)
{
    const size_t size = strlen(name);

    for (size_t at = 0; at + size <= length; at++) {
        size_t i = 0;

        while (i < size && line_lower(text[at + i]) == name[i])
            i++;
        if (i == size)
            return true;
    }
    return false;
}

static void read_comment(struct look *k, const struct line_word *w)
{
    static const struct {
        const char *name;
        enum dialect dialect;
    } known[] = {
        {"marlin", DIALECT_MARLIN},     {"cura", DIALECT_MARLIN},
        {"slic3r", DIALECT_MARLIN},     {"prusaslicer", DIALECT_MARLIN},
        {"simplify3d", DIALECT_MARLIN}, {"reprap", DIALECT_MARLIN},
        {"haas", DIALECT_HAAS},         {"fanuc", DIALECT_FANUC},
        {"mach3", DIALECT_MACH3},       {"mach 3", DIALECT_MACH3},
        {"grbl", DIALECT_GRBL},         {"lightburn", DIALECT_GRBL},
    };

    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (contains(&k->line.text[w->begin], (size_t)(w->end - w->begin), known[i].name))
            k->d->named |= BIT(known[i].dialect);
    }
}

/* O100 SUB, O<name> CALL, O[#1] IF */
static bool is_oword(const struct line *l)
{
    static const char *const keywords[] = {"sub",    "endsub",   "call",  "return",   "if",
                                           "elseif", "else",     "endif", "do",       "while",
                                           "repeat", "endwhile", "break", "continue", "endrepeat"};
    const struct line_word *w = &l->word[0];
    size_t at;

    if (l->words > 1 && w->letter == 'n')
        w++;
    if (l->words == 0 || w->letter != 'o' || w->kind == WORD_KEYWORD)
        return false;
    if (l->text[w->begin + 1] == '<')
        return true;
    for (at = w->end; l->text[at] == ' ' || l->text[at] == '\t';)
        at++;
    for (size_t i = 0; i < sizeof keywords / sizeof keywords[0]; i++) {
        if (contains(&l->text[at], strlen(keywords[i]), keywords[i]))
            return true;
    }
    return false;
}

/* A whole line that no part program has. */
static bool look_at_line(struct look *k)
{
    const char *text = k->line.text;
    const char c = text[0];
    const bool remark = (c == '/' && text[1] == '/') ||
                        (c == '#' && (text[1] == ' ' || contains(text + 1, 1, "a") ||
                                      (line_lower(text[1]) >= 'a' && line_lower(text[1]) <= 'z')));

    if (c == '$' || (strchr("?!~", c) != NULL && c != '\0') || remark) {
        note(k, BIT(DIALECT_GRBL), NULL);
        return true;
    }
    if (c == ':' ||
        (line_lower(c) == 'o' && k->line.words > 0 && k->line.word[0].kind == WORD_BARE))
        note(k, BIT(DIALECT_FANUC), NULL);
    return false;
}

static void look_at_code(struct look *k, struct line_word *w)
{
    static const uint16_t fanuc[] = {541, 650, 660, 661};
    const int number = line_code(w);

    if (number < 0)
        return;
    note(k, difference_dialects(w->letter, (unsigned)number), w);
    for (size_t i = 0; i < sizeof fanuc / sizeof fanuc[0]; i++) {
        if (w->letter == 'g' && number == fanuc[i])
            note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), w);
    }
    if (w->letter == 'g' && number == 1540)
        note(k, BIT(DIALECT_HAAS), w);
    if (w->letter == 'g' && number == 500 && line_find(&k->line, 's', 0) == NULL)
        note(k, INDUSTRY, w);
    if (w->letter == 'g' && number == 500 && line_find(&k->line, 's', 0) != NULL)
        note(k, BIT(DIALECT_FANUC), w);
    if (w->letter == 'm' &&
        (number == 1040 || number == 1090 || number == 1400 || number == 1900) &&
        line_find(&k->line, 's', 0) != NULL)
        note(k, BIT(DIALECT_MARLIN), w);
    if (w->letter == 'm' && (number == 820 || number == 830))
        note(k, BIT(DIALECT_MARLIN), w);
}

/* The line has G28 or G30. */
static void look_at_reference(struct look *k)
{
    struct line *l = &k->line;
    const bool moves = line_find_code(l, 'g', 0) != NULL || line_find_code(l, 'g', 10) != NULL;

    for (unsigned i = 0; i < l->words; i++) {
        struct line_word *w = &l->word[i];

        if (w->kind == WORD_BARE && strchr("xyzabc", w->letter) != NULL)
            note(k, BIT(DIALECT_GRBL) | BIT(DIALECT_MARLIN), w);
        if (w->kind == WORD_VALUE && (w->letter == 'u' || w->letter == 'w'))
            note(k, BIT(DIALECT_FANUC), w);
        if (w->kind == WORD_VALUE && moves && strchr("xyzabc", w->letter) != NULL)
            note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), w);
    }
}

/* 1.5e-17: a number as no controller reads it. */
static bool has_exponent(const struct line *l, const struct line_word *w)
{
    const char *behind = &l->text[w->end];

    return w->is_number && line_lower(behind[0]) == 'e' && (behind[1] == '-' || behind[1] == '+') &&
           behind[2] >= '0' && behind[2] <= '9';
}

/* The exponent itself, which looks like a word. */
static bool is_exponent(const struct line *l, const struct line_word *w)
{
    const char before = (char)(w->begin > 0 ? l->text[w->begin - 1] : ' ');

    return w->letter == 'e' && ((before >= '0' && before <= '9') || before == '.') &&
           strchr("+-", l->text[w->begin + 1]) != NULL;
}

static void look_at_word(struct look *k, struct line_word *w)
{
    struct line *l = &k->line;

    if (w->kind == WORD_COMMENT)
        read_comment(k, w);
    if (w->kind == WORD_KEYWORD)
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), w);
    if (w->kind == WORD_ASSIGNED && l->text[w->begin + 1] == '<')
        k->d->linuxcnc = true;
    if (w->kind != WORD_VALUE)
        return;
    k->d->translates = k->d->translates || w->letter == '@' || w->letter == '^';
    look_at_code(k, w);
    if (has_exponent(l, w))
        note(k, BIT(DIALECT_GRBL), w);
    else if (w->letter == 'e' && w->is_number && !is_exponent(l, w) &&
             (line_find_code(l, 'g', 10) != NULL || line_find_code(l, 'g', 920) != NULL))
        note(k, BIT(DIALECT_MARLIN), w);
    if (w->letter == 'n' && k->line.word[k->line.words - 1].kind == WORD_VALUE &&
        strchr(l->text, '*') != NULL && strchr(l->text, '[') == NULL &&
        strchr(l->text, '(') == NULL)
        note(k, BIT(DIALECT_MARLIN), w);
}

/* I, J and K in one arc: one of them is 0. */
static void look_at_centre(struct look *k)
{
    struct line_word *w[3] = {line_find(&k->line, 'i', 0), line_find(&k->line, 'j', 0),
                              line_find(&k->line, 'k', 0)};

    if (w[0] == NULL || w[1] == NULL || w[2] == NULL ||
        (line_find_code(&k->line, 'g', 20) == NULL && line_find_code(&k->line, 'g', 30) == NULL))
        return;
    for (unsigned i = 0; i < 3; i++) {
        if (w[i]->is_number && w[i]->value == 0.0) {
            note(k, BIT(DIALECT_GRBL), w[i]);
            return;
        }
    }
}

static bool is_declared(const struct line_word *w, const struct dialect_codes *codes)
{
    const int number = line_code(w);

    for (unsigned i = 0; i < codes->count && number >= 0; i++) {
        if (codes->code[i].letter == w->letter && codes->code[i].number_x10 == number)
            return true;
    }
    return false;
}

static void look_at_words(struct look *k, const struct dialect_codes *codes)
{
    for (unsigned i = 0; i < k->line.words; i++) {
        look_at_word(k, &k->line.word[i]);
        k->d->translates = k->d->translates || is_declared(&k->line.word[i], codes);
    }
    if (line_find_code(&k->line, 'g', 280) != NULL || line_find_code(&k->line, 'g', 300) != NULL)
        look_at_reference(k);
    look_at_centre(k);
}

/* Bytes that no text has: nothing can be guessed of what is none. */
static bool is_text(const char *bytes, size_t length)
{
    for (size_t i = 0; i < length; i++) {
        const unsigned char c = (unsigned char)bytes[i];

        if ((c < ' ' && c != '\t' && c != '\r' && c != DIALECT_TEXT_END) || c == 0x7f)
            return false;
    }
    return true;
}

void dialect_guess_line(struct dialect_detector *d, const char *bytes, size_t length,
                        const struct dialect_codes *codes)
{
    struct look k;

    k.d = d;
    d->line++;
    if (d->line == 1 && length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0) {
        d->translates = true;
        bytes += 3;
        length -= 3;
    }
    d->linuxcnc = d->linuxcnc || !is_text(bytes, length);
    d->translates = d->translates || memchr(bytes, DIALECT_TEXT_END, length) != NULL;
    if (!line_read(&k.line, bytes, length))
        return;
    d->translates = d->translates || contains(k.line.text, k.line.length, "#<_ini[") ||
                    contains(k.line.text, k.line.length, "#<_hal[");
    d->calls = d->calls || line_find_code(&k.line, 'm', 980) != NULL;
    if (is_oword(&k.line)) {
        d->calls = d->calls || contains(k.line.text, k.line.length, "call");
        d->linuxcnc = true;
        return;
    }
    if (!look_at_line(&k))
        look_at_words(&k, codes);
}

struct dialect_guess dialect_guess_end(const struct dialect_detector *d)
{
    static const enum dialect order[] = {DIALECT_MARLIN, DIALECT_HAAS, DIALECT_FANUC, DIALECT_MACH3,
                                         DIALECT_GRBL};
    struct dialect_guess guess = {.translates = d->translates};
    unsigned found = 0;

    for (unsigned i = 0; i < DIALECT_COUNT && !d->linuxcnc; i++)
        found |= d->found_line[i] != 0 ? BIT(i) : 0;
    if ((found & d->named) != 0)
        found &= d->named;
    if (found == INDUSTRY || found == (BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS)))
        found = BIT(DIALECT_FANUC);
    for (size_t i = 0; i < sizeof order / sizeof order[0] && guess.line == 0; i++) {
        if ((found & BIT(order[i])) != 0) {
            guess.dialect = order[i];
            guess.translates = true;
            guess.line = d->found_line[order[i]];
            memcpy(guess.evidence, d->found[order[i]], sizeof guess.evidence);
        }
    }
    return guess;
}

/*
 * What a program is written for. Only what LinuxCNC cannot read counts, so that a program that it
 * reads is never read as another dialect, and not what is a mistake as likely (H without G43, G96
 * without S, G53 before any motion, T1.5): those are read where something else has told the
 * dialect. Names in comments choose where that leaves several.
 */
#include "dialect/dialect.h"
#include "dialect/difference.h"
#include "dialect/translate.h"
#include "lathe/lathe.h"
#include "siemens/siemens.h"
#include "words/line.h"

#include <math.h>
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

    k->d->alone |= (dialects & (dialects - 1)) == 0 ? dialects : 0;
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
    const bool remark = line_is_order(&k->line) || (c == '/' && text[1] == '/') ||
                        (c == '#' && (text[1] == ' ' || contains(text + 1, 1, "a") ||
                                      (line_lower(text[1]) >= 'a' && line_lower(text[1]) <= 'z')));

    /* a simulator's orders begin so too, behind a program's number, which no sender knows */
    if (c == '$' && k->d->numbered) {
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), NULL);
        return true;
    }
    if (c == '$' || (strchr("?!~", c) != NULL && c != '\0') || remark) {
        note(k, BIT(DIALECT_GRBL), NULL);
        return true;
    }
    k->d->numbered =
        k->d->numbered || (line_lower(c) == 'o' && k->line.words > 0 && k->line.word[0].is_number);
    if (line_is_directive(&k->line)) {
        note(k, BIT(DIALECT_FANUC), NULL);
        return true;
    }
    size_t length;

    if (line_message(&k->line, &length) != NULL) {
        note(k, BIT(DIALECT_GRBL), NULL);
        return true;
    }
    if (siemens_tells(&k->line)) {
        note(k, BIT(DIALECT_SIEMENS), NULL);
        return true;
    }
    if (line_checksum(&k->line) != NULL)
        note(k, BIT(DIALECT_GRBL), NULL);
    if (c == ':' || (c == '%' && k->line.words > 1 && k->line.word[1].kind != WORD_COMMENT) ||
        (line_lower(c) == 'o' && k->line.words > 0 && k->line.word[0].kind == WORD_BARE))
        note(k, BIT(DIALECT_FANUC), NULL);
    return false;
}

static void look_at_code(struct look *k, struct line_word *w)
{
    static const uint16_t fanuc[] = {434, 541, 650, 660, 661, 682};
    const int number = line_code(w);

    if (number < 0)
        return;
    note(k, difference_dialects(w->letter, (unsigned)number), w);
    for (size_t i = 0; i < sizeof fanuc / sizeof fanuc[0]; i++) {
        if (w->letter == 'g' && number == fanuc[i])
            note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), w);
    }
    if (w->letter == 'g' && (number == 120 || number == 130) && line_find(&k->line, 'i', 0) != NULL)
        note(k, BIT(DIALECT_HAAS), w);
    if (w->letter == 'm' && number == 970 && line_find(&k->line, 'p', 0) != NULL)
        note(k, BIT(DIALECT_HAAS), w);
    if (w->letter == 'g' && (number == 1540 || number == 2340 || number == 2540))
        note(k, BIT(DIALECT_HAAS), w);
    if (w->letter == 'g' && number == 500 && line_find(&k->line, 's', 0) == NULL)
        note(k, INDUSTRY, w);
    if (w->letter == 'g' && w == registers_speed_limit(&k->line) &&
        line_find(&k->line, 's', 0) != NULL)
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
    k->d->translates = k->d->translates || line_runs_python(l, w);
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
    for (unsigned i = 0; i < codes->count; i++) {
        if (codes->code[i].use == DIALECT_FEED)
            return true;
    }
    return codes_find(codes, w) != NULL;
}

/*
 * Axis words before the first motion: Grbl begins in G0. Without any motion behind it is a mistake.
 * Axis words behind the end of a cycle: industry goes on with what was before it.
 */
static void look_at_motion(struct look *k)
{
    struct dialect_detector *d = k->d;
    struct line *l = &k->line;
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    if (!motion && !other && d->ended_cycle && line_has_axis(l) && line_is_plain(l))
        note(k, INDUSTRY, NULL);
    d->ended_cycle = line_ends_cycle(l) || (d->ended_cycle && !motion);
    if (!motion && !other && !d->moves && d->bare_line == 0 && line_has_axis(l) &&
        line_is_plain(l)) {
        d->bare_line = d->line;
        show(d->bare, l->text, l->length < 24 ? (int)l->length : 24);
    }
    d->moves = d->moves || motion;
    if (d->moves && d->bare_line != 0 && d->found_line[DIALECT_GRBL] == 0) {
        d->found_line[DIALECT_GRBL] = d->bare_line;
        memcpy(d->found[DIALECT_GRBL], d->bare, sizeof d->bare);
    }
}

/* #NAME */
static void look_at_names(struct look *k)
{
    const char *text = k->line.text;

    for (size_t at = 0; at < strcspn(text, "(;"); at++) {
        if (text[at] == '#' && line_name_length(&k->line, at + 1) > 0)
            note(k, BIT(DIALECT_GRBL), NULL);
    }
}

/* Words that LinuxCNC refuses beside others, and other controllers pass over. */
static void look_at_unused(struct look *k)
{
    static const uint16_t cycles[] = {730, 810, 830, 850};
    struct line *l = &k->line;
    struct line_word *p = line_find(l, 'p', 0);
    struct line_word *s = line_find(l, 's', 0);

    for (size_t i = 0; i < sizeof cycles / sizeof cycles[0]; i++) {
        if (p != NULL && line_find_code(l, 'g', cycles[i]) != NULL)
            note(k, INDUSTRY, p);
    }
    if (p != NULL && line_find_code(l, 'm', 60) != NULL && line_find_code(l, 'g', 40) == NULL)
        note(k, BIT(DIALECT_GRBL), p);
    if (p == NULL && line_find_code(l, 'g', 40) != NULL &&
        (line_find(l, 'x', 0) != NULL || line_find(l, 'u', 0) != NULL))
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), line_find_code(l, 'g', 40));
    if (p != NULL && line_find_code(l, 'g', 80) != NULL)
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), p);
    if ((p == NULL && line_find_code(l, 'm', 980) != NULL && line_find(l, 'q', 0) != NULL) ||
        turning_tells(l))
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), NULL);
    if (l->words > 1 && l->word[0].letter == 'n' && line_find(l, 'n', 1) != NULL)
        note(k, BIT(DIALECT_GRBL), line_find(l, 'n', 1));
    if (line_find_code(l, 'g', 430) != NULL && line_find_code(l, 'g', 410) == NULL &&
        line_find_code(l, 'g', 420) == NULL && line_find(l, 'd', 0) != NULL)
        note(k, BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS), line_find(l, 'd', 0));
    if (line_unit(l) != NULL)
        note(k, INDUSTRY, line_unit(l));
    if (s != NULL && line_find(l, 's', (unsigned)(s - l->word) + 1) != NULL)
        note(k, BIT(DIALECT_GRBL), s);
}

/* Does an arc from the place to end fit a centre? To 1 % of its radius, at least 0.02. */
static bool fits(const double from[2], const double end[2], const double centre[2])
{
    const double a = hypot(from[0] - centre[0], from[1] - centre[1]);
    const double b = hypot(end[0] - centre[0], end[1] - centre[1]);

    return fabs(a - b) < fmax(0.02, 0.01 * a);
}

static void look_at_arc(struct look *k, const double end[2])
{
    struct dialect_arcs *arcs = &k->d->arcs;
    const struct line_word *i = line_find(&k->line, 'i', 0);
    const struct line_word *j = line_find(&k->line, 'j', 0);

    if (i == NULL || j == NULL || !i->is_number || !j->is_number || !arcs->known[0] ||
        !arcs->known[1])
        return;
    const double absolute[2] = {i->value, j->value};
    const double relative[2] = {arcs->at[0] + i->value, arcs->at[1] + j->value};
    const bool is_absolute = fits(arcs->at, end, absolute);
    const bool is_relative = fits(arcs->at, end, relative);

    arcs->relative += is_relative && !is_absolute ? 1 : 0;
    arcs->absolute += is_absolute && !is_relative ? 1 : 0;
    if (arcs->absolute == 1 && arcs->line == 0)
        arcs->line = k->d->line;
}

/* Follows X and Y through the text. */
static void look_at_place(struct look *k)
{
    struct dialect_arcs *arcs = &k->d->arcs;
    struct line *l = &k->line;
    double end[2] = {arcs->at[0], arcs->at[1]};
    bool moves = false;

    arcs->incremental = (arcs->incremental || line_find_code(l, 'g', 910) != NULL) &&
                        line_find_code(l, 'g', 900) == NULL;
    arcs->said = arcs->said || line_find_code(l, 'g', 901) != NULL ||
                 line_find_code(l, 'g', 911) != NULL || line_find_code(l, 'g', 180) != NULL ||
                 line_find_code(l, 'g', 190) != NULL;
    if (line_find_code(l, 'g', 0) != NULL || line_find_code(l, 'g', 10) != NULL)
        arcs->turns = false;
    if (line_find_code(l, 'g', 20) != NULL || line_find_code(l, 'g', 30) != NULL)
        arcs->turns = true;
    for (unsigned axis = 0; axis < 2; axis++) {
        const struct line_word *w = line_find(l, (char)('x' + (char)axis), 0);

        if (w == NULL)
            continue;
        moves = true;
        end[axis] = w->value + (arcs->incremental ? arcs->at[axis] : 0.0);
        arcs->known[axis] = w->is_number && (arcs->known[axis] || !arcs->incremental);
    }
    if (arcs->turns && moves)
        look_at_arc(k, end);
    arcs->at[0] = end[0];
    arcs->at[1] = end[1];
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
    look_at_motion(k);
    look_at_place(k);
    look_at_unused(k);
    look_at_names(k);
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
    d->translates =
        d->translates || (codes->values > 0 && contains(k.line.text, k.line.length, "#<_"));
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
    static const enum dialect order[] = {DIALECT_SIEMENS, DIALECT_MARLIN, DIALECT_HAAS,
                                         DIALECT_FANUC,   DIALECT_MACH3,  DIALECT_GRBL};
    const struct dialect_arcs *arcs = &d->arcs;
    struct dialect_guess guess = {
        .absolute = arcs->absolute > 1 && arcs->relative == 0 && !arcs->said && !d->linuxcnc,
        .translates = d->translates,
    };
    unsigned found = 0;

    for (unsigned i = 0; i < DIALECT_COUNT && !d->linuxcnc; i++)
        found |= d->found_line[i] != 0 ? BIT(i) : 0;
    if ((found & d->named) != 0)
        found &= d->named;
    if (found == INDUSTRY || found == (BIT(DIALECT_FANUC) | BIT(DIALECT_HAAS)))
        found = (d->alone & found) == BIT(DIALECT_HAAS) ? BIT(DIALECT_HAAS) : BIT(DIALECT_FANUC);
    for (size_t i = 0; i < sizeof order / sizeof order[0] && guess.line == 0; i++) {
        if ((found & BIT(order[i])) != 0) {
            guess.dialect = order[i];
            guess.translates = true;
            guess.line = d->found_line[order[i]];
            memcpy(guess.evidence, d->found[order[i]], sizeof guess.evidence);
        }
    }
    if (guess.absolute && guess.line == 0) {
        guess.dialect = DIALECT_GRBL;
        guess.line = arcs->line;
        memcpy(guess.evidence, "absolute I J", sizeof "absolute I J");
    }
    guess.translates = guess.translates || guess.absolute;
    return guess;
}

#include "words/line.h"

#include "base/decimal.h"

#include <string.h>

static bool is_letter(char c)
{
    c = line_lower(c);
    return c >= 'a' && c <= 'z';
}

size_t line_name_length(const struct line *l, size_t at)
{
    const size_t begin = at;

    if (!is_letter(l->text[at]))
        return 0;
    while (is_letter(l->text[at]) || l->text[at] == '_' ||
           (l->text[at] >= '0' && l->text[at] <= '9'))
        at++;
    return at - begin;
}

/* What words begin with: letters, and the signs of polar coordinates. */
static bool is_word(char c)
{
    return is_letter(c) || c == '@' || c == '^';
}

static bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

static size_t skip_spaces(const struct line *l, size_t at)
{
    while (is_space(l->text[at]))
        at++;
    return at;
}

bool line_is_assigned(const struct line *l, size_t at)
{
    return l->text[skip_spaces(l, at)] == '=';
}

/*
 * Behind the bracket or parenthesis that closes the one at a place; the end of the line when none
 * does.
 */
static size_t skip_nested(const struct line *l, size_t at, char open, char close)
{
    unsigned depth = 0;

    for (; at < l->length; at++) {
        depth += l->text[at] == open ? 1U : 0U;
        depth -= l->text[at] == close ? 1U : 0U;
        if (depth == 0)
            return at + 1;
    }
    return l->length;
}

static size_t skip_letters(const struct line *l, size_t at)
{
    while (is_letter(l->text[at]))
        at++;
    return at;
}

/* Behind a value: number, #1, #<name>, [ ], or a function of it; at when there is none. */
static size_t skip_value(const struct line *l, size_t at)
{
    const size_t begin = at;
    double ignored;

    at = skip_spaces(l, at);
    while (l->text[at] == '-' || l->text[at] == '+' || l->text[at] == '#')
        at = skip_spaces(l, at + 1);
    if (l->text[at] == '[')
        return skip_nested(l, at, '[', ']');
    if (l->text[at] == '<')
        return skip_nested(l, at, '<', '>');
    const size_t letters = skip_letters(l, at);

    if (letters > at && l->text[skip_spaces(l, letters)] == '[')
        return skip_nested(l, skip_spaces(l, letters), '[', ']');
    const size_t digits = takt_decimal_read(&l->text[at], l->length - at, &ignored);

    return digits > 0 ? at + digits : begin;
}

static void set_number(struct line *l, struct line_word *w)
{
    size_t at = w->value_begin;
    double sign = 1.0;

    for (; l->text[at] == '-' || l->text[at] == '+' || is_space(l->text[at]); at++)
        sign = l->text[at] == '-' ? -sign : sign;
    const size_t digits = takt_decimal_read(&l->text[at], w->end - at, &w->value);

    w->is_number = digits > 0 && at + digits == w->end;
    w->value *= sign;
    w->has_point = memchr(&l->text[w->value_begin], '.', (size_t)(w->end - w->value_begin)) != NULL;
}

static bool matches(const struct line *l, size_t at, const char *keyword)
{
    for (; *keyword != '\0'; keyword++, at++) {
        if (line_lower(l->text[at]) != *keyword)
            return false;
    }
    return true;
}

/* What stands behind a keyword, and not behind the same letters in IFIX[1]. */
static bool begins_number(const struct line *l, size_t at)
{
    const char c = l->text[skip_spaces(l, at)];

    return c == '[' || c == '#' || (c >= '0' && c <= '9');
}

static size_t keyword_length(const struct line *l, size_t at)
{
    static const char *const keywords[] = {"if", "while", "do", "end", "goto", "then"};

    for (size_t i = 0; i < sizeof keywords / sizeof keywords[0]; i++) {
        const size_t length = strlen(keywords[i]);

        if (matches(l, at, keywords[i]) &&
            (i + 1 == sizeof keywords / sizeof keywords[0] || begins_number(l, at + length)))
            return length;
    }
    return 0;
}

static size_t read_letter(struct line *l, struct line_word *w, size_t at)
{
    const size_t keyword = keyword_length(l, at);

    if (keyword > 0) {
        w->kind = WORD_KEYWORD;
        return at + keyword;
    }
    w->value_begin = (uint16_t)(at + 1);
    const size_t end = skip_value(l, at + 1);

    w->kind = end > at + 1 ? WORD_VALUE : WORD_BARE;
    return end;
}

static size_t read_assignment(struct line *l, struct line_word *w, size_t at)
{
    const size_t equals = skip_spaces(l, skip_value(l, at));

    w->kind = WORD_ASSIGNED;
    if (l->text[equals] != '=')
        return equals > at ? equals : at + 1;
    w->value_begin = (uint16_t)(equals + 1);
    const size_t end = skip_value(l, equals + 1);

    return end;
}

static size_t read_word(struct line *l, struct line_word *w, size_t at)
{
    const char c = l->text[at];

    *w = (struct line_word){.kind = WORD_OTHER, .letter = line_lower(c), .begin = (uint16_t)at};
    if (c == '(') {
        w->kind = WORD_COMMENT;
        return skip_nested(l, at, '(', ')');
    }
    if (c == ';') {
        w->kind = WORD_COMMENT;
        return l->length;
    }
    if (c == '[') {
        w->kind = WORD_BRACKET;
        return skip_nested(l, at, '[', ']');
    }
    if (c == '#')
        return read_assignment(l, w, at);
    return is_word(c) ? read_letter(l, w, at) : at + 1;
}

static bool read_words(struct line *l)
{
    l->words = 0;
    for (size_t at = skip_spaces(l, 0); at < l->length; at = skip_spaces(l, at)) {
        struct line_word *w = &l->word[l->words];

        if (l->words == LINE_WORDS_MAX)
            return false;
        at = read_word(l, w, at);
        w->end = (uint16_t)at;
        if (w->kind == WORD_VALUE)
            set_number(l, w);
        l->words++;
    }
    return true;
}

bool line_read(struct line *l, const char *bytes, size_t length)
{
    if (length > LINE_MAX_BYTES || memchr(bytes, '\0', length) != NULL)
        return false;
    memmove(l->text, bytes, length);
    l->text[length] = '\0';
    l->length = length;
    return read_words(l);
}

uint32_t line_whole(double value)
{
    if (!(value > 0.0))
        return 0;
    return value < (double)UINT32_MAX ? (uint32_t)value : UINT32_MAX;
}

struct line_word *line_find(struct line *l, char letter, unsigned from)
{
    for (unsigned i = from; i < l->words; i++) {
        if (l->word[i].kind == WORD_VALUE && l->word[i].letter == letter)
            return &l->word[i];
    }
    return NULL;
}

const struct line_word *line_number(const struct line *l)
{
    const struct line_word *w = l->word;

    while (w < l->word + l->words &&
           (w->kind == WORD_COMMENT ||
            (w->kind == WORD_OTHER && strchr("/0123456789", w->letter) != NULL)))
        w++;
    return w < l->word + l->words && w->kind == WORD_VALUE && w->letter == 'n' && w->is_number
               ? w
               : NULL;
}

int line_code(const struct line_word *w)
{
    const double number_x10 = w->value * 10.0;

    if (w->kind != WORD_VALUE || (w->letter != 'g' && w->letter != 'm') || !w->is_number ||
        number_x10 < 0.0 || number_x10 >= 65535.0)
        return -1;
    return (int)(number_x10 + 0.5);
}

struct line_word *line_find_code(struct line *l, char letter, unsigned number_x10)
{
    for (unsigned i = 0; i < l->words; i++) {
        if (l->word[i].letter == letter && line_code(&l->word[i]) == (int)number_x10)
            return &l->word[i];
    }
    return NULL;
}

bool line_is_keyword(const struct line *l, const struct line_word *w, const char *keyword)
{
    return w->kind == WORD_KEYWORD && (size_t)(w->end - w->begin) == strlen(keyword) &&
           matches(l, w->begin, keyword);
}

void line_blank(struct line *l, struct line_word *w)
{
    memset(&l->text[w->begin], ' ', (size_t)(w->end - w->begin));
    w->kind = WORD_OTHER;
    w->letter = ' ';
}

static bool insert(struct line *l, size_t from, size_t to, const char *text)
{
    const size_t size = strlen(text);

    if (l->length + size > LINE_MAX_BYTES)
        return false;
    memmove(&l->text[from + size], &l->text[to], l->length - to + 1);
    memcpy(&l->text[from], text, size);
    l->length = l->length - (to - from) + size;
    return read_words(l);
}

bool line_replace(struct line *l, struct line_word *w, const char *text)
{
    const size_t size = strlen(text);

    if (size <= (size_t)(w->end - w->begin)) {
        memset(&l->text[w->begin], ' ', (size_t)(w->end - w->begin));
        memcpy(&l->text[w->begin], text, size);
        return read_words(l);
    }
    return insert(l, w->begin, w->end, text);
}

bool line_append(struct line *l, const char *text)
{
    const struct line_word *last = l->words > 0 ? &l->word[l->words - 1] : NULL;
    const size_t at = last != NULL && last->kind == WORD_COMMENT ? last->begin : l->length;

    return insert(l, at, at, " ") && insert(l, at + 1, at + 1, text);
}

const char *line_checksum(const struct line *l)
{
    const char *star = strrchr(l->text, '*');

    if (star == NULL || strpbrk(l->text, "[(;#=") != NULL ||
        strspn(star + 1, "0123456789 \r") != strlen(star + 1))
        return NULL;
    return star;
}

const char *line_message(const struct line *l, size_t *length)
{
    const size_t begin = skip_spaces(l, 0);

    if (!line_begins(&l->text[begin], "msg"))
        return NULL;
    const size_t quote = skip_spaces(l, begin + 3);

    if (l->text[quote] != '"')
        return NULL;
    const char *end = strchr(&l->text[quote + 1], '"');

    *length = end != NULL ? (size_t)(end - &l->text[quote + 1]) : l->length - quote - 1;
    return &l->text[quote + 1];
}

bool line_runs_python(const struct line *l, const struct line_word *w)
{
    const char *text = &l->text[w->begin + 1];

    text += strspn(text, " ");
    return w->kind == WORD_COMMENT && (line_begins(text, "py,") || line_begins(text, "pyrun,"));
}

bool line_is_directive(const struct line *l)
{
    const size_t at = skip_spaces(l, 0);

    return l->text[at] == '[' && is_letter(l->text[at + 1]);
}

size_t line_macro_length(const struct line *l)
{
    const size_t length = line_name_length(l, 0);
    bool joined = false;

    for (size_t i = 0; i < length; i++) {
        if (i < 3 && !is_letter(l->text[i]))
            return 0;
        joined = joined || l->text[i] == '_';
    }
    if (length < 3 || (!joined && strchr("gmnt", line_lower(l->text[0])) != NULL) ||
        line_is_assigned(l, length))
        return 0;
    return length;
}

struct line_word *line_unit(struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];

        if (w->kind != WORD_COMMENT &&
            (w->kind != WORD_VALUE || strchr("gmnfst", w->letter) == NULL))
            return NULL;
    }
    struct line_word *inches = line_find_code(l, 'g', 700);

    return inches != NULL ? inches : line_find_code(l, 'g', 710);
}

bool line_is_bare_machine(struct line *l)
{
    bool motion;
    bool other;

    line_look_for_motion(l, &motion, &other);
    return !motion && line_find_code(l, 'g', 530) != NULL && line_has_axis(l);
}

bool line_is_blank(const struct line *l)
{
    return skip_spaces(l, 0) == l->length;
}

bool line_is_calculation(const struct line *l, const struct line_word *w)
{
    const char *behind = &l->text[skip_spaces(l, w->end)];
    const bool operates = (*behind != '\0' && strchr("+-*/", *behind) != NULL) ||
                          line_begins(behind, "mod") || line_begins(behind, "and") ||
                          line_begins(behind, "or") || line_begins(behind, "xor");

    return w->kind == WORD_ASSIGNED && w->value_begin > 0 && w->end > w->value_begin &&
           l->text[w->value_begin - 1] == '=' && operates;
}

bool line_has_axis(struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        if (l->word[i].kind == WORD_VALUE && strchr(LINE_AXES, l->word[i].letter) != NULL)
            return true;
    }
    return false;
}

void line_look_for_motion(struct line *l, bool *motion, bool *other)
{
    static const uint16_t others[] = {40, 100, 280, 281, 300, 301, 520, 530, 920, 431, 432};

    *motion = *other = false;
    for (unsigned i = 0; i < l->words; i++) {
        const int number = l->word[i].letter == 'g' ? line_code(&l->word[i]) : -1;

        *motion = *motion || (number >= 0 && number < 40) || (number >= 50 && number <= 62) ||
                  number == 330 || number == 331 || (number >= 382 && number <= 385) ||
                  (number >= 730 && number <= 890);
        for (size_t k = 0; k < sizeof others / sizeof others[0]; k++)
            *other = *other || number == others[k];
    }
}

bool line_ends_cycle(struct line *l)
{
    for (unsigned number = 0; number < 40; number += 10) {
        if (line_find_code(l, 'g', number) != NULL)
            return false;
    }
    return line_find_code(l, 'g', 800) != NULL;
}

bool line_code_is_mode(int number)
{
    return (number >= 170 && number <= 210) || number == 400 || number == 490 ||
           (number >= 540 && number <= 640) || (number >= 900 && number <= 911) ||
           (number >= 930 && number <= 990);
}

bool line_is_plain(const struct line *l)
{
    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];

        if (w->letter == 'g' && w->kind == WORD_VALUE && !line_code_is_mode(line_code(w)))
            return false;
    }
    return true;
}

bool line_read_label(const struct line *l, char name[LINE_LABEL_MAX], const char **behind)
{
    const char *at = l->text;
    size_t length = 0;

    while (*at == ' ' || *at == '\t')
        at++;
    if (line_lower(*at) != 'o')
        return false;
    for (at++; length < LINE_LABEL_MAX - 1 && *at != '\0'; at++) {
        const char c = line_lower(*at);
        const bool named = length > 0 && name[0] == '<';

        if (!named && c != '<' && c != ' ' && !(c >= '0' && c <= '9'))
            break;
        if (c == '>') {
            at++;
            break;
        }
        if (c != ' ' && !(c == '0' && length == 0))
            name[length++] = c;
    }
    name[length] = '\0';
    *behind = at + strspn(at, " \t");
    return length > 0;
}

bool line_begins(const char *text, const char *word)
{
    for (; *word != '\0'; text++, word++) {
        if (line_lower(*text) != *word)
            return false;
    }
    return true;
}

bool line_defines_label(const char *behind)
{
    return line_begins(behind, "sub") || *behind == '\0' || *behind == '(' || *behind == ';' ||
           *behind == '\r';
}

#include "correction/table_cells.h"

#include "base/decimal.h"
#include "base/maths.h"

/* Larger exponents are no measurements any more. */
#define EXPONENT_MAX 300

void takt_cells_open(struct cells *c, const char *text, size_t length)
{
    *c = (struct cells){.text = text, .length = length};
}

static bool is_space(char character)
{
    return character == ' ' || character == '\t' || character == '\r';
}

static bool is_comment_or_empty(const struct cells *c)
{
    size_t at = c->begin;

    while (at < c->end && is_space(c->text[at])) {
        at++;
    }
    return at == c->end || c->text[at] == '#';
}

bool takt_cells_next_line(struct cells *c)
{
    while (c->next < c->length) {
        c->begin = c->end = c->next;
        c->line++;
        while (c->end < c->length && c->text[c->end] != '\n') {
            c->end++;
        }
        c->next = c->end + 1;
        if (!is_comment_or_empty(c)) {
            c->position = c->begin;
            c->more = true;
            return true;
        }
    }
    return false;
}

static bool is_separator(const struct cells *c, size_t at, bool white)
{
    const char character = c->text[at];

    return white ? is_space(character) : character == ',' || character == ';' || character == '\t';
}

static void trim(struct cells *c)
{
    while (c->cell < c->until && is_space(c->text[c->cell])) {
        c->cell++;
    }
    while (c->until > c->cell && is_space(c->text[c->until - 1])) {
        c->until--;
    }
}

bool takt_cells_next(struct cells *c, bool white)
{
    while (white && c->position < c->end && is_space(c->text[c->position])) {
        c->position++;
    }
    if (!c->more || (white && c->position == c->end)) {
        return false;
    }
    c->cell = c->until = c->position;
    while (c->until < c->end && !is_separator(c, c->until, white)) {
        c->until++;
    }
    c->more = c->until < c->end;
    c->position = c->until + (c->more ? 1 : 0);
    trim(c);
    return true;
}

static char small(char character)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz";

    if (character < 'A' || character > 'Z') {
        return character;
    }
    return letters[character - 'A'];
}

/*
 * Length of word if the text has it at a place of this cell, else 0; letters of either case are the
 * same.
 */
static size_t match(const struct cells *c, size_t at, const char *word)
{
    size_t length = 0;

    while (word[length] != '\0') {
        if (at + length >= c->until || small(c->text[at + length]) != small(word[length])) {
            return 0;
        }
        length++;
    }
    return length;
}

bool takt_cells_is(const struct cells *c, const char *word)
{
    return c->cell + match(c, c->cell, word) == c->until && c->cell < c->until;
}

/* value * 10^exponent. A power of ten up to 10^22 is exact, so most values are rounded once. */
static double scale(double value, int exponent)
{
    double power = 1.0;

    for (int i = exponent < 0 ? -exponent : exponent; i > 0; i--) {
        power *= 10.0;
    }
    return exponent < 0 ? value / power : value * power;
}

/* "e-05" at *at; leaves it where it is when no exponent stands there. */
static int read_exponent(const struct cells *c, size_t *at)
{
    size_t digit = *at + 1;
    int exponent = 0;
    bool negative = false;

    if (*at >= c->until || small(c->text[*at]) != 'e') {
        return 0;
    }
    if (digit < c->until && (c->text[digit] == '-' || c->text[digit] == '+')) {
        negative = c->text[digit++] == '-';
    }
    for (; digit < c->until && c->text[digit] >= '0' && c->text[digit] <= '9'; digit++) {
        exponent = exponent > EXPONENT_MAX ? exponent : exponent * 10 + (c->text[digit] - '0');
        *at = digit + 1;
    }
    return negative ? -exponent : exponent;
}

enum takt_error takt_cells_number(const struct cells *c, double *value)
{
    size_t at = c->cell;
    bool negative = false;

    if (at < c->until && (c->text[at] == '-' || c->text[at] == '+')) {
        negative = c->text[at++] == '-';
    }
    if (match(c, at, "nan") != 0 || match(c, at, "inf") != 0) {
        return TAKT_ERROR_TABLE_NOT_FINITE;
    }
    const size_t digits = takt_decimal_read(c->text + at, c->until - at, value);

    at += digits;
    const int exponent = read_exponent(c, &at);

    if (digits == 0 || at != c->until) {
        return TAKT_ERROR_TABLE_NUMBER;
    }
    if (exponent > EXPONENT_MAX || exponent < -EXPONENT_MAX) {
        return TAKT_ERROR_TABLE_NOT_FINITE;
    }
    *value = scale(negative ? -*value : *value, exponent);
    return maths_is_finite(*value) ? TAKT_OK : TAKT_ERROR_TABLE_NOT_FINITE;
}

bool takt_cells_refuse(const struct cells *c, struct diagnostic *wrong, enum takt_error code,
                       double value)
{
    takt_diagnostic_set(wrong, code, c->line, (uint32_t)(c->cell - c->begin) + 1, c->text + c->cell,
                        c->until - c->cell, value);
    return false;
}

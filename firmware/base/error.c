#include "error.h"

#include "decimal.h"

#define VALUE_PLACES 6

struct text {
    char *start;
    size_t length;
};

/* Cuts at the end of the room, and keeps one place for the terminating zero. */
static void text_add(struct text *t, const char *s, size_t length)
{
    for (size_t i = 0; i < length && t->length < DIAGNOSTIC_TEXT_MAX - 1; i++)
        t->start[t->length++] = s[i];
}

static void text_add_string(struct text *t, const char *s)
{
    size_t length = 0;
    while (s[length] != '\0')
        length++;
    text_add(t, s, length);
}

/* With at most VALUE_PLACES decimals, "0.5" and not "0.500000"; an exponent is kept whole. */
static void text_add_value(struct text *t, double value)
{
    char digits[DECIMAL_TEXT_MAX];
    size_t length = decimal_write(digits, value, VALUE_PLACES);
    size_t point = 0;
    while (point < length && digits[point] != '.')
        point++;
    if (point + 1 + VALUE_PLACES == length) {
        while (digits[length - 1] == '0')
            length--;
        if (digits[length - 1] == '.')
            length--;
    }
    text_add(t, digits, length);
}

static bool is_control(char c)
{
    unsigned char byte = (unsigned char)c;
    return byte < 0x20 || byte == 0x7f;
}

/* 10xxxxxx: inside a UTF-8 character. */
static bool is_utf8_continuation(char c)
{
    return ((unsigned char)c & 0xc0U) == 0x80U;
}

static size_t length_that_fits(const char *word, size_t length)
{
    if (length <= DIAGNOSTIC_WORD_MAX)
        return length;
    length = DIAGNOSTIC_WORD_MAX;
    while (length > 0 && is_utf8_continuation(word[length]))
        length--;
    return length;
}

void diagnostic_set(struct diagnostic *d, enum takt_error code, uint32_t line, uint32_t column,
                    const char *word, size_t word_length, double value)
{
    size_t length = length_that_fits(word, word_length);
    d->code = code;
    d->line = line;
    d->column = column;
    d->value = value;
    for (size_t i = 0; i < length; i++) {
        d->word[i] = word[i];
        if (is_control(word[i]))
            d->word[i] = '?';
    }
    d->word[length] = '\0';
}

#define TAKT_ERROR_TEXT(name, text) text,
static const char *const TEMPLATE[TAKT_ERROR_TOTAL] = {TAKT_ERRORS(TAKT_ERROR_TEXT)};
#undef TAKT_ERROR_TEXT

static void text_add_template(struct text *t, const char *template, const struct diagnostic *d)
{
    for (const char *c = template; *c != '\0'; c++) {
        if (c[0] == '%' && c[1] == 'w')
            text_add_string(t, d->word);
        else if (c[0] == '%' && c[1] == 'v')
            text_add_value(t, d->value);
        else {
            text_add(t, c, 1);
            continue;
        }
        c++;
    }
}

size_t diagnostic_text(const struct diagnostic *d, char *text)
{
    struct text t = {text, 0};
    int index = -1 - (int)d->code;
    if (d->code == TAKT_OK) {
        text_add_string(&t, "no error");
    } else if (index >= 0 && index < (int)TAKT_ERROR_TOTAL) {
        text_add_template(&t, TEMPLATE[index], d);
    } else {
        text_add_string(&t, "error ");
        text_add_value(&t, (double)(int)d->code);
    }
    text[t.length] = '\0';
    return t.length;
}

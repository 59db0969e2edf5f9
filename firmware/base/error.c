#include "error.h"

#include "base/assert.h"
#include "decimal.h"
#include "error_text.h"

#define VALUE_PLACES 6

struct text {
    char *start;
    size_t length;
    bool has_percent; /* the last character was a percent sign, and is not in it yet */
};

/* Cuts at the end of the room, and keeps one place for the terminating zero. */
static void text_add(struct text *t, const char *s, size_t length)
{
    TAKT_ASSERT(t->length < DIAGNOSTIC_TEXT_MAX);
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
    size_t length = takt_decimal_write(digits, value, VALUE_PLACES);
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

/* Whole numbers below 2^32, as codes are written: with 4 digits or 8. */
static void text_add_hex(struct text *t, double value)
{
    uint32_t bits = value > 0 && value <= (double)UINT32_MAX ? (uint32_t)value : 0;
    unsigned digits = bits > UINT16_MAX ? 8 : 4;
    while (digits-- > 0)
        text_add(t, &"0123456789ABCDEF"[bits >> (4 * digits) & 15], 1);
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

void takt_diagnostic_set(struct diagnostic *d, enum takt_error code, uint32_t line, uint32_t column,
                         const char *word, size_t word_length, double value)
{
    size_t length = length_that_fits(word, word_length);
    d->code = code;
    d->line = line;
    d->column = column;
    d->value = value;
    d->limit = 0.0;
    d->meaning = NULL;
    for (size_t i = 0; i < length; i++) {
        d->word[i] = word[i];
        if (is_control(word[i]))
            d->word[i] = '?';
    }
    d->word[length] = '\0';
}

void takt_diagnostic_set_limit(struct diagnostic *d, double limit)
{
    d->limit = limit;
}

/* The unit of the axis with which the word begins. */
static const char *unit_of(const char *word)
{
    return word[0] >= 'A' && word[0] <= 'C' ? "degrees" : "mm";
}

/* What a percent sign with this letter stands for; false: it stands for itself. */
static bool text_add_place(struct text *t, char letter, const struct diagnostic *d)
{
    switch (letter) {
    case 'w':
        text_add_string(t, d->word);
        return true;
    case 'v':
        text_add_value(t, d->value);
        return true;
    case 'l':
        text_add_value(t, d->limit);
        return true;
    case 'x':
        text_add_hex(t, d->value);
        return true;
    case 'm':
        text_add_string(t, d->meaning != NULL ? d->meaning : "?");
        return true;
    case 'u':
        text_add_string(t, unit_of(d->word));
        return true;
    default:
        return false;
    }
}

static void text_add_character(struct text *t, char c, const struct diagnostic *d)
{
    bool is_place = t->has_percent && text_add_place(t, c, d);
    if (t->has_percent && !is_place)
        text_add(t, "%", 1);
    t->has_percent = !is_place && c == '%';
    if (!is_place && c != '%')
        text_add(t, &c, 1);
}

/* What a stored byte stands for: the first of a pair at once, the second after it. */
static void text_add_stored(struct text *t, uint8_t byte, const struct diagnostic *d)
{
    uint8_t later[ERROR_TEXT_DEPTH];
    unsigned count = 0;
    later[count++] = byte;
    while (count > 0) {
        byte = later[--count];
        for (; byte >= ERROR_TEXT_PLAIN; byte = takt_error_text_pairs[byte - ERROR_TEXT_PLAIN][0])
            later[count++] = takt_error_text_pairs[byte - ERROR_TEXT_PLAIN][1];
        text_add_character(t, (char)byte, d);
    }
}

static void text_add_template(struct text *t, const uint8_t *stored, const struct diagnostic *d)
{
    for (; *stored != '\0'; stored++)
        text_add_stored(t, *stored, d);
    if (t->has_percent)
        text_add(t, "%", 1);
}

size_t takt_diagnostic_text(const struct diagnostic *d, char *text)
{
    struct text t = {text, 0, false};
    int index = -1 - (int)d->code;
    if (d->code == TAKT_OK) {
        text_add_string(&t, "no error");
    } else if (index >= 0 && index < (int)TAKT_ERROR_TOTAL) {
        text_add_template(&t, takt_error_text_find((unsigned)index), d);
    } else {
        text_add_string(&t, "error ");
        text_add_value(&t, (double)(int)d->code);
    }
    text[t.length] = '\0';
    return t.length;
}

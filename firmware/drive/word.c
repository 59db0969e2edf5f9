#include "drive/word.h"

#define DIGITS_MAX 10

static void add(struct word *word, char c)
{
    if (word->length < DIAGNOSTIC_WORD_MAX)
        word->text[word->length++] = c;
}

void takt_word_add_text(struct word *word, const char *text)
{
    while (*text != '\0')
        add(word, *text++);
}

void takt_word_add_number(struct word *word, uint32_t number)
{
    char digits[DIGITS_MAX];
    unsigned count = 0;
    do {
        digits[count++] = (char)('0' + number % 10);
        number /= 10;
    } while (number != 0);
    while (count > 0)
        add(word, digits[--count]);
}

void takt_word_add_hex(struct word *word, uint32_t number, unsigned digits)
{
    while (digits-- > 0)
        add(word, "0123456789ABCDEF"[number >> (4 * digits) & 15]);
}

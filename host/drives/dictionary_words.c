#include "drives/dictionary_words.h"

#include <ctype.h>
#include <limits.h>
#include <stdlib.h>

struct text_part words_trim(const char *start, size_t length)
{
    while (length > 0 && isspace((unsigned char)*start)) {
        start++;
        length--;
    }
    while (length > 0 && isspace((unsigned char)start[length - 1]))
        length--;
    return (struct text_part){start, length};
}

bool words_are(struct text_part part, const char *word)
{
    size_t i = 0;
    for (; i < part.length && word[i] != '\0'; i++)
        if (tolower((unsigned char)part.start[i]) != word[i])
            return false;
    return i == part.length && word[i] == '\0';
}

bool words_read_number(struct text_part part, int64_t *number, bool *has_node)
{
    char digits[40];
    size_t length = 0;
    char *end;
    *has_node = false;
    for (size_t i = 0; i < part.length && length + 1 < sizeof digits; i++) {
        const struct text_part rest = {part.start + i, part.length - i < 7 ? part.length - i : 7};
        char c = part.start[i];
        if (words_are(rest, "$nodeid")) {
            *has_node = true;
            i += 6;
        } else if (c != '+' && !isspace((unsigned char)c)) {
            digits[length++] = c;
        }
    }
    digits[length] = '\0';
    if (length == 0) {
        *number = 0;
        return *has_node;
    }
    *number = digits[0] == '-' ? strtoll(digits, &end, 0) : (int64_t)strtoull(digits, &end, 0);
    return *end == '\0';
}

long words_plain_number(struct text_part part, long otherwise)
{
    int64_t number;
    bool has_node;
    if (!words_read_number(part, &number, &has_node) || number < 0 || number > INT_MAX)
        return otherwise;
    return (long)number;
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c = (char)tolower((unsigned char)c);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

size_t words_read_hex(struct text_part part, size_t most, unsigned *number)
{
    size_t i = 0;
    *number = 0;
    for (; i < part.length && i < most && hex_digit(part.start[i]) >= 0; i++)
        *number = *number << 4 | (unsigned)hex_digit(part.start[i]);
    return i;
}

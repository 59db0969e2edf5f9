#include "console/reply.h"

#include "base/assert.h"
#include "base/decimal.h"

/* Characters of a number of 64 bits, with sign and point. */
#define DIGITS_MAX 24

void takt_reply_send(struct reply *r)
{
    if (r->length > 0)
        r->write(r->context, r->text, r->length);
    r->length = 0;
}

static void put(struct reply *r, char c)
{
    TAKT_ASSERT(r->length <= sizeof r->text);
    if (r->length == sizeof r->text)
        takt_reply_send(r);
    r->text[r->length++] = c;
}

void takt_reply_text(struct reply *r, const char *text)
{
    for (; *text != '\0'; text++)
        put(r, *text);
}

void takt_reply_counts(struct reply *r, int64_t counts, unsigned decimals)
{
    char digits[DIGITS_MAX];
    uint64_t rest = counts < 0 ? (uint64_t)-counts : (uint64_t)counts;
    unsigned length = 0;

    do {
        digits[length++] = (char)('0' + rest % 10U);
        rest /= 10U;
        if (length == decimals)
            digits[length++] = '.';
    } while (rest > 0 || length <= decimals + (decimals > 0));
    if (counts < 0)
        put(r, '-');
    while (length > 0)
        put(r, digits[--length]);
}

void takt_reply_number(struct reply *r, double value, unsigned decimals)
{
    char digits[DECIMAL_TEXT_MAX];
    const size_t length = takt_decimal_write(digits, value, decimals);

    for (size_t i = 0; i < length; i++)
        put(r, digits[i]);
}

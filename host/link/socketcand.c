#include "link/socketcand.h"

#include "bus/hex.h"

#include <stdio.h>
#include <string.h>

#define FLAG_RATE_SWITCH 1u
#define FLAG_PASSIVE     2u

#define EXTENDED_DIGITS 8

static unsigned id_digits(const struct wire_frame *frame)
{
    return frame->flags & WIRE_EXTENDED ? 8 : 3;
}

static unsigned fd_flags(const struct wire_frame *frame)
{
    return (frame->flags & WIRE_RATE_SWITCH ? FLAG_RATE_SWITCH : 0) |
           (frame->flags & WIRE_PASSIVE ? FLAG_PASSIVE : 0);
}

static char *put_text(char *at, const char *text)
{
    while (*text != '\0')
        *at++ = *text++;
    return at;
}

size_t socketcand_write_send(char text[SOCKETCAND_MESSAGE_MAX], const struct wire_frame *frame)
{
    bool remote = frame->flags & WIRE_REMOTE, fd = frame->flags & WIRE_FD;
    char *at = put_text(text, remote ? "< sendrtr " : fd ? "< fdsend " : "< send ");
    at = hex_put(at, frame->id, id_digits(frame));
    if (fd)
        at += sprintf(at, " %X", fd_flags(frame));
    at += sprintf(at, " %u", (unsigned)frame->length);
    for (unsigned i = 0; i < frame->length && !remote; i++) {
        *at++ = ' ';
        at = hex_put(at, frame->data[i], 2);
    }
    at = put_text(at, " >");
    return (size_t)(at - text);
}

size_t socketcand_write_frame(char text[SOCKETCAND_MESSAGE_MAX], const struct wire_frame *frame,
                              uint64_t time_ns)
{
    bool remote = frame->flags & WIRE_REMOTE, fd = frame->flags & WIRE_FD;
    char *at = put_text(text, remote ? "< rtr " : fd ? "< fdframe " : "< frame ");
    at = hex_put(at, frame->id, id_digits(frame));
    if (fd)
        at += sprintf(at, " %02X", fd_flags(frame));
    at += sprintf(at, " %llu.%06u ", (unsigned long long)(time_ns / 1000000000u),
                  (unsigned)(time_ns / 1000 % 1000000));
    if (remote)
        at += sprintf(at, "%u", (unsigned)frame->length);
    for (unsigned i = 0; i < frame->length && !remote; i++)
        at = hex_put(at, frame->data[i], 2);
    at = put_text(at, " >");
    return (size_t)(at - text);
}

/* Words between spaces, ended by >. */
struct words {
    const char *at, *end;
};

struct word {
    const char *text;
    size_t length;
};

/* False: there is none left. */
static bool take_word(struct words *words, struct word *word)
{
    while (words->at < words->end && *words->at == ' ')
        words->at++;
    word->text = words->at;
    while (words->at < words->end && *words->at != ' ')
        words->at++;
    word->length = (size_t)(words->at - word->text);
    return word->length > 0;
}

/* Without the < and the >. */
static struct words words_of(const char *text, size_t length)
{
    return (struct words){.at = text + 1, .end = text + length - 1};
}

static bool is_word(const struct word *word, const char *text)
{
    return word->length == strlen(text) && memcmp(word->text, text, word->length) == 0;
}

static bool take_hex(struct words *words, uint32_t *value)
{
    struct word word;
    return take_word(words, &word) && word.length <= 8 &&
           hex_get(word.text, (unsigned)word.length, value);
}

static bool take_id(struct words *words, struct wire_frame *frame)
{
    struct word word;
    if (!take_word(words, &word) || word.length > EXTENDED_DIGITS ||
        !hex_get(word.text, (unsigned)word.length, &frame->id))
        return false;
    if (word.length == EXTENDED_DIGITS)
        frame->flags |= WIRE_EXTENDED;
    return frame->id <= (word.length == EXTENDED_DIGITS ? 0x1FFFFFFFu : 0x7FFu);
}

/*
 * Lengths are decimal in some clients and hexadecimal in others; they agree up to 9, and FD lengths
 * above are told by the data.
 */
static bool take_length(struct words *words, struct wire_frame *frame)
{
    struct word word;
    unsigned length = 0;
    if (!take_word(words, &word) || word.length > 2)
        return false;
    for (size_t i = 0; i < word.length; i++) {
        if (word.text[i] < '0' || word.text[i] > '9')
            return false;
        length = 10 * length + (unsigned)(word.text[i] - '0');
    }
    frame->length = (uint8_t)length;
    return length <= (frame->flags & WIRE_FD ? WIRE_DATA_MAX : CAN_CLASSIC_MAX);
}

static bool take_fd_flags(struct words *words, struct wire_frame *frame)
{
    uint32_t flags;
    if (!take_hex(words, &flags))
        return false;
    frame->flags |= (uint8_t)(WIRE_FD | (flags & FLAG_RATE_SWITCH ? WIRE_RATE_SWITCH : 0) |
                              (flags & FLAG_PASSIVE ? WIRE_PASSIVE : 0));
    return true;
}

/* Bytes as words of one or two digits, or several in one word of two digits each. */
static bool take_data(struct words *words, struct wire_frame *frame, unsigned *count)
{
    struct word word;
    uint32_t value;
    *count = 0;
    while (take_word(words, &word)) {
        if (word.length > 1 && word.length % 2 != 0)
            return false;
        unsigned digits = word.length == 1 ? 1 : 2;
        for (size_t i = 0; i < word.length; i += digits) {
            if (*count == WIRE_DATA_MAX || !hex_get(word.text + i, digits, &value))
                return false;
            frame->data[(*count)++] = (uint8_t)value;
        }
    }
    return true;
}

static bool is_fd_length(unsigned count)
{
    return wire_frame_fd_length(count) == count;
}

bool socketcand_read_send(const char *text, size_t length, struct wire_frame *frame)
{
    struct words words = words_of(text, length);
    struct word name;
    unsigned count;
    frame->flags = 0;
    if (!take_word(&words, &name) || !take_id(&words, frame))
        return false;
    if (is_word(&name, "sendrtr"))
        frame->flags |= WIRE_REMOTE;
    else if (is_word(&name, "fdsend") ? !take_fd_flags(&words, frame) : !is_word(&name, "send"))
        return false;
    if (!take_length(&words, frame))
        return false;
    if (frame->flags & WIRE_REMOTE)
        return words.at <= words.end && !take_word(&words, &name);
    return take_data(&words, frame, &count) && count == frame->length && is_fd_length(count);
}

/* A time stamp: looked at by nobody, but it must be there. */
static bool skip_time(struct words *words)
{
    struct word word;
    return take_word(words, &word) && word.text[0] >= '0' && word.text[0] <= '9';
}

bool socketcand_read_frame(const char *text, size_t length, struct wire_frame *frame)
{
    struct words words = words_of(text, length);
    struct word name;
    unsigned count;
    frame->flags = 0;
    if (!take_word(&words, &name) || !take_id(&words, frame))
        return false;
    if (is_word(&name, "rtr")) {
        frame->flags |= WIRE_REMOTE;
        return skip_time(&words) && take_length(&words, frame);
    }
    if (is_word(&name, "fdframe") ? !take_fd_flags(&words, frame) : !is_word(&name, "frame"))
        return false;
    if (!skip_time(&words) || !take_data(&words, frame, &count) || !is_fd_length(count))
        return false;
    frame->length = (uint8_t)count;
    return count <= (frame->flags & WIRE_FD ? WIRE_DATA_MAX : CAN_CLASSIC_MAX);
}

size_t socketcand_find(const char *bytes, size_t count, size_t *begin)
{
    const char *open = memchr(bytes, '<', count);
    if (open == NULL) {
        *begin = count;
        return 0;
    }
    *begin = (size_t)(open - bytes);
    const char *close = memchr(open, '>', count - *begin);
    return close != NULL ? (size_t)(close - open) + 1 : 0;
}

bool socketcand_is(const char *text, size_t length, const char *expected)
{
    struct words given = words_of(text, length);
    struct words wanted = {.at = expected, .end = expected + strlen(expected)};
    struct word a, b;
    while (take_word(&wanted, &b))
        if (!take_word(&given, &a) || a.length != b.length || memcmp(a.text, b.text, a.length) != 0)
            return false;
    return !take_word(&given, &a);
}

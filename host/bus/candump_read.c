#include "bus/candump_read.h"

#include "bus/hex.h"

#include <string.h>

#define SECOND_NS        UINT64_C(1000000000)
#define MICROS_DIGITS    6
#define SECONDS_MAX      UINT64_C(9999999999)
#define STANDARD_DIGITS  3
#define EXTENDED_DIGITS  8
#define ERROR_FLAG       0x20000000u
#define EXTENDED_ID_MASK 0x1FFFFFFFu

struct cursor {
    const char *begin, *at, *end;
};

static bool take(struct cursor *c, char wanted)
{
    if (c->at == c->end || *c->at != wanted)
        return false;
    c->at++;
    return true;
}

static unsigned take_decimal(struct cursor *c, uint64_t *value)
{
    unsigned digits = 0;
    *value = 0;
    for (; c->at < c->end && *c->at >= '0' && *c->at <= '9' && digits < 18; c->at++, digits++)
        *value = 10 * *value + (uint64_t)(*c->at - '0');
    return digits;
}

static const char *take_time(struct cursor *c, uint64_t *time_ns)
{
    static const char wrong[] = "a time in seconds is expected: (12.345678)";
    uint64_t seconds, micros;
    if (!take(c, '(') || take_decimal(c, &seconds) == 0 || seconds > SECONDS_MAX || !take(c, '.') ||
        take_decimal(c, &micros) != MICROS_DIGITS || !take(c, ')') || !take(c, ' '))
        return wrong;
    *time_ns = seconds * SECOND_NS + micros * 1000;
    return NULL;
}

static const char *take_interface(struct cursor *c, struct candump_line *read)
{
    const char *begin = c->at;
    while (c->at < c->end && *c->at != ' ')
        c->at++;
    read->interface = begin;
    read->interface_length = (size_t)(c->at - begin);
    return c->at > begin && take(c, ' ') ? NULL : "the name of an interface is expected";
}

static const char *take_id(struct cursor *c, struct wire_frame *frame)
{
    static const char wrong[] = "an identifier of 3 or 8 hexadecimal digits and # are expected";
    const char *mark = memchr(c->at, '#', (size_t)(c->end - c->at));
    size_t digits = mark != NULL ? (size_t)(mark - c->at) : 0;
    if ((digits != STANDARD_DIGITS && digits != EXTENDED_DIGITS) ||
        !hex_get(c->at, (unsigned)digits, &frame->id))
        return wrong;
    if (digits == STANDARD_DIGITS ? frame->id > 0x7FF : frame->id > (ERROR_FLAG | EXTENDED_ID_MASK))
        return "the identifier is out of range";
    if (digits == EXTENDED_DIGITS)
        frame->flags = frame->id & ERROR_FLAG ? WIRE_ERROR : WIRE_EXTENDED;
    frame->id &= EXTENDED_ID_MASK;
    c->at = mark + 1;
    return NULL;
}

/* "R", or "R" and a length of one digit. */
static void take_remote(struct cursor *c, struct wire_frame *frame)
{
    frame->flags |= WIRE_REMOTE;
    if (c->at < c->end && *c->at >= '0' && *c->at <= '8')
        frame->length = (uint8_t)(*c->at++ - '0');
}

static const char *take_bytes(struct cursor *c, struct wire_frame *frame)
{
    unsigned most = frame->flags & WIRE_FD ? WIRE_DATA_MAX : CAN_CLASSIC_MAX;
    while (c->end - c->at >= 2 && frame->length < most &&
           hex_get_bytes(c->at, 1, frame->data + frame->length)) {
        frame->length++;
        c->at += 2;
    }
    if (frame->flags & WIRE_FD && wire_frame_fd_length(frame->length) != frame->length)
        return "a CAN FD frame cannot have this number of bytes";
    return NULL;
}

static const char *take_data(struct cursor *c, struct wire_frame *frame)
{
    uint32_t flags;
    if (take(c, '#')) {
        if (c->at == c->end || !hex_get(c->at, 1, &flags))
            return "the flags of a CAN FD frame are expected, one hexadecimal digit";
        c->at++;
        frame->flags |= (uint8_t)(WIRE_FD | (flags & 1 ? WIRE_RATE_SWITCH : 0) |
                                  (flags & 2 ? WIRE_PASSIVE : 0));
    }
    if (take(c, 'R'))
        take_remote(c, frame);
    else
        return take_bytes(c, frame);
    return NULL;
}

const char *candump_read_line(const char *line, size_t length, struct candump_line *read,
                              unsigned *column)
{
    struct cursor c = {line, line, line + length};
    const char *wrong;
    memset(&read->frame, 0, sizeof read->frame);
    wrong = take_time(&c, &read->time_ns);
    if (wrong == NULL)
        wrong = take_interface(&c, read);
    if (wrong == NULL)
        wrong = take_id(&c, &read->frame);
    if (wrong == NULL)
        wrong = take_data(&c, &read->frame);
    if (wrong == NULL && c.at < c.end && *c.at != ' ')
        wrong = "bytes of two hexadecimal digits are expected, as many as the frame may have";
    *column = (unsigned)(c.at - c.begin) + 1;
    return wrong;
}

#include "link/slcan.h"

#include "bus/hex.h"

#define STANDARD_DIGITS 3
#define EXTENDED_DIGITS 8

/* The letter of a frame without its case, which says how long the identifier is. */
static char letter_of(uint8_t flags)
{
    if (flags & WIRE_REMOTE)
        return 'r';
    if (flags & WIRE_FD)
        return flags & WIRE_RATE_SWITCH ? 'b' : 'd';
    return 't';
}

/* DLC of a CAN FD frame: 9 ... 15 stand for 12, 16, 20, 24, 32, 48, 64. */
static unsigned dlc_of(uint8_t length)
{
    unsigned dlc = length <= CAN_CLASSIC_MAX ? length : CAN_CLASSIC_MAX;
    for (unsigned bytes = CAN_CLASSIC_MAX; bytes < length; dlc++)
        bytes = wire_frame_fd_length(bytes + 1);
    return dlc;
}

static uint8_t length_of(unsigned dlc)
{
    uint8_t length = (uint8_t)(dlc <= CAN_CLASSIC_MAX ? dlc : CAN_CLASSIC_MAX);
    for (unsigned i = CAN_CLASSIC_MAX; i < dlc; i++)
        length = wire_frame_fd_length(length + 1u);
    return length;
}

size_t slcan_write(char line[SLCAN_LINE_MAX], const struct wire_frame *frame)
{
    bool extended = frame->flags & WIRE_EXTENDED;
    char *at = line;
    *at++ = (char)(letter_of(frame->flags) - (extended ? 'a' - 'A' : 0));
    at = hex_put(at, frame->id, extended ? EXTENDED_DIGITS : STANDARD_DIGITS);
    at = hex_put(at, dlc_of(frame->length), 1);
    for (unsigned i = 0; i < frame->length && !(frame->flags & WIRE_REMOTE); i++)
        at = hex_put(at, frame->data[i], 2);
    *at++ = '\r';
    return (size_t)(at - line);
}

/* False: no letter of a frame. */
static bool read_letter(char letter, uint8_t *flags)
{
    *flags = letter >= 'A' && letter <= 'Z' ? WIRE_EXTENDED : 0;
    switch (letter) {
    case 't':
    case 'T':
        return true;
    case 'r':
    case 'R':
        *flags |= WIRE_REMOTE;
        return true;
    case 'd':
    case 'D':
        *flags |= WIRE_FD;
        return true;
    case 'b':
    case 'B':
        *flags |= WIRE_FD | WIRE_RATE_SWITCH;
        return true;
    default:
        return false;
    }
}

bool slcan_read(const char *line, size_t length, struct wire_frame *frame)
{
    uint32_t dlc;
    if (length == 0 || !read_letter(line[0], &frame->flags))
        return false;
    bool extended = frame->flags & WIRE_EXTENDED;
    unsigned digits = extended ? EXTENDED_DIGITS : STANDARD_DIGITS;
    if (length < digits + 2 || !hex_get(line + 1, digits, &frame->id) ||
        !hex_get(line + 1 + digits, 1, &dlc))
        return false;
    if (frame->id > (extended ? 0x1FFFFFFFu : 0x7FFu))
        return false;
    if (dlc > CAN_CLASSIC_MAX && !(frame->flags & WIRE_FD))
        return false;
    frame->length = length_of(dlc);
    if (frame->flags & WIRE_REMOTE)
        return true;
    return length >= digits + 2 + 2u * frame->length &&
           hex_get_bytes(line + digits + 2, frame->length, frame->data);
}

char slcan_bitrate_digit(uint32_t bitrate)
{
    static const uint32_t rates[] = {10000,  20000,  50000,  100000, 125000,
                                     250000, 500000, 800000, 1000000};
    for (unsigned i = 0; i < sizeof rates / sizeof rates[0]; i++)
        if (rates[i] == bitrate)
            return (char)('0' + i);
    return 0;
}

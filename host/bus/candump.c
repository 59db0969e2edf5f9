#include "bus/candump.h"

#include "bus/hex.h"

#include <string.h>

#define SECONDS_DIGITS 10
#define MICROS_DIGITS  6
#define ERROR_FLAG     0x20000000u
/*
 * "(" seconds "." micros ") " interface " " identifier "#" data "\n", and room for seconds of any
 * uint64_t
 */
#define LINE_MAX_LENGTH (64 + CANDUMP_INTERFACE_MAX + 2 * WIRE_DATA_MAX)

void candump_init(struct candump *log, FILE *file, const char *interface)
{
    log->file = file;
    log->failed = log->is_fd = false;
    log->used = 0;
    log->interface_length = 0;
    while (interface[log->interface_length] && log->interface_length < CANDUMP_INTERFACE_MAX)
        log->interface_length++;
    memcpy(log->interface, interface, log->interface_length);
}

void candump_select(struct candump *log, unsigned bus)
{
    memcpy(log->interface, "can", 3);
    log->interface[3] = (char)('0' + bus % 10);
    log->interface_length = 4;
}

static char *put_decimal(char *text, uint64_t value, unsigned digits)
{
    for (unsigned i = digits; i-- > 0; value /= 10)
        text[i] = (char)('0' + value % 10);
    return text + digits;
}

static char *put_time(char *text, uint64_t time_ns)
{
    uint64_t micros = time_ns / 1000;
    *text++ = '(';
    text = put_decimal(text, micros / 1000000, SECONDS_DIGITS);
    *text++ = '.';
    text = put_decimal(text, micros % 1000000, MICROS_DIGITS);
    *text++ = ')';
    *text++ = ' ';
    return text;
}

static void write_buffer(struct candump *log)
{
    if (fwrite(log->buffer, 1, log->used, log->file) != log->used)
        log->failed = true;
    log->used = 0;
}

/* Everything before the identifier. */
static char *begin_line(struct candump *log, uint64_t time_ns)
{
    if (log->used + LINE_MAX_LENGTH > CANDUMP_BUFFER_SIZE)
        write_buffer(log);
    char *text = put_time(log->buffer + log->used, time_ns);
    memcpy(text, log->interface, log->interface_length);
    text += log->interface_length;
    *text++ = ' ';
    return text;
}

static void end_line(struct candump *log, char *text, const uint8_t *data, unsigned length)
{
    for (unsigned i = 0; i < length; i++)
        text = hex_put(text, data[i], 2);
    *text++ = '\n';
    log->used = (size_t)(text - log->buffer);
}

static char *put_identifier(char *text, const struct wire_frame *frame)
{
    if (frame->flags & WIRE_ERROR)
        return hex_put(text, frame->id | ERROR_FLAG, 8);
    return hex_put(text, frame->id, frame->flags & WIRE_EXTENDED ? 8 : 3);
}

/* "#", "##1" or "#R2". */
static char *put_kind(char *text, const struct wire_frame *frame)
{
    *text++ = '#';
    if (frame->flags & WIRE_FD) {
        *text++ = '#';
        *text++ = (char)('0' + (frame->flags & WIRE_RATE_SWITCH ? 1 : 0) +
                         (frame->flags & WIRE_PASSIVE ? 2 : 0));
    }
    if (frame->flags & WIRE_REMOTE) {
        *text++ = 'R';
        *text++ = (char)('0' + frame->length);
    }
    return text;
}

void candump_wire(void *context, const struct wire_frame *frame, uint64_t time_ns)
{
    struct candump *log = context;
    char *text = put_kind(put_identifier(begin_line(log, time_ns), frame), frame);
    end_line(log, text, frame->data, frame->flags & WIRE_REMOTE ? 0 : frame->length);
}

void candump_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    const struct candump *log = context;
    struct wire_frame wire;
    wire_frame_from_can(&wire, frame, log->is_fd);
    candump_wire(context, &wire, time_ns);
}

bool candump_flush(struct candump *log)
{
    write_buffer(log);
    if (fflush(log->file) != 0)
        log->failed = true;
    return !log->failed;
}

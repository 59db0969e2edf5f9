#include "bus/candump.h"

#include <string.h>

#define SECONDS_DIGITS 10
#define MICROS_DIGITS  6
/*
 * "(" seconds "." micros ") " interface " " identifier "#" data "\n", and room for seconds of any
 * uint64_t
 */
#define LINE_MAX_LENGTH (64 + CANDUMP_INTERFACE_MAX)

void candump_init(struct candump *log, FILE *file, const char *interface)
{
    log->file = file;
    log->failed = false;
    log->used = 0;
    log->interface_length = 0;
    while (interface[log->interface_length] && log->interface_length < CANDUMP_INTERFACE_MAX)
        log->interface_length++;
    memcpy(log->interface, interface, log->interface_length);
}

static char *put_decimal(char *text, uint64_t value, unsigned digits)
{
    for (unsigned i = digits; i-- > 0; value /= 10)
        text[i] = (char)('0' + value % 10);
    return text + digits;
}

static char *put_hex(char *text, unsigned value, unsigned digits)
{
    for (unsigned i = digits; i-- > 0; value >>= 4)
        text[i] = "0123456789ABCDEF"[value & 15];
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

void candump_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct candump *log = context;
    if (log->used + LINE_MAX_LENGTH > CANDUMP_BUFFER_SIZE)
        write_buffer(log);
    char *text = put_time(log->buffer + log->used, time_ns);
    memcpy(text, log->interface, log->interface_length);
    text += log->interface_length;
    *text++ = ' ';
    text = put_hex(text, frame->id, 3);
    *text++ = '#';
    for (unsigned i = 0; i < frame->length; i++)
        text = put_hex(text, frame->data[i], 2);
    *text++ = '\n';
    log->used = (size_t)(text - log->buffer);
}

bool candump_flush(struct candump *log)
{
    write_buffer(log);
    if (fflush(log->file) != 0)
        log->failed = true;
    return !log->failed;
}

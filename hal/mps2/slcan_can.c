#include "mps2/slcan_can.h"

#include <string.h>

/* "t" or "r", three digits, the length, two digits a byte, the end. */
#define HEAD      5
#define LINE_MOST (HEAD + 2 * CAN_CLASSIC_MAX + 1)

#define SYNC_ID    0x080U
#define REQUEST_ID 0x600U /* of an SDO, and its answer */
#define ANSWER_ID  0x580U
#define TPDO1_ID   0x180U
#define FUNCTION   0x780U
#define NODE_MASK  0x07FU

void takt_slcan_can_open(struct slcan_can *can, struct uart *line)
{
    memset(can, 0, sizeof *can);
    can->line = line;
}

bool takt_slcan_can_announce(struct slcan_can *can)
{
    static const char open[] = "\rC\rS8\rO\r";

    if (can->written == 0)
        (void)takt_uart_send(can->line, open, sizeof open - 1);
    return can->written != 0;
}

static char digit(unsigned value)
{
    return "0123456789ABCDEF"[value & 0xFU];
}

static int value_of(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

static bool send(void *context, const struct can_frame *frame)
{
    struct slcan_can *can = context;
    char text[LINE_MOST] = {can_is_remote(frame) ? 'r' : 't', digit((frame->id & CAN_ID_MASK) >> 8),
                            digit(frame->id >> 4), digit(frame->id), digit(frame->length)};
    size_t at = HEAD;

    for (unsigned i = 0; i < can_data_length(frame); i++) {
        text[at++] = digit(frame->data[i] >> 4);
        text[at++] = digit(frame->data[i]);
    }
    text[at++] = '\r';
    /* Counted first: the answer may come while the line is still being handed over. */
    if (frame->id == SYNC_ID)
        can->cycle = (uint8_t)(can->cycle % UINT8_MAX + 1U);
    if ((frame->id & FUNCTION) == REQUEST_ID)
        can->asked[frame->id & NODE_MASK] = true;
    return takt_uart_send(can->line, text, at);
}

static bool receive(void *context, struct can_frame *frame)
{
    struct slcan_can *can = context;

    if (can->taken == can->written)
        return false;
    *frame = can->frame[can->taken % SLCAN_CAN_FRAMES_MAX];
    can->taken++;
    return true;
}

struct can_port takt_slcan_can_get_port(struct slcan_can *can)
{
    return (struct can_port){.send = send, .receive = receive, .context = can};
}

/* Reads count hexadecimal digits; -1: they are none. */
static int32_t read_digits(const char *text, unsigned count)
{
    int32_t value = 0;

    for (unsigned i = 0; i < count; i++) {
        const int digit_value = value_of(text[i]);

        if (digit_value < 0)
            return -1;
        value = value * 16 + digit_value;
    }
    return value;
}

/* False: the line is no data frame with an 11-bit identifier. */
static bool read_frame(const char *text, unsigned length, struct can_frame *frame)
{
    const int32_t id = length >= HEAD && text[0] == 't' ? read_digits(text + 1, 3) : -1;
    const int32_t bytes = id >= 0 ? read_digits(text + 4, 1) : -1;

    if (bytes < 0 || bytes > CAN_CLASSIC_MAX || length < HEAD + 2U * (unsigned)bytes)
        return false;
    *frame = (struct can_frame){.id = (uint16_t)id, .length = (uint8_t)bytes};
    for (int32_t i = 0; i < bytes; i++) {
        const int32_t value = read_digits(text + HEAD + 2 * i, 2);

        if (value < 0)
            return false;
        frame->data[i] = (uint8_t)value;
    }
    return true;
}

static void note_answer(struct slcan_can *can, const struct can_frame *frame)
{
    if ((frame->id & FUNCTION) == TPDO1_ID && can->cycle > 0)
        can->answered[frame->id & NODE_MASK] = can->cycle;
    if ((frame->id & FUNCTION) == ANSWER_ID)
        can->asked[frame->id & NODE_MASK] = false;
}

/* Whatever else the other end says, commands to an adapter among it, needs no answer here. */
static void take_line(struct slcan_can *can)
{
    struct can_frame frame;

    if (!read_frame(can->text, can->length, &frame))
        return;
    if (can->written - can->taken == SLCAN_CAN_FRAMES_MAX) {
        can->lost = true;
        return;
    }
    can->frame[can->written % SLCAN_CAN_FRAMES_MAX] = frame;
    can->written++;
    note_answer(can, &frame);
}

void takt_slcan_can_take(void *context, uint8_t byte)
{
    struct slcan_can *can = context;

    if (byte == '\r') {
        take_line(can);
        can->length = 0;
    } else if (can->length < SLCAN_CAN_LINE_MAX) {
        can->text[can->length++] = (char)byte;
    }
}

bool takt_slcan_can_is_in_step(const struct slcan_can *can, uint8_t node)
{
    return can->answered[node & NODE_MASK] != 0;
}

bool takt_slcan_can_has_answered(const struct slcan_can *can, uint8_t node)
{
    const uint8_t answered = can->answered[node & NODE_MASK];

    return !can->asked[node & NODE_MASK] && (answered == 0 || answered == can->cycle);
}

void takt_slcan_can_give_up(struct slcan_can *can, uint8_t node)
{
    can->answered[node & NODE_MASK] = 0;
    can->asked[node & NODE_MASK] = false;
}

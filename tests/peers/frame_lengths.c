/*
 * Prints random frames with our lengths: "flags id length data bits", hexadecimal but for length
 * and bits; data "-" if there is none. Intermission included.
 */
#include "bus/frame_bits.h"

#include <stdio.h>
#include <stdlib.h>

static uint64_t state = 1;

static uint32_t draw(uint32_t range)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) % range;
}

/* Half of the bytes are of equal bits, which are stuffed. */
static struct wire_frame random_frame(void)
{
    static const uint8_t bytes[] = {0x00, 0xFF, 0x0F, 0x83, 0x7C, 0xE0};
    struct wire_frame frame = {.flags = draw(2) ? WIRE_EXTENDED : 0, .length = (uint8_t)draw(9)};
    frame.id = draw(frame.flags ? 0x20000000u : 0x800u);
    for (unsigned i = 0; i < frame.length; i++)
        frame.data[i] = draw(2) ? bytes[draw(6)] : (uint8_t)draw(256);
    return frame;
}

/* The bus itself counts frames of the firmware's kind. */
static unsigned count_bits(const struct frame_bits *tables, const struct wire_frame *frame)
{
    struct can_frame can;
    if (wire_frame_to_can(frame, &can))
        return frame_bits_count(tables, &can);
    return frame_bits_count_wire(tables, frame).nominal;
}

int main(int argc, char **argv)
{
    static struct frame_bits tables;
    long frames = argc == 2 ? atol(argv[1]) : 0;
    frame_bits_init(&tables);
    for (long i = 0; i < frames; i++) {
        struct wire_frame frame = random_frame();
        (void)printf("%X %X %u ", frame.flags, (unsigned)frame.id, frame.length);
        for (unsigned k = 0; k < frame.length; k++)
            (void)printf("%02X", frame.data[k]);
        (void)printf("%s %u\n", frame.length == 0 ? "-" : "",
                     count_bits(&tables, &frame) + FRAME_BITS_INTERMISSION);
    }
    return 0;
}

#include "simulation/frame_buffer.h"

static void keep_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    const struct frame_buffer_tap *tap = context;
    struct frame_buffer *buffer = tap->buffer;

    if (buffer->count == FRAME_BUFFER_MAX)
        frame_buffer_write(buffer);
    buffer->seen[buffer->count++] =
        (struct frame_seen){.frame = *frame, .bus = tap->bus, .time_ns = time_ns};
}

void frame_buffer_attach(struct frame_buffer *buffer, struct bus bus[], unsigned count,
                         struct candump *log)
{
    buffer->count = 0;
    buffer->log = log;
    log->is_fd = bus_is_fd(&bus[0]);
    for (unsigned i = 0; i < count; i++) {
        buffer->tap[i] = (struct frame_buffer_tap){buffer, (uint8_t)i};
        bus_observe(&bus[i], &(struct bus_listener){keep_frame, &buffer->tap[i]});
    }
}

/*
 * Each bus has told its frames in order, one bus after the other: insertion leaves those of one bus
 * as they are.
 */
static void sort_by_time(struct frame_buffer *buffer)
{
    for (unsigned i = 1; i < buffer->count; i++) {
        const struct frame_seen moved = buffer->seen[i];
        unsigned at = i;

        for (; at > 0 && buffer->seen[at - 1].time_ns > moved.time_ns; at--)
            buffer->seen[at] = buffer->seen[at - 1];
        buffer->seen[at] = moved;
    }
}

void frame_buffer_write(struct frame_buffer *buffer)
{
    sort_by_time(buffer);
    for (unsigned i = 0; i < buffer->count; i++) {
        candump_select(buffer->log, buffer->seen[i].bus);
        candump_frame(buffer->log, &buffer->seen[i].frame, buffer->seen[i].time_ns);
    }
    buffer->count = 0;
}

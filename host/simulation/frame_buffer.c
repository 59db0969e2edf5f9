#include "simulation/frame_buffer.h"

static void keep_frame(void *context, const struct can_frame *frame, uint64_t time_ns)
{
    struct frame_buffer *buffer = context;

    if (buffer->count == FRAME_BUFFER_MAX)
        frame_buffer_write(buffer);
    buffer->seen[buffer->count].frame = *frame;
    buffer->seen[buffer->count].time_ns = time_ns;
    buffer->count++;
}

void frame_buffer_attach(struct frame_buffer *buffer, struct bus *bus, struct candump *log)
{
    struct bus_listener listener = {.on_frame = keep_frame, .context = buffer};

    buffer->count = 0;
    buffer->log = log;
    log->is_fd = bus_is_fd(bus);
    bus_observe(bus, &listener);
}

void frame_buffer_write(struct frame_buffer *buffer)
{
    for (unsigned i = 0; i < buffer->count; i++)
        candump_frame(buffer->log, &buffer->seen[i].frame, buffer->seen[i].time_ns);
    buffer->count = 0;
}

#define _DEFAULT_SOURCE

#include "link/stream.h"

#include "link/link.h"

#include <errno.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

void stream_init(struct stream *stream, int fd)
{
    struct stat status;
    stream->fd = fd;
    stream->is_socket = fstat(fd, &status) == 0 && S_ISSOCK(status.st_mode);
    stream->hold_until_ns = 0;
    stream->out_used = 0;
    stream->in_used = 0;
}

void stream_close(struct stream *stream)
{
    if (stream->fd < 0)
        return;
    stream->hold_until_ns = 0;
    (void)stream_flush(stream);
    (void)close(stream->fd);
    stream->fd = -1;
}

static bool is_for_later(void)
{
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

/* Bytes written, 0 if none can be now, -1 when the other side is gone. */
static ssize_t write_some(struct stream *stream, const char *bytes, size_t count)
{
    ssize_t written = stream->is_socket ? send(stream->fd, bytes, count, MSG_NOSIGNAL)
                                        : write(stream->fd, bytes, count);
    if (written < 0 && is_for_later())
        return 0;
    return written;
}

bool stream_write(struct stream *stream, const char *bytes, size_t count)
{
    if (stream->fd < 0 || stream->out_used + count > STREAM_OUT_MAX)
        return false;
    memcpy(stream->out + stream->out_used, bytes, count);
    stream->out_used += count;
    return stream_flush(stream);
}

bool stream_flush(struct stream *stream)
{
    if (stream->out_used == 0)
        return true;
    if (stream->hold_until_ns != 0 && link_clock_ns() < stream->hold_until_ns)
        return true;
    stream->hold_until_ns = 0;
    ssize_t written = write_some(stream, stream->out, stream->out_used);
    if (written < 0)
        return false;
    stream->out_used -= (size_t)written;
    memmove(stream->out, stream->out + written, stream->out_used);
    return true;
}

bool stream_wants_to_write(const struct stream *stream)
{
    return stream->out_used > 0 && stream->hold_until_ns == 0;
}

/* A reader that is so far behind that nothing fits takes what it has first. */
bool stream_read(struct stream *stream)
{
    size_t room = STREAM_IN_MAX - stream->in_used;
    if (room == 0)
        return true;
    ssize_t got = read(stream->fd, stream->in + stream->in_used, room);
    if (got < 0)
        return is_for_later();
    stream->in_used += (size_t)got;
    return got > 0;
}

void stream_take(struct stream *stream, size_t count)
{
    stream->in_used -= count;
    memmove(stream->in, stream->in + count, stream->in_used);
}

/*
 * A stream of bytes that never waits: a serial line, a pseudo-terminal, a TCP connection. What
 * cannot be written at once is kept; what is read is kept until a whole message has come.
 */
#ifndef TAKT_HOST_LINK_STREAM_H
#define TAKT_HOST_LINK_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define STREAM_OUT_MAX 65536
#define STREAM_IN_MAX  65536

struct stream {
    int fd; /* -1: not open */
    bool is_socket;
    uint64_t hold_until_ns; /* nothing is written before, by link_clock_ns(); 0: at once */
    size_t out_used, in_used;
    char out[STREAM_OUT_MAX];
    char in[STREAM_IN_MAX];
};

/* fd: non-blocking; it is the stream's from now on. */
void stream_init(struct stream *stream, int fd);
void stream_close(struct stream *stream); /* tries once to write what is kept */

/* All or nothing: false when there is no room, or the stream is closed. */
bool stream_write(struct stream *stream, const char *bytes, size_t count);
/* Writes of what is kept as much as goes. False: the other side is gone. */
bool stream_flush(struct stream *stream);
bool stream_wants_to_write(const struct stream *stream);

/* Adds what has come to `in`. False: the other side is gone. */
bool stream_read(struct stream *stream);
/* Drops the first count bytes of `in`. */
void stream_take(struct stream *stream, size_t count);

/* Each returns a file descriptor, non-blocking, or -1 with errno set. */
int stream_open_serial(const char *path, unsigned baud);
int stream_open_pty(char *name, size_t size,
                    int *other_end);   /* other_end keeps it alive without a client */
int stream_hold_pty(const char *name); /* its other end once more, blocking */
int stream_connect(const char *host, const char *port, int timeout_ms, const char **problem);
int stream_listen(const char *host, const char *port, char *address, size_t size,
                  const char **problem);
int stream_accept(int listener);

/* The speeds stream_open_serial knows: false for any other. */
bool stream_knows_baud(unsigned baud);

#endif

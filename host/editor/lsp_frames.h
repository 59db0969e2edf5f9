/*
 * Bytes of an editor, put together to the messages of the language server protocol:
 *
 *     Content-Length: N\r\n  ... \r\n \r\n  N bytes of JSON
 */
#ifndef TAKT_HOST_LSP_FRAMES_H
#define TAKT_HOST_LSP_FRAMES_H

#include <stdbool.h>
#include <stddef.h>

/* Longest message, and its longest header. */
#define LSP_MESSAGE_MAX ((size_t)64 * 1024 * 1024)
#define LSP_HEADER_MAX  4096

struct lsp_frames {
    char *bytes; /* owned */
    size_t length, room;
    size_t used; /* of the message that was handed out last */
};

enum lsp_frame {
    LSP_FRAME_WHOLE,
    LSP_FRAME_PART,  /* more must come first */
    LSP_FRAME_BROKEN /* what comes is not the protocol: nothing after it can be read */
};

/* All zeros before the first. False: out of memory. */
bool lsp_frames_add(struct lsp_frames *f, const char *bytes, size_t length);
/* The next message, valid until the next call of either. */
enum lsp_frame lsp_frames_next(struct lsp_frames *f, const char **json, size_t *length);
void lsp_frames_close(struct lsp_frames *f);

#endif

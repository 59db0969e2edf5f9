/*
 * An answer to an HTTP request, sent in pieces as the connection takes them.
 */
#ifndef TAKT_PAGE_PAGE_ANSWER_H
#define TAKT_PAGE_PAGE_ANSWER_H

#include <libwebsockets.h>
#include <stddef.h>

struct page_answer {
    const unsigned char *bytes;
    size_t size, sent;
    unsigned char *owned; /* NULL: bytes are the executable's */
};

/* All return what the library's callback is to return. The bytes are set; headers go first. */
int page_answer_begin(struct lws *wsi, unsigned status, const char *type, size_t size);
int page_answer_refuse(struct lws *wsi, struct page_answer *r, unsigned status, const char *why);
/* Bytes that may change while they are sent. */
int page_answer_copy(struct lws *wsi, struct page_answer *r, const void *bytes, size_t size);
/* The connection takes more. */
int page_answer_send(struct lws *wsi, struct page_answer *r);
/* NULL is allowed. */
void page_answer_free(struct page_answer *r);

#endif

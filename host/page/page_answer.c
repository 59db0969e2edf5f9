#define _GNU_SOURCE

#include "page/page_answer.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define PIECE       16384
#define HEADERS_MAX 1024

/* Nothing but our own files runs, nothing is loaded from elsewhere, and nobody frames the page. */
static bool add_headers(struct lws *wsi, unsigned char **at, unsigned char *end)
{
    static const char *const headers[][2] = {
        {"content-security-policy:",
         "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
         "connect-src "
         "'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
        {"x-content-type-options:", "nosniff"},
        {"referrer-policy:", "no-referrer"},
        {"cross-origin-resource-policy:", "same-origin"},
        {"cache-control:", "no-store"},
    };

    for (unsigned i = 0; i < sizeof headers / sizeof headers[0]; i++) {
        if (lws_add_http_header_by_name(wsi, (const unsigned char *)headers[i][0],
                                        (const unsigned char *)headers[i][1],
                                        (int)strlen(headers[i][1]), at, end) != 0)
            return false;
    }
    return true;
}

int page_answer_begin(struct lws *wsi, unsigned status, const char *type, size_t size)
{
    unsigned char room[LWS_PRE + HEADERS_MAX], *begin = room + LWS_PRE, *at = begin,
                                               *end = room + sizeof room - 1;

    if (lws_add_http_common_headers(wsi, status, type, size, &at, end) != 0 ||
        !add_headers(wsi, &at, end) || lws_finalize_write_http_header(wsi, begin, &at, end) != 0)
        return -1;
    lws_callback_on_writable(wsi);
    return 0;
}

int page_answer_refuse(struct lws *wsi, struct page_answer *r, unsigned status, const char *why)
{
    r->bytes = (const unsigned char *)why;
    r->size = strlen(why);
    return page_answer_begin(wsi, status, "text/plain; charset=utf-8", r->size);
}

/* Bytes of our own, copied: they may change while they are sent. */
int page_answer_copy(struct lws *wsi, struct page_answer *r, const void *bytes, size_t size)
{
    r->owned = malloc(size > 0 ? size : 1);
    if (r->owned == NULL)
        return -1;
    if (size > 0)
        memcpy(r->owned, bytes, size);
    r->bytes = r->owned;
    r->size = size;
    return page_answer_begin(wsi, HTTP_STATUS_OK, "application/octet-stream", size);
}

int page_answer_send(struct lws *wsi, struct page_answer *r)
{
    unsigned char room[LWS_PRE + PIECE];
    const size_t left = r->size - r->sent, length = left < PIECE ? left : PIECE;

    if (length > 0)
        memcpy(room + LWS_PRE, r->bytes + r->sent, length);
    r->sent += length;
    if (lws_write(wsi, room + LWS_PRE, length,
                  r->sent < r->size ? LWS_WRITE_HTTP : LWS_WRITE_HTTP_FINAL) < 0)
        return -1;
    if (r->sent == r->size)
        return lws_http_transaction_completed(wsi) != 0 ? -1 : 0;
    lws_callback_on_writable(wsi);
    return 0;
}

void page_answer_free(struct page_answer *r)
{
    if (r == NULL)
        return;
    free(r->owned);
    r->owned = NULL;
}

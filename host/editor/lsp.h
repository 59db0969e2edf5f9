/*
 * A server of the language server protocol (3.17): requests and notifications of an editor in,
 * answers and diagnostics out.
 *
 *     bytes ─ lsp_frames ─> messages ─ lsp ─> documents ─ lsp_program ─> answers
 *
 * Whole texts are exchanged, not differences. Positions are in UTF-16 code units.
 */
#ifndef TAKT_HOST_LSP_H
#define TAKT_HOST_LSP_H

#include "cli/options.h"

#include <stdbool.h>
#include <stddef.h>

struct lsp_document {
    char *uri, *path, *text; /* owned */
    bool changed;            /* since it was checked */
};

struct lsp {
    const struct options *options;
    double stock_top_mm;
    void (*write)(void *context, const char *json); /* a message for the editor */
    void *context;
    unsigned documents;
    struct lsp_document *document; /* owned */
    bool initialized;
    bool shut_down; /* asked for: nothing but the end may follow */
    bool ended;
};

/* The caller has set the first four fields, the others are zeros. */
void lsp_hear(struct lsp *s, const char *json, size_t length);
/* When nothing more has come for now: checks what has changed. */
void lsp_rest(struct lsp *s);
void lsp_close(struct lsp *s);

#endif

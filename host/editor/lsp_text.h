/*
 * Places in the documents of an editor: it counts lines and UTF-16 code units from 0, and names
 * files by URI.
 */
#ifndef TAKT_HOST_LSP_TEXT_H
#define TAKT_HOST_LSP_TEXT_H

#include <stddef.h>
#include <stdint.h>

/* The line (from 0) of a text, without its end; its length is 0 behind the last one. */
const char *lsp_text_line(const char *text, size_t text_length, uint32_t line, size_t *length);

/* UTF-16 code units of the first bytes of a line, and the byte behind this many units. */
size_t lsp_text_units(const char *line, size_t length, size_t bytes);
size_t lsp_text_byte(const char *line, size_t length, size_t units);

/* What is no UTF-8, such as half a character that a message is about, becomes '?'. */
void lsp_text_clean(char *text);

/* The path of a file: URI; of others the URI itself. Owned by the caller; NULL: out of memory. */
char *lsp_text_path(const char *uri);
/* And back, for an absolute path. */
char *lsp_text_uri(const char *path);

#endif

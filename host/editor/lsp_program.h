/*
 * What takt says about a program in an editor: everything `takt check` and `takt lint` find, what a
 * word means and which modes are in effect there, and where a subroutine is. Answers are JSON of
 * the protocol, owned by the caller.
 */
#ifndef TAKT_HOST_LSP_PROGRAM_H
#define TAKT_HOST_LSP_PROGRAM_H

#include "cli/options.h"

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

/* A program as it stands in the editor. */
struct lsp_program {
    const struct options *options;
    double stock_top_mm;
    const char *uri;
    const char *path; /* of it */
    const char *text;
    size_t length;
};

/* An array of Diagnostic. */
cJSON *lsp_program_check(const struct lsp_program *p);
/* A Hover, or null. line and character are from 0. */
cJSON *lsp_program_hover(const struct lsp_program *p, uint32_t line, size_t character);
/* A Location, or null. */
cJSON *lsp_program_definition(const struct lsp_program *p, uint32_t line, size_t character);

#endif

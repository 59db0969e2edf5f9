/*
 * The line of an image's console: UART3 (console_line.c), or none (no_console.c).
 */
#ifndef TAKT_MPS2_CONSOLE_LINE_H
#define TAKT_MPS2_CONSOLE_LINE_H

#include "port/embedded.h"

/* For embedded_config: NULL: there is no console. */
const struct service_lines *takt_console_line_get_lines(void);

/* After takt_embedded_init. */
void takt_console_line_open(struct embedded *embedded);

/* From the background, as often as it comes round. */
void takt_console_line_serve(void);

#endif

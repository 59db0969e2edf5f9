/*
 * What the options of `takt serve` and the machine file's section [panel] say of the panel's
 * server.
 */
#ifndef TAKT_HOST_SERVING_OPTIONS_H
#define TAKT_HOST_SERVING_OPTIONS_H

#include "page/page_server.h"
#include "serve/console_server.h"
#include "serve/serial_line.h"
#include "serve/server.h"
#include "session/session.h"

#include <stdbool.h>

struct serving_options {
    char address[MACHINE_SETUP_PATH_MAX + 1];
    char http[MACHINE_SETUP_PATH_MAX + 1];
    char grbl[MACHINE_SETUP_PATH_MAX + 1];
    struct allow_list allowed;
    struct serial_settings serial;
};

/*
 * Fills the parts of *config that options decide, the serial line opened. options must stay. False
 * after a message.
 */
bool serving_options_read(struct serving_options *options, const struct session *session,
                          struct server_config *config);

/* The same of the page in the browser, --http; address NULL: there is none. */
bool serving_options_read_page(struct serving_options *options, const struct session *session,
                               struct page_server_config *config);

/* The same of the console, --grbl. */
bool serving_options_read_console(struct serving_options *options, const struct session *session,
                                  struct console_server_config *config);

/* What a machine file says of the panel can be served. False after a message. */
bool serving_options_check(const struct machine_setup *setup);

/* HOST:PORT or [HOST]:PORT apart, in *text. False: it is neither, or PORT is above 65535. */
bool serving_options_split(char *text, const char **host, const char **port);

/* --unit: 1 if it is not given. False after a message. */
bool serving_options_unit(double given, uint8_t *unit);

#endif

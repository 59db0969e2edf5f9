/*
 * The console beside `takt serve`, --grbl: what it stands on.
 */
#ifndef TAKT_HOST_SERVING_CONSOLE_H
#define TAKT_HOST_SERVING_CONSOLE_H

#include "cli/status.h"
#include "cutter_compensation/cutter_compensation.h"
#include "program/program.h"
#include "serve/console_server.h"
#include "service/service.h"

#include <stdbool.h>

struct serving;

/* A program that is read and does nothing ($C). */
struct serving_check {
    struct program program;
    struct cutter_compensation offset;
    struct parameters parameters; /* as they were when it began */
    struct source_text text;      /* the line being read */
    bool has_line;
};

struct serving_console {
    struct console_server server;
    struct serving_check check;
    bool is_open;
};

/* Where the service's lines come from; the console is opened later. */
struct service_lines serving_console_get_lines(struct serving *s);

/* The service and its panel are open. STATUS_DONE; else after a message. */
enum command_status serving_console_open(struct serving *s);
bool serving_console_start(struct serving *s);
void serving_console_close(struct serving *s);
void serving_console_print(const struct serving *s);

#endif

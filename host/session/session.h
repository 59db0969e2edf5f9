/*
 * What every command on a part program begins with: the machine, the program's text, tools and
 * parameters, and the first reading that finds all errors before anything moves or any file is
 * written.
 */
#ifndef TAKT_HOST_SESSION_H
#define TAKT_HOST_SESSION_H

#include "cli/options.h"
#include "cli/program_text.h"
#include "cli/status.h"
#include "config/configuration_file.h"
#include "config/machine_setup.h"
#include "controller/controller.h"
#include "correction/tables.h"
#include "cutter_compensation/cutter_compensation.h"
#include "program/program.h"
#include "tables/parameter_file.h"
#include "tables/tool_file.h"

#include <stdbool.h>
#include <stdint.h>

struct compiled;

struct session {
    const struct options *options;
    struct machine_setup setup;
    struct configuration_files configurations; /* of its drives */
    struct program_text program;
    struct tool_file tools;
    bool guesses_tools;         /* --tools auto: by what the program says */
    const char *parameter_path; /* NULL: none */
    struct parameter_file parameters;
    bool runs; /* set it when the program is run: a check then ends at the first G38 or M66 */
    struct correction_tables *correction; /* NULL: none */
    const struct compiled *compiled;      /* the program, planned ahead; NULL: planned as it runs */
};

/*
 * Reads everything the options name; the first operand is the program. STATUS_DONE, or STATUS_INPUT
 * after messages; session_close is due in either case.
 */
enum command_status session_open(struct session *s, const struct options *options);
/* The same with a program that is in memory; name is its path. */
enum command_status session_open_text(struct session *s, const struct options *options,
                                      const char *name, const char *bytes, size_t length);
/* The same without a program. */
enum command_status session_open_machine(struct session *s, const struct options *options);
void session_close(struct session *s);

/*
 * One reading of the program: struct program and what belongs to it. It must not be moved once
 * begun.
 */
struct session_reading {
    struct program program;
    struct cutter_compensation offset;
    struct parameters parameters; /* its own copy, as they were before the program */
    struct program_text_reader text;
};

/* The configuration of a reading: sources and parameters are its own. */
void session_begin_reading(const struct session *s, struct session_reading *reading,
                           struct program_config *config, struct source *source);

struct session_totals {
    uint32_t moves;      /* of all kinds */
    uint32_t motions;    /* that move axes */
    uint32_t last;       /* number of the last motion that has a length; 0: none */
    uint32_t curves;     /* motions that have a length */
    double length_mm;    /* of them; motions of rotary axes alone do not count */
    double tolerance_mm; /* the smallest of motions that are blended; 0: none is */
    unsigned errors;
    unsigned warnings;
    bool sets_up; /* the part, by G10 L13 */
    bool is_open; /* only up to the first G38 or M66: what follows depends on what becomes of it */
};

/*
 * Reads the whole program, prints up to errors_max errors and the first warnings. STATUS_DONE,
 * STATUS_INPUT when there was an error, STATUS_INTERRUPTED.
 */
enum command_status session_check(const struct session *s, unsigned errors_max,
                                  struct session_totals *totals);

#endif

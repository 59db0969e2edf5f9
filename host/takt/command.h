/*
 * Sub-commands, in the manner of git.
 */
#ifndef TAKT_HOST_COMMAND_H
#define TAKT_HOST_COMMAND_H

#include "cli/options.h"
#include "cli/status.h"

#include <stddef.h>

struct command {
    const char *name;
    const char *usage;   /* what follows the name: "PROGRAM [options]" */
    const char *summary; /* one line */
    const char *help;    /* paragraphs and examples below the options */
    const struct option_row *options;
    unsigned operands_min, operands_max;
    enum command_status (*run)(const struct options *options);
};

extern const struct command command_run;
extern const struct command command_plan;
extern const struct command command_check;
extern const struct command command_lint;
extern const struct command command_canon;
extern const struct command command_lsp;
extern const struct command command_convert;
extern const struct command command_trace;
extern const struct command command_view;
extern const struct command command_machine;
extern const struct command command_cycle_frequency;
extern const struct command command_precision;
extern const struct command command_calibrate;
extern const struct command command_correct;
extern const struct command command_serve;
extern const struct command command_panel;
extern const struct command command_drives;
extern const struct command command_replay;
extern const struct command command_bore;
extern const struct command command_circle;
extern const struct command command_friction;
extern const struct command command_resonance;
extern const struct command command_tune;
extern const struct command command_compile;
extern const struct command command_completion;

/* All of them, in the order of the help. */
const struct command *const *command_list(unsigned *count);

/* Finds and runs the sub-command of a command line. Returns the exit status. */
enum command_status command_main(int argc, char **argv);

#endif

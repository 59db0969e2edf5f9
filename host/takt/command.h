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

/* All of them, in the order of the help: command_NAME of command_NAME.c. */
#define COMMAND_ROWS(ROW)                                                                          \
    ROW(run)                                                                                       \
    ROW(plan)                                                                                      \
    ROW(check)                                                                                     \
    ROW(lint)                                                                                      \
    ROW(lsp)                                                                                       \
    ROW(convert)                                                                                   \
    ROW(canon)                                                                                     \
    ROW(trace)                                                                                     \
    ROW(view)                                                                                      \
    ROW(machine)                                                                                   \
    ROW(serve)                                                                                     \
    ROW(panel)                                                                                     \
    ROW(bore)                                                                                      \
    ROW(circle)                                                                                    \
    ROW(friction)                                                                                  \
    ROW(resonance)                                                                                 \
    ROW(tune)                                                                                      \
    ROW(drives)                                                                                    \
    ROW(calibrate)                                                                                 \
    ROW(correct)                                                                                   \
    ROW(replay)                                                                                    \
    ROW(cycle_frequency)                                                                           \
    ROW(precision)                                                                                 \
    ROW(compile)                                                                                   \
    ROW(completion)

#define COMMAND_DECLARE(name) extern const struct command command_##name;
COMMAND_ROWS(COMMAND_DECLARE)

const struct command *const *command_list(unsigned *count);

/* Finds and runs the sub-command of a command line. Returns the exit status. */
enum command_status command_main(int argc, char **argv);

#endif

/* A command as it stands, printing what it prints: for who has the library and no `takt`. */
#include "library/library.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/options.h"

#include "takt/command.h"

#include <stdio.h>
#include <string.h>

static const struct command *const commands[] = {&command_run,  &command_canon,   &command_convert,
                                                 &command_plan, &command_compile, &command_machine};

#define COMMANDS (sizeof commands / sizeof commands[0])

/* NULL after a message. */
static const struct command *find(const char *name)
{
    for (size_t i = 0; i < COMMANDS; i++) {
        if (strcmp(commands[i]->name, name) == 0)
            return commands[i];
    }
    message_command_error("the library has no command '%s', but these:", name);
    for (size_t i = 0; i < COMMANDS; i++)
        (void)fprintf(stderr, "  %-8s %s\n", commands[i]->name, commands[i]->summary);
    return NULL;
}

static enum command_status run(const struct command *command, int argc, char **argv)
{
    struct options options;
    enum command_status status;

    if (!options_read(&options, command->options, command->operands_min, command->operands_max,
                      argc, argv))
        return STATUS_INPUT;
    if (options.help) {
        (void)printf("usage: takt %s %s\n\n", command->name, command->usage);
        options_print(command->options);
        return STATUS_DONE;
    }
    status = command->run(&options);
    return status == STATUS_INTERRUPTED ? (enum command_status)interrupt_status() : status;
}

int takt_command(int argc, char **argv)
{
    const char *name = argc > 0 ? argv[0] : "";
    const struct command *command;
    enum command_status status;

    interrupt_catch();
    message_set_command(name);
    command = find(name);
    status = command != NULL ? run(command, argc, argv) : STATUS_INPUT;
    return (int)(fflush(stdout) == 0 ? status : STATUS_ENVIRONMENT);
}

#include "takt/command.h"

#include "cli/files_read.h"
#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/suggest.h"
#include "inject/inject.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define ADDRESS(name) &command_##name,
static const struct command *const commands[] = {COMMAND_ROWS(ADDRESS)};

#define COMMANDS (sizeof commands / sizeof commands[0])

const struct command *const *command_list(unsigned *count)
{
    *count = COMMANDS;
    return commands;
}

static void print_usage(FILE *stream)
{
    (void)fputs("usage: takt COMMAND [arguments]\n\ncommands:\n", stream);
    for (size_t i = 0; i < COMMANDS; i++)
        (void)fprintf(stream, "  %-15s %s\n", commands[i]->name, commands[i]->summary);
    (void)fputs("  help            explain a command\n"
                "\n"
                "takt help COMMAND shows options and examples, takt help inject how faults are\n"
                "scripted, takt --version the version.\n",
                stream);
}

static void print_help(const struct command *command)
{
    (void)printf("usage: takt %s %s\n\ntakt %s: %s\n\noptions:\n", command->name, command->usage,
                 command->name, command->summary);
    options_print(command->options);
    (void)printf("\n%s", command->help);
}

/* NULL after a message. */
static const struct command *find_command(const char *name)
{
    const char *names[COMMANDS + 1] = {"help"};

    for (size_t i = 0; i < COMMANDS; i++) {
        names[i + 1] = commands[i]->name;
        if (strcmp(name, commands[i]->name) == 0)
            return commands[i];
    }
    message_command_error("there is no command '%s'%s", name,
                          message_did_you_mean("", suggest_word(name, names, COMMANDS + 1)));
    print_usage(stderr);
    return NULL;
}

static enum command_status help(int argc, char **argv)
{
    const struct command *command;

    if (argc < 3 || strcmp(argv[2], "help") == 0) {
        print_usage(stdout);
        return STATUS_DONE;
    }
    if (strcmp(argv[2], "inject") == 0) {
        inject_write_help(stdout);
        return STATUS_DONE;
    }
    command = find_command(argv[2]);
    if (command == NULL)
        return STATUS_INPUT;
    print_help(command);
    return STATUS_DONE;
}

static enum command_status run_command(const struct command *command, int argc, char **argv)
{
    struct options options;

    message_set_command(command->name);
    files_read_begin();
    if (!options_read(&options, command->options, command->operands_min, command->operands_max,
                      argc, argv))
        return STATUS_INPUT;
    if (options.help) {
        print_help(command);
        return STATUS_DONE;
    }
    return command->run(&options);
}

/* Which signal it was. */
static enum command_status tell_signal(enum command_status status)
{
    return status == STATUS_INTERRUPTED ? (enum command_status)interrupt_status() : status;
}

/*
 * What was printed must have arrived: a full disk behind a redirection is an error like any other.
 * A reader who has seen enough (`takt plan | head`) needs no message.
 */
static enum command_status flush_stdout(enum command_status status)
{
    if (fflush(stdout) == 0 && ferror(stdout) == 0)
        return status;
    if (errno == EPIPE)
        return STATUS_ENVIRONMENT;
    message_command_error("standard output cannot be written");
    return STATUS_ENVIRONMENT;
}

enum command_status command_main(int argc, char **argv)
{
    const struct command *command;

    interrupt_catch();
    if (argc < 2) {
        print_usage(stderr);
        return STATUS_INPUT;
    }
    if (strcmp(argv[1], "--version") == 0) {
        (void)printf("takt %s\n", TAKT_VERSION);
        return flush_stdout(STATUS_DONE);
    }
    if (strcmp(argv[1], "help") == 0 || strcmp(argv[1], "--help") == 0 ||
        strcmp(argv[1], "-h") == 0)
        return flush_stdout(help(argc, argv));
    command = find_command(argv[1]);
    return command != NULL ? flush_stdout(tell_signal(run_command(command, argc - 1, argv + 1)))
                           : STATUS_INPUT;
}

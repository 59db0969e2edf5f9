/*
 * Completions of the command line for shells, made from the option tables: what is offered is what
 * is there.
 */
#include "takt/command.h"

#include "cli/message.h"

#include <stdio.h>
#include <string.h>

static const struct option_row options_of_completion[] = {OPTIONS_END};

static const char help[] =
    "Prints the script that completes takt's commands and options in a shell. Packages bring\n"
    "them; else:\n"
    "\n"
    "  takt completion bash > ~/.local/share/bash-completion/completions/takt\n"
    "  takt completion zsh > \"${fpath[1]}/_takt\"\n"
    "  takt completion fish > ~/.config/fish/completions/takt.fish\n";

static bool is_path(const struct option_row *row)
{
    return row->argument != NULL &&
           (strstr(row->argument, "FILE") != NULL || strstr(row->argument, "FOLDER") != NULL);
}

/* Within quotes of a shell that end at '. */
static void write_quoted(const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '\'')
            (void)fputs("'\\''", stdout);
        else
            (void)putchar(*text);
    }
}

/* zsh: of a description in brackets. */
static void write_described(const char *text)
{
    for (; *text != '\0'; text++) {
        if (*text == '[' || *text == ']' || *text == ':' || *text == '\\')
            (void)putchar('\\');
        if (*text == '\'')
            (void)fputs("'\\''", stdout);
        else
            (void)putchar(*text);
    }
}

/* ---- bash: words by command; options that take a path, and those that take something else ---- */

static void bash_command(const struct command *command)
{
    (void)printf("    %s) words='", command->name);
    for (const struct option_row *row = command->options; row->name != NULL; row++)
        (void)printf("%s--%s", row == command->options ? "" : " ", row->name);
    (void)fputs("' others='", stdout);
    for (const struct option_row *row = command->options; row->name != NULL; row++) {
        if (row->argument != NULL && !is_path(row))
            (void)printf(" --%s ", row->name);
    }
    (void)fputs("' ;;\n", stdout);
}

static void write_bash(const struct command *const *commands, unsigned count)
{
    (void)fputs(
        "# bash completion of takt, made by `takt completion bash`\n"
        "_takt() {\n"
        "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
        "    local words='' others=''\n"
        "    COMPREPLY=()\n"
        "    if ((COMP_CWORD == 1)) || [[ ${COMP_WORDS[1]} == help ]]; then\n"
        "        mapfile -t COMPREPLY < <(compgen -W '",
        stdout);
    for (unsigned i = 0; i < count; i++)
        (void)printf("%s ", commands[i]->name);
    (void)fputs("help --version' -- \"$current\")\n"
                "        return\n"
                "    fi\n"
                "    case ${COMP_WORDS[1]} in\n",
                stdout);
    for (unsigned i = 0; i < count; i++)
        bash_command(commands[i]);
    (void)fputs("    esac\n"
                "    if [[ $others == *\" $previous \"* ]]; then\n"
                "        return\n"
                "    fi\n"
                "    if [[ $current == -* ]]; then\n"
                "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
                "    else\n"
                "        compopt -o filenames 2>/dev/null\n"
                "        mapfile -t COMPREPLY < <(compgen -f -- \"$current\")\n"
                "    fi\n"
                "}\n"
                "complete -F _takt takt\n",
                stdout);
}

/* ---- zsh ---- */

static void zsh_command(const struct command *command)
{
    (void)printf("    %s) _arguments", command->name);
    for (const struct option_row *row = command->options; row->name != NULL; row++) {
        (void)printf(" \\\n      '%s--%s%s[", row->kind == OPTION_LIST ? "*" : "", row->name,
                     row->argument != NULL ? "=" : "");
        write_described(row->help);
        (void)putchar(']');
        if (row->argument != NULL) {
            (void)putchar(':');
            write_described(row->argument);
            (void)fputs(is_path(row) ? ":_files" : ": ", stdout);
        }
        (void)putchar('\'');
    }
    (void)fputs(" \\\n      '*:file:_files' ;;\n", stdout);
}

static void write_zsh(const struct command *const *commands, unsigned count)
{
    (void)fputs("#compdef takt\n"
                "# zsh completion of takt, made by `takt completion zsh`\n"
                "_takt() {\n"
                "  local -a commands=(\n",
                stdout);
    for (unsigned i = 0; i < count; i++) {
        (void)printf("    '%s:", commands[i]->name);
        write_quoted(commands[i]->summary);
        (void)fputs("'\n", stdout);
    }
    (void)fputs("    'help:explain a command'\n"
                "  )\n"
                "  if ((CURRENT == 2)) || [[ $words[2] == help ]]; then\n"
                "    _describe command commands\n"
                "    return\n"
                "  fi\n"
                "  shift words\n"
                "  ((CURRENT--))\n"
                "  case $words[1] in\n",
                stdout);
    for (unsigned i = 0; i < count; i++)
        zsh_command(commands[i]);
    (void)fputs("  esac\n"
                "}\n"
                "_takt \"$@\"\n",
                stdout);
}

/* ---- fish ---- */

static void fish_command(const struct command *command)
{
    (void)printf("complete -c takt -f -n '__fish_is_nth_token 1' -a %s -d '", command->name);
    write_quoted(command->summary);
    (void)fputs("'\n", stdout);
    for (const struct option_row *row = command->options; row->name != NULL; row++) {
        (void)printf("complete -c takt -n '__fish_seen_subcommand_from %s' -l %s%s -d '",
                     command->name, row->name,
                     row->argument == NULL ? ""
                     : is_path(row)        ? " -r -F"
                                           : " -x");
        write_quoted(row->help);
        (void)fputs("'\n", stdout);
    }
}

static void write_fish(const struct command *const *commands, unsigned count)
{
    (void)fputs("# fish completion of takt, made by `takt completion fish`\n", stdout);
    for (unsigned i = 0; i < count; i++)
        fish_command(commands[i]);
}

static enum command_status run(const struct options *options)
{
    static const struct {
        const char *name;
        void (*write)(const struct command *const *commands, unsigned count);
    } shells[] = {{"bash", write_bash}, {"zsh", write_zsh}, {"fish", write_fish}};
    unsigned count;
    const struct command *const *commands = command_list(&count);

    for (size_t i = 0; i < sizeof shells / sizeof shells[0]; i++) {
        if (strcmp(options->operand[0], shells[i].name) == 0) {
            shells[i].write(commands, count);
            return STATUS_DONE;
        }
    }
    message_command_error("%s: bash, zsh or fish is expected", options->operand[0]);
    return STATUS_INPUT;
}

const struct command command_completion = {
    .name = "completion",
    .usage = "SHELL",
    .summary = "print the completions of a shell: bash, zsh or fish",
    .help = help,
    .options = options_of_completion,
    .operands_min = 1,
    .operands_max = 1,
    .run = run,
};

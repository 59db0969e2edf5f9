#define _GNU_SOURCE

#include "cli/options.h"

#include "cli/files_read.h"
#include "cli/message.h"
#include "cli/suggest.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define OPTIONS_ROWS_MAX 48

static unsigned options_count(const struct option_row *rows)
{
    unsigned count = 0;

    while (rows[count].name != NULL)
        count++;
    return count;
}

static void *options_field(struct options *options, const struct option_row *row)
{
    return (char *)options + row->field;
}

static bool options_set_text(const struct option_row *row, const char **field, const char *value)
{
    if (*field != NULL) {
        message_command_error("--%s is given twice", row->name);
        return false;
    }
    if (value[0] == '\0') {
        message_command_error("--%s needs a value that is not empty", row->name);
        return false;
    }
    *field = value;
    return true;
}

/* Before anything is opened: the first output may be opened before the last input. */
static bool options_set_input(const struct option_row *row, const char **field, const char *value)
{
    files_read_note(value);
    return options_set_text(row, field, value);
}

static bool options_set_list(const struct option_row *row, struct option_list *field,
                             const char *value)
{
    if (field->count == OPTION_LIST_MAX) {
        message_command_error("--%s is given more than %d times", row->name, OPTION_LIST_MAX);
        return false;
    }
    field->item[field->count++] = value;
    return true;
}

static bool options_set_number(const struct option_row *row, double *field, const char *value)
{
    char *end;

    *field = strtod(value, &end);
    if (end == value || *end != '\0' || !isfinite(*field) || *field < 0) {
        message_command_error("--%s %s: a number, 0 or more, is expected", row->name, value);
        return false;
    }
    return true;
}

static bool options_set_positive(const struct option_row *row, double *field, const char *value)
{
    if (!options_set_number(row, field, value))
        return false;
    if (*field > 0)
        return true;
    message_command_error("--%s %s: it must be above 0", row->name, value);
    return false;
}

static bool options_set_count(const struct option_row *row, uint32_t *field, const char *value)
{
    char *end;
    double count = strtod(value, &end);
    const uint32_t least = row->kind == OPTION_WHOLE ? 0 : 1;

    if (end == value || *end != '\0' || !(count >= least && count <= UINT32_MAX) ||
        count != floor(count)) {
        message_command_error("--%s %s: %s is expected", row->name, value,
                              row->kind == OPTION_LINE    ? "the number of a line"
                              : row->kind == OPTION_COUNT ? "a whole number from 1 on"
                                                          : "a whole number from 0 on");
        return false;
    }
    *field = (uint32_t)count;
    return true;
}

static bool options_set(struct options *options, const struct option_row *row, const char *value)
{
    void *field = options_field(options, row);

    switch (row->kind) {
    case OPTION_FLAG:
        *(bool *)field = true;
        return true;
    case OPTION_TEXT:
        return options_set_text(row, field, value);
    case OPTION_INPUT:
        return options_set_input(row, field, value);
    case OPTION_LIST:
        return options_set_list(row, field, value);
    case OPTION_NUMBER:
        return options_set_number(row, field, value);
    case OPTION_POSITIVE:
        return options_set_positive(row, field, value);
    case OPTION_LINE:
    case OPTION_COUNT:
    case OPTION_WHOLE:
        return options_set_count(row, field, value);
    }
    return false;
}

/* The names of all options that begin as the ambiguous one does. */
static void options_report_ambiguous(const struct option_row *rows, const char *given)
{
    char names[256] = "";
    size_t length = strcspn(given, "=");

    for (; rows->name != NULL; rows++) {
        size_t used = strlen(names);

        if (strncmp(rows->name, given, length) == 0)
            (void)snprintf(names + used, sizeof names - used, "%s--%s", used > 0 ? " or " : "",
                           rows->name);
    }
    message_command_error("--%s is ambiguous: %s", given, names);
}

static bool options_is_prefix(const struct option_row *rows, const char *given)
{
    for (; rows->name != NULL; rows++) {
        if (strncmp(rows->name, given, strcspn(given, "=")) == 0)
            return true;
    }
    return false;
}

static void options_report_unknown(const struct option_row *rows, const char *argument)
{
    const char *names[OPTIONS_ROWS_MAX];
    unsigned count = options_count(rows);
    const char *given = argument + strspn(argument, "-");
    char word[SUGGEST_WORD_MAX + 1];
    const char *near;

    if (strncmp(argument, "--", 2) == 0 && options_is_prefix(rows, given)) {
        options_report_ambiguous(rows, given);
        return;
    }
    for (unsigned i = 0; i < count; i++)
        names[i] = rows[i].name;
    (void)snprintf(word, sizeof word, "%.*s", (int)strcspn(given, "="), given);
    near = suggest_word(word, names, count);
    message_command_error("unknown option %s%s", argument,
                          near != NULL ? message_did_you_mean("--", near)
                                       : "; --help lists the options");
}

static void options_fill_table(const struct option_row *rows, struct option *table)
{
    static const int has_value[] = {
        [OPTION_FLAG] = no_argument,         [OPTION_TEXT] = required_argument,
        [OPTION_INPUT] = required_argument,  [OPTION_LIST] = required_argument,
        [OPTION_NUMBER] = required_argument, [OPTION_POSITIVE] = required_argument,
        [OPTION_LINE] = required_argument,   [OPTION_COUNT] = required_argument,
        [OPTION_WHOLE] = required_argument};
    unsigned count = options_count(rows);

    for (unsigned i = 0; i < count; i++)
        table[i] = (struct option){
            .name = rows[i].name, .has_arg = has_value[rows[i].kind], .val = (int)i};
    table[count] = (struct option){0};
}

/* The row of --output, which -o is short for; NULL: the command has none. */
static const struct option_row *options_find_output(const struct option_row *rows)
{
    for (; rows->name != NULL; rows++) {
        if (strcmp(rows->name, "output") == 0)
            return rows;
    }
    return NULL;
}

/* getopt's codes for what it cannot read; numbers from 0 are rows. */
static bool options_take(struct options *options, const struct option_row *rows, int code,
                         char **argv)
{
    if (code == ':') {
        message_command_error("%s needs a value", argv[optind - 1]);
        return false;
    }
    if (code == 'h') {
        options->help = true;
        return true;
    }
    if (code == 'o')
        return options_set(options, options_find_output(rows), optarg);
    if (code != '?')
        return options_set(options, &rows[code], optarg);
    if (optopt > 0 && optopt < (int)options_count(rows))
        message_command_error("--%s takes no value", rows[optopt].name);
    else if (optopt != 0)
        message_command_error("unknown option -%c; options begin with --, --help lists them",
                              optopt);
    else
        options_report_unknown(rows, argv[optind - 1]);
    return false;
}

static bool options_take_operands(struct options *options, unsigned least, unsigned most, int argc,
                                  char **argv)
{
    unsigned given = (unsigned)(argc - optind);

    if (options->help)
        return true;
    if (given > most) {
        message_command_error("%s: one argument too many; --help shows the usage",
                              argv[optind + (int)most]);
        return false;
    }
    for (unsigned i = 0; i < given; i++) {
        options->operand[i] = argv[optind + (int)i];
        files_read_note(options->operand[i]);
    }
    options->operands = given;
    if (given < least) {
        message_command_error("a file name is missing; --help shows the usage");
        return false;
    }
    return true;
}

bool options_read(struct options *options, const struct option_row *rows, unsigned operands_min,
                  unsigned operands_max, int argc, char **argv)
{
    struct option table[OPTIONS_ROWS_MAX + 1];
    const char *letters = options_find_output(rows) != NULL ? ":ho:" : ":h";
    int code;

    *options = (struct options){0};
    options_fill_table(rows, table);
    opterr = 0;
    optind = 0; /* start anew */
    while ((code = getopt_long(argc, argv, letters, table, NULL)) != -1) {
        if (!options_take(options, rows, code, argv))
            return false;
    }
    return options_take_operands(options, operands_min, operands_max, argc, argv);
}

void options_print(const struct option_row *rows)
{
    for (; rows->name != NULL; rows++) {
        char left[64];

        (void)snprintf(left, sizeof left, "--%s%s%s", rows->name, rows->argument != NULL ? " " : "",
                       rows->argument != NULL ? rows->argument : "");
        (void)printf("  %-24s  %s\n", left, rows->help);
    }
}

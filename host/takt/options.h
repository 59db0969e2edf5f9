/*
 * Long options by table: each sub-command has rows, a row says where the value goes.
 */
#ifndef TAKT_HOST_OPTIONS_H
#define TAKT_HOST_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OPTION_LIST_MAX    64
#define OPTION_OPERAND_MAX 2

struct option_list {
    unsigned count;
    const char *item[OPTION_LIST_MAX];
};

/* Everything a command line may say; each sub-command offers a part. NULL: not given. Texts are argv's. */
struct options {
    bool help;
    unsigned operands;
    const char *operand[OPTION_OPERAND_MAX];

    const char *machine;
    struct option_list set;
    const char *tools;
    const char *parameters;
    bool exact_path;
    bool block_delete;
    uint32_t from_line; /* 0: from the beginning */
    bool save_parameters;
    double until_s;   /* 0: to the end */
    double tolerance; /* of `takt trace`; 0: equal */
    const char *trace;
    const char *bus_log;
    const char *report;
    const char *json;
    const char *junit;
    bool quiet;
};

enum option_kind {
    OPTION_FLAG,   /* bool */
    OPTION_TEXT,   /* const char *, given once */
    OPTION_LIST,   /* struct option_list, may be repeated */
    OPTION_NUMBER, /* double, >= 0 */
    OPTION_LINE    /* uint32_t, >= 1 */
};

struct option_row {
    const char *name;
    enum option_kind kind;
    size_t field;         /* offset in struct options */
    const char *argument; /* its name in the help; NULL for flags */
    const char *help;
};

/* Rows in common; each list of rows ends with OPTIONS_END. */
#define OPTIONS_MACHINE                                                                            \
    {"machine", OPTION_TEXT, offsetof(struct options, machine), "FILE",                            \
     "machine file (default: the built-in mill)"},                                                 \
    {                                                                                              \
        "set", OPTION_LIST, offsetof(struct options, set), "KEY=VALUE",                            \
            "override a key of the machine file: axis.X.max_jerk_mm_s3=20000"                      \
    }

#define OPTIONS_PROGRAM                                                                            \
    OPTIONS_MACHINE,                                                                               \
        {"tools", OPTION_TEXT, offsetof(struct options, tools), "FILE",                            \
         "tool table, LinuxCNC's .tbl"},                                                           \
        {"parameters", OPTION_TEXT, offsetof(struct options, parameters), "FILE",                  \
         "parameters, LinuxCNC's .var"},                                                           \
        {"from-line", OPTION_LINE, offsetof(struct options, from_line), "N",                       \
         "start in the middle: all modes as there, and a safe way to it"},                         \
        {"exact-path", OPTION_FLAG, offsetof(struct options, exact_path), NULL,                    \
         "treat every G64 as G61"},                                                                \
    {                                                                                              \
        "block-delete", OPTION_FLAG, offsetof(struct options, block_delete), NULL,                 \
            "skip lines that begin with /"                                                         \
    }

#define OPTIONS_END                                                                                \
    {"help", OPTION_FLAG, offsetof(struct options, help), NULL, "this text"},                      \
    {                                                                                              \
        NULL, OPTION_FLAG, 0, NULL, NULL                                                           \
    }

/*
 * Fills *options from the arguments after the sub-command's name (argv[0]). At least operands_min and at most
 * operands_max operands, unless --help is given. False after a message.
 */
bool options_read(struct options *options, const struct option_row *rows, unsigned operands_min,
                  unsigned operands_max, int argc, char **argv);

/* Lists rows on stdout, one a line, aligned. */
void options_print(const struct option_row *rows);

#endif

/*
 * Long options by table: each sub-command has rows, a row says where the value goes.
 */
#ifndef TAKT_HOST_OPTIONS_H
#define TAKT_HOST_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define OPTION_LIST_MAX    64
#define OPTION_OPERAND_MAX 34

struct option_list {
    unsigned count;
    const char *item[OPTION_LIST_MAX];
};

/* For `takt bore`: mm, mm/min, rpm; 0: not given. */
struct option_bore {
    const char *pass;
    const char *as;
    const char *start;
    double hole, cutter, step, allowance;
    double start_radius, start_length, turns;
    double direction_deg;
    double depth, depth_step, height;
    double feed, plunge, spindle;
    bool compare;
};

/* For `takt circle`: NULL or 0: not given. */
struct option_circle {
    const char *plane, *centre;
    double radius, feed;
};

/* For `takt serve` and `takt panel`. */
struct option_panel {
    const char *listen, *connect; /* HOST:PORT */
    const char *http;             /* HOST:PORT, or off; NULL: the default */
    const char *grbl;             /* tcp:HOST:PORT or pty:LINK; NULL: no console */
    const char *serial;           /* PATH, or PATH,BAUD,PARITY */
    const char *program;
    const char *store;
    const char *state;   /* a folder, or none; NULL: the user's */
    const char *spindle; /* where its drive is; see `takt help serve` */
    double unit;         /* on the serial line; 0: 1 */
    double interval_s;   /* of `takt panel watch`; 0: its default */
    uint32_t count;      /* of `takt panel watch`; 0: without end */
    double timeout_s;
    double password;
    bool insecure;
    bool starts; /* of `takt panel stream` */
};

/* For `takt cycle-frequency`: numbers as given, NULL: not. */
struct option_frequency {
    const char *feed_max, *acceleration, *jerk, *resolution, *tolerance, *frequency;
    bool radius_table;
    const char *svg, *html;
};

/* For `takt machine`. */
struct option_pack {
    bool pack, unpack, sector;
};

/* For `takt calibrate`, `takt correct` and, of noise and seed, `takt resonance`. */
struct option_correction {
    const char *grid, *axis, *unit, *from, *to, *noise, *comp, *table, *tolerance;
    uint32_t seed, comp_type;
    bool filter, compose;
};

/*
 * Everything a command line may say; each sub-command offers a part. NULL: not given. Texts are
 * argv's.
 */
struct options {
    bool help;
    unsigned operands;
    const char *operand[OPTION_OPERAND_MAX];

    const char *machine;
    struct option_list with; /* of `takt machine`: files whose keys take the place of its own */
    struct option_list set;
    const char *tools;
    const char *parameters;
    const char *dialect;
    struct option_list subroutines; /* folders */
    struct option_list drive_type;  /* [AXIS=]can|step */
    const char *interpolator;
    bool exact_path;
    bool block_delete;
    uint32_t from_line; /* 0: from the beginning */
    uint32_t lines_max; /* read again; 0: OPTIONS_LINES_MAX */
    bool save_parameters;
    const char *probe;
    const char *stock; /* of `takt run`: what is cut */
    const char *override;
    const char *rapid_override;
    const char *override_method;
    double until_s;         /* 0: to the end */
    const char *to_dialect; /* of `takt convert` */
    const char *stock_top;  /* of `takt lint`, mm */
    double speed;           /* of `takt view`; 0: 1 */
    double tolerance;       /* of `takt trace`; 0: equal. Of `takt bore`, mm; 0: its default */
    const char *output;     /* -o is short for --output */
    struct option_bore bore;
    struct option_circle circle;
    const char *axes;              /* of `takt friction`, `takt resonance`, `takt tune`: letters */
    const char *dcf, *tune_record; /* of `takt tune` */
    struct option_frequency frequency;
    struct option_correction correction;
    struct option_panel panel;
    struct option_pack pack;
    const char *target, *image; /* of `takt run` */
    const char *drive_image;    /* of the drives that --drives names */
    const char *plan;           /* of `takt run`: board, ahead, or a compiled program */
    double ceiling;             /* of `takt compile`, per cent; 0: not given */
    const char *trace;
    const char *rests;  /* of `takt run`: where the tool stood */
    const char *bus;    /* bus/link.h */
    const char *drives; /* internal, external */
    bool realtime;
    const char *ids, *interface; /* of takt replay */
    bool fast, fd;
    const char *inject; /* scripted faults */
    const char *nodes;  /* of `takt drives` */
    uint32_t can;       /* index of the bus that they are on */
    const char *eds;
    const char *store; /* folder */
    bool unconfigured;
    const char *log;
    const char *bus_log;
    const char *pulse_log; /* of `takt run`: of step drives */
    const char *report;
    const char *json;
    const char *junit;
    bool quiet;
};

enum option_kind {
    OPTION_FLAG,     /* bool */
    OPTION_TEXT,     /* const char *, given once */
    OPTION_INPUT,    /* the same, a file that is read: see files_read.h */
    OPTION_LIST,     /* struct option_list, may be repeated */
    OPTION_NUMBER,   /* double, >= 0 */
    OPTION_POSITIVE, /* double, > 0: 0 says that it is not given */
    OPTION_LINE,     /* uint32_t, >= 1: the number of a line */
    OPTION_COUNT,    /* uint32_t, >= 1 */
    OPTION_WHOLE     /* uint32_t, >= 0 */
};

struct option_row {
    const char *name;
    enum option_kind kind;
    size_t field;         /* offset in struct options */
    const char *argument; /* its name in the help; NULL for flags */
    const char *help;
};

/*
 * Lines that loops and subroutines may read again in all, unless --lines-max says otherwise: some
 * seconds of reading, and with a move of a millisecond each some hours of cutting.
 */
#define OPTIONS_LINES_MAX 10000000

/* Rows in common; each list of rows ends with OPTIONS_END. */
#define OPTIONS_MACHINE                                                                            \
    {"machine", OPTION_INPUT, offsetof(struct options, machine), "FILE",                           \
     "machine file (default: the built-in mill)"},                                                 \
    {                                                                                              \
        "set", OPTION_LIST, offsetof(struct options, set), "KEY=VALUE",                            \
            "override a key of the machine file: axis.X.max_jerk_mm_s3=20000"                      \
    }

/* How the machine's axes are driven: machine_file_load obeys them. */
#define OPTIONS_DRIVEN                                                                             \
    {"drive-type", OPTION_LIST, offsetof(struct options, drive_type), "[AXIS=]TYPE",               \
     "can or step: drive of one axis, or of all"},                                                 \
    {                                                                                              \
        "interpolator", OPTION_TEXT, offsetof(struct options, interpolator), "NAME",               \
            "exact (default), integrate or rotate"                                                 \
    }

#define OPTIONS_PROGRAM                                                                            \
    OPTIONS_MACHINE,                                                                               \
        {"tools", OPTION_INPUT, offsetof(struct options, tools), "FILE",                           \
         "tool table, LinuxCNC's .tbl; auto: what the program itself says of its tools"},          \
        {"parameters", OPTION_INPUT, offsetof(struct options, parameters), "FILE",                 \
         "parameters, LinuxCNC's .var"},                                                           \
        {"dialect", OPTION_TEXT, offsetof(struct options, dialect), "NAME",                        \
         "what the program is written for: auto (default), linuxcnc, grbl, fanuc, haas, mach3, "   \
         "marlin, siemens"},                                                                       \
        {"subroutines", OPTION_LIST, offsetof(struct options, subroutines), "FOLDER",              \
         "where files of subroutines are, beside the program's own folder"},                       \
        {"from-line", OPTION_LINE, offsetof(struct options, from_line), "N",                       \
         "start in the middle: all modes as there, and a safe way to it"},                         \
        {"lines-max", OPTION_LINE, offsetof(struct options, lines_max), "N",                       \
         "lines that loops may repeat in all, until the program is endless (10 million)"},         \
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
 * Fills *options from the arguments after the sub-command's name (argv[0]). At least operands_min
 * and at most operands_max operands, unless --help is given. False after a message.
 */
bool options_read(struct options *options, const struct option_row *rows, unsigned operands_min,
                  unsigned operands_max, int argc, char **argv);

/* Lists rows on stdout, one a line, aligned. */
void options_print(const struct option_row *rows);

#endif

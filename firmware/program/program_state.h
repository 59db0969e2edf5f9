/*
 * What struct program consists of. Callers own the memory and touch nothing in it; included by
 * program.h alone.
 */
#include "program/program.h" /* before the guard: that one includes this in its place */

#ifndef TAKT_PROGRAM_STATE_H
#define TAKT_PROGRAM_STATE_H

#include "geometry/nurbs.h"
#include "program/codes.h"
#include "program/program_limits.h"
#include "program/turning.h"

#include <stddef.h>

/* A piece of the current line: indices into struct program_lexer, text. */
struct program_span {
    uint16_t begin, end;
};

/* The current line, without spaces, tabs and comments and in lower case. */
struct program_lexer {
    struct source source;
    char input[PROGRAM_INPUT_MAX];
    size_t input_at, input_length;
    uint64_t input_offset;   /* of input in the text */
    uint64_t line_offset;    /* of the current line */
    uint32_t line;           /* number of the current line, from 1 */
    uint16_t at;             /* next character to read */
    uint16_t length;         /* of text */
    uint16_t end_column;     /* of its end, from 1; 0: not known */
    uint16_t comment_length; /* of its last comment, which lies backwards at the end of text */
    char text[PROGRAM_LINE_MAX + 1];   /* ends in zero */
    uint8_t dropped[PROGRAM_LINE_MAX]; /* characters before each of it that are not in text */
    uint8_t nesting;                   /* values being read now */
};

/* What an assignment or an expression names after '#'. */
struct program_reference {
    uint16_t number;          /* 0: by name */
    struct program_span span; /* the name alone, or all of '#...' */
};

struct program_assignment {
    struct program_reference reference;
    double value;
};

/* The words of the current line. */
struct program_words {
    uint32_t given; /* letters with a value: bit 0 is A */
    uint32_t steps; /* codes to execute: bits are enum step */
    uint32_t groups;
    double value[26];
    struct program_span span[26];
    const struct program_code *code[STEP_COUNT];
    struct program_span code_span[STEP_COUNT];
    unsigned assignments;
    uint16_t names_before; /* names known before the line */
    /* Done ones hold the value from before. */
    struct program_assignment assignment[PROGRAM_ASSIGNMENTS_MAX + PROGRAM_STORES_MAX];
};

/*
 * Named parameters, and the texts of all names, those of O-words too. Parameters that begin with
 * '_' are global, others belong to the call they were set in.
 */
struct program_names {
    uint16_t count;
    uint16_t text_length; /* of the texts that are kept */
    uint8_t call;         /* the current one: 0 outside subroutines */
    uint8_t of_call[PROGRAM_NAMES_MAX];
    uint16_t place[PROGRAM_NAMES_MAX]; /* in text, of their names */
    double value[PROGRAM_NAMES_MAX];
    /* Each once, with a zero at its end. Behind them there is room for one that is not kept. */
    char text[PROGRAM_TEXT_MAX + PROGRAM_NAME_MAX + 1];
};

/* A rotation of X and Y. */
struct program_turn {
    double degrees; /* 0: none */
    double sine, cosine;
};

/* What a cycle leaves for the next one of its kind: work coordinates and lengths in mm, seconds. */
struct program_cycle_words {
    double retract_mm;  /* R */
    double bottom_mm;   /* Z, or the axis across the plane */
    double peck_mm;     /* Q */
    double dwell_s;     /* P */
    double aside_mm[2]; /* G87: first and second axis of the plane */
    double middle_mm;   /* G87: the axis across it */
    double initial_mm;  /* the height across the plane before the first cycle in a row */
    bool initial_known;
};

/* Everything one line leaves for the next; a line with an error leaves it as it was. */
struct program_modes {
    struct point at;            /* machine position after the last move */
    struct point system_offset; /* G54 ... G59.3 */
    struct point axis_offset;   /* G92 */
    struct point tool_offset;   /* G43 */
    struct program_turn turn;   /* of the coordinate system */
    struct program_cycle_words cycle;
    const struct program_code *motion;      /* G0, G1, G2, G3, or NULL after G80 */
    double unit_mm;                         /* G20: 25.4, G21: 1 */
    double feed_mm_s, feed_rad_s;           /* the last F, along X Y Z and along A B C; 0: none */
    double feed_rev_mm, feed_rev_rad;       /* the same with G95, per revolution */
    double tolerance_mm;                    /* G64 P */
    double merge_mm;                        /* G64 Q */
    double speed_rpm;                       /* S with G97 */
    double surface_mm_s;                    /* S with G96 */
    double surface_max_rpm;                 /* D of G96; 0: any */
    unsigned overrides;                     /* OVERRIDE_... */
    const struct program_code *cutter_code; /* G41, G42, G41.1, G42.1; NULL: G40 */
    double cutter_radius_mm;                /* 0: compensation is on and moves nothing */
    enum cutter_side cutter_side;
    uint8_t cutter_orientation;
    uint8_t correction_off; /* M121: bit i set: layer i of correction is off */
    bool cutter_moved;      /* since compensation is on */
    bool cutter_left;       /* G40 was the last to happen: no arc may follow */
    enum plane plane;
    enum move_path path;
    enum spindle_direction direction;
    uint32_t tool_selected; /* T */
    uint32_t tool_current;  /* M6 */
    bool tool_is_selected;
    bool incremental;     /* G91 */
    bool centre_absolute; /* G90.1 */
    bool inverse_time;    /* G93 */
    bool per_revolution;  /* G95 */
    bool diameter;        /* G7 */
    bool surface_speed;   /* G96 */
    bool retract_to_r;    /* G99 */
    bool mist, flood;
    uint8_t system; /* 1: G54 ... 9: G59.3 */
};

/* A place to go to: the beginning of the line after line. */
struct program_place {
    uint64_t offset;
    uint32_t line;
};

/*
 * What names an O-word: a number, or PROGRAM_LABEL_NAME and the place of a name in struct
 * program_names.
 */
struct program_label {
    uint32_t id;
};
#define PROGRAM_LABEL_NAME UINT32_C(0x80000000)

/* An IF, WHILE, DO or REPEAT that has been entered and not been left. */
struct program_block {
    uint64_t again; /* where the next round begins */
    struct program_label label;
    uint32_t left; /* REPEAT: rounds to come */
    uint32_t line;
    uint16_t column;
    uint8_t kind; /* enum oword_kind */
    bool done;    /* IF: a branch has been taken; loops: their end leaves them */
};

/* A subroutine, or with M98 a numbered program. */
struct program_sub {
    struct program_place body;
    struct program_label label;
    bool numbered;
    bool visited; /* since the first error */
};

/* What M70 and M73 save. */
struct program_saved {
    struct point tool_offset;
    double unit_mm, feed_mm_s, feed_rad_s, feed_rev_mm, feed_rev_rad, tolerance_mm, merge_mm;
    double speed_rpm, surface_mm_s, surface_max_rpm;
    unsigned overrides;
    enum plane plane;
    enum move_path path;
    enum spindle_direction direction;
    bool incremental, centre_absolute, inverse_time, per_revolution, diameter, retract_to_r;
    bool surface_speed, mist, flood;
    uint8_t system;
};
#define PROGRAM_SAVED_NUMBERS                                                                      \
    ((unsigned)((sizeof(struct program_saved) + sizeof(double) - 1) / sizeof(double)))

/* A call; the first is the main program. */
struct program_frame {
    struct program_place back;
    uint32_t times; /* M98 L: runs to come */
    /* The call itself, for messages. */
    uint32_t line;
    uint16_t column;
    uint16_t
        kept; /* where the caller's #1 ... are kept, and behind them what M70 or M73 has saved */
    uint8_t locals; /* so many; the caller's others are 0 */
    uint8_t sub;
    uint8_t blocks;    /* of its callers */
    bool is_saved : 1; /* M70 or M73 */
    bool restores : 1; /* M73 */
    bool numbered : 1; /* M98 */
};

/* Lines are passed over up to ... */
enum program_skip {
    SKIP_NOTHING,
    SKIP_TO_BRANCH, /* ELSEIF, ELSE or ENDIF of the innermost block */
    SKIP_TO_END,    /* the end of the innermost block */
    SKIP_TO_ENDSUB, /* the end of a definition */
    SKIP_TO_SUB     /* a subroutine further down */
};

/* Where the program stands among its O-words. */
struct program_flow {
    enum program_skip skip;
    struct program_label skip_label; /* SKIP_TO_ENDSUB, SKIP_TO_SUB */
    uint32_t skip_line;              /* SKIP_TO_ENDSUB: of the definition */
    uint16_t skip_column;
    uint8_t blocks, subs, calls;
    bool all_seen; /* the text has been read to its end */
    bool
        failed; /* there has been an error: nothing is repeated any more, so that it is told once */
    bool value_returned;
    bool restarted;      /* M99 of the main program has gone back to the beginning */
    bool motion_refused; /* by a line with an error; no motion code has come since */
    uint32_t refused;    /* axes and F of such lines, not given since */
    double value;
    struct program_place furthest; /* everything before it has been read */
    uint64_t read_to;              /* and something up to here: further on behind a jump forward */
    uint32_t lines_again;          /* lines read again since the last move that takes time */
    uint32_t lines_repeated;       /* lines read again in all */
    double kept[PROGRAM_KEPT_MAX]; /* what calls keep: a stack */
    struct program_block block[PROGRAM_BLOCKS_MAX];
    struct program_sub sub[PROGRAM_SUBS_MAX];
    struct program_frame frame[PROGRAM_CALLS_MAX + 1];
};

/* The way to the line that --from-line starts at. */
struct program_approach {
    bool pending;     /* the line has not been reached: moves are dropped */
    bool holds_line;  /* the lexer holds it while the approach is fetched */
    bool is_up;       /* its first half has been queued */
    uint8_t setups;   /* bit i set: number i of the set-up has been told by what was dropped */
    double height_mm; /* highest Z of what was dropped */
    struct point at;  /* where that ended; then where the approach has come to */
    double setup[MOVE_SETUP_VALUES];
};

/* Tools whose values the program has changed (G10). */
struct program_tools {
    struct tool tool[PROGRAM_TOOL_CHANGES_MAX];
    unsigned count;
    struct tool before; /* of the tool the current line has changed */
    int changed;        /* its index; -1: none */
    unsigned count_before;
};

/* A parameter that a line has set: changes.h. */
struct program_change {
    double before;
    uint32_t place;
    uint16_t parameter;
    uint8_t number; /* those without a move in between have the same */
    bool placed;
};

struct program_changes {
    struct program_change change[PROGRAM_CHANGES_MAX]; /* ring, the oldest first */
    unsigned first, count;
    uint8_t number;   /* of the newest, modulo 256 */
    bool open;        /* no move has come since */
    bool behind_move; /* any has: changes before the first one are done as they are read */
    bool full;        /* the oldest have been forgotten */
};

/* A spline under way, in the plane and machine coordinates. */
struct program_spline {
    struct nurbs nurbs;
    double from_mm[2];
    double tail_mm[2]; /* G5: from its end to the point before it */
    double knot_end;
    uint32_t closing; /* knots of the end still to be added */
};

/* G70 to G72 while the lines of the profile are read. */
struct program_contour {
    const struct program_code *code;
    struct point start;      /* of the cycle, machine position */
    struct profile_point at; /* the profile's end so far: work coordinates of Z and X */
    struct turning_words words;
    uint32_t line; /* of the code */
    uint16_t column;
    uint8_t calls; /* that are open behind the profile's end */
    bool begun;    /* the profile has a line */
    bool failed;   /* an error in the profile: nothing is cut */
};

/*
 * A drilling cycle, G76, a profile or a spline under way: its moves are made one by one as they are
 * fetched. The line it is on has been checked and done; lengths are in mm, positions work
 * coordinates.
 */
struct program_cycle {
    const struct program_code *code; /* NULL: none */
    unsigned before;                 /* moves in the queue that come first */
    struct move feed;                /* its cutting moves, but for their ends */
    enum axis axis[3];               /* first and second of the plane, the one across */
    bool spline_open;                /* further control points are to come */
    bool contour_open;               /* the lines of a profile are being read */
    union {
        struct program_spline spline;   /* splines alone */
        struct program_contour contour; /* G70 to G72 alone */
        struct {
            double hole_mm[2], step_mm[2]; /* the current hole; from one to the next */
            double start_mm, retract_mm, clear_mm, bottom_mm, middle_mm; /* across the plane */
            double aside_mm[2], peck_mm, dwell_s;
            double clearance_mm; /* above the last cut, between pecks */
            double depth_mm;     /* the current peck's */
            uint32_t repeats;
            unsigned stage, substage;
            bool first;
            struct program_thread {
                double start_mm[3], end_mm[3]; /* X, Y, Z */
                double side, depth_mm, first_mm, cut_mm, last_mm, height_mm, degression;
                double slope; /* of the cuts: Z per depth */
                double taper_mm, pitch_mm, taper_pitch_mm, length_end_mm;
                uint32_t pass, springs;
                bool taper_in, taper_out;
            } thread;
        };
    };
};

/* What the last move that was fetched asks of the world. */
enum program_question { QUESTION_NONE, QUESTION_PROBE, QUESTION_INPUT, QUESTION_SETUP };

enum program_phase { PROGRAM_AT_START, PROGRAM_IN_TEXT, PROGRAM_ENDED };

struct program {
    struct program_config config;
    struct program_lexer lexer;
    struct program_words words;
    struct program_modes modes;
    struct program_names names;
    struct program_flow flow;
    struct program_approach approach;
    struct program_tools tools;
    struct program_changes changes;
    struct program_cycle cycle;
    union {
        struct move queue[PROGRAM_QUEUE_MAX]; /* made by the current line, not yet fetched */
        struct turning turning; /* from the first line of a profile to the last move along it */
    };
    unsigned queue_first, queue_count;
    struct diagnostic error;
    struct diagnostic warning[PROGRAM_WARNINGS_MAX];
    unsigned warnings;
    enum program_phase phase;
    enum program_question question; /* not answered yet */
};

#endif

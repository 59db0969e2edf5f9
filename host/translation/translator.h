/*
 * A program that is being translated: its line, what comes of it, and what it leaves for later
 * lines. Languages read and change the line, and add to what stands before and behind it.
 */
#ifndef TAKT_HOST_TRANSLATION_TRANSLATOR_H
#define TAKT_HOST_TRANSLATION_TRANSLATOR_H

#include "translation/codes.h"
#include "translation/dialects.h"
#include "translation/result.h"
#include "words/line.h"

#define TRANSLATE_PROGRAMS_MAX 128
#define TRANSLATE_JUMPS_MAX    1024
#define TRANSLATE_LINES_MAX    16
#define TRANSLATE_NUMBERS_MAX  64
#define TRANSLATE_NAMES_MAX    1024
/* More than the interpreter has in one another. */
#define TRANSLATE_BLOCKS_MAX  64
#define TRANSLATE_TARGETS_MAX 512
/* A call with all of its arguments. */
#define TRANSLATE_CALL_MAX 1664

/* A line with a number N that a jump can go to. */
struct label {
    uint32_t program, number, line;
    size_t offset;  /* in the text */
    unsigned depth; /* loops it is in */
};

enum jump_way { JUMP_ANYWHERE, JUMP_FORWARD, JUMP_BACK };

/* A jump whose target is filled in at the end. */
struct jump {
    enum jump_way way;
    uint32_t program, number, line;
    size_t patch; /* in the text: where its digits begin */
    unsigned depth;
    bool possible; /* one of several: without a target it is none of them */
};

/* A program that is called while a pass of a lathe is in effect. */
struct passed {
    uint32_t program;
    unsigned pass;
};

/* DO that is open. */
struct loop {
    uint32_t number, line;
};

/* Blocks of the program that are a profile, and the subroutine that it has become. */
struct turned {
    double from, to;
    unsigned label, side; /* side: 41, 42 or 0 */
};

/* What has been seen of the whole text before. */
struct survey {
    bool lathe;
    bool limits_speed; /* it has G50 S or G92 S, */
    bool lies_flat;    /* and it has a G17 */
    bool rotary;       /* it has words of rotary axes */
    bool absolute;     /* a lathe whose G90 is that of mills: it has G91 or G95 */
    bool whole;        /* turning cycles write distances in whole thousandths */
    unsigned programs, macros;
    uint32_t program[TRANSLATE_PROGRAMS_MAX]; /* O1000 */
    uint32_t macro[TRANSLATE_PROGRAMS_MAX];   /* called by G65 */
    bool jumps;
    unsigned targets; /* numbers N, each once; one more than the most: there are too many */
    uint32_t target[TRANSLATE_TARGETS_MAX];
    bool changes;            /* it has M6 */
    bool ended;              /* M30, M2 or M99 has passed */
    bool drilling, relative; /* a series of drilling cycles, and G91, are in effect */
    bool mixes;              /* a series has both G90 and G91 */
    unsigned drilled;
    uint32_t drills[TRANSLATE_PROGRAMS_MAX]; /* called in a series */
    unsigned calls, locals;
    uint32_t call[TRANSLATE_PROGRAMS_MAX];  /* N that M97 calls */
    uint32_t local[TRANSLATE_PROGRAMS_MAX]; /* those of them that begin behind an end */
    unsigned numbers;
    uint32_t number[TRANSLATE_NUMBERS_MAX]; /* parameters beyond those of LinuxCNC */
};

struct translator {
    enum dialect dialect;
    const struct dialect_codes *codes;
    const char *source; /* the whole text */
    size_t source_length;
    struct dialect_result *result;
    struct survey survey;
    struct line line;                   /* the current one */
    uint32_t number;                    /* of it */
    struct dialect_text before, behind; /* lines of their own, each with its end */
    /* what the words so far leave for the next */
    char across;          /* centre word that arcs of the plane do not have: 'k' in G17 */
    bool incremental;     /* G91 */
    bool has_motion;      /* there has been a motion code */
    bool ended_cycle;     /* the last one was G80 */
    const char *straight; /* G0 or G1 before cycles; NULL: neither, or not known */
    bool motion_is_owed;  /* G0 stood beside G28: it holds from the next line on */
    bool has_tool;        /* there has been a T */
    bool begun;           /* a line with words has passed */
    bool absolute;        /* centres of arcs are, and G90.1 has to say so */
    bool globals_given;   /* those that the machine file knows are set */
    bool feeds;           /* a printer's program has had an F */
    bool feed_given;      /* the F that the machine file declares has been put in */
    char speed_limit[24]; /* G50 S */
    char radius[24];      /* D beside G43 */
    char length[24];      /* H that stood alone */
    bool has_length;      /* G43 is in effect */
    bool has_height;      /* a cycle of the series in effect has had its R */
    bool has_two_heights; /* Fagor's G81 */
    bool bores_fine;      /* G76 of a mill is in effect */
    unsigned cycle;       /* that of drilling in effect, times ten; 0: none, or not known */
    bool bores_along;     /* and it goes along Z on a lathe */
    bool has_level;       /* its R counts from #<_level>, where the tool was before */
    unsigned arc;         /* G2 or G3 is in effect: 2, 3; else 0 */
    bool cuts_thread;     /* G32 is in effect */
    char lead[24];        /* K, the F of it */
    unsigned pass;        /* G90, G92 or G94 of a lathe is in effect: 90, 92, 94; else 0 */
    unsigned pass_known;  /* its words so far (passes.c) */
    unsigned passed;
    struct passed passes[TRANSLATE_LINES_MAX];
    unsigned turns;                      /* the spindle, by M3 or M4: 3, 4; else 0 */
    bool polar;                          /* G16 is in effect */
    unsigned side;                       /* G41 or G42 is in effect: 41, 42; else 0 */
    bool surface_is_owed;                /* G96 waits for its S */
    uint32_t program;                    /* number of O1000 lines so far */
    uint32_t macro;                      /* the current program is called by G65; 0: it is not */
    char modal_call[TRANSLATE_CALL_MAX]; /* G66; empty: none */
    char modal_times[48];                /* how often; empty: once */
    /*
     * Siemens: names that are jumped to, those of variables (DEF), open blocks, sections that are
     * repeated, the subprogram it is in
     */
    unsigned names, variables, blocks, nested, repeats;
    char name[TRANSLATE_NAMES_MAX][32], variable[TRANSLATE_NAMES_MAX][32];
    char kind[TRANSLATE_NAMES_MAX]; /* of a variable: 'i' INT, 'v' VAR of a PROC, else ' ' */
    uint32_t block[TRANSLATE_BLOCKS_MAX];
    char subprogram[32];
    const char *called;    /* the text is the subprogram of this name; NULL: the program itself */
    bool worded;           /* this program or subprogram has had a line */
    bool diameter;         /* X is one (DIAMON), */
    bool diameter_follows; /* as long as G90 is in effect (DIAM90) */
    size_t line_offset;    /* of the current line, in the text */
    struct turned profile[TRANSLATE_LINES_MAX];
    unsigned profiles;
    double skip_from, skip_to; /* blocks to be passed over; 0: none */
    bool skipping;
    char depth_of_cut[48], way_back[48];   /* G71 U R */
    uint32_t thread_form;                  /* P of the first line of G76 */
    unsigned depth;                        /* open loops */
    struct loop loop[TRANSLATE_LINES_MAX]; /* those of Fanuc */
    unsigned labels, jumps;
    struct label *label;
    struct jump jump[TRANSLATE_JUMPS_MAX];
    size_t label_room;
};

/* Dialects that have something in common, as bits. */
#define TRANSLATE_GRBL        (1U << DIALECT_GRBL)
#define TRANSLATE_MARLIN      (1U << DIALECT_MARLIN)
#define TRANSLATE_MACROS      (1U << DIALECT_FANUC | 1U << DIALECT_HAAS)
#define TRANSLATE_SIEMENS     (1U << DIALECT_SIEMENS)
#define TRANSLATE_INDUSTRY    (TRANSLATE_MACROS | 1U << DIALECT_MACH3)
#define TRANSLATE_NOT_FOREIGN (1U << DIALECT_LINUXCNC)

static inline bool translate_is(const struct translator *t, unsigned dialects)
{
    return ((1U << t->dialect) & dialects) != 0;
}

/* Tells of a word that is left out, once for each. */
void translate_note(struct translator *t, const struct line_word *w, const char *meaning);

/* Tells what cannot be translated, at a word of the line; NULL: the line. */
__attribute__((format(printf, 3, 4))) void
translate_wrong(struct translator *t, const struct line_word *w, const char *format, ...);

/* Shows text to the operator: a comment, so parentheses in it become brackets. */
void translate_message(struct translator *t, const char *text, size_t length);

/* Adds a line; the first of all lines that one becomes loses its DIALECT_GOES_ON. */
__attribute__((format(printf, 2, 3))) void translate_add(struct dialect_text *t, const char *format,
                                                         ...);

#endif

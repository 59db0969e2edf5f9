/*
 * The text of a part program. Of a file only the piece being read is in memory, so its length does
 * not matter; what cannot be read twice, standard input or a pipe, is kept whole.
 */
#ifndef TAKT_HOST_PROGRAM_TEXT_H
#define TAKT_HOST_PROGRAM_TEXT_H

#include "cli/text.h"
#include "program/source.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#define PROGRAM_TEXT_PIECE 16384

/*
 * A file that the text consists of, as it is found. The first is the program, the others are
 * subroutines.
 */
struct program_piece {
    uint32_t first_line; /* of its lines in the text; its own count from 1 */
    char *name;          /* owned */
    struct text found;   /* owned */
};

struct program_text {
    const char *name; /* for messages: the path, or "<stdin>". Not owned */
    bool is_file;     /* else whole */
    int file;
    int64_t size; /* when it was opened; and when it had last been changed then */
    struct timespec changed;
    struct text whole;
    /* of one that has been prepared (program_front.h) */
    unsigned pieces; /* 0: it is read as it is found */
    struct program_piece *piece;
};

/* Where a line is found: its file, and *line becomes that of the file. */
const char *program_text_place(const struct program_text *text, uint32_t *line);

/* One reading of it; several may go on at once. */
struct program_text_reader {
    const struct program_text *text;
    uint64_t at;       /* next byte to read */
    uint64_t piece_at; /* of the piece in the text */
    size_t piece_length;
    char piece[PROGRAM_TEXT_PIECE];
};

/* Opens path, "-" for standard input. False after a message: it cannot be opened or read. */
bool program_text_open(struct program_text *text, const char *path);
/*
 * A text that is in memory already; bytes are copied, name is not. False after a message: out of
 * memory.
 */
bool program_text_hold(struct program_text *text, const char *name, const char *bytes,
                       size_t length);
void program_text_close(struct program_text *text);

/*
 * A source that begins at the beginning. The reader is the caller's and must stay where it is.
 * Reading ends in an error when the file is changed meanwhile.
 */
void program_text_read(const struct program_text *text, struct program_text_reader *reader,
                       struct source *source);

/*
 * Up to size bytes of a line (from 1) after its first ones, without its end; returns how many there
 * are.
 */
size_t program_text_line(const struct program_text *text, uint32_t line, size_t first, char *bytes,
                         size_t size);

#endif

#define _POSIX_C_SOURCE 200809L

#include "cli/program_text.h"

#include "cli/files_read.h"
#include "cli/message.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Files without a size are made while they are read, and may not come out the same twice. */
static bool is_lasting(const struct stat *status)
{
    return S_ISREG(status->st_mode) && status->st_size > 0;
}

static bool open_file(struct program_text *text, const char *path)
{
    struct stat status;
    int file = open(path, O_RDONLY | O_CLOEXEC);

    if (file < 0)
        return false;
    if (fstat(file, &status) != 0 || !is_lasting(&status)) {
        (void)close(file);
        return false;
    }
    files_read_note(path);
    text->name = path;
    text->is_file = true;
    text->file = file;
    text->size = status.st_size;
    text->changed = status.st_mtim;
    return true;
}

bool program_text_open(struct program_text *text, const char *path)
{
    *text = (struct program_text){0};
    if (strcmp(path, "-") != 0 && text_find_held(path) == NULL && open_file(text, path))
        return true;
    if (!text_read(&text->whole, path))
        return false;
    text->name = text->whole.name;
    return true;
}

bool program_text_hold(struct program_text *text, const char *name, const char *bytes,
                       size_t length)
{
    char *copy = malloc(length + 1);

    *text = (struct program_text){.name = name};
    if (copy == NULL) {
        message_command_error("out of memory");
        return false;
    }
    memcpy(copy, bytes, length);
    copy[length] = '\0';
    text->whole = (struct text){.name = name, .bytes = copy, .length = length};
    return true;
}

void program_text_close(struct program_text *text)
{
    for (unsigned i = 0; i < text->pieces; i++) {
        text_free(&text->piece[i].found);
        free(text->piece[i].name);
    }
    free(text->piece);
    if (text->is_file)
        (void)close(text->file);
    text_free(&text->whole);
    *text = (struct program_text){0};
}

static bool is_unchanged(const struct program_text *text)
{
    struct stat status;

    return fstat(text->file, &status) == 0 && status.st_size == text->size &&
           status.st_mtim.tv_sec == text->changed.tv_sec &&
           status.st_mtim.tv_nsec == text->changed.tv_nsec;
}

/*
 * The piece that begins where is to be read next; its length 0: the end. False: it cannot be read.
 */
static bool next_piece(struct program_text_reader *r)
{
    ssize_t got = pread(r->text->file, r->piece, sizeof r->piece, (off_t)r->at);

    if (got < 0 || !is_unchanged(r->text))
        return false;
    r->piece_at = r->at;
    r->piece_length = (size_t)got;
    return true;
}

static size_t left_of_piece(const struct program_text_reader *r)
{
    if (r->at < r->piece_at || r->at >= r->piece_at + r->piece_length)
        return 0;
    return (size_t)(r->piece_at + r->piece_length - r->at);
}

static long file_read(void *context, char *buffer, size_t size)
{
    struct program_text_reader *r = context;
    size_t count = left_of_piece(r);

    if (count == 0) {
        if (!next_piece(r))
            return SOURCE_ERROR;
        count = r->piece_length;
    }
    if (count == 0)
        return SOURCE_END;
    if (count > size)
        count = size;
    memcpy(buffer, r->piece + (r->at - r->piece_at), count);
    r->at += count;
    return (long)count;
}

static long whole_read(void *context, char *buffer, size_t size)
{
    struct program_text_reader *r = context;
    size_t left = r->text->whole.length - (size_t)r->at;
    size_t count = left < size ? left : size;

    if (count == 0)
        return SOURCE_END;
    memcpy(buffer, r->text->whole.bytes + r->at, count);
    r->at += count;
    return (long)count;
}

static bool seek(void *context, uint64_t offset)
{
    struct program_text_reader *r = context;
    uint64_t size = r->text->is_file ? (uint64_t)r->text->size : r->text->whole.length;

    if (offset > size)
        return false;
    r->at = offset;
    return true;
}

void program_text_read(const struct program_text *text, struct program_text_reader *reader,
                       struct source *source)
{
    reader->text = text;
    reader->at = 0;
    reader->piece_at = 0;
    reader->piece_length = 0;
    *source = (struct source){
        .read = text->is_file ? file_read : whole_read,
        .seek = seek,
        .context = reader,
    };
}

/* Bytes of a text in their order. */
struct line_search {
    struct source source;
    size_t length, at;
    char piece[PROGRAM_TEXT_PIECE];
};

/* False: the end. */
static bool next_byte(struct line_search *s, char *byte)
{
    long got;

    if (s->at == s->length) {
        got = s->source.read(s->source.context, s->piece, sizeof s->piece);
        if (got <= 0)
            return false;
        s->length = (size_t)got;
        s->at = 0;
    }
    *byte = s->piece[s->at++];
    return true;
}

/* Goes behind the end of a line. False: the text has ended. */
static bool pass_line(struct line_search *s)
{
    char byte;

    while (next_byte(s, &byte)) {
        if (byte == '\n')
            return true;
    }
    return false;
}

static size_t take_line(struct line_search *s, size_t first, char *bytes, size_t size)
{
    size_t count = 0;
    char byte;

    for (size_t i = 0; count < size && next_byte(s, &byte) && byte != '\n'; i++) {
        if (i >= first)
            bytes[count++] = byte;
    }
    return count > 0 && bytes[count - 1] == '\r' ? count - 1 : count;
}

/* The file that a line is found in. */
static const struct program_piece *piece_of(const struct program_text *text, uint32_t line)
{
    unsigned i = text->pieces;

    while (i > 1 && text->piece[i - 1].first_line > line)
        i--;
    return &text->piece[i - 1];
}

const char *program_text_place(const struct program_text *text, uint32_t *line)
{
    if (text->pieces == 0 || *line == 0)
        return text->name;
    const struct program_piece *piece = piece_of(text, *line);

    *line -= piece->first_line - 1;
    return piece->name;
}

static size_t found_line(const struct text *text, uint32_t line, size_t first, char *bytes,
                         size_t size)
{
    size_t position = 0;
    const char *start = "";
    size_t length = 0;

    for (uint32_t i = 0; i < line; i++) {
        if (!text_next_line(text, &position, &start, &length))
            return 0;
    }
    const size_t left = length > first ? length - first : 0;
    const size_t count = left < size ? left : size;

    memcpy(bytes, start + (left > 0 ? first : 0), count);
    return count;
}

size_t program_text_line(const struct program_text *text, uint32_t line, size_t first, char *bytes,
                         size_t size)
{
    static _Thread_local struct program_text_reader reader;
    static _Thread_local struct line_search search;

    if (text->pieces > 0) {
        const struct program_piece *piece = piece_of(text, line);

        return found_line(&piece->found, line - (piece->first_line - 1), first, bytes, size);
    }
    search.length = 0;
    search.at = 0;
    program_text_read(text, &reader, &search.source);
    for (uint32_t i = 1; i < line; i++) {
        if (!pass_line(&search))
            return 0;
    }
    return take_line(&search, first, bytes, size);
}

#define _POSIX_C_SOURCE 200809L

#include "session/program_front.h"

#include "cli/message.h"
#include "session/subroutine_file.h"
#include "words/line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* ---- what a program is written for ---- */

/* Bytes of a text, given to the detector line by line. */
struct scan {
    struct dialect_detector detector;
    const struct dialect_codes *codes;
    size_t length;
    char line[LINE_MAX_BYTES + 1]; /* a longer line is not looked at */
};

static void scan_byte(struct scan *s, char byte)
{
    if (byte == '\n') {
        dialect_guess_line(&s->detector, s->line, s->length, s->codes);
        s->length = 0;
    } else if (s->length < sizeof s->line) {
        s->line[s->length++] = byte;
    }
}

static struct dialect_guess scan_end(struct scan *s)
{
    if (s->length > 0)
        scan_byte(s, '\n');
    return dialect_guess_end(&s->detector);
}

static struct dialect_guess guess_bytes(const char *bytes, size_t length,
                                        const struct dialect_codes *codes)
{
    static _Thread_local struct scan s;

    s = (struct scan){.codes = codes};
    for (size_t i = 0; i < length; i++)
        scan_byte(&s, bytes[i]);
    return scan_end(&s);
}

/* A text without any line feed whose lines end with carriage returns. */
static bool ends_with_returns(const struct program_text *text)
{
    static _Thread_local struct program_text_reader reader;
    struct source source;
    char piece[4096];
    bool returns = false;
    long got;

    program_text_read(text, &reader, &source);
    while ((got = source.read(source.context, piece, sizeof piece)) > 0) {
        if (memchr(piece, '\n', (size_t)got) != NULL)
            return false;
        returns = returns || memchr(piece, '\r', (size_t)got) != NULL;
    }
    return returns;
}

static void mend_line_ends(struct text *text)
{
    if (memchr(text->bytes, '\n', text->length) != NULL)
        return;
    for (size_t i = 0; i < text->length; i++)
        text->bytes[i] = (char)(text->bytes[i] == '\r' ? '\n' : text->bytes[i]);
}

/* Without keeping it: a program may be long. */
static struct dialect_guess guess_text(const struct program_text *text,
                                       const struct dialect_codes *codes, bool *calls)
{
    static _Thread_local struct program_text_reader reader;
    static _Thread_local struct scan s;
    const bool returns = ends_with_returns(text);
    struct source source;
    char piece[4096];
    long got;

    s = (struct scan){.codes = codes};
    s.detector.translates = returns;
    program_text_read(text, &reader, &source);
    while ((got = source.read(source.context, piece, sizeof piece)) > 0) {
        for (long i = 0; i < got; i++)
            scan_byte(&s, (char)(returns && piece[i] == '\r' ? '\n' : piece[i]));
    }
    *calls = s.detector.calls;
    return scan_end(&s);
}

/* ---- subroutines ---- */

/* What calls and definitions go by: <name>, or a number without zeros before it. */
struct labels {
    unsigned count, room;
    char (*name)[64];
};

static bool knows(const struct labels *labels, const char *name)
{
    for (unsigned i = 0; i < labels->count; i++) {
        if (strcmp(labels->name[i], name) == 0)
            return true;
    }
    return false;
}

static void add_label(struct labels *labels, const char *name)
{
    if (name[0] == '\0' || knows(labels, name))
        return;
    if (labels->count == labels->room) {
        const unsigned room = 2 * labels->room + 16;
        void *grown = realloc(labels->name, room * sizeof *labels->name);

        if (grown == NULL)
            return;
        labels->name = grown;
        labels->room = room;
    }
    (void)snprintf(labels->name[labels->count++], sizeof *labels->name, "%s", name);
}

/* A program with what belongs to it, as it grows. */
struct junction {
    const struct program_front *front;
    struct program_text *text;
    enum dialect dialect; /* of the program */
    struct dialect_text bytes;
    uint32_t lines; /* of bytes */
    struct labels defined, called;
    bool failed;
};

static void add_bytes(struct junction *j, const char *bytes, size_t length)
{
    struct dialect_text *t = &j->bytes;

    if (t->length + length > t->room) {
        const size_t room = 2 * (t->length + length) + 4096;
        char *grown = realloc(t->bytes, room);

        j->failed = j->failed || grown == NULL;
        if (grown == NULL)
            return;
        t->bytes = grown;
        t->room = room;
    }
    if (length > 0)
        memcpy(t->bytes + t->length, bytes, length);
    t->length += length;
}

static void note_oword(struct junction *j, const char *name, const char *behind)
{
    if (line_defines_label(behind))
        add_label(&j->defined, name);
    if (line_begins(behind, "call"))
        add_label(&j->called, name);
}

static void note_line(struct junction *j, const char *bytes, size_t length)
{
    static _Thread_local struct line l;
    char name[LINE_LABEL_MAX];
    const char *behind;

    if (length > 0 && bytes[0] == DIALECT_GOES_ON) {
        bytes++;
        length--;
    }
    if (!line_read(&l, bytes, length))
        return;
    if (line_read_label(&l, name, &behind)) {
        note_oword(j, name, behind);
        return;
    }
    const struct line_word *p = line_find(&l, 'p', 0);

    if (p != NULL && p->is_number && line_find_code(&l, 'm', 980) != NULL) {
        (void)snprintf(name, sizeof name, "%.0f", p->value);
        add_label(&j->called, name);
    }
}

/* In a file that is no program by itself '%' means nothing; a program ends with its second one. */
static bool take_line(struct junction *j, const char *bytes, size_t length, bool program)
{
    const bool percent = length > 0 && bytes[0] == '%';
    const bool counts = length == 0 || bytes[0] != DIALECT_GOES_ON;

    if (percent && program && j->lines > 0)
        return false;
    note_line(j, bytes, length);
    add_bytes(j, bytes, percent && !program ? 0 : length);
    add_bytes(j, "\n", 1);
    j->lines += counts ? 1U : 0U;
    return true;
}

static void take_lines(struct junction *j, const struct dialect_text *text, bool program)
{
    const char *at = text->bytes;
    const char *end = text->bytes + text->length;
    bool goes_on = true;

    while (at < end && goes_on) {
        const char *next = memchr(at, '\n', (size_t)(end - at));
        const char *line_end = next != NULL ? next : end;

        goes_on = take_line(j, at, (size_t)(line_end - at), program);
        at = line_end + 1;
    }
}

/* ---- pieces ---- */

static bool add_piece(struct junction *j, const char *name, struct text *found)
{
    struct program_text *text = j->text;
    struct program_piece *grown = realloc(text->piece, (text->pieces + 1) * sizeof *text->piece);
    char *copy = strdup(name);

    if (grown != NULL)
        text->piece = grown;
    if (grown == NULL || copy == NULL) {
        j->failed = true;
        free(copy);
        return false;
    }
    found->name = copy;
    text->piece[text->pieces++] =
        (struct program_piece){.first_line = j->lines + 1, .name = copy, .found = *found};
    return true;
}

static void tell_notes(const char *name, enum dialect dialect, const struct dialect_result *result)
{
    for (unsigned i = 0; i < result->notes; i++) {
        const struct dialect_note *note = &result->note[i];

        message_warning(name, note->line, note->column, "'%s' is left out (%s: %s)", note->word,
                        dialect_name(dialect), note->meaning);
    }
}

/* What has been found, in takt's own language. False after a message. */
static bool translate(const struct junction *j, const char *called, enum dialect dialect,
                      const struct text *found, struct dialect_text *bytes)
{
    static _Thread_local struct dialect_result result;
    const bool good =
        dialect_translate(dialect, j->front->codes, called, found->bytes, found->length, &result);

    *bytes = result.text;
    if (!good) {
        message_command_error("out of memory");
        return false;
    }
    if (!j->front->quiet)
        tell_notes(found->name, dialect, &result);
    if (result.wrong_line != 0)
        message_error(found->name, result.wrong_line, result.wrong_column, "%s", result.wrong);
    return result.wrong_line == 0;
}

/* The program has ended before what follows; nothing of it is executed on the way. */
static void end_program(struct junction *j)
{
    static const char end[] = {DIALECT_GOES_ON, 'M', '2', '\n'};

    if (j->text->pieces == 2) /* the program, and the first of the others */
        add_bytes(j, end, sizeof end);
}

/* A subprogram of Siemens need not have anything that tells of it. */
static enum dialect dialect_of(const struct junction *j, const char *path,
                               const struct dialect_guess *guess)
{
    const size_t length = strlen(path);
    const bool spf = length > 4 && strcasecmp(path + length - 4, ".spf") == 0;

    return spf && guess->dialect == DIALECT_LINUXCNC ? j->dialect : guess->dialect;
}

static bool bring_in(struct junction *j, const char *label)
{
    char path[4096 + 128];
    struct text found;
    struct dialect_text bytes;

    if (!subroutine_file_find(j->front, j->text->name, label, path, sizeof path) ||
        strcmp(path, j->text->name) == 0)
        return true;
    if (!text_read(&found, path))
        return false;
    mend_line_ends(&found);
    const struct dialect_guess guess = guess_bytes(found.bytes, found.length, j->front->codes);

    if (!add_piece(j, path, &found)) {
        text_free(&found);
        return false;
    }
    const char *called = label[0] == '<' ? label + 1 : label;
    const bool good = translate(j, called, dialect_of(j, path, &guess), &found, &bytes);

    if (good) {
        end_program(j);
        j->text->piece[j->text->pieces - 1].first_line = j->lines + 1;
        take_lines(j, &bytes, false);
    }
    dialect_text_free(&bytes);
    return good;
}

/* Those of the program, then those of what has been brought in. */
static bool bring_in_all(struct junction *j)
{
    for (unsigned i = 0; i < j->called.count; i++) {
        if (!knows(&j->defined, j->called.name[i])) {
            char label[64];

            (void)snprintf(label, sizeof label, "%s", j->called.name[i]);
            if (!bring_in(j, label))
                return false;
        }
    }
    return true;
}

/* ---- all of it ---- */

static bool read_found(const struct program_text *text, struct text *found)
{
    struct text copy = {.name = text->name};

    if (text->is_file)
        return text_read(found, text->name);
    copy.bytes = malloc(text->whole.length + 1);
    if (copy.bytes == NULL)
        return false;
    memcpy(copy.bytes, text->whole.bytes, text->whole.length);
    copy.bytes[text->whole.length] = '\0';
    copy.length = text->whole.length;
    *found = copy;
    return true;
}

static void tell_dialect(const struct program_front *front, const char *name,
                         const struct dialect_guess *guess)
{
    if (front->dialect == DIALECT_AUTO && guess->line != 0 && !front->quiet)
        message_command_note("%s is read as %s, since line %u has '%s' (--dialect says otherwise)",
                             name, dialect_name(guess->dialect), (unsigned)guess->line,
                             guess->evidence);
}

/* The program as its first piece, and everything it calls. */
static bool join(struct junction *j, enum dialect dialect)
{
    struct text found;
    struct dialect_text bytes;

    if (!read_found(j->text, &found))
        return false;
    mend_line_ends(&found);
    if (!add_piece(j, j->text->name, &found)) {
        text_free(&found);
        return false;
    }
    j->dialect = dialect;
    const bool good = translate(j, NULL, dialect, &found, &bytes);

    if (good)
        take_lines(j, &bytes, true);
    dialect_text_free(&bytes);
    return good && bring_in_all(j) && !j->failed;
}

static void free_junction(struct junction *j)
{
    dialect_text_free(&j->bytes);
    free(j->defined.name);
    free(j->called.name);
}

/* The junction takes the place of the text as it was found. */
static void replace_text(struct junction *j)
{
    struct program_text *text = j->text;

    if (text->is_file)
        (void)close(text->file);
    text_free(&text->whole);
    text->is_file = false;
    text->whole =
        (struct text){.name = text->name, .bytes = j->bytes.bytes, .length = j->bytes.length};
    j->bytes = (struct dialect_text){0};
}

static void forget_pieces(struct program_text *text)
{
    for (unsigned i = 0; i < text->pieces; i++) {
        text_free(&text->piece[i].found);
        free(text->piece[i].name);
    }
    free(text->piece);
    text->piece = NULL;
    text->pieces = 0;
}

bool program_front_prepare(const struct program_front *front, struct program_text *text)
{
    struct junction j = {.front = front, .text = text};
    bool calls;
    const struct dialect_guess guess = guess_text(text, front->codes, &calls);
    const enum dialect dialect = front->dialect == DIALECT_AUTO ? guess.dialect : front->dialect;
    const bool translates = guess.translates || dialect != DIALECT_LINUXCNC;

    if (!translates && !calls)
        return true;
    tell_dialect(front, text->name, &guess);
    const bool good = join(&j, dialect);

    if (good && (translates || text->pieces > 1))
        replace_text(&j);
    else if (good)
        forget_pieces(text);
    free_junction(&j);
    return good;
}

bool program_front_read(const struct program_front *front, const char *path, struct text *text)
{
    struct program_text program;
    bool good = program_text_open(&program, path);

    if (!good)
        return false;
    good = program_front_prepare(front, &program);
    if (good && program.is_file) {
        good = text_read(text, path);
    } else if (good) {
        *text = program.whole;
        text->name = path;
        program.whole = (struct text){0};
    }
    program_text_close(&program);
    return good;
}

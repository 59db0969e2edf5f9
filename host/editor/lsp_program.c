#include "editor/lsp_program.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "editor/lint.h"
#include "editor/lsp_text.h"
#include "editor/meaning.h"
#include "editor/mode_text.h"
#include "session/session.h"
#include "words/line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Errors of one program that are told. */
#define ERRORS_MAX 100
/* DiagnosticSeverity of the protocol. */
#define SEVERITY_ERROR       1
#define SEVERITY_WARNING     2
#define SEVERITY_INFORMATION 3
#define TEXT_MAX             4096

static struct session session;

/* ---- places ---- */

static cJSON *position(uint32_t line, size_t character)
{
    cJSON *p = cJSON_CreateObject();

    (void)cJSON_AddNumberToObject(p, "line", line);
    (void)cJSON_AddNumberToObject(p, "character", (double)character);
    return p;
}

/* Bytes begin to end of a line (from 0) that consists of these bytes. */
static cJSON *range(uint32_t line, const char *bytes, size_t length, size_t begin, size_t end)
{
    cJSON *r = cJSON_CreateObject();

    (void)cJSON_AddItemToObject(r, "start", position(line, lsp_text_units(bytes, length, begin)));
    (void)cJSON_AddItemToObject(r, "end", position(line, lsp_text_units(bytes, length, end)));
    return r;
}

/* The word that covers a byte of a line; NULL: none does. */
static const struct line_word *word_at(struct line *l, const char *bytes, size_t length, size_t at)
{
    if (!line_read(l, bytes, length))
        return NULL;
    for (unsigned i = 0; i < l->words; i++) {
        if (l->word[i].begin <= at && at < l->word[i].end)
            return &l->word[i];
    }
    return NULL;
}

/* ---- what is wrong ---- */

struct listener {
    const struct lsp_program *program;
    cJSON *diagnostics;
};

/* From its column to the end of the word; what is about a line as a whole has its first column. */
static cJSON *range_of(const struct lsp_program *p, const struct message *m)
{
    static struct line l;
    const uint32_t line = m->line > 0 ? m->line - 1 : 0;
    size_t length;
    const char *bytes = lsp_text_line(p->text, p->length, line, &length);
    const size_t column = m->column > 0 ? m->column - 1 : 0;
    const size_t begin = column < length ? column : length;
    const struct line_word *w = word_at(&l, bytes, length, begin);
    const bool whole = begin == 0 && strcmp(m->kind, "error") != 0;

    return range(line, bytes, length, begin, w != NULL && !whole ? w->end : length);
}

static int severity(const char *kind)
{
    if (strcmp(kind, "error") == 0)
        return SEVERITY_ERROR;
    return strcmp(kind, "warning") == 0 ? SEVERITY_WARNING : SEVERITY_INFORMATION;
}

/*
 * What is about another file, a subroutine's or the machine's, stands on the first line with the
 * place before it.
 */
static void hear(void *context, const struct message *m)
{
    const struct listener *l = context;
    const bool here = m->file != NULL && strcmp(m->file, l->program->path) == 0;
    const struct message elsewhere = {.kind = m->kind};
    const size_t cure = strlen(m->cure);
    char text[TEXT_MAX];
    cJSON *d = cJSON_CreateObject();

    if (here || m->file == NULL)
        (void)snprintf(text, sizeof text, "%s%s%.*s", m->text, cure > 0 ? "\n" : "",
                       cure > 0 ? (int)cure - 1 : 0, m->cure);
    else
        (void)snprintf(text, sizeof text, "%s:%u:%u: %s", m->file, (unsigned)m->line,
                       (unsigned)m->column, m->text);
    lsp_text_clean(text);
    (void)cJSON_AddItemToObject(d, "range", range_of(l->program, here ? m : &elsewhere));
    (void)cJSON_AddNumberToObject(d, "severity", severity(m->kind));
    (void)cJSON_AddStringToObject(d, "source", "takt");
    (void)cJSON_AddStringToObject(d, "message", text);
    (void)cJSON_AddItemToArray(l->diagnostics, d);
}

static void ignore(void *context, const struct message *m)
{
    (void)context;
    (void)m;
}

static enum command_status open_session(const struct lsp_program *p)
{
    return session_open_text(&session, p->options, p->path, p->text, p->length);
}

cJSON *lsp_program_check(const struct lsp_program *p)
{
    struct listener listener = {p, cJSON_CreateArray()};
    struct session_totals totals;
    unsigned findings;

    message_listen(hear, &listener);
    if (open_session(p) == STATUS_DONE &&
        session_check(&session, ERRORS_MAX, &totals) == STATUS_DONE)
        (void)lint_program(&session, p->stock_top_mm, &findings);
    session_close(&session);
    message_listen(NULL, NULL);
    return listener.diagnostics;
}

/* ---- what a word means ---- */

/* Modes where a line of the program itself begins. */
struct arrival {
    const struct lsp_program *program;
    uint32_t line;   /* from 1 */
    bool flows;      /* it is an O-word, which does not tell: what is executed next does */
    uint32_t before; /* executed last of this file */
    unsigned axes;
    bool found;
    char modes[MODE_TEXT_MAX];
};

static void arrive(void *context, const struct program *p)
{
    struct arrival *a = context;
    uint32_t line = p->lexer.line;

    if (a->found || strcmp(program_text_place(&session.program, &line), a->program->path) != 0)
        return;
    if (line == a->line || (a->flows && a->before < a->line && line > a->line)) {
        a->found = true;
        mode_text_write(p, a->axes, a->modes);
    }
    a->before = line;
}

static void find_modes(struct arrival *a)
{
    static struct session_reading reading;
    struct program_config config;
    struct source source;
    struct diagnostic ignored;
    struct move move;
    enum program_result result = PROGRAM_MOVE;

    session_begin_reading(&session, &reading, &config, &source);
    config.say = arrive;
    config.listener = a;
    a->axes = config.axes;
    takt_program_open(&reading.program, &config, &source);
    while ((result == PROGRAM_MOVE || result == PROGRAM_ERROR) && !a->found && !interrupt_asked())
        result = takt_program_next(&reading.program, &move, &ignored);
}

static void write_modes(const struct lsp_program *p, uint32_t line, bool flows, char *text,
                        size_t size)
{
    struct arrival arrival = {.program = p, .line = line + 1, .flows = flows};
    const size_t length = strlen(text);

    message_listen(ignore, NULL);
    if (open_session(p) == STATUS_DONE)
        find_modes(&arrival);
    session_close(&session);
    message_listen(NULL, NULL);
    if (arrival.found)
        (void)snprintf(text + length, size - length, "In effect before this line:\n```\n%s\n```",
                       arrival.modes);
    else
        (void)snprintf(text + length, size - length, "This line is never reached.");
}

/* What stands behind the label of an O-word. */
static const char *meaning_in_flow(const struct line *l, size_t at, size_t *begin, size_t *end)
{
    char label[LINE_LABEL_MAX];
    const char *behind;
    size_t length;

    if (!line_read_label(l, label, &behind))
        return NULL;
    const char *meaning = meaning_of_flow(behind, &length);

    *begin = (size_t)(behind - l->text);
    *end = *begin + length;
    return at < *end ? meaning : NULL;
}

static const char *meaning_of_word(const struct line_word *w)
{
    const int number = line_code(w);

    if (number >= 0)
        return meaning_of_code(w->letter, (unsigned)number);
    return w->kind == WORD_VALUE ? meaning_of_letter(w->letter) : NULL;
}

/* The machine file may say what becomes of a code that takt does not have. */
static const char *meaning_declared(const struct lsp_program *p, const struct line_word *w,
                                    char text[DIALECT_CODE_TEXT_MAX])
{
    const struct dialect_codes *codes = &session.setup.codes;
    const char *found = NULL;

    message_listen(ignore, NULL);
    (void)session_open_machine(&session, p->options);
    for (unsigned i = 0; i < codes->count; i++) {
        if (codes->code[i].letter == w->letter && codes->code[i].number_x10 == line_code(w)) {
            dialect_code_write(&codes->code[i], text);
            found = text;
        }
    }
    session_close(&session);
    message_listen(NULL, NULL);
    return found;
}

static cJSON *hover(char *text, cJSON *of)
{
    cJSON *h = cJSON_CreateObject();
    cJSON *contents = cJSON_AddObjectToObject(h, "contents");

    lsp_text_clean(text);
    (void)cJSON_AddStringToObject(contents, "kind", "markdown");
    (void)cJSON_AddStringToObject(contents, "value", text);
    (void)cJSON_AddItemToObject(h, "range", of);
    return h;
}

cJSON *lsp_program_hover(const struct lsp_program *p, uint32_t line, size_t character)
{
    static struct line l;
    char declared[DIALECT_CODE_TEXT_MAX];
    char text[TEXT_MAX];
    size_t length;
    const char *bytes = lsp_text_line(p->text, p->length, line, &length);
    const size_t at = lsp_text_byte(bytes, length, character);
    const struct line_word *w = word_at(&l, bytes, length, at);

    if (w == NULL || w->kind == WORD_COMMENT)
        return cJSON_CreateNull();
    size_t begin = w->begin;
    size_t end = w->end;
    const char *meaning = meaning_in_flow(&l, at, &begin, &end);

    if (meaning == NULL) {
        begin = w->begin;
        end = w->end;
        meaning = meaning_of_word(w);
    }
    if (meaning == NULL && line_code(w) >= 0)
        meaning = meaning_declared(p, w, declared);
    text[0] = '\0';
    if (meaning != NULL)
        (void)snprintf(text, sizeof text, "**%.*s**: %s\n\n", (int)(end - begin), bytes + begin,
                       meaning);
    write_modes(p, line, l.word[0].letter == 'o', text, sizeof text);
    return hover(text, range(line, bytes, length, begin, end));
}

/* ---- where a subroutine is ---- */

/* The label a line calls: O… call, P of M98, G65, G66, Q of G70 to G72. False: none. */
static bool read_call(struct line *l, char label[LINE_LABEL_MAX])
{
    static const struct {
        char letter;
        uint16_t number_x10;
        char word;
    } codes[] = {{'m', 980, 'p'}, {'g', 650, 'p'}, {'g', 660, 'p'}, {'g', 661, 'p'},
                 {'g', 700, 'q'}, {'g', 710, 'q'}, {'g', 711, 'q'}, {'g', 712, 'q'},
                 {'g', 720, 'q'}, {'g', 721, 'q'}, {'g', 722, 'q'}};
    const char *behind;

    if (line_read_label(l, label, &behind))
        return line_begins(behind, "call");
    for (size_t i = 0; i < sizeof codes / sizeof codes[0]; i++) {
        const struct line_word *code = line_find_code(l, codes[i].letter, codes[i].number_x10);
        const struct line_word *w = code != NULL ? line_find(l, codes[i].word, 0) : NULL;

        if (w != NULL && w->is_number) {
            (void)snprintf(label, LINE_LABEL_MAX, "%.0f", w->value);
            return true;
        }
    }
    return false;
}

/* Is the label defined on this line? Programs of Fanuc begin with ':' as well as with 'O'. */
static bool defines(const char *bytes, size_t length, const char *label)
{
    static struct line l;
    char name[LINE_LABEL_MAX];
    const char *behind;

    if (!line_read(&l, bytes, length))
        return false;
    if (l.text[0] == ':')
        l.text[0] = 'o';
    return line_read_label(&l, name, &behind) && strcmp(name, label) == 0 &&
           line_defines_label(behind);
}

/* The line (from 0) of a text that defines it; false: none does. */
static bool find_in(const char *text, size_t length, const char *label, uint32_t *line)
{
    const char *at = text;
    const char *end = text + length;

    for (*line = 0; at < end; (*line)++) {
        const char *next = memchr(at, '\n', (size_t)(end - at));
        const char *stop = next != NULL ? next : end;

        if (defines(at, (size_t)(stop - at), label))
            return true;
        at = stop + 1;
    }
    return false;
}

static cJSON *location(const char *uri, const char *text, size_t text_length, uint32_t line)
{
    size_t length;
    const char *bytes = lsp_text_line(text, text_length, line, &length);
    cJSON *l = cJSON_CreateObject();

    (void)cJSON_AddStringToObject(l, "uri", uri);
    (void)cJSON_AddItemToObject(l, "range", range(line, bytes, length, 0, length));
    return l;
}

/* Among the files that the program's calls have brought in. */
static cJSON *find_elsewhere(const struct lsp_program *p, const char *label)
{
    cJSON *found = NULL;
    uint32_t line;

    message_listen(ignore, NULL);
    (void)open_session(p);
    for (unsigned i = 1; i < session.program.pieces && found == NULL; i++) {
        const struct program_piece *piece = &session.program.piece[i];

        if (find_in(piece->found.bytes, piece->found.length, label, &line)) {
            char *uri = lsp_text_uri(piece->name);

            found =
                uri != NULL ? location(uri, piece->found.bytes, piece->found.length, line) : NULL;
            free(uri);
        }
    }
    session_close(&session);
    message_listen(NULL, NULL);
    return found != NULL ? found : cJSON_CreateNull();
}

cJSON *lsp_program_definition(const struct lsp_program *p, uint32_t line, size_t character)
{
    static struct line l;
    char label[LINE_LABEL_MAX];
    size_t length;
    const char *bytes = lsp_text_line(p->text, p->length, line, &length);
    uint32_t at;

    (void)character;
    if (!line_read(&l, bytes, length) || !read_call(&l, label))
        return cJSON_CreateNull();
    if (find_in(p->text, p->length, label, &at))
        return location(p->uri, p->text, p->length, at);
    return find_elsewhere(p, label);
}

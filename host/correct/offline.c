#include "correct/offline.h"

#include "cli/interrupt.h"
#include "cli/message.h"
#include "correct/offline_private.h"
#include "program/coordinates.h"

#include <stdlib.h>
#include <string.h>

/* Motions of all executions together. */
#define OFFLINE_EXECUTIONS_MAX 2000000

/* A line of a stream that is longer is handed on in parts: the interpreter refuses it. */
#define OFFLINE_LINE_MAX ((size_t)1024)

/* What one execution of a line has become. */
struct execution {
    uint32_t line;
    char *text;
};

struct offline {
    const struct offline_config *config;
    struct offline_totals *totals;
    struct program program;
    struct parameters parameters;
    struct offline_rewriter rewriter;
    struct offline_line current;
    /* the source */
    uint64_t at;              /* next byte of the text */
    uint64_t line_start;      /* of the line handed out last */
    uint32_t reading;         /* counts lines handed to the interpreter */
    struct offline_text line; /* stream: the line being read */
    bool line_waits;          /* stream: it has not been written yet */
    bool write_failed;
    /* a text: what its lines have become */
    struct execution *executions;
    size_t count, room;
};

/* ---- the source: one line at a time ---- */

/* The next line of the stream, with its end. False: there is none. */
static bool read_stream_line(struct offline *o)
{
    int byte;

    o->line.length = 0;
    while ((byte = getc(o->config->stream)) != EOF) {
        char character = (char)byte;

        offline_text_add(&o->line, &character, 1);
        if (character == '\n' || o->line.length > OFFLINE_LINE_MAX)
            break;
    }
    o->at = 0;
    return o->line.length > 0;
}

static void finish_line(struct offline *o);
static void see_setting(struct offline *o);

/* A line can be longer than a piece of the source. */
static bool begins_line(const struct offline *o)
{
    const char *text = o->config->text != NULL ? o->config->text : o->line.bytes;

    return o->at == 0 || text[o->at - 1] == '\n';
}

/* The interpreter asks for more: all moves of the line before have been fetched. */
static long read_piece(struct offline *o, const char *text, size_t length, char *buffer,
                       size_t size)
{
    size_t count = 0;

    if (begins_line(o))
        o->line_start = o->at;
    while (count < size && o->at < length) {
        buffer[count] = text[o->at++];
        if (buffer[count++] == '\n')
            break;
    }
    o->reading++;
    return count > 0 ? (long)count : SOURCE_END;
}

static long read_source(void *context, char *buffer, size_t size)
{
    struct offline *o = context;

    see_setting(o);
    if (o->config->text != NULL)
        return read_piece(o, o->config->text, o->config->length, buffer, size);
    if (o->at >= o->line.length) {
        finish_line(o);
        if (!read_stream_line(o))
            return SOURCE_END;
        o->line_waits = true;
    }
    return read_piece(o, o->line.bytes, o->line.length, buffer, size);
}

static bool seek_source(void *context, uint64_t offset)
{
    struct offline *o = context;

    o->at = offset;
    return offset <= o->config->length;
}

/* ---- a line of text ---- */

static size_t without_end(const char *line, size_t length)
{
    while (length > 0 && (line[length - 1] == '\n' || line[length - 1] == '\r'))
        length--;
    return length;
}

/* Where the current line of the interpreter stands. */
static void find_raw(struct offline *o, struct offline_line *line)
{
    const char *text = o->config->text != NULL ? o->config->text : o->line.bytes;
    const size_t length = o->config->text != NULL ? o->config->length : o->line.length;
    const size_t from = (size_t)o->line_start;
    const char *end = memchr(text + from, '\n', length - from);

    line->raw = text + from;
    line->raw_length =
        without_end(line->raw, end != NULL ? (size_t)(end - line->raw) + 1 : length - from);
}

/* ---- executions ---- */

static void keep_execution(struct offline *o, uint32_t line, char *text)
{
    if (o->count == o->room) {
        size_t room = 2 * o->room + 1024;
        struct execution *larger = realloc(o->executions, room * sizeof *larger);

        if (larger == NULL) {
            o->rewriter.wrong = "out of memory";
            free(text);
            return;
        }
        o->executions = larger;
        o->room = room;
    }
    o->executions[o->count++] = (struct execution){line, text};
    if (o->count > OFFLINE_EXECUTIONS_MAX) {
        o->rewriter.wrong = "the program makes too many motions";
        o->rewriter.wrong_line = line;
    }
}

/* The moves of the current line are all there. */
static void finish_execution(struct offline *o)
{
    struct offline_text text = {0};

    if (o->current.line == 0)
        return;
    if (offline_rewrite_line(&o->rewriter, &o->current, &text) && !text.failed) {
        offline_text_add(&text, "", 0);
        if (o->config->text != NULL) {
            keep_execution(o, o->current.line, text.bytes);
            text.bytes = NULL;
        } else {
            (void)fprintf(o->config->out, "%s\n", text.bytes);
            o->line_waits = false;
        }
    }
    if (text.failed)
        o->rewriter.wrong = "out of memory";
    offline_text_free(&text);
    o->current.line = 0;
    o->current.moves = 0;
}

/* A stream's line that has made no motion is passed on as it is. */
static void finish_line(struct offline *o)
{
    finish_execution(o);
    if (o->line_waits)
        (void)fwrite(o->line.bytes, 1, o->line.length, o->config->out);
    o->line_waits = false;
    o->write_failed = o->write_failed || fflush(o->config->out) != 0;
}

static bool belongs_to_current(const struct offline *o, const struct move *move)
{
    return o->current.line == move->line && o->current.reading == o->reading;
}

static void begin_execution(struct offline *o, uint32_t line)
{
    finish_execution(o);
    o->current.line = line;
    o->current.reading = o->reading;
    o->current.context = o->program;
    find_raw(o, &o->current);
}

/*
 * A line that has been done, just before the next one is read, may have taken over where the
 * machine stands.
 */
static void see_setting(struct offline *o)
{
    if (o->reading == 0 || !begins_line(o) || !offline_is_setting(&o->program))
        return;
    if (o->current.line != o->program.lexer.line || o->current.reading != o->reading)
        begin_execution(o, o->program.lexer.line);
}

/* Motions, and what cycles do between them. */
static bool is_wanted(const struct offline *o, const struct move *move)
{
    return move_is_motion(move) || (belongs_to_current(o, move) && o->current.moves > 0 &&
                                    offline_is_cycle(&o->current) && offline_is_cycle_event(move));
}

static void take_move(struct offline *o, const struct move *move)
{
    if (move->kind == MOVE_INPUT && o->rewriter.totals.input_line == 0)
        o->rewriter.totals.input_line = move->line;
    if (!is_wanted(o, move) && move->kind != MOVE_SETUP)
        return;
    if (!belongs_to_current(o, move))
        begin_execution(o, move->line);
    if (move->kind == MOVE_SETUP) {
        offline_set_up(&o->rewriter, move);
        return;
    }
    if (o->current.moves == OFFLINE_MOVES_MAX) {
        o->rewriter.wrong = "this line makes too many motions";
        o->rewriter.wrong_line = move->line;
        return;
    }
    o->current.move[o->current.moves++] = *move;
}

/* ---- writing a text ---- */

/* How often a line makes motions, and whether always the same. */
struct usage {
    uint32_t times;
    size_t first; /* its first execution */
    bool differs;
};

static struct usage *count_usage(const struct offline *o, uint32_t lines)
{
    struct usage *usage = calloc((size_t)lines + 1, sizeof *usage);

    for (size_t i = 0; usage != NULL && i < o->count; i++) {
        struct usage *of = &usage[o->executions[i].line];

        if (of->times++ == 0)
            of->first = i;
        else
            of->differs |= strcmp(o->executions[of->first].text, o->executions[i].text) != 0;
    }
    return usage;
}

/*
 * A line in a loop or a subroutine is at another place each time: a counter of all such executions,
 * a parameter, says which of its forms is due.
 */
static void write_forms(const struct offline *o, const struct usage *usage, uint32_t line)
{
    const char *word = "if";
    uint32_t due = 0;

    (void)fprintf(o->config->out, "#<_correction>=[#<_correction>+1]\n");
    for (size_t i = 0; i < o->count; i++) {
        due += usage[o->executions[i].line].differs ? 1 : 0;
        if (o->executions[i].line != line)
            continue;
        (void)fprintf(o->config->out, "O<correction%u> %s [#<_correction> EQ %u]\n%s\n",
                      (unsigned)line, word, (unsigned)due, o->executions[i].text);
        word = "elseif";
    }
    (void)fprintf(o->config->out, "O<correction%u> endif\n", (unsigned)line);
}

static bool any_differs(const struct usage *usage, uint32_t lines)
{
    for (uint32_t i = 0; i <= lines; i++) {
        if (usage[i].differs)
            return true;
    }
    return false;
}

static bool is_percent(const char *line, size_t length)
{
    size_t i = 0;

    while (i < length && (line[i] == ' ' || line[i] == '\t'))
        i++;
    return i < length && line[i] == '%';
}

static bool write_text(const struct offline *o)
{
    struct text text = {.bytes = o->config->text, .length = o->config->length};
    uint32_t lines = 1;
    struct usage *usage;
    size_t position = 0, length;
    const char *line;
    bool counter;

    for (size_t i = 0; i < text.length; i++)
        lines += text.bytes[i] == '\n' ? 1 : 0;
    usage = count_usage(o, lines);
    if (usage == NULL)
        return false;
    counter = any_differs(usage, lines);
    for (uint32_t i = 1; text_next_line(&text, &position, &line, &length); i++) {
        if (counter && !is_percent(line, length)) {
            (void)fputs("#<_correction>=0\n", o->config->out);
            counter = false;
        }
        if (usage[i].differs)
            write_forms(o, usage, i);
        else if (usage[i].times > 0)
            (void)fprintf(o->config->out, "%s\n", o->executions[usage[i].first].text);
        else
            (void)fprintf(o->config->out, "%.*s\n", (int)length, line);
    }
    free(usage);
    return true;
}

/* ---- all of it ---- */

static void note_references(struct offline_rewriter *r, const struct parameters *parameters)
{
    static const unsigned first[] = {PARAMETER_REFERENCE_1, PARAMETER_REFERENCE_2};

    for (unsigned i = 0; i < 2 * AXIS_COUNT; i++)
        r->reference_mm[i / AXIS_COUNT][i % AXIS_COUNT] = takt_coordinates_from_parameter(
            takt_parameters_get(parameters, first[i / AXIS_COUNT] + i % AXIS_COUNT),
            (enum axis)(i % AXIS_COUNT));
}

static void open_program(struct offline *o)
{
    struct controller_config controller = {
        .machine = &o->config->session->setup.machine,
        .tools = &o->config->session->tools.table,
        .parameters = &o->parameters,
        .exact_path = o->config->session->options->exact_path,
        .block_delete = o->config->session->options->block_delete,
    };
    struct source source = {
        .read = read_source, .seek = o->config->text != NULL ? seek_source : NULL, .context = o};
    struct program_config config;
    struct offline_rewriter *r = &o->rewriter;

    o->parameters = o->config->session->parameters.values;
    takt_controller_program_config(&controller, &config);
    config.waits = false;
    takt_program_open(&o->program, &config, &source);
    note_references(r, &o->parameters);
    r->tolerance_mm = o->config->tolerance_mm;
    r->axes = config.axes;
    r->at = r->written = config.start;
    takt_correction_init(&r->correction, &o->config->session->setup.machine.correction, config.axes,
                         machine_cycle_s(&o->config->session->setup.machine),
                         o->config->session->correction, &config.start);
}

static enum command_status fail(const struct offline *o)
{
    if (o->rewriter.wrong_line > 0)
        message_error(o->config->name, o->rewriter.wrong_line, 1, "%s", o->rewriter.wrong);
    else
        message_command_error("%s", o->rewriter.wrong);
    return o->rewriter.wrong_line > 0 ? STATUS_INPUT : STATUS_ENVIRONMENT;
}

static void takt_report_error(const struct offline *o, const struct diagnostic *error)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)takt_diagnostic_text(error, text);
    message_error(o->config->name, error->line, error->column, "%s", text);
}

static enum command_status read_program(struct offline *o)
{
    struct diagnostic error;
    struct move move;

    for (;;) {
        const enum program_result result = takt_program_next(&o->program, &move, &error);

        if (result == PROGRAM_ERROR) {
            takt_report_error(o, &error);
            return STATUS_INPUT;
        }
        if (result == PROGRAM_END || move.kind == MOVE_END)
            break;
        take_move(o, &move);
        if (o->rewriter.wrong != NULL)
            return fail(o);
        if (interrupt_asked())
            return STATUS_INTERRUPTED;
    }
    finish_line(o);
    return o->rewriter.wrong != NULL ? fail(o) : STATUS_DONE;
}

/* What follows the end of a streamed program. */
static void copy_rest(struct offline *o)
{
    while (o->config->text == NULL && read_stream_line(o))
        (void)fwrite(o->line.bytes, 1, o->line.length, o->config->out);
}

static void close_offline(struct offline *o)
{
    for (size_t i = 0; i < o->count; i++)
        free(o->executions[i].text);
    free(o->executions);
    offline_text_free(&o->line);
    free(o);
}

enum command_status offline_correct(const struct offline_config *config,
                                    struct offline_totals *totals)
{
    struct offline *o = calloc(1, sizeof *o);
    enum command_status status;

    if (o == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    o->config = config;
    open_program(o);
    status = read_program(o);
    if (status == STATUS_DONE && config->text != NULL && !write_text(o)) {
        message_command_error("out of memory");
        status = STATUS_ENVIRONMENT;
    }
    if (status == STATUS_DONE)
        copy_rest(o);
    *totals = o->rewriter.totals;
    close_offline(o);
    return status;
}

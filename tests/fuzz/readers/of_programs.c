/*
 * Part programs of every dialect: any bytes are translated, read to moves, and written for another
 * controller.
 */
#define _POSIX_C_SOURCE 200809L

#include "readers.h"

#include "base/maths.h"
#include "cutter_compensation/cutter_compensation.h"
#include "dialect/dialect.h"
#include "program/program.h"
#include "session/convert.h"

#include <stdio.h>
#include <string.h>

#define TRAVEL_MM  500.0
#define MOVES_MAX  300
#define ERRORS_MAX 300
/* After this many bytes the source fails, in loops that move nothing. */
#define READ_MAX 50000U

static const struct tool tools[] = {
    {.number = 1, .offset = {{0.0, 0.0, 50.0, 0.0, 0.0, 0.0}}, .diameter_mm = 6.0},
    {.number = 2, .offset = {{1.0, 2.0, 80.5, 0.0, 0.0, 0.0}}, .diameter_mm = 0.8},
};
static const struct tool_table tool_table = {tools, sizeof tools / sizeof tools[0]};

static const struct dialect_codes codes = {
    .count = 4,
    .code = {{.letter = 'm', .number_x10 = 310, .use = DIALECT_IGNORE},
             {.letter = 'm', .number_x10 = 320, .use = DIALECT_OUTPUT_ON, .number = 3},
             {.letter = 'm', .number_x10 = 1000, .use = DIALECT_SUBROUTINE, .subroutine = "x"},
             {.letter = 'f', .use = DIALECT_FEED, .number = 600}},
    .values = 1,
    .value = {{"_ini[a]b", 2.5}}};

struct bounded {
    struct source_text text;
    struct source source;
    size_t left;
};

static long read_some(void *context, char *buffer, size_t size)
{
    struct bounded *b = context;
    const long count = b->source.read(b->source.context, buffer, size);

    if (count > 0 && (size_t)count > b->left)
        return SOURCE_ERROR;
    b->left -= count > 0 ? (size_t)count : 0;
    return count;
}

static bool seek(void *context, uint64_t position)
{
    struct bounded *b = context;

    return b->source.seek(b->source.context, position);
}

static size_t count_lines(const char *bytes, size_t length)
{
    size_t lines = 0;

    for (size_t i = 0; i < length; i++)
        lines += (i == 0 || bytes[i - 1] == '\n') && bytes[i] != DIALECT_GOES_ON;
    return lines;
}

static void write_move(struct convert *c, const struct move *move)
{
    const double *centre = move->centre_mm;

    require(!move_is_motion(move) || maths_is_finite(move->end.at[AXIS_X]));
    require(!move_is_arc(move) || (maths_is_finite(centre[0]) && maths_is_finite(centre[1])));
    (void)convert_move(c, move);
}

static struct program program;
static struct cutter_compensation offset;
static struct parameters parameters;

static void open_program(const struct source *source, struct program_config *config)
{
    *config = (struct program_config){.parameters = &parameters,
                                      .axes = 0x3fU,
                                      .tools = &tool_table,
                                      .spindle_max_rpm = 24000.0,
                                      .repeats_max = 2000,
                                      .spindle_encoder = true};
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        config->travel_min[axis] = -TRAVEL_MM;
        config->travel_max[axis] = TRAVEL_MM;
    }
    takt_parameters_clear(&parameters);
    takt_program_open(&program, config, source);
    takt_cutter_compensation_open(&offset, config);
}

static void write_moves(struct convert *convert)
{
    struct diagnostic error;
    struct move move;
    enum program_result result;
    unsigned moves = 0;
    unsigned errors = 0;

    while (moves < MOVES_MAX && errors < ERRORS_MAX &&
           (result = takt_cutter_compensation_next(&offset, &program, &move, &error)) !=
               PROGRAM_END) {
        require(result != PROGRAM_WAIT);
        if (result == PROGRAM_ERROR) {
            errors++;
        } else {
            write_move(convert, &move);
            moves++;
        }
    }
}

/* What is read of a text, in the words of a dialect. */
static void read_moves(const char *bytes, size_t length, enum dialect to)
{
    static struct convert convert;
    struct bounded text = {.left = READ_MAX};
    const struct source source = {read_some, seek, &text};
    struct program_config config;
    char *written = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&written, &size);

    require(out != NULL);
    takt_source_open_text(&text.source, &text.text, bytes, length);
    open_program(&source, &config);
    convert_open(&convert, out, to, config.axes, &config.start);
    write_moves(&convert);
    convert_close(&convert);
    require(fclose(out) == 0);
    free(written);
}

static void read_as(enum dialect dialect, const char *bytes, size_t length)
{
    static struct dialect_result result;
    const size_t mark = length >= 3 && memcmp(bytes, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;

    require(dialect_translate(dialect, &codes, NULL, bytes, length, &result));
    if (memchr(bytes, DIALECT_GOES_ON, length) == NULL)
        require(count_lines(bytes + mark, length - mark) ==
                count_lines(result.text.bytes, result.text.length));
    if (result.text.length > 0)
        read_moves(result.text.bytes, result.text.length, dialect);
    dialect_text_free(&result.text);
}

void read_dialects(const uint8_t *data, size_t size)
{
    char *bytes = malloc(size + 1);

    require(bytes != NULL);
    memcpy(bytes, data, size);
    for (unsigned dialect = 0; dialect < DIALECT_COUNT; dialect++)
        read_as((enum dialect)dialect, bytes, size);
    free(bytes);
}

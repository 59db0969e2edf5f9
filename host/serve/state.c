#define _POSIX_C_SOURCE 200809L

#include "serve/state.h"

#include "base/crc32.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longer than any line that is written. */
#define LINE_MAX_LENGTH 511

#define TOOL_NUMBERS                                                                               \
    9 /* of a tool, beside its number and orientation: six offsets, diameter, two angles */

static void tool_to_numbers(const struct tool *tool, double number[TOOL_NUMBERS])
{
    memcpy(number, tool->offset.at, sizeof tool->offset.at);
    number[AXIS_COUNT] = tool->diameter_mm;
    number[AXIS_COUNT + 1] = tool->front_angle_deg;
    number[AXIS_COUNT + 2] = tool->back_angle_deg;
}

static void tool_of_numbers(struct tool *tool, const double number[TOOL_NUMBERS])
{
    memcpy(tool->offset.at, number, sizeof tool->offset.at);
    tool->diameter_mm = number[AXIS_COUNT];
    tool->front_angle_deg = number[AXIS_COUNT + 1];
    tool->back_angle_deg = number[AXIS_COUNT + 2];
}

/* ---- to text ---- */

static void write_tool(FILE *stream, const struct tool *tool)
{
    double number[TOOL_NUMBERS];

    tool_to_numbers(tool, number);
    (void)fprintf(stream, "tool %" PRIu32 " %" PRIu32, tool->number, tool->orientation);
    for (unsigned i = 0; i < TOOL_NUMBERS; i++)
        (void)fprintf(stream, " %.17g", number[i]);
    (void)fputc('\n', stream);
}

static void write_parameters(FILE *stream, const struct parameters *parameters)
{
    unsigned number = PARAMETERS_LOCAL; /* those up to here are a subroutine's own */
    double value;

    while (takt_parameters_next(parameters, &number, &value))
        (void)fprintf(stream, "parameter %u %.17g\n", number, value);
}

static void write_setup(FILE *stream, const struct state *s)
{
    if (!s->has_setup)
        return;
    (void)fprintf(stream, "setup");
    for (size_t i = 0; i < sizeof s->setup / sizeof s->setup[0]; i++)
        (void)fprintf(stream, " %.17g", s->setup[i]);
    (void)fprintf(stream, "\n");
}

static void write_all(FILE *stream, const struct state *s)
{
    (void)fprintf(stream, "takt-state %d\nmachine %s\nbase %" PRIu32 " %" PRIu32 "\n",
                  STATE_VERSION, s->machine, s->tools_base, s->parameters_base);
    (void)fprintf(stream, "program %" PRIu32 " %" PRIu32 " %" PRIu32 "\n", s->program_size,
                  s->program_crc, s->line);
    write_parameters(stream, &s->parameters);
    for (size_t i = 0; i < s->tools_count; i++)
        write_tool(stream, &s->tools[i]);
    for (size_t i = 0; i < s->wears; i++)
        (void)fprintf(stream, "wear %" PRIu32 " %.17g %.17g\n", s->wear[i].tool,
                      s->wear[i].length_mm, s->wear[i].time_s);
    write_setup(stream, s);
}

char *state_write(const struct state *state, size_t *length)
{
    char *text = NULL;
    FILE *stream = open_memstream(&text, length);

    if (stream == NULL)
        return NULL;
    write_all(stream, state);
    if (fclose(stream) == 0)
        return text;
    free(text);
    return NULL;
}

/* ---- and back ---- */

/* Steps over a number. False: there is none, or it is not finite. */
static bool take_number(const char **at, double *value)
{
    char *end;

    *value = strtod(*at, &end);
    if (end == *at || !isfinite(*value))
        return false;
    *at = end;
    return true;
}

static bool take_count(const char **at, uint32_t *count)
{
    double value;

    if (!take_number(at, &value) || value < 0 || value > UINT32_MAX || value != floor(value))
        return false;
    *count = (uint32_t)value;
    return true;
}

static bool take_tool(struct state *s, const char *at)
{
    struct tool tool = {0};
    double number[TOOL_NUMBERS];
    bool good = take_count(&at, &tool.number) && take_count(&at, &tool.orientation);

    for (unsigned i = 0; i < TOOL_NUMBERS; i++)
        good = good && take_number(&at, &number[i]);
    if (!good || s->tools_count == s->tools_max)
        return good; /* a tool beyond those of the file: the file has changed, and counts */
    tool_of_numbers(&tool, number);
    s->tools[s->tools_count++] = tool;
    return true;
}

static bool take_wear(struct state *s, const char *at)
{
    struct state_wear wear;

    if (!take_count(&at, &wear.tool) || !take_number(&at, &wear.length_mm) ||
        !take_number(&at, &wear.time_s))
        return false;
    if (s->wears < STATE_WEARS_MAX)
        s->wear[s->wears++] = wear;
    return true;
}

static bool take_setup(struct state *s, const char *at)
{
    for (size_t i = 0; i < sizeof s->setup / sizeof s->setup[0]; i++) {
        if (!take_number(&at, &s->setup[i]))
            return false;
    }
    s->has_setup = true;
    return true;
}

static bool take_parameter(struct state *s, const char *at)
{
    uint32_t number;
    double value;

    return take_count(&at, &number) && number >= 1 && number <= PARAMETER_NUMBER_MAX &&
           take_number(&at, &value) && takt_parameters_set(&s->parameters, number, value);
}

static bool take_program(struct state *s, const char *at)
{
    return take_count(&at, &s->program_size) && take_count(&at, &s->program_crc) &&
           take_count(&at, &s->line);
}

static bool take_base(struct state *s, const char *at)
{
    return take_count(&at, &s->tools_base) && take_count(&at, &s->parameters_base);
}

static bool take_machine(struct state *s, const char *at)
{
    (void)snprintf(s->machine, sizeof s->machine, "%s", at + (*at == ' '));
    return true;
}

static const struct {
    const char *name;
    bool (*take)(struct state *s, const char *at);
} kinds[] = {{"machine", take_machine},     {"base", take_base}, {"program", take_program},
             {"parameter", take_parameter}, {"tool", take_tool}, {"wear", take_wear},
             {"setup", take_setup}};

static bool take_line(struct state *s, const char *line)
{
    const size_t length = strcspn(line, " ");

    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strlen(kinds[i].name) == length && strncmp(kinds[i].name, line, length) == 0)
            return kinds[i].take(s, line + length);
    }
    return true;
}

/*
 * Copies a line with a zero at its end, and steps over it. False: there is none, or it is too long.
 */
static bool next_line(const char **at, size_t *left, char line[LINE_MAX_LENGTH + 1])
{
    const char *end = memchr(*at, '\n', *left);
    const size_t length = end != NULL ? (size_t)(end - *at) : 0;

    if (end == NULL || length > LINE_MAX_LENGTH)
        return false;
    memcpy(line, *at, length);
    line[length] = '\0';
    *at += length + 1;
    *left -= length + 1;
    return true;
}

static bool has_version(const char *line, char *problem)
{
    int version = 0;

    if (sscanf(line, "takt-state %d", &version) == 1 && version >= 1 && version <= STATE_VERSION)
        return true;
    (void)snprintf(problem, STATE_PROBLEM_MAX + 1, "it is of a later version of takt: '%.40s'",
                   line);
    return false;
}

bool state_read(struct state *s, const char *text, size_t length,
                char problem[STATE_PROBLEM_MAX + 1])
{
    struct tool *const tools = s->tools;
    const size_t tools_max = s->tools_max;
    char line[LINE_MAX_LENGTH + 1] = "";

    *s = (struct state){.tools = tools, .tools_max = tools_max};
    if (!next_line(&text, &length, line) || !has_version(line, problem))
        return false;
    while (length > 0) {
        if (next_line(&text, &length, line) && take_line(s, line))
            continue;
        (void)snprintf(problem, STATE_PROBLEM_MAX + 1, "this line makes no sense: '%.60s'", line);
        return false;
    }
    return true;
}

/* ---- checksums ---- */

static uint32_t add_number(uint32_t sum, double value)
{
    return takt_crc32_add(sum, (const void *)&value, sizeof value);
}

uint32_t state_sum_tools(const struct tool *tools, size_t count)
{
    uint32_t sum = CRC32_START;
    double number[TOOL_NUMBERS];

    for (size_t i = 0; i < count; i++) {
        tool_to_numbers(&tools[i], number);
        sum = add_number(add_number(sum, tools[i].number), tools[i].orientation);
        for (unsigned k = 0; k < TOOL_NUMBERS; k++)
            sum = add_number(sum, number[k]);
    }
    return sum;
}

uint32_t state_sum_parameters(const struct parameters *parameters)
{
    uint32_t sum = CRC32_START;
    unsigned number = 0;
    double value;

    while (takt_parameters_next(parameters, &number, &value))
        sum = add_number(add_number(sum, number), value);
    return sum;
}

#include "tables/tool_file.h"

#include "base/maths.h"
#include "cli/message.h"
#include "cli/text.h"
#include "program/program_limits.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TOOL_LINE_MAX        255
#define TOOL_ORIENTATION_MAX 9

struct tool_reader {
    const struct text *text;
    uint32_t line;
    unsigned errors;
    struct tool_file *file;
    size_t room;
};

static bool is_known(const struct tool_reader *r, uint32_t number)
{
    return takt_tool_table_find(&r->file->table, number) != NULL;
}

static void tool_error(struct tool_reader *r, size_t offset, const char *what)
{
    message_error(r->text->name, r->line, (uint32_t)offset + 1, "%s", what);
    r->errors++;
}

/* What a word sets; false: no word of a tool table. */
static bool set_word(struct tool *tool, char letter, double value)
{
    const char *axis = strchr(AXIS_LETTERS, letter);

    if (axis != NULL) {
        unsigned i = (unsigned)(axis - AXIS_LETTERS);

        tool->offset.at[i] = i < AXIS_LINEAR_COUNT ? value : value * MATHS_PI / 180.0;
        return true;
    }
    if (letter == 'D')
        tool->diameter_mm = value;
    if (letter == 'T')
        tool->number = (uint32_t)value;
    if (letter == 'I')
        tool->front_angle_deg = value;
    if (letter == 'J')
        tool->back_angle_deg = value;
    if (letter == 'Q')
        tool->orientation = (unsigned)value;
    return strchr("TDPIJQUVW", letter) != NULL;
}

/* Bit of a letter from A to Z. */
static uint32_t letter_bit(char letter)
{
    return 1U << (letter - 'A');
}

/* One word at line[*offset]; false after a message. given: letters of the line so far. */
static bool read_word(struct tool_reader *r, const char *line, size_t *offset, struct tool *tool,
                      uint32_t *given)
{
    char letter = (char)toupper((unsigned char)line[*offset]);
    const char *start = line + *offset + 1;
    char *end;
    double value = strtod(start, &end);

    if (end == start || !isfinite(value)) {
        tool_error(r, *offset, "a letter and its number are expected, such as T1 or Z50.8");
        return false;
    }
    if (letter == 'T' && (value < 0 || value > PROGRAM_TOOL_MAX || value != floor(value))) {
        tool_error(r, *offset, "a tool number is a whole number from 0 to 99999");
        return false;
    }
    if (letter == 'Q' && (value < 0 || value > TOOL_ORIENTATION_MAX || value != floor(value))) {
        tool_error(r, *offset, "a tool's orientation is a whole number from 0 to 9");
        return false;
    }
    if (!set_word(tool, letter, value)) {
        tool_error(r, *offset, "unknown word; known are T P X Y Z A B C U V W D I J Q");
        return false;
    }
    if ((*given & letter_bit(letter)) != 0) {
        tool_error(r, *offset, "this letter stands on the line already");
        return false;
    }
    *given |= letter_bit(letter);
    *offset = (size_t)(end - line);
    return true;
}

static bool keep_tool(struct tool_reader *r, const struct tool *tool)
{
    struct tool_table *table = &r->file->table;

    if (table->count == r->room) {
        size_t room = r->room * 2 + 16;
        struct tool *tools = realloc(r->file->tools, room * sizeof *tools);

        if (tools == NULL) {
            tool_error(r, 0, "out of memory");
            return false;
        }
        r->room = room;
        r->file->tools = tools;
        table->tools = tools;
    }
    r->file->tools[table->count++] = *tool;
    return true;
}

static void read_tool(struct tool_reader *r, const char *line)
{
    struct tool tool = {0};
    uint32_t given = 0;
    size_t offset = strspn(line, " \t");

    if (line[offset] == '\0' || line[offset] == ';')
        return;
    while (line[offset] != '\0' && line[offset] != ';') {
        if (!read_word(r, line, &offset, &tool, &given))
            return;
        offset += strspn(line + offset, " \t");
    }
    if ((given & letter_bit('T')) == 0)
        tool_error(r, 0, "the tool's number is missing: T");
    else if (is_known(r, tool.number))
        tool_error(r, 0, "this tool is already in the table");
    else
        (void)keep_tool(r, &tool);
}

static void read_line(struct tool_reader *r, const char *start, size_t length)
{
    char line[TOOL_LINE_MAX + 1];

    r->line++;
    if (length > TOOL_LINE_MAX) {
        tool_error(r, TOOL_LINE_MAX, "the line is too long");
        return;
    }
    memcpy(line, start, length);
    line[length] = '\0';
    read_tool(r, line);
}

bool tool_file_read(struct tool_file *file, const char *path)
{
    struct text text;
    struct tool_reader reader = {.text = &text, .file = file};
    size_t position = 0, length;
    const char *line;

    *file = (struct tool_file){0};
    if (!text_read(&text, path))
        return false;
    while (text_next_line(&text, &position, &line, &length))
        read_line(&reader, line, length);
    text_free(&text);
    if (reader.errors == 0)
        return true;
    tool_file_close(file);
    return false;
}

void tool_file_close(struct tool_file *file)
{
    free(file->tools);
    *file = (struct tool_file){0};
}

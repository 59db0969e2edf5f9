#include "tables/tool_guess.h"

#include "cli/message.h"
#include "program/program_limits.h"
#include "words/line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MM_PER_INCH 25.4

struct guess {
    struct tool_file *file;
    struct line line;
    bool inches;
    bool failed;
};

/* The tool of a number, added if it is not there. NULL: it is no number of a tool. */
static struct tool *tool_of(struct guess *g, double number)
{
    struct tool_table *table = &g->file->table;
    const uint32_t whole = (uint32_t)number;

    if (!(number >= 1.0) || number > PROGRAM_TOOL_MAX || (double)whole != number)
        return NULL;
    for (size_t i = 0; i < table->count; i++) {
        if (g->file->tools[i].number == whole)
            return &g->file->tools[i];
    }
    struct tool *grown = realloc(g->file->tools, (table->count + 1) * sizeof *grown);

    g->failed = g->failed || grown == NULL;
    if (grown == NULL)
        return NULL;
    g->file->tools = grown;
    table->tools = grown;
    grown[table->count] = (struct tool){.number = whole};
    return &grown[table->count++];
}

/* T1 D=6. of a comment, with anything but another T between them. */
static void read_comment(struct guess *g, const char *text, size_t length)
{
    const char *end = text + length;
    double number = 0.0;

    for (const char *c = text; c + 1 < end; c++) {
        const bool word = c == text || c[-1] == ' ' || c[-1] == '(' || c[-1] == ';';
        const char letter = (char)(word ? line_lower(*c) : ' ');
        const bool equals = c[1] == '=';
        const char *digits = c + (equals ? 2 : 1);
        char *behind = NULL;
        const double value =
            letter == 't' || (letter == 'd' && equals) ? strtod(digits, &behind) : 0.0;

        if (value > 0.0 && behind != NULL && behind <= end && letter == 't')
            number = value;
        struct tool *tool = value > 0.0 && letter == 'd' ? tool_of(g, number) : NULL;

        if (tool != NULL && tool->diameter_mm == 0.0)
            tool->diameter_mm = value;
    }
}

static void read_line(struct guess *g, const char *bytes, size_t length)
{
    struct line *l = &g->line;

    if (!line_read(l, bytes, length))
        return;
    g->inches = g->inches || line_find_code(l, 'g', 200) != NULL;
    for (unsigned i = 0; i < l->words; i++) {
        const struct line_word *w = &l->word[i];

        if (w->kind == WORD_COMMENT)
            read_comment(g, &l->text[w->begin], (size_t)(w->end - w->begin));
        else if (w->kind == WORD_VALUE && w->is_number && strchr("tdh", w->letter) != NULL)
            (void)tool_of(g, w->value);
    }
}

static void read_lines(struct guess *g, const struct program_text *text)
{
    static _Thread_local struct program_text_reader reader;
    static _Thread_local char line[LINE_MAX_BYTES + 1];
    struct source source;
    size_t length = 0;
    char byte;

    program_text_read(text, &reader, &source);
    while (source.read(source.context, &byte, 1) == 1) {
        if (byte == '\n') {
            read_line(g, line, length);
            length = 0;
        } else if (length < sizeof line) {
            line[length++] = byte;
        }
    }
    read_line(g, line, length);
}

bool tool_guess(struct tool_file *file, const struct program_text *text)
{
    static _Thread_local struct guess g;
    unsigned unknown = 0;

    g = (struct guess){.file = file};
    read_lines(&g, text);
    for (size_t i = 0; i < file->table.count; i++) {
        file->tools[i].diameter_mm *= g.inches ? MM_PER_INCH : 1.0;
        unknown += file->tools[i].diameter_mm == 0.0 ? 1U : 0U;
    }
    if (g.failed)
        message_command_error("out of memory");
    else if (file->table.count > 0)
        message_command_warning(
            "--tools auto: %u tools without a table, all of length 0, %u of diameter 0",
            (unsigned)file->table.count, unknown);
    return !g.failed;
}

#include "program/tool_values.h"

#include "program/changes.h"
#include "program/report.h"

#include <stddef.h>

#define NONE (-1)

static int index_of(const struct program_tools *tools, uint32_t number)
{
    for (unsigned i = 0; i < tools->count; i++) {
        if (tools->tool[i].number == number) {
            return (int)i;
        }
    }
    return NONE;
}

const struct tool *takt_tool_values_find(const struct program *p, uint32_t number)
{
    const int i = index_of(&p->tools, number);

    return i != NONE ? &p->tools.tool[i] : takt_tool_table_find(p->config.tools, number);
}

struct tool *takt_tool_values_change(struct program *p, enum step step, uint32_t number)
{
    struct program_tools *tools = &p->tools;
    const struct tool *tool = takt_tool_values_find(p, number);
    int i = index_of(tools, number);

    if (tool == NULL) {
        (void)takt_report_error_code(p, TAKT_ERROR_TOOL_ABSENT, step, number);
        return NULL;
    }
    if (i == NONE && tools->count == PROGRAM_TOOL_CHANGES_MAX) {
        (void)takt_report_error_code(p, TAKT_ERROR_TOOL_CHANGES_FULL, step,
                                     PROGRAM_TOOL_CHANGES_MAX);
        return NULL;
    }
    tools->before = *tool;
    if (i == NONE) {
        i = (int)tools->count++;
        tools->tool[i] = *tool;
    }
    tools->changed = i;
    return &tools->tool[i];
}

void takt_tool_values_begin_line(struct program *p)
{
    p->tools.changed = NONE;
    p->tools.count_before = p->tools.count;
}

void takt_tool_values_note_changes(struct program *p)
{
    if (p->tools.changed != NONE) {
        takt_changes_note_tool(p, (unsigned)p->tools.changed);
    }
}

void takt_tool_values_take_back(struct program *p)
{
    if (p->tools.changed != NONE) {
        p->tools.tool[p->tools.changed] = p->tools.before;
        p->tools.count = p->tools.count_before;
        p->tools.changed = NONE;
    }
}

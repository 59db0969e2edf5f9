#include "program/tools.h"

const struct tool *takt_tool_table_find(const struct tool_table *table, uint32_t number)
{
    for (size_t i = 0; table != NULL && i < table->count; i++) {
        if (table->tools[i].number == number) {
            return &table->tools[i];
        }
    }
    return NULL;
}

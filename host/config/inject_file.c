#include "config/inject_file.h"

#include "cli/message.h"
#include "cli/text.h"

bool inject_file_load(struct inject *script, const char *path)
{
    struct text text;
    struct inject_error error;
    bool good;

    if (!text_read(&text, path))
        return false;
    good = inject_read(script, text.bytes, text.length, &error);
    if (!good)
        message_error(text.name, error.line, error.column, "%s", error.text);
    text_free(&text);
    return good;
}

static bool is_one_of(uint8_t node, const uint8_t nodes[], unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (nodes[i] == node)
            return true;
    }
    return false;
}

bool inject_file_check_nodes(const struct inject *script, const char *path, const uint8_t nodes[],
                             unsigned count)
{
    for (unsigned i = 0; i < script->count; i++) {
        const struct inject_fault *fault = &script->fault[i];
        bool names_drive = fault->node != INJECT_ANY_NODE && fault->node != INJECT_CONTROLLER;

        if (names_drive && !is_one_of(fault->node, nodes, count)) {
            message_error(path, fault->line, 0, "there is no drive with node %u",
                          (unsigned)fault->node);
            return false;
        }
    }
    return true;
}

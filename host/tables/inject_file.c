#include "tables/inject_file.h"

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

static bool is_one_of(uint16_t node, const uint16_t nodes[], unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (nodes[i] == node)
            return true;
    }
    return false;
}

static bool has_bus(uint8_t bus, const uint16_t nodes[], unsigned count)
{
    bool has = false;

    for (unsigned i = 0; i < count; i++)
        has = has || nodes[i] >> 8 == bus;
    return has;
}

bool inject_file_check_nodes(const struct inject *script, const char *path, const uint16_t nodes[],
                             unsigned count)
{
    for (unsigned i = 0; i < script->count; i++) {
        const struct inject_fault *fault = &script->fault[i];
        if (fault->bus > 0 && !has_bus(fault->bus, nodes, count)) {
            message_error(path, fault->line, 0, "the machine has nothing on CAN bus %u",
                          (unsigned)fault->bus);
            return false;
        }
        bool names_drive = fault->node != INJECT_ANY_NODE && fault->node != INJECT_CONTROLLER;

        if (names_drive && !is_one_of(INJECT_ADDRESS(fault->bus, fault->node), nodes, count)) {
            message_error(path, fault->line, 0, "there is no drive with node %u%s",
                          (unsigned)fault->node, fault->bus > 0 ? " on that bus" : "");
            return false;
        }
    }
    return true;
}

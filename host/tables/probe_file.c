#include "tables/probe_file.h"

#include "cli/message.h"
#include "cli/text.h"

bool probe_file_load(struct virtual_probe *probe, const char *path)
{
    struct text text;
    struct virtual_probe_error error;
    bool good;

    *probe = (struct virtual_probe){0};
    if (path == NULL)
        return true;
    if (!text_read(&text, path))
        return false;
    good = virtual_probe_read(probe, text.bytes, text.length, &error);
    if (!good)
        message_error(text.name, error.line, error.column, "%s", error.text);
    text_free(&text);
    return good;
}

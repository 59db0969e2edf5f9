#include "cli/axis_letters.h"

#include "base/point.h"
#include "cli/message.h"

#include <stddef.h>
#include <string.h>

bool axis_letters_read(const char *text, unsigned *axes)
{
    *axes = 0;
    for (const char *c = text; c != NULL && *c != '\0'; c++) {
        const char *found = strchr(AXIS_LETTERS, *c);

        if (found == NULL) {
            message_command_error("--axes %s: letters of axes are expected, as in XY", text);
            return false;
        }
        *axes |= 1U << (found - AXIS_LETTERS);
    }
    return true;
}

/* Orders of senders that begin like the end of a program. */
#include "words/line.h"

#include <string.h>

bool line_is_order(const struct line *l)
{
    const char *name = l->text + 1;

    return l->text[0] == '%' && line_name_length(l, 1) > 0 &&
           (line_begins(name, "wait") || line_begins(name, "msg") ||
            name[strcspn(name, "=(;")] == '=');
}

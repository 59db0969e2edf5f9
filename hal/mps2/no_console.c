/* The line of the console of images that have none. */
#include "mps2/console_line.h"

#include <stddef.h>

const struct service_lines *takt_console_line_get_lines(void)
{
    return NULL;
}

void takt_console_line_open(struct embedded *embedded)
{
    (void)embedded;
}

void takt_console_line_serve(void)
{
}

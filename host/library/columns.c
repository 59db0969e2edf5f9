#include "library/columns.h"

#include <stdlib.h>

/* Rows there is room for at first: a minute. */
#define ROOM_FIRST 65536

void columns_init(struct columns *c, unsigned axes, double cycle_s, bool has_tool)
{
    *c = (struct columns){.axes = axes, .cycle_s = cycle_s, .has_tool = has_tool};
    c->count = trace_columns(axes, has_tool, c->column);
}

static void grow(struct columns *c)
{
    const uint64_t room = c->room > 0 ? 2 * c->room : ROOM_FIRST;

    for (unsigned i = 0; i < c->count && !c->failed; i++) {
        double *value = realloc(c->value[i], room * sizeof *value);

        c->failed = value == NULL;
        if (value != NULL)
            c->value[i] = value;
    }
    if (!c->failed)
        c->room = room;
}

void columns_add(struct columns *c, const struct cycle_record *record, const struct point *tool)
{
    double value[TRACE_ROW_COLUMNS];

    if (c->rows == c->room)
        grow(c);
    if (c->failed)
        return;
    (void)trace_values(c->axes, c->cycle_s, record, c->has_tool ? tool : NULL, value);
    for (unsigned i = 0; i < c->count; i++)
        c->value[i][c->rows] = value[i];
    c->rows++;
}

void columns_free(struct columns *c)
{
    for (unsigned i = 0; i < c->count; i++)
        free(c->value[i]);
    *c = (struct columns){0};
}

#include "page/page_path.h"

#include <stdlib.h>
#include <string.h>

bool page_path_open(struct page_path *path)
{
    memset(path, 0, sizeof *path);
    path->every = 1;
    path->point = malloc(PAGE_PATH_MAX * sizeof *path->point);
    return path->point != NULL;
}

void page_path_close(struct page_path *path)
{
    free(path->point);
    path->point = NULL;
    path->count = 0;
}

static void halve(struct page_path *path)
{
    for (size_t i = 1; 2 * i < path->count; i++)
        path->point[i] = path->point[2 * i];
    path->count = (path->count + 1) / 2;
    path->every *= 2;
}

bool page_path_add(struct page_path *path, const struct point *at, uint32_t line, bool is_rapid)
{
    path->last = (struct page_path_point){(float)at->at[AXIS_X], (float)at->at[AXIS_Y],
                                          (float)at->at[AXIS_Z], line, is_rapid};
    if (path->skipped++ % path->every == 0) {
        if (path->count == PAGE_PATH_MAX)
            halve(path);
        path->point[path->count++] = path->last;
    }
    return !atomic_load(&path->is_to_end);
}

void page_path_finish(struct page_path *path)
{
    if (path->count > 0)
        path->point[path->count - 1] = path->last;
}

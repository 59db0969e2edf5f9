/*
 * The files of the page, by the path they are asked for: "/" is "/index.html".
 */
#ifndef TAKT_PAGE_PAGE_ASSET_H
#define TAKT_PAGE_PAGE_ASSET_H

#include "report/asset.h"

#include <stdbool.h>

struct page_asset {
    const char *type;
    const struct asset *asset;
};

/* False: there is none. */
bool page_asset_find(const char *path, struct page_asset *found);

#endif

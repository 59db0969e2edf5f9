/*
 * Files that are part of the executable. embed.cmake makes one source file of each.
 */
#ifndef TAKT_REPORT_ASSET_H
#define TAKT_REPORT_ASSET_H

#include <stddef.h>

struct asset {
    size_t size; /* bytes; 0: left out of this build */
    const unsigned char *bytes;
};

extern const struct asset asset_page;
extern const struct asset asset_style;
extern const struct asset asset_summary;
extern const struct asset asset_charts;
extern const struct asset asset_path;
extern const struct asset asset_map;
extern const struct asset asset_shares;
extern const struct asset asset_start;
extern const struct asset asset_plotly;

#endif

#include "report/page.h"

#include "report/asset.h"
#include "report/data.h"

#include <string.h>

#define PLACE_OPEN  "{{"
#define PLACE_CLOSE "}}"

struct page {
    FILE *file;
    const struct recording *recording;
    const struct page_texts *texts;
};

bool page_has_plots(void)
{
    return asset_plotly.size > 0;
}

static bool write_bytes(FILE *file, const unsigned char *bytes, size_t size)
{
    return fwrite(bytes, 1, size, file) == size;
}

/*
 * '<' stands only inside strings of JSON; escaped there, no text can end the script element it lies
 * in. NULL: none.
 */
static bool write_json(FILE *file, const char *json)
{
    if (json == NULL)
        json = "null";
    while (*json != '\0') {
        const size_t plain = strcspn(json, "<");
        if (fwrite(json, 1, plain, file) != plain)
            return false;
        json += plain;
        if (*json == '<' && fputs("\\u003c", file) < 0)
            return false;
        json += *json == '<';
    }
    return true;
}

static bool place_is(const unsigned char *name, size_t length, const char *expected)
{
    return length == strlen(expected) && memcmp(name, expected, length) == 0;
}

static bool page_fill(const struct page *page, const unsigned char *name, size_t length)
{
    static const struct {
        const char *name;
        const struct asset *asset;
    } place[] = {
        {"STYLE", &asset_style},   {"PLOTLY", &asset_plotly}, {"SUMMARY_SCRIPT", &asset_summary},
        {"CHARTS", &asset_charts}, {"PATH", &asset_path},     {"MAP", &asset_map},
        {"SHARES", &asset_shares}, {"START", &asset_start},
    };
    if (place_is(name, length, "SUMMARY"))
        return write_json(page->file, page->texts->summary_json);
    if (place_is(name, length, "MAP_DATA"))
        return write_json(page->file, page->texts->map_json);
    if (place_is(name, length, "SHARES_DATA"))
        return write_json(page->file, page->texts->shares_json);
    if (place_is(name, length, "DATA"))
        return data_write(page->file, page->recording);
    for (size_t i = 0; i < sizeof place / sizeof place[0]; i++) {
        if (place_is(name, length, place[i].name))
            return write_bytes(page->file, place[i].asset->bytes, place[i].asset->size);
    }
    return false;
}

/* First place at or after text, or end. */
static const unsigned char *find_mark(const unsigned char *text, const unsigned char *end,
                                      const char *mark)
{
    while (end - text >= 2 && memcmp(text, mark, 2) != 0)
        text++;
    return end - text >= 2 ? text : end;
}

bool page_write(FILE *file, const struct recording *rec, const struct page_texts *texts)
{
    const struct page page = {file, rec, texts};
    const unsigned char *text = asset_page.bytes;
    const unsigned char *end = text + asset_page.size;
    while (text < end) {
        const unsigned char *open = find_mark(text, end, PLACE_OPEN);
        if (!write_bytes(file, text, (size_t)(open - text)))
            return false;
        if (open == end)
            return true;
        const unsigned char *close = find_mark(open, end, PLACE_CLOSE);
        if (close == end || !page_fill(&page, open + 2, (size_t)(close - open - 2)))
            return false;
        text = close + 2;
    }
    return true;
}

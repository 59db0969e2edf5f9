#include "port/settings_upload.h"

#include <string.h>

#define REFUSED "settings refused: "
#define STORED  "settings stored: they count from the next start on"

/* Two texts that fit into a line together. */
static void log_pair(const struct settings_upload *u, const char *first, const char *second)
{
    char line[sizeof REFUSED + DIAGNOSTIC_TEXT_MAX];
    size_t at = 0;

    while (*first != '\0')
        line[at++] = *first++;
    while (*second != '\0')
        line[at++] = *second++;
    line[at] = '\0';
    u->port.log(u->port.context, line);
}

/* why: shorter than DIAGNOSTIC_TEXT_MAX. */
static bool refuse(struct settings_upload *u, const char *why)
{
    memmove(u->text, why, strlen(why) + 1);
    log_pair(u, REFUSED, u->text);
    return false;
}

static bool may_load(const struct settings_upload *u)
{
    return u->port.may_load(u->port.context);
}

static bool begin(void *context, uint32_t size)
{
    struct settings_upload *u = context;

    if (!may_load(u))
        return refuse(u, "settings are taken while the drives are off: press emergency stop first");
    if (size > store_room(u->store))
        return refuse(u, "these settings are larger than the memory for them");
    return store_begin(u->store, size) || refuse(u, "the memory for settings cannot be erased");
}

/* Chunks come in order: see panel_upload_take. */
static bool take(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct settings_upload *u = context;

    (void)offset;
    return may_load(u) && store_write(u->store, data, length);
}

static bool prepare(void *context)
{
    struct settings_upload *u = context;
    const uint8_t *bytes = store_look(u->store);
    struct machine machine;
    char text[DIAGNOSTIC_TEXT_MAX];
    struct diagnostic wrong;

    if (bytes == NULL)
        return refuse(u, "the settings are not complete");
    if (settings_read(bytes, u->store->coming, &machine, &u->tables, &wrong))
        return true;
    (void)diagnostic_text(&wrong, text);
    return refuse(u, text);
}

static bool place(void *context)
{
    struct settings_upload *u = context;

    if (!store_commit(u->store))
        return refuse(u, "the memory for settings does not keep them");
    log_pair(u, STORED, "");
    return true;
}

static const char *why(void *context)
{
    const struct settings_upload *u = context;

    return u->text;
}

struct panel_store settings_upload_open(struct settings_upload *upload, struct store *store,
                                        const struct settings_upload_port *port)
{
    memset(upload, 0, sizeof *upload);
    upload->store = store;
    upload->port = *port;
    return (struct panel_store){.begin = begin,
                                .write = take,
                                .prepare = prepare,
                                .place = place,
                                .why = why,
                                .context = upload};
}

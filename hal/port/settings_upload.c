#include "port/settings_upload.h"

#include <string.h>

#define REFUSED "settings refused: "
#define STORED  "settings stored: they count from the next start on"

#define DRIVES_ARE_ON "settings are taken while the drives are off: press emergency stop first"

/* Why, in words. */
static void tell(const struct settings_upload *u, char text[DIAGNOSTIC_TEXT_MAX])
{
    if (u->why != NULL)
        memcpy(text, u->why, strlen(u->why) + 1);
    else
        (void)takt_diagnostic_text(&u->wrong, text);
}

static bool log_refusal(const struct settings_upload *u)
{
    char line[sizeof REFUSED + DIAGNOSTIC_TEXT_MAX] = REFUSED;

    tell(u, line + sizeof REFUSED - 1);
    u->port.log(u->port.context, line);
    return false;
}

/* why: shorter than DIAGNOSTIC_TEXT_MAX. */
static bool refuse(struct settings_upload *u, const char *why)
{
    u->why = why;
    return log_refusal(u);
}

static bool may_load(const struct settings_upload *u)
{
    return u->port.may_load(u->port.context);
}

static bool begin(void *context, uint32_t size)
{
    struct settings_upload *u = context;

    if (!may_load(u))
        return refuse(u, DRIVES_ARE_ON);
    if (size > takt_store_room(u->store))
        return refuse(u, "these settings are larger than the memory for them");
    return takt_store_begin(u->store, size) ||
           refuse(u, "the memory for settings cannot be erased");
}

/* Chunks come in order: see takt_panel_upload_take. */
static bool take(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct settings_upload *u = context;

    (void)offset;
    return may_load(u) && takt_store_write(u->store, data, length);
}

static bool prepare(void *context)
{
    struct settings_upload *u = context;
    const uint8_t *bytes = takt_store_look(u->store);
    struct machine machine;

    if (!may_load(u))
        return refuse(u, DRIVES_ARE_ON);
    if (bytes == NULL)
        return refuse(u, "the settings are not complete");
    u->why = NULL;
    return takt_settings_read(bytes, u->store->coming, &machine, u->port.borrow(u->port.context),
                              NULL, &u->wrong) ||
           log_refusal(u);
}

static bool place(void *context)
{
    struct settings_upload *u = context;

    if (!takt_store_commit(u->store))
        return refuse(u, "the memory for settings does not keep them");
    u->port.log(u->port.context, STORED);
    return true;
}

static void why(void *context, char *text)
{
    tell(context, text);
}

struct panel_store takt_settings_upload_open(struct settings_upload *upload, struct store *store,
                                             const struct settings_upload_port *port)
{
    memset(upload, 0, sizeof *upload);
    upload->why = "";
    upload->store = store;
    upload->port = *port;
    return (struct panel_store){.begin = begin,
                                .write = take,
                                .prepare = prepare,
                                .place = place,
                                .why = why,
                                .context = upload};
}

#include "panel/upload.h"

#include "base/assert.h"
#include "base/crc32.h"
#include "modbus/crc.h"

#include <string.h>

/* Bytes that turned out wrong are no reason to go on. */
static bool may_go_on(const struct panel_upload *upload, uint32_t size, uint32_t crc)
{
    return upload->size == size && upload->crc == crc &&
           (upload->state == PANEL_UPLOAD_OPEN || takt_panel_upload_is_right(upload));
}

bool takt_panel_upload_begin(struct panel_upload *upload, const struct panel_store *store,
                             uint32_t size, uint32_t crc)
{
    if (may_go_on(upload, size, crc))
        return true;
    if (!store->begin(store->context, size))
        return false;
    *upload = (struct panel_upload){.state = PANEL_UPLOAD_OPEN, .size = size, .crc = crc};
    return true;
}

bool takt_panel_upload_stream(struct panel_upload *upload, const struct panel_store *store,
                              uint32_t size, uint32_t crc)
{
    if (store->begin_stream == NULL || !store->begin_stream(store->context, size))
        return false;
    *upload = (struct panel_upload){
        .state = PANEL_UPLOAD_OPEN, .size = size, .crc = crc, .is_stream = true};
    return true;
}

uint32_t takt_panel_upload_room(const struct panel_upload *upload, const struct panel_store *store)
{
    TAKT_ASSERT(upload->received <= upload->size);
    const uint32_t left = upload->size - upload->received;
    const uint32_t room = store->room == NULL ? left : store->room(store->context);

    return room < left ? room : left;
}

static bool fits(const struct panel_upload *upload, uint32_t offset, size_t length)
{
    return upload->state != PANEL_UPLOAD_NONE && offset <= upload->received && length >= 1 &&
           length <= upload->size - offset;
}

/*
 * The last byte has come. Nobody commits a stream: it tells by itself whether it is what was
 * announced.
 */
static void complete(struct panel_upload *upload, const struct panel_store *store)
{
    TAKT_ASSERT(upload->state == PANEL_UPLOAD_OPEN && upload->received == upload->size);
    upload->state = PANEL_UPLOAD_WHOLE;
    if (upload->is_stream)
        store->end_stream(store->context, takt_panel_upload_is_right(upload));
}

bool takt_panel_upload_take(struct panel_upload *upload, const struct panel_store *store,
                            uint32_t offset, const uint8_t *data, size_t length, uint16_t check)
{
    size_t known;

    if (!fits(upload, offset, length) || takt_crc16(data, length) != check)
        return false;
    known = upload->received - offset;
    if (known >= length)
        return true;
    if (!store->write(store->context, upload->received, data + known, length - known))
        return false;
    upload->received_crc = takt_crc32_add(upload->received_crc, data + known, length - known);
    upload->received += (uint32_t)(length - known);
    if (upload->received == upload->size)
        complete(upload, store);
    return true;
}

bool takt_panel_upload_is_right(const struct panel_upload *upload)
{
    return upload->state == PANEL_UPLOAD_WHOLE && upload->received_crc == upload->crc;
}

void takt_panel_upload_abandon(struct panel_upload *upload, const struct panel_store *store)
{
    if (upload->is_stream && upload->state == PANEL_UPLOAD_OPEN)
        store->end_stream(store->context, false);
    memset(upload, 0, sizeof *upload);
}

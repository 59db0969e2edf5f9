#include "panel/upload.h"

#include "base/crc32.h"
#include "modbus/crc.h"

#include <string.h>

/* Bytes that turned out wrong are no reason to go on. */
static bool may_go_on(const struct panel_upload *upload, uint32_t size, uint32_t crc)
{
    return upload->size == size && upload->crc == crc &&
           (upload->state == PANEL_UPLOAD_OPEN || panel_upload_is_right(upload));
}

bool panel_upload_begin(struct panel_upload *upload, const struct panel_store *store, uint32_t size,
                        uint32_t crc)
{
    if (may_go_on(upload, size, crc))
        return true;
    if (!store->begin(store->context, size))
        return false;
    *upload = (struct panel_upload){.state = PANEL_UPLOAD_OPEN, .size = size, .crc = crc};
    return true;
}

static bool fits(const struct panel_upload *upload, uint32_t offset, size_t length)
{
    return upload->state != PANEL_UPLOAD_NONE && offset <= upload->received && length >= 1 &&
           length <= upload->size - offset;
}

bool panel_upload_take(struct panel_upload *upload, const struct panel_store *store,
                       uint32_t offset, const uint8_t *data, size_t length, uint16_t check)
{
    size_t known;

    if (!fits(upload, offset, length) || crc16(data, length) != check)
        return false;
    known = upload->received - offset;
    if (known >= length)
        return true;
    if (!store->write(store->context, upload->received, data + known, length - known))
        return false;
    upload->received_crc = crc32_add(upload->received_crc, data + known, length - known);
    upload->received += (uint32_t)(length - known);
    if (upload->received == upload->size)
        upload->state = PANEL_UPLOAD_WHOLE;
    return true;
}

bool panel_upload_is_right(const struct panel_upload *upload)
{
    return upload->state == PANEL_UPLOAD_WHOLE && upload->received_crc == upload->crc;
}

void panel_upload_abandon(struct panel_upload *upload)
{
    memset(upload, 0, sizeof *upload);
}

/*
 * A drive with a concise configuration of its maker's: what it has is compared with that, object by
 * object, and where all agrees nothing is written. Else the whole is, in its order, since one entry
 * may need another before it (a PDO is not valid while it is mapped). Then the drive counts as set
 * up.
 *
 *     compare each object's last entry --one differs--> write all entries
 */
#include "base/assert.h"
#include "canopen/concise_dcf.h"
#include "drive/drives_private.h"

#include <string.h>

/* Store and restore: they are orders, and read as something else. */
#define OBJECT_STORE   0x1010
#define OBJECT_RESTORE 0x1011

static bool is_compared(const struct concise_dcf *dcf, uint32_t behind,
                        const struct concise_dcf_entry *entry)
{
    const uint16_t index = sdo_index(entry->object);
    return index != OBJECT_STORE && index != OBJECT_RESTORE &&
           !takt_concise_dcf_has(dcf, behind, entry->object);
}

/*
 * The entry at the cursor, or the first behind it that counts in this pass; the cursor stays in
 * front of it.
 */
static bool find_entry(struct drives *d, struct concise_dcf_entry *entry, uint32_t *behind)
{
    const struct concise_dcf *dcf = d->axis[d->at_axis].config.dcf;
    for (*behind = d->dcf.at; takt_concise_dcf_next(dcf, behind, entry); d->dcf.at = *behind)
        if (d->dcf.writes || is_compared(dcf, *behind, entry))
            return true;
    return false;
}

bool takt_drives_ask_dcf(struct drives *d)
{
    const uint8_t node = d->node[d->at_axis];
    struct concise_dcf_entry entry;
    uint32_t behind;
    TAKT_ASSERT(d->at_axis < d->count);
    if (d->axis[d->at_axis].config.dcf == NULL || !find_entry(d, &entry, &behind))
        return false;
    if (d->dcf.writes)
        takt_sdo_client_download(&d->sdo, node, entry.object, entry.value, entry.size,
                                 d->sdo_timeout_cycles);
    else
        takt_sdo_client_upload(&d->sdo, node, entry.object, d->sdo_timeout_cycles);
    d->sdo_bus = (uint8_t)drives_bus_of(d, d->at_axis);
    return true;
}

static bool is_same(const struct sdo_client *sdo, const struct concise_dcf_entry *entry)
{
    return sdo->result == SDO_DONE && sdo->length >= entry->size &&
           memcmp(sdo->value, entry->value, entry->size) == 0;
}

void takt_drives_take_dcf(struct drives *d)
{
    struct concise_dcf_entry entry;
    uint32_t behind;
    if (!find_entry(d, &entry, &behind))
        return;
    if (d->dcf.writes && d->sdo.result == SDO_ABORTED)
        takt_drives_raise_object(d, d->at_axis, entry.object, TAKT_ERROR_DRIVE_REFUSES,
                                 d->sdo.abort_code, takt_sdo_abort_text(d->sdo.abort_code));
    if (d->dcf.writes || is_same(&d->sdo, &entry)) {
        d->dcf.at = behind;
        return;
    }
    d->dcf.writes = true;
    d->dcf.at = CONCISE_DCF_FIRST;
}

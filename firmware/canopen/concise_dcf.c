#include "canopen/concise_dcf.h"

#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/sdo_client.h"

#define HEAD 7 /* index, sub-index, size */

static struct concise_dcf_entry entry_at(const uint8_t *at)
{
    return (struct concise_dcf_entry){
        .object = SDO_OBJECT(little_endian_read16(at), at[2]),
        .size = little_endian_read32(at + 3),
        .value = at + HEAD,
    };
}

bool takt_concise_dcf_next(const struct concise_dcf *dcf, uint32_t *at,
                           struct concise_dcf_entry *entry)
{
    if (dcf->length - *at < HEAD)
        return false;
    *entry = entry_at(dcf->bytes + *at);
    *at += HEAD + entry->size;
    return true;
}

bool takt_concise_dcf_is_well(const struct concise_dcf *dcf, uint32_t *object)
{
    uint32_t at = CONCISE_DCF_FIRST, count = 0;
    *object = 0;
    if (dcf->length < CONCISE_DCF_FIRST)
        return false;
    while (dcf->length - at >= HEAD) {
        const struct concise_dcf_entry entry = entry_at(dcf->bytes + at);
        *object = entry.object;
        if (entry.size == 0 || entry.size > SDO_CLIENT_VALUE_MAX ||
            entry.size > dcf->length - at - HEAD)
            return false;
        at += HEAD + entry.size;
        count++;
    }
    *object = 0;
    return at == dcf->length && count == little_endian_read32(dcf->bytes);
}

bool takt_concise_dcf_has(const struct concise_dcf *dcf, uint32_t at, uint32_t object)
{
    struct concise_dcf_entry entry;
    while (takt_concise_dcf_next(dcf, &at, &entry))
        if (entry.object == object)
            return true;
    return false;
}

/*
 * A concise device configuration (CiA 302-3, object 1F22): what a node is to be told, as its
 * maker's tool or a generator has written it. All numbers have the lowest byte first.
 *
 *     number of entries, 4 bytes; each: index 2, sub-index 1, size 4, and the value, of that size
 */
#ifndef TAKT_CANOPEN_CONCISE_DCF_H
#define TAKT_CANOPEN_CONCISE_DCF_H

#include <stdbool.h>
#include <stdint.h>

struct concise_dcf {
    const uint8_t *bytes; /* of the caller, for as long as it is used */
    uint32_t length;
};

struct concise_dcf_entry {
    uint32_t object; /* SDO_OBJECT */
    uint32_t size;   /* bytes */
    const uint8_t *value;
};

/*
 * It can be gone through: there are as many entries as it says, none is without a value or has more
 * bytes than a transfer takes (SDO_CLIENT_VALUE_MAX), and nothing comes behind them. *object: of
 * the entry that is wrong; 0: none is.
 */
bool takt_concise_dcf_is_well(const struct concise_dcf *dcf, uint32_t *object);

/*
 * Where the first entry begins. The next one's begins behind it: *at goes on. False: there is none
 * left. Of a good one.
 */
#define CONCISE_DCF_FIRST 4
bool takt_concise_dcf_next(const struct concise_dcf *dcf, uint32_t *at,
                           struct concise_dcf_entry *entry);

/* There is an entry of the same object at or behind this place. */
bool takt_concise_dcf_has(const struct concise_dcf *dcf, uint32_t at, uint32_t object);

#endif

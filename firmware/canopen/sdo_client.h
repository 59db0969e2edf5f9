/*
 * The client's end of SDO (CiA 301, 7.2.4): reads and writes objects of nodes, one transfer at a
 * time; values of up to four bytes expedited, longer ones in segments. It knows no port and no
 * clock: whoever owns it hands in frames and counts cycles.
 *
 *     takt_sdo_client_download(&client, node, object, bytes, length, timeout_cycles);
 *     every cycle:
 *         takt_sdo_client_take(&client, &frame)          for every frame that has come
 *         takt_sdo_client_next(&client, &frame)          true: send it; takt_sdo_client_sent(&client) when that worked
 *         takt_sdo_client_tick(&client)                  once
 *     until sdo_client_is_busy(&client) is false; then client.result
 *
 * Goals: a lost, late, doubled or foreign frame never completes a transfer wrongly; a transfer
 * always ends, at the latest timeout_cycles after its last progress. An answer that belongs to
 * another object, is of another kind, or comes when none is due, is passed over. A lost request or
 * response is not repeated here: the whole transfer may be, by its owner, and the node is told
 * before that it has been given up.
 */
#ifndef TAKT_CANOPEN_SDO_CLIENT_H
#define TAKT_CANOPEN_SDO_CLIENT_H

#include "canopen/sdo.h"

/* Bytes of the longest value; CiA 301's names (1008 ... 100A) are shorter in practice. */
#define SDO_CLIENT_VALUE_MAX 64

enum sdo_result {
    SDO_IDLE,      /* no transfer has been started */
    SDO_BUSY,      /* a transfer is under way */
    SDO_DONE,      /* it has succeeded */
    SDO_ABORTED,   /* the node refused, or broke the protocol: abort_code says why */
    SDO_UNANSWERED /* no answer in time */
};

/* A node that is to be told that we give up, and what; node 0: none is. */
struct sdo_client_abort {
    uint8_t node;
    uint32_t object;
    uint32_t code;
};

struct sdo_client {
    enum sdo_result result;
    uint8_t node;
    uint32_t object;     /* SDO_OBJECT */
    uint32_t abort_code; /* in SDO_ABORTED, enum sdo_abort or what the node made up */

    uint8_t length; /* of the value, bytes; of an upload: in SDO_DONE */
    uint8_t value[SDO_CLIENT_VALUE_MAX];

    /* Private. */
    bool is_upload;
    bool is_segmented;
    bool in_segments; /* the transfer has been initiated */
    bool send_pending;
    struct sdo_client_abort abort;
    uint8_t toggle;
    uint8_t moved; /* bytes of the value transferred, those in an unanswered request not */
    uint32_t timeout_cycles;
    uint32_t waited_cycles;
};

/*
 * Begins a transfer; one that is under way is forgotten. value: copied. length: 1 ...
 * SDO_CLIENT_VALUE_MAX.
 */
void takt_sdo_client_download(struct sdo_client *client, uint8_t node, uint32_t object,
                              const uint8_t *value, unsigned length, uint32_t timeout_cycles);
void takt_sdo_client_upload(struct sdo_client *client, uint8_t node, uint32_t object,
                            uint32_t timeout_cycles);

/* The same for a number of 1, 2 or 4 bytes. */
void takt_sdo_client_download_number(struct sdo_client *client, uint8_t node, uint32_t object,
                                     uint32_t value, unsigned length, uint32_t timeout_cycles);

/* The value of SDO_DONE as a number; only its first four bytes count. */
uint32_t takt_sdo_client_number(const struct sdo_client *client);

static inline bool sdo_client_is_busy(const struct sdo_client *client)
{
    return client->result == SDO_BUSY;
}

/* A frame has come; whatever is no answer to the transfer is passed over. */
void takt_sdo_client_take(struct sdo_client *client, const struct can_frame *frame);

/*
 * True: *frame is to be sent. It is given again until takt_sdo_client_sent says that it has been.
 */
bool takt_sdo_client_next(const struct sdo_client *client, struct can_frame *frame);
void takt_sdo_client_sent(struct sdo_client *client);

/* A cycle has passed. */
void takt_sdo_client_tick(struct sdo_client *client);

#endif

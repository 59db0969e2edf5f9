/*
 * The server's end of SDO (CiA 301, 7.2.4): expedited, segmented and block transfers, both ways,
 * one at a time. It knows neither objects nor a port: whoever owns it has the functions for them.
 *
 *     IDLE --upload-----------> UPLOAD --last segment--> IDLE
 *          --download---------> DOWNLOAD --last segment--> IDLE
 *          --block upload-----> OFFERED --start--> SENDING <--acknowledge--+
 *                                                     |    (more)          |
 *                                                     +--all acknowledged--> ENDING --end--> IDLE
 *          --block download---> TAKING --last block--> TAKEN --end--> IDLE
 *     from every state: abort, a client that stays silent, and a request that begins another
 *     transfer; but in TAKING whatever comes is a segment
 */
#ifndef TAKT_CANOPEN_SDO_SERVER_H
#define TAKT_CANOPEN_SDO_SERVER_H

#include "canopen/sdo.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes a client may write in one transfer. */
#define SDO_SERVER_WRITE_MAX 1024

#define SDO_BLOCK_SEGMENTS_MAX 127

/*
 * A transfer in which nothing has moved for this long is given up: a client that has gone away
 * would keep the server from all others. CiA 301 names the abort (05040000) and no time. Twice what
 * takt's master by default waits for an answer (sdo_timeout_ms), so that a client whose answer was
 * lost gives up first and the server's abort does not get into its next attempt; and twice the
 * 1.7 s that a block of 127 segments, 135 bits each, takes on the slowest bus, 10 kbit/s: while its
 * first one is lost, nothing moves before the client repeats it.
 */
#define SDO_SERVER_TIMEOUT_MS 4000

/* What the server asks of its owner. Abort codes: SDO_ABORT_NONE is success. */
struct sdo_server_owner {
    /*
     * The value of an object: *bytes stays valid and the same until the next call. number: room for
     * a value that has no memory of its own.
     */
    uint32_t (*read)(void *context, uint32_t object, uint8_t number[4], const uint8_t **bytes,
                     size_t *length);
    /*
     * May this object be written? Asked before the data come. *size: the bytes of its value; 0: it
     * may have any length.
     */
    uint32_t (*may_write)(void *context, uint32_t object, size_t *size);
    uint32_t (*write)(void *context, uint32_t object, const uint8_t *bytes, size_t length);
    /* False: no room now; the server comes back with it. */
    bool (*send)(void *context, const struct can_frame *frame);
    void *context;
};

enum sdo_server_state {
    SDO_SERVER_IDLE,
    SDO_SERVER_UPLOAD,
    SDO_SERVER_DOWNLOAD,
    SDO_SERVER_OFFERED,
    SDO_SERVER_SENDING,
    SDO_SERVER_ENDING,
    SDO_SERVER_TAKING,
    SDO_SERVER_TAKEN
};

/* Private. */
struct sdo_server {
    struct sdo_server_owner owner;
    uint8_t node;

    enum sdo_server_state state;
    uint64_t moved_ns; /* when the transfer has got on */
    uint32_t object;
    uint8_t toggle;
    size_t expected; /* download: bytes announced; 0: not announced */
    size_t moved;    /* bytes that are across, of a block upload: acknowledged */

    const uint8_t *source; /* upload */
    size_t length;
    uint8_t number[4];

    uint8_t block_size; /* segments of a block */
    uint8_t sequence;   /* of the block's last segment: sent, or received in order */
    bool has_last;      /* block download: the last segment has come */
    bool with_crc;

    uint8_t data[SDO_SERVER_WRITE_MAX + SDO_SEGMENT_MAX]; /* download */
};

void takt_sdo_server_init(struct sdo_server *server, uint8_t node,
                          const struct sdo_server_owner *owner);

/* Forgets the transfer under way without a word. */
void takt_sdo_server_reset(struct sdo_server *server);

/*
 * A request has come, a frame of 8 bytes to this node's server; the answer is sent at once. now_ns:
 * by any clock, always the same.
 */
void takt_sdo_server_take(struct sdo_server *server, const struct can_frame *frame,
                          uint64_t now_ns);

/* Segments of a block that found no room are sent again. To be called now and then. */
void takt_sdo_server_go_on(struct sdo_server *server, uint64_t now_ns);

/* When the transfer under way is given up, if it does not get on; UINT64_MAX: there is none. */
uint64_t takt_sdo_server_due_ns(const struct sdo_server *server);

/* Aborts it. */
void takt_sdo_server_give_up(struct sdo_server *server);

#endif

/*
 * Block transfers of the SDO server (CiA 301, 7.2.4.3.8 and following): many segments to one
 * acknowledgement, the whole value guarded by a checksum.
 */
#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/sdo_server_private.h"

#include <string.h>

/* Sub-commands: bits 1 and 0 of byte 0, of both sides. */
#define BLOCK_SUBCOMMAND_MASK 0x03
#define BLOCK_INITIATE        0x00
#define BLOCK_END             0x01
#define BLOCK_ACKNOWLEDGE     0x02
#define BLOCK_START           0x03

/* Flags of the first frames. */
#define BLOCK_WITH_CRC   0x04
#define BLOCK_SIZE_GIVEN 0x02

/* Flag of the last segment; the other bits count segments from 1. */
#define BLOCK_LAST_SEGMENT 0x80

/* Remainder of the polynomial x^16 + x^12 + x^5 + 1, from 0 (CiA 301, 7.2.4.3.16). */
static uint16_t checksum(const uint8_t *bytes, size_t length)
{
    uint16_t crc = 0;
    for (size_t i = 0; i < length; i++) {
        crc = (uint16_t)(crc ^ bytes[i] << 8);
        for (unsigned bit = 0; bit < 8; bit++)
            crc = (uint16_t)(crc & 0x8000u ? crc << 1 ^ 0x1021 : crc << 1);
    }
    return crc;
}

/* A frame that names no object: its command and two bytes. */
static void send_plain(struct sdo_server *server, unsigned command, uint8_t first, uint8_t second)
{
    struct can_frame frame = {.id = (uint16_t)(SDO_RESPONSE_FUNCTION + server->node),
                              .length = SDO_LENGTH,
                              .data = {(uint8_t)command, first, second}};
    (void)takt_sdo_server_send(server, &frame);
}

static bool is_block_size(uint8_t segments)
{
    return segments >= 1 && segments <= SDO_BLOCK_SEGMENTS_MAX;
}

/* ---- Upload ---- */

/*
 * The client says how many segments it takes at once, and from which length on a block transfer is
 * worth it; a shorter value is answered in the common way.
 */
static void offer(struct sdo_server *server, const struct can_frame *frame)
{
    server->object = takt_sdo_read_object(frame);
    server->state = SDO_SERVER_IDLE;
    server->block_size = frame->data[4];
    server->with_crc = frame->data[0] & BLOCK_WITH_CRC;
    if (!is_block_size(server->block_size)) {
        takt_sdo_server_abort(server, SDO_ABORT_BLOCK_SIZE);
        return;
    }
    if (!takt_sdo_server_open(server))
        return;
    if (server->length <= frame->data[5]) {
        takt_sdo_server_begin_upload(server);
        return;
    }
    server->state = SDO_SERVER_OFFERED;
    takt_sdo_server_answer(server, SDO_RESPONSE_BLOCK_UPLOAD | BLOCK_WITH_CRC | BLOCK_SIZE_GIVEN,
                           (uint32_t)server->length);
}

static bool send_segment(struct sdo_server *server, uint8_t sequence)
{
    struct can_frame frame = {.id = (uint16_t)(SDO_RESPONSE_FUNCTION + server->node),
                              .length = SDO_LENGTH};
    size_t from = server->moved + (size_t)(sequence - 1) * SDO_SEGMENT_MAX;
    size_t left = server->length - from;
    size_t length = left < SDO_SEGMENT_MAX ? left : SDO_SEGMENT_MAX;
    TAKT_ASSERT(server->moved <= server->length);
    frame.data[0] = (uint8_t)(sequence | (length == left ? BLOCK_LAST_SEGMENT : 0));
    memcpy(frame.data + 1, server->source + from, length);
    return takt_sdo_server_send(server, &frame);
}

/* Segments of the block that begins at server->moved; at least one, for a value of length 0 too. */
static unsigned segments_of_block(const struct sdo_server *server)
{
    size_t left = server->length - server->moved;
    size_t segments = left == 0 ? 1 : (left + SDO_SEGMENT_MAX - 1) / SDO_SEGMENT_MAX;
    TAKT_ASSERT(server->moved <= server->length);
    return segments < server->block_size ? (unsigned)segments : server->block_size;
}

void takt_sdo_server_send_segments(struct sdo_server *server)
{
    unsigned segments = segments_of_block(server);
    TAKT_ASSERT(server->state == SDO_SERVER_SENDING);
    while (server->sequence < segments) {
        if (!send_segment(server, (uint8_t)(server->sequence + 1)))
            return;
        server->sequence++;
    }
}

static void send_block(struct sdo_server *server)
{
    server->state = SDO_SERVER_SENDING;
    server->sequence = 0;
    takt_sdo_server_send_segments(server);
}

/* How many bytes of the last segment hold nothing, and the checksum. */
static void send_end(struct sdo_server *server)
{
    size_t rest = server->length % SDO_SEGMENT_MAX;
    unsigned unused = server->length == 0 ? SDO_SEGMENT_MAX
                                          : (SDO_SEGMENT_MAX - (unsigned)rest) % SDO_SEGMENT_MAX;
    unsigned crc = server->with_crc ? checksum(server->source, server->length) : 0;
    send_plain(server, SDO_RESPONSE_BLOCK_UPLOAD | unused << 2 | BLOCK_END, (uint8_t)crc,
               (uint8_t)(crc >> 8));
    server->state = SDO_SERVER_ENDING;
}

/* The client has taken the segments up to byte 1; byte 2 is the size of the next block. */
static void take_acknowledge(struct sdo_server *server, const struct can_frame *frame)
{
    uint8_t acknowledged = frame->data[1];
    if (acknowledged > server->sequence) {
        takt_sdo_server_abort(server, SDO_ABORT_SEQUENCE);
        return;
    }
    if (!is_block_size(frame->data[2])) {
        takt_sdo_server_abort(server, SDO_ABORT_BLOCK_SIZE);
        return;
    }
    bool is_empty = server->length == 0 && acknowledged > 0;
    server->block_size = frame->data[2];
    server->moved += (size_t)acknowledged * SDO_SEGMENT_MAX;
    if (is_empty || (server->moved >= server->length && server->length > 0))
        send_end(server);
    else
        send_block(server);
}

void takt_sdo_server_take_block_upload(struct sdo_server *server, const struct can_frame *frame)
{
    unsigned subcommand = frame->data[0] & BLOCK_SUBCOMMAND_MASK;
    if (subcommand == BLOCK_INITIATE)
        offer(server, frame);
    else if (subcommand == BLOCK_START && server->state == SDO_SERVER_OFFERED)
        send_block(server);
    else if (subcommand == BLOCK_ACKNOWLEDGE && server->state == SDO_SERVER_SENDING)
        take_acknowledge(server, frame);
    else if (subcommand == BLOCK_END && server->state == SDO_SERVER_ENDING)
        server->state = SDO_SERVER_IDLE;
    else
        takt_sdo_server_abort(server, SDO_ABORT_COMMAND);
}

/* ---- Download ---- */

static void accept(struct sdo_server *server, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    server->object = takt_sdo_read_object(frame);
    server->state = SDO_SERVER_IDLE;
    size_t size = 0;
    uint32_t code = server->owner.may_write(server->owner.context, server->object, &size);
    server->expected = command & BLOCK_SIZE_GIVEN ? little_endian_read32(frame->data + 4) : 0;
    if (code == SDO_ABORT_NONE && server->expected > SDO_SERVER_WRITE_MAX)
        code = SDO_ABORT_TOO_LONG;
    if (code != SDO_ABORT_NONE) {
        takt_sdo_server_abort(server, code);
        return;
    }
    server->with_crc = command & BLOCK_WITH_CRC;
    server->state = SDO_SERVER_TAKING;
    server->moved = 0;
    server->sequence = 0;
    server->has_last = false;
    takt_sdo_server_answer(server, SDO_RESPONSE_BLOCK_DOWNLOAD | BLOCK_WITH_CRC,
                           SDO_BLOCK_SEGMENTS_MAX);
}

static void acknowledge(struct sdo_server *server)
{
    send_plain(server, SDO_RESPONSE_BLOCK_DOWNLOAD | BLOCK_ACKNOWLEDGE, server->sequence,
               SDO_BLOCK_SEGMENTS_MAX);
    server->state = server->has_last ? SDO_SERVER_TAKEN : SDO_SERVER_TAKING;
    server->sequence = 0;
}

/*
 * Segments count from 1. One that does not continue the row is lost; the acknowledgement at the end
 * of the block tells the client from where to repeat.
 */
bool takt_sdo_server_take_block_segment(struct sdo_server *server, const struct can_frame *frame)
{
    bool is_last = frame->data[0] & BLOCK_LAST_SEGMENT;
    uint8_t sequence = frame->data[0] & (uint8_t)~BLOCK_LAST_SEGMENT;
    bool is_next = sequence == server->sequence + 1;
    if (is_next) {
        if (server->moved + SDO_SEGMENT_MAX > sizeof server->data) {
            takt_sdo_server_abort(server, SDO_ABORT_TOO_LONG);
            return true;
        }
        memcpy(server->data + server->moved, frame->data + 1, SDO_SEGMENT_MAX);
        server->moved += SDO_SEGMENT_MAX;
        server->sequence = sequence;
        server->has_last = is_last;
    }
    if (is_last || sequence == SDO_BLOCK_SEGMENTS_MAX)
        acknowledge(server);
    return is_next;
}

/* Byte 0 says how many bytes of the last segment hold nothing, bytes 1 and 2 are the checksum. */
static void end_download(struct sdo_server *server, const struct can_frame *frame)
{
    unsigned unused = frame->data[0] >> 2 & 7u;
    size_t length = server->moved - unused;
    server->state = SDO_SERVER_IDLE;
    if (server->expected != 0 && length != server->expected) {
        takt_sdo_server_abort(server,
                              length < server->expected ? SDO_ABORT_TOO_SHORT : SDO_ABORT_TOO_LONG);
        return;
    }
    if (server->with_crc &&
        little_endian_read16(frame->data + 1) != checksum(server->data, length)) {
        takt_sdo_server_abort(server, SDO_ABORT_CRC);
        return;
    }
    if (takt_sdo_server_deliver(server, server->data, length))
        send_plain(server, SDO_RESPONSE_BLOCK_DOWNLOAD | BLOCK_END, 0, 0);
}

void takt_sdo_server_take_block_download(struct sdo_server *server, const struct can_frame *frame)
{
    if ((frame->data[0] & BLOCK_END) == 0)
        accept(server, frame);
    else if (server->state == SDO_SERVER_TAKEN)
        end_download(server, frame);
    else
        takt_sdo_server_abort(server, SDO_ABORT_COMMAND);
}

void takt_sdo_server_go_on(struct sdo_server *server, uint64_t now_ns)
{
    const uint8_t before = server->sequence;
    if (server->state == SDO_SERVER_SENDING)
        takt_sdo_server_send_segments(server);
    if (server->sequence != before)
        server->moved_ns = now_ns;
}

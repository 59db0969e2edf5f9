#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/sdo_server_private.h"

#include <string.h>

#define MILLISECOND_NS UINT64_C(1000000)

void takt_sdo_server_init(struct sdo_server *server, uint8_t node,
                          const struct sdo_server_owner *owner)
{
    memset(server, 0, sizeof *server);
    server->owner = *owner;
    server->node = node;
}

void takt_sdo_server_reset(struct sdo_server *server)
{
    server->state = SDO_SERVER_IDLE;
}

bool takt_sdo_server_send(struct sdo_server *server, const struct can_frame *frame)
{
    return server->owner.send(server->owner.context, frame);
}

void takt_sdo_server_answer(struct sdo_server *server, unsigned command, uint32_t value)
{
    struct can_frame frame;
    takt_sdo_write_initiate(&frame, (uint16_t)(SDO_RESPONSE_FUNCTION + server->node),
                            (uint8_t)command, server->object, value);
    (void)takt_sdo_server_send(server, &frame);
}

void takt_sdo_server_abort(struct sdo_server *server, uint32_t code)
{
    takt_sdo_server_answer(server, SDO_ABORT, code);
    server->state = SDO_SERVER_IDLE;
}

uint64_t takt_sdo_server_due_ns(const struct sdo_server *server)
{
    return server->state == SDO_SERVER_IDLE
               ? UINT64_MAX
               : server->moved_ns + SDO_SERVER_TIMEOUT_MS * MILLISECOND_NS;
}

void takt_sdo_server_give_up(struct sdo_server *server)
{
    TAKT_ASSERT(server->state != SDO_SERVER_IDLE);
    takt_sdo_server_abort(server, SDO_ABORT_TIMEOUT);
}

bool takt_sdo_server_open(struct sdo_server *server)
{
    uint32_t code = server->owner.read(server->owner.context, server->object, server->number,
                                       &server->source, &server->length);
    server->moved = 0;
    if (code != SDO_ABORT_NONE)
        takt_sdo_server_abort(server, code);
    return code == SDO_ABORT_NONE;
}

static uint32_t expedited_value(const struct sdo_server *server)
{
    uint8_t bytes[SDO_EXPEDITED_MAX] = {0};
    TAKT_ASSERT(server->length <= SDO_EXPEDITED_MAX);
    memcpy(bytes, server->source, server->length);
    return little_endian_read32(bytes);
}

/* An empty value has no expedited form: its length is 0 and one empty segment follows. */
void takt_sdo_server_begin_upload(struct sdo_server *server)
{
    if (server->length >= 1 && server->length <= SDO_EXPEDITED_MAX) {
        unsigned unused = SDO_EXPEDITED_MAX - (unsigned)server->length;
        takt_sdo_server_answer(server,
                               SDO_RESPONSE_UPLOAD | unused << 2 | SDO_EXPEDITED | SDO_SIZE_GIVEN,
                               expedited_value(server));
        server->state = SDO_SERVER_IDLE;
        return;
    }
    takt_sdo_server_answer(server, SDO_RESPONSE_UPLOAD | SDO_SIZE_GIVEN, (uint32_t)server->length);
    server->state = SDO_SERVER_UPLOAD;
    server->toggle = 0;
}

bool takt_sdo_server_deliver(struct sdo_server *server, const uint8_t *bytes, size_t length)
{
    uint32_t code = server->owner.write(server->owner.context, server->object, bytes, length);
    if (code != SDO_ABORT_NONE)
        takt_sdo_server_abort(server, code);
    return code == SDO_ABORT_NONE;
}

/* Of the four bytes without a size, as many count as the object has (CiA 301, 7.2.4.3.3). */
static size_t expedited_length(uint8_t command, size_t object_size)
{
    if (command & SDO_SIZE_GIVEN)
        return SDO_EXPEDITED_MAX - sdo_unused_expedited(command);
    return object_size >= 1 && object_size < SDO_EXPEDITED_MAX ? object_size : SDO_EXPEDITED_MAX;
}

static void take_download(struct sdo_server *server, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    size_t size = 0;
    uint32_t code = server->owner.may_write(server->owner.context, server->object, &size);
    if (code != SDO_ABORT_NONE) {
        takt_sdo_server_abort(server, code);
    } else if (command & SDO_EXPEDITED) {
        server->state = SDO_SERVER_IDLE;
        if (takt_sdo_server_deliver(server, frame->data + 4, expedited_length(command, size)))
            takt_sdo_server_answer(server, SDO_RESPONSE_DOWNLOAD, 0);
    } else {
        server->expected = command & SDO_SIZE_GIVEN ? little_endian_read32(frame->data + 4) : 0;
        if (server->expected > SDO_SERVER_WRITE_MAX) {
            takt_sdo_server_abort(server, SDO_ABORT_TOO_LONG);
            return;
        }
        server->state = SDO_SERVER_DOWNLOAD;
        server->moved = 0;
        server->toggle = 0;
        takt_sdo_server_answer(server, SDO_RESPONSE_DOWNLOAD, 0);
    }
}

static void answer_segment(struct sdo_server *server, unsigned command, const uint8_t *bytes,
                           size_t length)
{
    struct can_frame frame = {.id = (uint16_t)(SDO_RESPONSE_FUNCTION + server->node),
                              .length = SDO_LENGTH};
    TAKT_ASSERT(length <= SDO_SEGMENT_MAX);
    frame.data[0] = (uint8_t)command;
    if (length > 0)
        memcpy(frame.data + 1, bytes, length);
    (void)takt_sdo_server_send(server, &frame);
    server->toggle ^= SDO_TOGGLE;
}

/* The value is complete: as long as announced? */
static void end_download(struct sdo_server *server, uint8_t toggle)
{
    server->state = SDO_SERVER_IDLE;
    if (server->expected != 0 && server->moved != server->expected)
        takt_sdo_server_abort(server, server->moved < server->expected ? SDO_ABORT_TOO_SHORT
                                                                       : SDO_ABORT_TOO_LONG);
    else if (takt_sdo_server_deliver(server, server->data, server->moved))
        answer_segment(server, SDO_RESPONSE_DOWNLOAD_SEGMENT | toggle, NULL, 0);
}

static void take_download_segment(struct sdo_server *server, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    size_t length = SDO_SEGMENT_MAX - sdo_unused_segment(command);
    if (server->state != SDO_SERVER_DOWNLOAD) {
        takt_sdo_server_abort(server, SDO_ABORT_COMMAND);
        return;
    }
    if ((command & SDO_TOGGLE) != server->toggle) {
        takt_sdo_server_abort(server, SDO_ABORT_TOGGLE);
        return;
    }
    if (server->moved + length > SDO_SERVER_WRITE_MAX) {
        takt_sdo_server_abort(server, SDO_ABORT_TOO_LONG);
        return;
    }
    memcpy(server->data + server->moved, frame->data + 1, length);
    server->moved += length;
    if (command & SDO_LAST)
        end_download(server, command & SDO_TOGGLE);
    else
        answer_segment(server, SDO_RESPONSE_DOWNLOAD_SEGMENT | server->toggle, NULL, 0);
}

static void take_upload_segment(struct sdo_server *server, const struct can_frame *frame)
{
    size_t left = server->length - server->moved;
    size_t length = left < SDO_SEGMENT_MAX ? left : SDO_SEGMENT_MAX;
    unsigned unused = SDO_SEGMENT_MAX - (unsigned)length;
    unsigned last = length == left ? SDO_LAST : 0;
    if (server->state != SDO_SERVER_UPLOAD) {
        takt_sdo_server_abort(server, SDO_ABORT_COMMAND);
        return;
    }
    if ((frame->data[0] & SDO_TOGGLE) != server->toggle) {
        takt_sdo_server_abort(server, SDO_ABORT_TOGGLE);
        return;
    }
    answer_segment(server, SDO_RESPONSE_UPLOAD_SEGMENT | server->toggle | unused << 1 | last,
                   server->source + server->moved, length);
    server->moved += length;
    if (last)
        server->state = SDO_SERVER_IDLE;
}

/* Requests that begin a transfer name their object; a transfer under way is forgotten. */
static void take_request(struct sdo_server *server, const struct can_frame *frame)
{
    server->object = takt_sdo_read_object(frame);
    server->state = SDO_SERVER_IDLE;
    if ((frame->data[0] & SDO_COMMAND_MASK) == SDO_REQUEST_DOWNLOAD)
        take_download(server, frame);
    else if (takt_sdo_server_open(server))
        takt_sdo_server_begin_upload(server);
}

static void take_command(struct sdo_server *server, const struct can_frame *frame)
{
    switch (frame->data[0] & SDO_COMMAND_MASK) {
    case SDO_REQUEST_DOWNLOAD:
    case SDO_REQUEST_UPLOAD:
        take_request(server, frame);
        break;
    case SDO_REQUEST_DOWNLOAD_SEGMENT:
        take_download_segment(server, frame);
        break;
    case SDO_REQUEST_UPLOAD_SEGMENT:
        take_upload_segment(server, frame);
        break;
    case SDO_REQUEST_BLOCK_UPLOAD:
        takt_sdo_server_take_block_upload(server, frame);
        break;
    case SDO_REQUEST_BLOCK_DOWNLOAD:
        takt_sdo_server_take_block_download(server, frame);
        break;
    default:
        takt_sdo_server_abort(server, SDO_ABORT_COMMAND);
        break;
    }
}

/*
 * While a block is being taken, only a segment that is the next one counts as getting on: what a
 * client sends in vain, such as requests for something else, would keep the block for ever.
 */
void takt_sdo_server_take(struct sdo_server *server, const struct can_frame *frame, uint64_t now_ns)
{
    bool gets_on = true;
    if (frame->length != SDO_LENGTH)
        return;
    if (frame->data[0] == SDO_ABORT)
        server->state = SDO_SERVER_IDLE;
    else if (server->state == SDO_SERVER_TAKING)
        gets_on = takt_sdo_server_take_block_segment(server, frame);
    else
        take_command(server, frame);
    if (gets_on)
        server->moved_ns = now_ns;
}

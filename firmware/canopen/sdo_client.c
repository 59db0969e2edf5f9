#include "canopen/sdo_client.h"
#include "base/assert.h"
#include "canopen/little_endian.h"
#include "canopen/node.h"

#include <string.h>

/* An abort that has not been sent yet goes first, if it is for the same node. */
static void begin(struct sdo_client *client, uint8_t node, uint32_t object, uint32_t timeout_cycles)
{
    const struct sdo_client_abort before = client->abort;
    TAKT_ASSERT(node >= NODE_MIN && node <= NODE_MAX);
    memset(client, 0, sizeof *client);
    if (before.node == node)
        client->abort = before;
    client->result = SDO_BUSY;
    client->node = node;
    client->object = object;
    client->timeout_cycles = timeout_cycles;
    client->send_pending = true;
}

void takt_sdo_client_download(struct sdo_client *client, uint8_t node, uint32_t object,
                              const uint8_t *value, unsigned length, uint32_t timeout_cycles)
{
    TAKT_ASSERT(length >= 1 && length <= SDO_CLIENT_VALUE_MAX);
    begin(client, node, object, timeout_cycles);
    client->length = (uint8_t)length;
    client->is_segmented = length > SDO_EXPEDITED_MAX;
    memcpy(client->value, value, length);
}

void takt_sdo_client_upload(struct sdo_client *client, uint8_t node, uint32_t object,
                            uint32_t timeout_cycles)
{
    begin(client, node, object, timeout_cycles);
    client->is_upload = true;
}

void takt_sdo_client_download_number(struct sdo_client *client, uint8_t node, uint32_t object,
                                     uint32_t value, unsigned length, uint32_t timeout_cycles)
{
    uint8_t bytes[SDO_EXPEDITED_MAX];
    TAKT_ASSERT(length <= sizeof bytes);
    little_endian_write32(bytes, value);
    takt_sdo_client_download(client, node, object, bytes, length, timeout_cycles);
}

uint32_t takt_sdo_client_number(const struct sdo_client *client)
{
    uint8_t bytes[SDO_EXPEDITED_MAX] = {0};
    memcpy(bytes, client->value, client->length < sizeof bytes ? client->length : sizeof bytes);
    return little_endian_read32(bytes);
}

static unsigned segment_length(const struct sdo_client *client)
{
    unsigned left = (unsigned)client->length - client->moved;
    return left < SDO_SEGMENT_MAX ? left : SDO_SEGMENT_MAX;
}

static uint8_t download_command(const struct sdo_client *client)
{
    unsigned unused = SDO_EXPEDITED_MAX - (unsigned)client->length;
    TAKT_ASSERT(client->is_segmented || client->length <= SDO_EXPEDITED_MAX);
    if (client->is_segmented)
        return SDO_REQUEST_DOWNLOAD | SDO_SIZE_GIVEN;
    return (uint8_t)(SDO_REQUEST_DOWNLOAD | unused << 2 | SDO_EXPEDITED | SDO_SIZE_GIVEN);
}

static void write_initiate(const struct sdo_client *client, uint16_t cob_id,
                           struct can_frame *frame)
{
    uint32_t value = client->is_segmented ? client->length : takt_sdo_client_number(client);
    uint8_t command = client->is_upload ? SDO_REQUEST_UPLOAD : download_command(client);
    takt_sdo_write_initiate(frame, cob_id, command, client->object, client->is_upload ? 0 : value);
}

static void write_segment(const struct sdo_client *client, uint16_t cob_id, struct can_frame *frame)
{
    unsigned length = segment_length(client);
    unsigned unused = SDO_SEGMENT_MAX - length;
    bool is_last = client->moved + length == client->length;
    memset(frame, 0, sizeof *frame);
    frame->id = cob_id;
    frame->length = SDO_LENGTH;
    if (client->is_upload) {
        frame->data[0] = (uint8_t)(SDO_REQUEST_UPLOAD_SEGMENT | client->toggle);
        return;
    }
    frame->data[0] = (uint8_t)(SDO_REQUEST_DOWNLOAD_SEGMENT | client->toggle | unused << 1 |
                               (is_last ? SDO_LAST : 0));
    memcpy(frame->data + 1, client->value + client->moved, length);
}

bool takt_sdo_client_next(const struct sdo_client *client, struct can_frame *frame)
{
    uint16_t cob_id = (uint16_t)(SDO_REQUEST_FUNCTION + client->node);
    if (client->abort.node != 0) {
        takt_sdo_write_abort(frame, SDO_REQUEST_FUNCTION, client->abort.node, client->abort.object,
                             client->abort.code);
        return true;
    }
    if (!client->send_pending)
        return false;
    if (client->in_segments)
        write_segment(client, cob_id, frame);
    else
        write_initiate(client, cob_id, frame);
    return true;
}

void takt_sdo_client_sent(struct sdo_client *client)
{
    TAKT_ASSERT(client->send_pending || client->abort.node != 0);
    if (client->abort.node != 0)
        client->abort.node = 0;
    else
        client->send_pending = false;
}

/* The node has broken the protocol, or let us wait: it is told, so that it forgets the transfer. */
static void give_up(struct sdo_client *client, enum sdo_result result, uint32_t code)
{
    TAKT_ASSERT(result != SDO_BUSY && result != SDO_DONE);
    client->result = result;
    client->abort_code = code;
    client->send_pending = false;
    client->abort = (struct sdo_client_abort){client->node, client->object, code};
}

static void progress(struct sdo_client *client)
{
    client->waited_cycles = 0;
    client->send_pending = true;
}

static void take_value(struct sdo_client *client, const uint8_t *bytes, unsigned length)
{
    TAKT_ASSERT(client->moved <= SDO_CLIENT_VALUE_MAX);
    if (client->moved + length > SDO_CLIENT_VALUE_MAX) {
        give_up(client, SDO_ABORTED, SDO_ABORT_MEMORY);
        return;
    }
    memcpy(client->value + client->moved, bytes, length);
    client->moved = (uint8_t)(client->moved + length);
}

static void finish_upload(struct sdo_client *client)
{
    if (client->result != SDO_BUSY)
        return;
    client->length = client->moved;
    client->result = SDO_DONE;
}

/*
 * Of the four answers CiA 301 knows beside an abort one that is not due belongs to a transfer
 * before: it is late, or has come twice.
 */
static void take_other(struct sdo_client *client, uint8_t command)
{
    switch (command & SDO_COMMAND_MASK) {
    case SDO_RESPONSE_UPLOAD:
    case SDO_RESPONSE_DOWNLOAD:
    case SDO_RESPONSE_UPLOAD_SEGMENT:
    case SDO_RESPONSE_DOWNLOAD_SEGMENT:
        break;
    default:
        give_up(client, SDO_ABORTED, SDO_ABORT_COMMAND);
        break;
    }
}

/* Answers to the initiating request. */
static void take_initiated(struct sdo_client *client, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    uint8_t expected = client->is_upload ? SDO_RESPONSE_UPLOAD : SDO_RESPONSE_DOWNLOAD;
    if ((command & SDO_COMMAND_MASK) != expected) {
        take_other(client, command);
    } else if (client->is_upload && command & SDO_EXPEDITED) {
        unsigned unused = command & SDO_SIZE_GIVEN ? sdo_unused_expedited(command) : 0;
        take_value(client, frame->data + 4, SDO_EXPEDITED_MAX - unused);
        finish_upload(client);
    } else if (client->is_upload || client->is_segmented) {
        client->in_segments = true;
        progress(client);
    } else {
        client->result = SDO_DONE;
    }
}

static void take_uploaded(struct sdo_client *client, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    take_value(client, frame->data + 1, SDO_SEGMENT_MAX - sdo_unused_segment(command));
    if (command & SDO_LAST)
        finish_upload(client);
}

static void take_downloaded(struct sdo_client *client)
{
    client->moved = (uint8_t)(client->moved + segment_length(client));
    if (client->moved == client->length)
        client->result = SDO_DONE;
}

/* Answers to a segment. The toggle bit tells it from the answer before. */
static void take_segment(struct sdo_client *client, const struct can_frame *frame)
{
    uint8_t command = frame->data[0];
    uint8_t expected =
        client->is_upload ? SDO_RESPONSE_UPLOAD_SEGMENT : SDO_RESPONSE_DOWNLOAD_SEGMENT;
    if ((command & SDO_COMMAND_MASK) != expected) {
        take_other(client, command);
        return;
    }
    if ((command & SDO_TOGGLE) != client->toggle)
        return; /* the answer before, doubled on its way */
    if (client->is_upload)
        take_uploaded(client, frame);
    else
        take_downloaded(client);
    client->toggle ^= SDO_TOGGLE;
    if (client->result == SDO_BUSY)
        progress(client);
}

void takt_sdo_client_take(struct sdo_client *client, const struct can_frame *frame)
{
    bool is_abort = frame->data[0] == SDO_ABORT;
    if (frame->id != SDO_RESPONSE_FUNCTION + client->node || frame->length != SDO_LENGTH)
        return;
    if (client->result != SDO_BUSY || client->send_pending)
        return; /* none is due */
    if ((is_abort || !client->in_segments) && takt_sdo_read_object(frame) != client->object)
        return; /* of a transfer before */
    if (is_abort) {
        client->result = SDO_ABORTED;
        client->abort_code = little_endian_read32(frame->data + 4);
    } else if (client->in_segments) {
        take_segment(client, frame);
    } else {
        take_initiated(client, frame);
    }
}

void takt_sdo_client_tick(struct sdo_client *client)
{
    if (client->result != SDO_BUSY || client->waited_cycles++ < client->timeout_cycles)
        return;
    give_up(client, SDO_UNANSWERED, SDO_ABORT_TIMEOUT);
}

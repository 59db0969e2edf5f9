/*
 * Shared by the sources of the SDO server.
 */
#ifndef TAKT_CANOPEN_SDO_SERVER_PRIVATE_H
#define TAKT_CANOPEN_SDO_SERVER_PRIVATE_H

#include "canopen/sdo_server.h"

bool takt_sdo_server_send(struct sdo_server *server, const struct can_frame *frame);

/* A first frame, or any that is not a segment. value: bytes 4 to 7. */
void takt_sdo_server_answer(struct sdo_server *server, unsigned command, uint32_t value);

/* Tells the client and forgets the transfer. */
void takt_sdo_server_abort(struct sdo_server *server, uint32_t code);

/* Fetches the value to upload. False: aborted. */
bool takt_sdo_server_open(struct sdo_server *server);

/* Answers an upload request whose value is open: expedited, or with its length. */
void takt_sdo_server_begin_upload(struct sdo_server *server);

/* Hands in what has been downloaded. False: aborted. */
bool takt_sdo_server_deliver(struct sdo_server *server, const uint8_t *bytes, size_t length);

/* Block transfers. */
void takt_sdo_server_take_block_upload(struct sdo_server *server, const struct can_frame *frame);
void takt_sdo_server_take_block_download(struct sdo_server *server, const struct can_frame *frame);
/*
 * A frame while a block is being taken: a segment, whatever its first bits say. True: the next one.
 */
bool takt_sdo_server_take_block_segment(struct sdo_server *server, const struct can_frame *frame);
void takt_sdo_server_send_segments(struct sdo_server *server);

#endif

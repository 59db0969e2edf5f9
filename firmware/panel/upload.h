/*
 * A program on its way in: begun with its size and CRC-32, brought chunk by chunk in order,
 * committed when all of it is there and the CRC is right.
 */
#ifndef TAKT_PANEL_UPLOAD_H
#define TAKT_PANEL_UPLOAD_H

#include "panel/registers.h"

/*
 * Where the bytes are kept until they are a program. None of these may keep the control cycle
 * waiting.
 */
struct panel_store {
    /* Room for a program of size bytes; what was brought before is dropped. False: no room. */
    bool (*begin)(void *context, uint32_t size);
    /* Bytes at an offset, within the size. */
    bool (*write)(void *context, uint32_t offset, const uint8_t *data, size_t length);
    /*
     * All bytes are there and right: makes them durable beside the program there is. False: cannot.
     */
    bool (*prepare)(void *context);
    /*
     * The controller has taken the program: puts it in the place of the one before, at once or not
     * at all. False: cannot, and the controller takes the program before again.
     */
    bool (*place)(void *context);
    /*
     * The same as begin, of a program that is run while it comes; then how it ended: all bytes are
     * there and right, or no more will come. NULL, both: this store does not do that.
     */
    bool (*begin_stream)(void *context, uint32_t size);
    void (*end_stream)(void *context, bool right);
    /*
     * Why begin, write, prepare or place has said false last, into text[PANEL_ALARM_TEXT_MAX]: it
     * ends with a zero, empty: it has not. NULL: this store does not know.
     */
    void (*why)(void *context, char *text);
    /*
     * Bytes that write takes now. NULL: any. Less than a chunk is no fault: what runs makes room.
     */
    uint32_t (*room)(void *context);
    void *context; /* owned by whoever made the store */
};

struct panel_upload {
    enum panel_upload_state state;
    uint32_t size, crc; /* announced */
    uint32_t received;
    uint32_t received_crc;
    bool is_stream;
};

/* Begins, or goes on with an open upload of the same size and CRC. False: the store has no room. */
bool takt_panel_upload_begin(struct panel_upload *upload, const struct panel_store *store,
                             uint32_t size, uint32_t crc);

/* Begins a stream. False: the store does not, or what runs keeps it. */
bool takt_panel_upload_stream(struct panel_upload *upload, const struct panel_store *store,
                              uint32_t size, uint32_t crc);

/* Bytes that can be handed in now. */
uint32_t takt_panel_upload_room(const struct panel_upload *upload, const struct panel_store *store);

/*
 * A chunk. It may repeat bytes that are there already (the reply to it may have been lost) but
 * leave none out. False: it does not fit, its check is wrong, or no upload is open; nothing has
 * changed.
 */
bool takt_panel_upload_take(struct panel_upload *upload, const struct panel_store *store,
                            uint32_t offset, const uint8_t *data, size_t length, uint16_t check);

/* All bytes are there and are those that were announced. */
bool takt_panel_upload_is_right(const struct panel_upload *upload);

void takt_panel_upload_abandon(struct panel_upload *upload, const struct panel_store *store);

#endif

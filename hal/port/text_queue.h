/*
 * The program of an image with little memory: its last bytes in a ring.
 *
 * A program that fits is kept whole, uploaded and started as often as wanted. A longer one is
 * streamed: it is read while it comes, each byte once, and has room for as many more as have been
 * read. The panel brings bytes, the program reads them; both run in the background.
 */
#ifndef TAKT_PORT_TEXT_QUEUE_H
#define TAKT_PORT_TEXT_QUEUE_H

#include "panel/upload.h"
#include "program/source.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes; a power of two. Longer programs are streamed. A build may have others. */
#ifndef TEXT_QUEUE_MAX
#define TEXT_QUEUE_MAX 4096
#endif

struct text_queue {
    uint32_t size;    /* of the program that is coming, or there; 0: none */
    uint32_t written; /* bytes of it that have come */
    uint32_t read;    /* and that have been read for good: their room is free */
    uint32_t at;      /* where reading is */
    bool is_stream;   /* read while it comes */
    bool is_whole;    /* of a stream: all of it has come and is right */
    bool is_wrong;    /* of a stream: it has been given up, or is not what was announced */
    bool has_program; /* it can be started */
    bool in_use;      /* it is being read: no other may come */
    char byte[TEXT_QUEUE_MAX];
};

void takt_text_queue_init(struct text_queue *q);

/* Tells whether the program is running, before what the panel brings is taken. */
void takt_text_queue_use(struct text_queue *q, bool in_use);

/* What the panel brings its bytes to. */
struct panel_store takt_text_queue_get_store(struct text_queue *q);

/*
 * For struct service_programs: a source at the beginning. False: none, or its beginning has been
 * read and is gone.
 */
bool takt_text_queue_open(void *queue, struct source *source);
void takt_text_queue_adopt(void *queue);

#endif

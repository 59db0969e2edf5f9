/*
 * Text on its way to the sender, in small pieces.
 */
#ifndef TAKT_CONSOLE_REPLY_H
#define TAKT_CONSOLE_REPLY_H

#include <stddef.h>
#include <stdint.h>

#define REPLY_PIECE 64

/* Private. */
struct reply {
    void (*write)(void *context, const char *text, size_t length);
    void *context;
    char text[REPLY_PIECE];
    size_t length;
};

void takt_reply_text(struct reply *r, const char *text);
/* counts / 10^decimals, with all of its decimals. */
void takt_reply_counts(struct reply *r, int64_t counts, unsigned decimals);
/* Rounded. */
void takt_reply_number(struct reply *r, double value, unsigned decimals);
/* What has been put together goes out. */
void takt_reply_send(struct reply *r);

#endif

/*
 * The messages of socketcand, which offers CAN interfaces over TCP: words between < and >.
 *
 *     server: < hi >                     client: < open can0 >
 *             < ok >                             < rawmode >
 *             < ok >                             < send 123 2 AA BB >
 *             < frame 123 17.000042 AABB >       < sendrtr 123 2 >, < fdsend 123 1 2 AA BB >
 *             < rtr 123 17.000042 2 >, < fdframe 123 01 17.000042 AABB >, < error ... >
 *
 * Identifiers of eight digits are of 29 bits. Flags of CAN FD: 1 rate switch, 2 sender error
 * passive.
 */
#ifndef TAKT_HOST_LINK_SOCKETCAND_H
#define TAKT_HOST_LINK_SOCKETCAND_H

#include "bus/wire_frame.h"

#include <stddef.h>

#define SOCKETCAND_MESSAGE_MAX 320

/* Each writes one message and returns its number of bytes. */
size_t socketcand_write_send(char text[SOCKETCAND_MESSAGE_MAX], const struct wire_frame *frame);
size_t socketcand_write_frame(char text[SOCKETCAND_MESSAGE_MAX], const struct wire_frame *frame,
                              uint64_t time_ns);

/*
 * What a server, or a client, has sent; text is one message from < to >. False: no frame, or a
 * wrong one.
 */
bool socketcand_read_send(const char *text, size_t length, struct wire_frame *frame);
bool socketcand_read_frame(const char *text, size_t length, struct wire_frame *frame);

/*
 * The first message in count bytes: *begin where its < stands; returns its length, 0: there is no
 * whole one. What stands before a < is no message.
 */
size_t socketcand_find(const char *bytes, size_t count, size_t *begin);

/* The message consists of these words, whatever spaces are between them. */
bool socketcand_is(const char *text, size_t length, const char *words);

#endif

/*
 * Which addresses may connect: "192.168.1.0/24", "::1", "10.0.0.7".
 */
#ifndef TAKT_SERVE_ALLOW_LIST_H
#define TAKT_SERVE_ALLOW_LIST_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/socket.h>

#define ALLOW_LIST_MAX 64

struct allow_list {
    unsigned count; /* 0: everybody */
    struct allow_entry {
        uint8_t address[16]; /* IPv4 as ::ffff:a.b.c.d */
        unsigned bits;       /* of it that count */
    } entry[ALLOW_LIST_MAX];
};

/* False: the text is no address, or the list is full. */
bool allow_list_add(struct allow_list *list, const char *text);

bool allow_list_has(const struct allow_list *list, const struct sockaddr_storage *address);

#endif

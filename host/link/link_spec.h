/*
 * The text that names an outside bus (link.h), taken apart.
 */
#ifndef TAKT_HOST_LINK_SPEC_H
#define TAKT_HOST_LINK_SPEC_H

#include "link/link.h"

#include <stdbool.h>

#define LINK_NAME_MAX 255
#define LINK_BAUD     115200 /* of serial ports, unless the text says PATH@BAUD */

enum link_way {
    LINK_WAY_NONE,    /* the kind says all */
    LINK_WAY_DEVICE,  /* name: path of a serial port */
    LINK_WAY_PTY,     /* name: symbolic link to be made, or empty */
    LINK_WAY_CONNECT, /* to host and port */
    LINK_WAY_LISTEN   /* at host and port */
};

struct link_spec {
    enum link_kind kind;
    enum link_way way;
    unsigned baud;
    char host[LINK_NAME_MAX + 1];
    char port[LINK_NAME_MAX + 1];
    char name[LINK_NAME_MAX + 1]; /* interface, path or bus */
};

/* False: *error says what is wrong. */
bool link_spec_read(const char *text, struct link_spec *spec, struct link_error *error);

#endif

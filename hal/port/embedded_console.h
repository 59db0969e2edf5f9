/*
 * Grbl's interface on a serial line of an image, beside the panel: CNCjs, UGS or a script at its
 * other end stream lines into the program that runs. A port that has a line and the memory for it
 * gives embedded_config the lines of a console, and calls
 *
 *     takt_embedded_console_take_byte     from the interrupt of the line
 *     takt_embedded_console_background    from main, after takt_embedded_background
 *
 * There is no check mode ($C): it would need a second program reader.
 */
#ifndef TAKT_PORT_EMBEDDED_CONSOLE_H
#define TAKT_PORT_EMBEDDED_CONSOLE_H

#include "console/console.h"
#include "port/embedded.h"

/*
 * A power of two; half of it is told to senders. As much may come before the background looks, and
 * what its interrupt keeps until then is a ring.
 */
#define EMBEDDED_CONSOLE_TEXT (2 * LINE_RING_MAX)

struct embedded_console_config {
    struct embedded *embedded; /* has been initialised; must stay */
    const char *version;       /* of the firmware; must stay */
    /*
     * A piece of an answer, copied or sent. It may wait for room, but not for a sender that does
     * not read: the panel waits too.
     */
    void (*write)(void *context, const char *text, size_t length);
    void *context; /* owned by whoever made it */
};

/* Private, but the caller owns it. */
struct embedded_console {
    struct embedded_console_config config;
    struct console console;
    struct panel_client client; /* of the panel */
    struct line_ring received;
    /* bytes behind those that the ring has; until the background knows, more of them */
    volatile bool has_lost;
    struct lines lines;
    uint8_t text[EMBEDDED_CONSOLE_TEXT];
};

/* For embedded_config: before takt_embedded_init, which copies them. */
struct service_lines takt_embedded_console_get_lines(struct embedded_console *c);

/* After takt_embedded_init; the sender is welcomed. */
void takt_embedded_console_init(struct embedded_console *c,
                                const struct embedded_console_config *config);

void takt_embedded_console_take_byte(struct embedded_console *c, uint8_t byte);

void takt_embedded_console_background(struct embedded_console *c);

#endif

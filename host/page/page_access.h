/*
 * Who may ask for the page: a browser shows other people's pages too, and those must reach no
 * machine.
 *
 * Host: what the browser thinks it talks to. A name that is not this computer's is somebody else's
 * name for its address (DNS rebinding). Origin: whose page asks; only our own may open the
 * connection that carries orders.
 */
#ifndef TAKT_PAGE_PAGE_ACCESS_H
#define TAKT_PAGE_PAGE_ACCESS_H

#include <stdbool.h>

/*
 * "localhost", an address, or name (this computer's; with ".local" or without), each with a port or
 * without.
 */
bool page_access_is_host(const char *host, const char *name);

/* "http://HOST", or "https://HOST" where something in between encrypts. */
bool page_access_is_origin(const char *origin, const char *host);

#endif

#define _POSIX_C_SOURCE 200809L

#include "page/page_access.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define HOST_MAX 255

static bool is_digits(const char *text)
{
    return text[0] != '\0' && strspn(text, "0123456789") == strlen(text);
}

/* "[::1]:8080" -> "::1", "mill:8080" -> "mill". False: it is no such thing. */
static bool take_port_off(const char *host, char name[HOST_MAX + 1])
{
    const char *end = host[0] == '[' ? strchr(host, ']') : host + strcspn(host, ":");
    const char *begin = host + (host[0] == '[');
    const char *rest = end != NULL ? end + (host[0] == '[') : NULL;

    if (end == NULL || end == begin || end - begin > HOST_MAX)
        return false;
    if (rest[0] != '\0' && !(rest[0] == ':' && is_digits(rest + 1)))
        return false;
    (void)snprintf(name, HOST_MAX + 1, "%.*s", (int)(end - begin), begin);
    return true;
}

static bool is_address(const char *text)
{
    struct in6_addr room;

    return inet_pton(AF_INET, text, &room) == 1 || inet_pton(AF_INET6, text, &room) == 1;
}

/*
 * mill, mill.local, mill.shop.example where this computer calls itself mill or mill.shop.example.
 */
static bool is_own_name(const char *text, const char *name)
{
    const size_t length = strcspn(name, ".");

    if (strcasecmp(text, name) == 0)
        return name[0] != '\0';
    if (length == 0 || strncasecmp(text, name, length) != 0)
        return false;
    return text[length] == '\0' || strcasecmp(text + length, ".local") == 0;
}

bool page_access_is_host(const char *host, const char *name)
{
    char bare[HOST_MAX + 1];

    if (!take_port_off(host, bare))
        return false;
    return strcasecmp(bare, "localhost") == 0 || is_address(bare) || is_own_name(bare, name);
}

bool page_access_is_origin(const char *origin, const char *host)
{
    static const char *const schemes[] = {"http://", "https://"};

    for (unsigned i = 0; i < sizeof schemes / sizeof schemes[0]; i++) {
        const size_t length = strlen(schemes[i]);

        if (strncasecmp(origin, schemes[i], length) == 0 && strcasecmp(origin + length, host) == 0)
            return true;
    }
    return false;
}

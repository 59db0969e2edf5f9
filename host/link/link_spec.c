#include "link/link_spec.h"

#include "link/stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_HOST "127.0.0.1"
#define DEFAULT_BUS  "can0"

/* Longest name of a network interface, without its zero. */
#define INTERFACE_MAX 15

#define FORMS                                                                                      \
    "embedded, socketcan:INTERFACE, slcan:PATH, slcan:HOST:PORT, slcan:pty, slcan:listen:PORT, "   \
    "socketcand:HOST:PORT or socketcand:listen:PORT"

static bool refuse(struct link_error *error, const char *text, const char *why)
{
    error->is_environment = false;
    (void)snprintf(error->text, sizeof error->text, "bus %s: %s", text, why);
    return false;
}

/* Copies what stands before the next colon, and steps behind that. False: empty or too long. */
static bool take_word(const char **at, char word[LINK_NAME_MAX + 1])
{
    size_t length = strcspn(*at, ":");
    if (length == 0 || length > LINK_NAME_MAX)
        return false;
    memcpy(word, *at, length);
    word[length] = '\0';
    *at += length;
    if (**at == ':')
        ++*at;
    return true;
}

static bool is_port(const char *text)
{
    size_t digits = strspn(text, "0123456789");
    return digits > 0 && digits <= 5 && text[digits] == '\0' && atol(text) <= 65535;
}

/* [HOST:]PORT of a listener, HOST:PORT of a client; *at then stands behind. */
static bool take_address(const char **at, struct link_spec *spec)
{
    (void)snprintf(spec->host, sizeof spec->host, "%s", DEFAULT_HOST);
    if (!take_word(at, spec->port))
        return false;
    if (spec->way == LINK_WAY_LISTEN && is_port(spec->port))
        return true;
    (void)snprintf(spec->host, sizeof spec->host, "%s", spec->port);
    return take_word(at, spec->port) && is_port(spec->port) &&
           (spec->way == LINK_WAY_LISTEN || atol(spec->port) > 0);
}

/* The way, and what the way needs to find the other side. */
static bool take_network(const char **at, struct link_spec *spec)
{
    spec->way = LINK_WAY_CONNECT;
    if (strncmp(*at, "listen:", 7) == 0) {
        spec->way = LINK_WAY_LISTEN;
        *at += 7;
    }
    return take_address(at, spec);
}

static bool read_socketcan(const char *rest, struct link_spec *spec)
{
    return take_word(&rest, spec->name) && *rest == '\0' && strlen(spec->name) <= INTERFACE_MAX;
}

/* PATH, or PATH@BAUD. */
static bool read_device(const char *rest, struct link_spec *spec)
{
    char *baud;
    if (strlen(rest) > LINK_NAME_MAX)
        return false;
    spec->way = LINK_WAY_DEVICE;
    (void)snprintf(spec->name, sizeof spec->name, "%s", rest);
    baud = strrchr(spec->name, '@');
    if (baud == NULL || strspn(baud + 1, "0123456789") != strlen(baud + 1))
        return true;
    spec->baud = (unsigned)strtoul(baud + 1, NULL, 10);
    *baud = '\0';
    return stream_knows_baud(spec->baud);
}

static bool read_slcan(const char *rest, struct link_spec *spec)
{
    if (strcmp(rest, "pty") == 0 || strncmp(rest, "pty:", 4) == 0) {
        spec->way = LINK_WAY_PTY;
        (void)snprintf(spec->name, sizeof spec->name, "%s", rest[3] == ':' ? rest + 4 : "");
        return strlen(rest) <= LINK_NAME_MAX;
    }
    if (strchr(rest, '/') != NULL)
        return read_device(rest, spec);
    return take_network(&rest, spec) && *rest == '\0';
}

static bool read_socketcand(const char *rest, struct link_spec *spec)
{
    if (!take_network(&rest, spec))
        return false;
    (void)snprintf(spec->name, sizeof spec->name, "%s", DEFAULT_BUS);
    return *rest == '\0' ||
           (take_word(&rest, spec->name) && *rest == '\0' && strlen(spec->name) <= INTERFACE_MAX);
}

static bool read_embedded(const char *rest, struct link_spec *spec)
{
    (void)spec;
    return *rest == '\0';
}

static const struct {
    const char *prefix;
    enum link_kind kind;
    bool (*read)(const char *rest, struct link_spec *spec);
    const char *form;
} kinds[] = {
    {"embedded", LINK_EMBEDDED, read_embedded, "expected embedded alone"},
    {"socketcan:", LINK_SOCKETCAN, read_socketcan,
     "expected socketcan:INTERFACE, such as socketcan:can0"},
    {"slcan:", LINK_SLCAN, read_slcan,
     "expected slcan:PATH with a /, slcan:PATH@BAUD with a common baud rate, slcan:HOST:PORT, "
     "slcan:pty[:NAME] or slcan:listen:[HOST:]PORT"},
    {"socketcand:", LINK_SOCKETCAND, read_socketcand,
     "expected socketcand:HOST:PORT[:BUS] or socketcand:listen:[HOST:]PORT[:BUS]"},
};

bool link_spec_read(const char *text, struct link_spec *spec, struct link_error *error)
{
    *spec = (struct link_spec){.baud = LINK_BAUD};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        size_t length = strlen(kinds[i].prefix);
        if (strncmp(text, kinds[i].prefix, length) != 0)
            continue;
        spec->kind = kinds[i].kind;
        return kinds[i].read(text + length, spec) || refuse(error, text, kinds[i].form);
    }
    return refuse(error, text, "unknown kind; there are " FORMS);
}

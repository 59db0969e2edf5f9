#define _POSIX_C_SOURCE 200809L

#include "serving/serving_options.h"

#include "base/maths.h"
#include "cli/message.h"

#include <arpa/inet.h>
#include <errno.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ALLOW_ENTRY_MAX 63

#define HTTP_DEFAULT "127.0.0.1:8080"

/* "192.168.1.0/24,::1" */
static bool read_allowed(struct allow_list *allowed, const char *text)
{
    allowed->count = 0;
    while (*text != '\0') {
        const size_t length = strcspn(text, ",");
        char entry[ALLOW_ENTRY_MAX + 1] = "";

        if (length <= ALLOW_ENTRY_MAX)
            memcpy(entry, text, length);
        if (!allow_list_add(allowed, entry)) {
            message_command_error("panel.allow: '%.*s' is no address, or one of more than %d",
                                  (int)length, text, ALLOW_LIST_MAX);
            return false;
        }
        text += length + (text[length] == ',');
    }
    return true;
}

/* A number that sockets would cut to another, silently. Names of services are found elsewhere. */
static bool is_beyond_ports(const char *port)
{
    return port[strspn(port, "0123456789")] == '\0' && strtod(port, NULL) > UINT16_MAX;
}

/* The last colon parts them: IPv6 addresses have some of their own. */
bool serving_options_split(char *text, const char **host, const char **port)
{
    char *colon = strrchr(text, ':');

    if (colon == NULL || colon == text || colon[1] == '\0' || is_beyond_ports(colon + 1))
        return false;
    *colon = '\0';
    *port = colon + 1;
    *host = text;
    if (text[0] == '[' && colon[-1] == ']') {
        colon[-1] = '\0';
        *host = text + 1;
    }
    return true;
}

bool serving_options_unit(double given, uint8_t *unit)
{
    *unit = 1;
    if (given == 0)
        return true;
    if (given > MODBUS_RTU_UNIT_MAX || given != takt_maths_floor(given)) {
        message_command_error("--unit %g: a whole number from 1 to %d is expected", given,
                              MODBUS_RTU_UNIT_MAX);
        return false;
    }
    *unit = (uint8_t)given;
    return true;
}

bool serving_options_check(const struct machine_setup *setup)
{
    char address[MACHINE_SETUP_PATH_MAX + 1];
    const char *host, *port;
    struct allow_list allowed;

    (void)snprintf(address, sizeof address, "%s", setup->panel.listen);
    if (address[0] != '\0' && !serving_options_split(address, &host, &port)) {
        message_command_error("panel.listen %s: HOST:PORT is expected, PORT at most 65535",
                              setup->panel.listen);
        return false;
    }
    return read_allowed(&allowed, setup->panel.allow);
}

static bool read_address(struct serving_options *options, const struct session *session,
                         struct server_config *config)
{
    const char *given = session->options->panel.listen;

    if (given == NULL)
        given = session->setup.panel.listen;
    (void)snprintf(options->address, sizeof options->address, "%s", given);
    config->address = NULL;
    if (given[0] == '\0' ||
        serving_options_split(options->address, &config->address, &config->port))
        return true;
    message_command_error("--listen %s: HOST:PORT is expected, PORT at most 65535", given);
    return false;
}

/* 127.0.0.0/8, ::1, and the former written as the latter. */
static bool is_loopback(const struct sockaddr *address)
{
    const struct sockaddr_in *v4 = (const void *)address;
    const struct sockaddr_in6 *v6 = (const void *)address;

    if (address->sa_family == AF_INET)
        return ntohl(v4->sin_addr.s_addr) >> 24 == 127;
    return IN6_IS_ADDR_LOOPBACK(&v6->sin6_addr) ||
           (IN6_IS_ADDR_V4MAPPED(&v6->sin6_addr) && v6->sin6_addr.s6_addr[12] == 127);
}

/*
 * Only this computer reaches it. What cannot be found cannot be listened on, which is told later.
 */
static bool is_private(const char *host)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    struct addrinfo *found = NULL;
    bool private = true;

    if (getaddrinfo(host, NULL, &wanted, &found) != 0)
        return true;
    for (const struct addrinfo *one = found; one != NULL; one = one->ai_next)
        if (!is_loopback(one->ai_addr))
    private = false;
    freeaddrinfo(found);
    return private;
}

/*
 * Whoever reaches the panel moves the machine: beyond this computer somebody has to say that this
 * is meant.
 */
static bool check_access(const struct session *session, const char *address,
                         const struct allow_list *allowed)
{
    static const char open[] = "anybody who reaches %s can move the machine: set panel.allow or "
                               "panel.password%s";

    if (address == NULL || allowed->count > 0 || session->setup.panel.password != 0 ||
        is_private(address))
        return true;
    if (session->options->panel.insecure)
        message_command_warning(open, address, "");
    else
        message_command_error(open, address, ", or say --insecure");
    return session->options->panel.insecure;
}

static bool open_serial(struct serving_options *options, const char *given,
                        struct server_config *config)
{
    config->serial = -1;
    if (given == NULL)
        return true;
    if (!serial_settings_read(&options->serial, given)) {
        message_command_error("--serial %s: PATH, PATH,BAUD or PATH,BAUD,even|odd|none is expected",
                              given);
        return false;
    }
    config->serial = serial_line_open(&options->serial);
    config->serial_gap_us = takt_modbus_rtu_gap_us(options->serial.bauds, SERIAL_BITS);
    if (config->serial < 0)
        message_command_error("%s: %s", options->serial.path, strerror(errno));
    return config->serial >= 0;
}

bool serving_options_read(struct serving_options *options, const struct session *session,
                          struct server_config *config)
{
    const struct option_panel *panel = &session->options->panel;

    if (!read_address(options, session, config) ||
        !serving_options_unit(panel->unit, &config->unit) ||
        !read_allowed(&config->allowed, session->setup.panel.allow) ||
        !check_access(session, config->address, &config->allowed))
        return false;
    return open_serial(options, panel->serial, config);
}

bool serving_options_read_page(struct serving_options *options, const struct session *session,
                               struct page_server_config *config)
{
    const char *given = session->options->panel.http;

    config->address = NULL;
    if (given != NULL && strcmp(given, "off") == 0)
        return true;
    (void)snprintf(options->http, sizeof options->http, "%s", given != NULL ? given : HTTP_DEFAULT);
    if (!serving_options_split(options->http, &config->address, &config->port)) {
        message_command_error("--http %s: HOST:PORT or off is expected, PORT at most 65535", given);
        return false;
    }
    return read_allowed(&config->allowed, session->setup.panel.allow) &&
           check_access(session, config->address, &config->allowed);
}

bool serving_options_read_console(struct serving_options *options, const struct session *session,
                                  struct console_server_config *config)
{
    static const char tcp[] = "tcp:", pty[] = "pty:";
    const char *given = session->options->panel.grbl;

    config->address = NULL;
    (void)snprintf(options->grbl, sizeof options->grbl, "%s", given);
    if (strncmp(given, pty, sizeof pty - 1) == 0 && given[sizeof pty - 1] != '\0') {
        config->link = options->grbl + sizeof pty - 1;
        return true;
    }
    if (strncmp(given, tcp, sizeof tcp - 1) != 0 ||
        !serving_options_split(options->grbl + sizeof tcp - 1, &config->address, &config->port)) {
        message_command_error(
            "--grbl %s: tcp:HOST:PORT, PORT at most 65535, or pty:LINK is expected", given);
        return false;
    }
    return read_allowed(&config->allowed, session->setup.panel.allow) &&
           check_access(session, config->address, &config->allowed);
}

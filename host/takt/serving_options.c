#include "takt/serving_options.h"

#include "base/maths.h"
#include "takt/message.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define ALLOW_ENTRY_MAX 63

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

/* The last colon parts them: IPv6 addresses have some of their own. */
bool serving_options_split(char *text, const char **host, const char **port)
{
    char *colon = strrchr(text, ':');

    if (colon == NULL || colon == text || colon[1] == '\0')
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
    if (given > MODBUS_RTU_UNIT_MAX || given != maths_floor(given)) {
        message_command_error("--unit %g: a whole number from 1 to %d is expected", given,
                              MODBUS_RTU_UNIT_MAX);
        return false;
    }
    *unit = (uint8_t)given;
    return true;
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
    message_command_error("--listen %s: HOST:PORT is expected", given);
    return false;
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
    config->serial_gap_us = modbus_rtu_gap_us(options->serial.bauds, SERIAL_BITS);
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
        !read_allowed(&config->allowed, session->setup.panel.allow))
        return false;
    return open_serial(options, panel->serial, config);
}

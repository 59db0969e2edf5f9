#include "serving/panel_line.h"

#include "base/maths.h"
#include "cli/message.h"
#include "cli/suggest.h"
#include "serving/serving_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ADDRESS_DEFAULT "127.0.0.1:1502"
#define TIMEOUT_MS      2000
#define TIMEOUT_MAX_S   3600

static enum client_table table_of(const struct panel_register *row)
{
    switch (row->table) {
    case MODBUS_COILS:
        return CLIENT_COILS;
    case MODBUS_INPUTS:
        return CLIENT_INPUTS;
    case MODBUS_HOLDINGS:
        break;
    }
    return CLIENT_HOLDINGS;
}

static bool set_place(struct panel_line *line, const struct option_panel *options,
                      struct client_config *config)
{
    static const char parity[] = {[SERIAL_EVEN] = 'E', [SERIAL_ODD] = 'O', [SERIAL_NONE] = 'N'};
    const char *address = options->connect != NULL ? options->connect : ADDRESS_DEFAULT;

    if (options->serial == NULL) {
        (void)snprintf(line->address, sizeof line->address, "%s", address);
        if (serving_options_split(line->address, &config->host, &config->port))
            return true;
        message_command_error("--connect %s: HOST:PORT is expected, PORT at most 65535", address);
        return false;
    }
    if (!serial_settings_read(&line->serial, options->serial)) {
        message_command_error("--serial %s: PATH, PATH,BAUD or PATH,BAUD,even|odd|none is expected",
                              options->serial);
        return false;
    }
    config->path = line->serial.path;
    config->bauds = line->serial.bauds;
    config->parity = parity[line->serial.parity];
    return true;
}

static bool unlock(struct panel_line *line, double password)
{
    if (password == 0)
        return true;
    if (password > (double)PANEL_U32_MOST || password != takt_maths_floor(password)) {
        message_command_error("--password %.0f: a whole number up to 4294967295 is expected",
                              password);
        return false;
    }
    return panel_line_set(line, REGISTER_PASSWORD, (int64_t)password);
}

static enum command_status connect_line(struct panel_line *line, const struct option_panel *options,
                                        const struct client_config *config)
{
    if (!client_open(&line->client, config)) {
        message_command_error("no panel at %s: %s",
                              options->serial != NULL    ? options->serial
                              : options->connect != NULL ? options->connect
                                                         : ADDRESS_DEFAULT,
                              client_get_problem(&line->client));
        return STATUS_ENVIRONMENT;
    }
    if (unlock(line, options->password))
        return STATUS_DONE;
    client_close(&line->client);
    return STATUS_INPUT;
}

enum command_status panel_line_open(struct panel_line *line, const struct options *options)
{
    const struct option_panel *panel = &options->panel;
    struct client_config config = {.timeout_ms = TIMEOUT_MS};

    memset(line, 0, sizeof *line);
    if (panel->timeout_s > TIMEOUT_MAX_S) {
        message_command_error("--timeout %g: at most %d s", panel->timeout_s, TIMEOUT_MAX_S);
        return STATUS_INPUT;
    }
    if (panel->timeout_s > 0)
        config.timeout_ms = (uint32_t)(1000 * panel->timeout_s) + 1;
    if (!serving_options_unit(panel->unit, &config.unit) || !set_place(line, panel, &config))
        return STATUS_INPUT;
    return connect_line(line, panel, &config);
}

void panel_line_close(struct panel_line *line)
{
    client_close(&line->client);
}

/* Why the panel refused the last write, in words. */
static const char *refusal_text(struct panel_line *line)
{
    static const char *const texts[] = {
        [PANEL_REFUSAL_NONE] = "",
        [PANEL_REFUSAL_STATE] = ": not in the state the controller is in",
        [PANEL_REFUSAL_LOCKED] = ": the password comes first (--password)",
        [PANEL_REFUSAL_CONTROL] = ": another panel has claimed control",
        [PANEL_REFUSAL_VALUE] = ": the value is out of range",
        [PANEL_REFUSAL_ADDRESS] = ": it cannot be written",
        [PANEL_REFUSAL_BUSY] = ": the controller did not take it in time; try again",
    };
    const struct panel_register *row = &takt_panel_registers[REGISTER_REFUSAL];
    uint16_t reason = 0;

    if (client_read(&line->client, table_of(row), row->address, 1, &reason) &&
        reason < sizeof texts / sizeof texts[0])
        return texts[reason];
    return "";
}

void panel_line_report(struct panel_line *line, enum panel_id id, const char *what)
{
    const int exception = client_get_exception(&line->client);

    if (exception == 0)
        message_command_error("%s: it cannot be %s: %s", takt_panel_texts[id].name, what,
                              client_get_problem(&line->client));
    else
        message_command_error("%s: exception %02d%s", takt_panel_texts[id].name, exception,
                              refusal_text(line));
}

static bool read_words(struct panel_line *line, enum panel_id id, uint16_t *word)
{
    const struct panel_register *row = &takt_panel_registers[id];

    if (client_read(&line->client, table_of(row), row->address, row->words, word))
        return true;
    panel_line_report(line, id, "read");
    return false;
}

bool panel_line_get(struct panel_line *line, enum panel_id id, int64_t *value)
{
    const struct panel_register *row = &takt_panel_registers[id];
    uint16_t word[CLIENT_READ_MAX];
    uint32_t bits;

    if (!read_words(line, id, word))
        return false;
    bits = word[0];
    if (row->words == 2)
        bits = bits << 16 | word[1];
    *value = row->form == PANEL_S32 ? (int32_t)bits : (int64_t)bits;
    return true;
}

bool panel_line_set(struct panel_line *line, enum panel_id id, int64_t value)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const uint32_t bits = (uint32_t)(uint64_t)value;
    const uint16_t word[] = {(uint16_t)(bits >> 16), (uint16_t)bits};

    if (client_write(&line->client, table_of(row), row->address, row->words,
                     row->words == 2 ? word : word + 1))
        return true;
    panel_line_report(line, id, "written");
    return false;
}

static bool read_text(struct panel_line *line, enum panel_id id, char *text)
{
    const struct panel_register *row = &takt_panel_registers[id];
    uint16_t word[CLIENT_READ_MAX];

    if (!read_words(line, id, word))
        return false;
    for (unsigned i = 0; i < row->words; i++) {
        if (row->form == PANEL_BYTES) {
            (void)snprintf(text + 4 * (size_t)i, 5, "%04x", word[i]);
            continue;
        }
        (void)snprintf(text + 2 * (size_t)i, 3, "%c%c", word[i] >> 8, word[i] & 0xFF);
    }
    return true;
}

bool panel_line_read(struct panel_line *line, enum panel_id id, char text[PANEL_VALUE_MAX + 1])
{
    const struct panel_register *row = &takt_panel_registers[id];
    int64_t value;

    if (row->form == PANEL_TEXT || row->form == PANEL_BYTES)
        return read_text(line, id, text);
    if (!panel_line_get(line, id, &value))
        return false;
    (void)snprintf(text, PANEL_VALUE_MAX + 1, "%.*f", (int)row->decimals,
                   (double)value / takt_panel_counts_per_unit(id));
    return true;
}

static enum command_status write_text(struct panel_line *line, enum panel_id id, const char *text)
{
    const struct panel_register *row = &takt_panel_registers[id];
    uint16_t word[CLIENT_WRITE_MAX] = {0};
    const size_t length = strlen(text);

    if (length > (size_t)2 * row->words) {
        message_command_error("%s: the text is longer than %d characters", panel_text(row)->name,
                              2 * row->words);
        return STATUS_INPUT;
    }
    for (size_t i = 0; i < length; i++)
        word[i / 2] |= (uint16_t)((uint8_t)text[i] << (i % 2 == 0 ? 8 : 0));
    if (client_write(&line->client, table_of(row), row->address, row->words, word))
        return STATUS_DONE;
    panel_line_report(line, id, "written");
    return STATUS_INPUT;
}

enum command_status panel_line_write(struct panel_line *line, enum panel_id id, const char *text)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const double counts_per_unit = takt_panel_counts_per_unit(id);
    char *end;
    double value;

    if (row->states == PANEL_NEVER || row->form == PANEL_BYTES) {
        message_command_error("%s cannot be written", panel_text(row)->name);
        return STATUS_INPUT;
    }
    if (row->form == PANEL_TEXT)
        return write_text(line, id, text);
    value = strtod(text, &end) * counts_per_unit;
    if (end == text || *end != '\0' || !(value >= (double)takt_panel_least(row) - 0.5) ||
        !(value <= (double)panel_most(row) + 0.5)) {
        message_command_error("%s %s: a number from %.*f to %.*f is expected",
                              panel_text(row)->name, text, (int)row->decimals,
                              (double)takt_panel_least(row) / counts_per_unit, (int)row->decimals,
                              (double)panel_most(row) / counts_per_unit);
        return STATUS_INPUT;
    }
    return panel_line_set(line, id, (int64_t)takt_maths_round(value)) ? STATUS_DONE : STATUS_INPUT;
}

enum panel_id panel_line_find(const char *name)
{
    const char *names[REGISTER_COUNT];
    const enum panel_id id = takt_panel_find_name(name);

    if (id != REGISTER_COUNT)
        return id;
    for (unsigned i = 0; i < REGISTER_COUNT; i++)
        names[i] = takt_panel_texts[i].name;
    message_command_error("there is no register '%s'%s", name,
                          message_did_you_mean("", suggest_word(name, names, REGISTER_COUNT)));
    return REGISTER_COUNT;
}

#define _POSIX_C_SOURCE 200809L

#include "serve/panel_host.h"

#include <string.h>

static enum modbus_exception read_map(void *context, enum modbus_table table, uint16_t address,
                                      uint16_t count, uint8_t *data)
{
    struct panel_seat *seat = context;
    const struct modbus_map map = takt_panel_client_map(&seat->client);
    enum modbus_exception exception;

    panel_host_lock(seat->host);
    exception = map.read(map.context, table, address, count, data);
    panel_host_unlock(seat->host);
    return exception;
}

static enum modbus_exception write_map(void *context, enum modbus_table table, uint16_t address,
                                       uint16_t count, const uint8_t *data)
{
    struct panel_seat *seat = context;
    const struct modbus_map map = takt_panel_client_map(&seat->client);
    enum modbus_exception exception;

    panel_host_lock(seat->host);
    exception = map.write(map.context, table, address, count, data);
    panel_host_unlock(seat->host);
    return exception;
}

static struct modbus_map enter(void *context, unsigned place)
{
    struct panel_host *host = context;
    struct panel_seat *seat = &host->seat[place];

    panel_host_lock(host);
    seat->host = host;
    takt_panel_client_enter(&seat->client, &host->panel);
    panel_host_unlock(host);
    return (struct modbus_map){.read = read_map, .write = write_map, .context = seat};
}

static void leave(void *context, unsigned place)
{
    struct panel_host *host = context;

    panel_host_lock(host);
    takt_panel_client_leave(&host->seat[place].client);
    panel_host_unlock(host);
}

/* The panel in control stays. */
static bool keeps(void *context, unsigned place)
{
    struct panel_host *host = context;
    bool is_owner;

    panel_host_lock(host);
    is_owner = host->panel.owner == &host->seat[place].client;
    panel_host_unlock(host);
    return is_owner;
}

void panel_host_init(struct panel_host *host, const struct panel_config *config)
{
    pthread_mutexattr_t attributes;

    memset(host, 0, sizeof *host);
    (void)pthread_mutexattr_init(&attributes);
    (void)pthread_mutexattr_settype(&attributes, PTHREAD_MUTEX_RECURSIVE);
    (void)pthread_mutex_init(&host->lock, &attributes);
    (void)pthread_mutexattr_destroy(&attributes);
    takt_panel_init(&host->panel, config);
}

struct server_host panel_host_get(struct panel_host *host)
{
    return (struct server_host){.enter = enter, .leave = leave, .keeps = keeps, .context = host};
}

struct modbus_map panel_host_enter_page(struct panel_host *host, unsigned page)
{
    return enter(host, SERVER_PLACES + page);
}

void panel_host_leave_page(struct panel_host *host, unsigned page)
{
    leave(host, SERVER_PLACES + page);
}

void panel_host_enter_console(struct panel_host *host)
{
    (void)enter(host, PANEL_HOST_CONSOLE);
}

void panel_host_leave_console(struct panel_host *host)
{
    leave(host, PANEL_HOST_CONSOLE);
}

enum panel_refusal panel_host_order(struct panel_host *host, const struct panel_order *order)
{
    enum panel_refusal refusal;

    panel_host_lock(host);
    refusal = takt_panel_client_order(&host->seat[PANEL_HOST_CONSOLE].client, order);
    panel_host_unlock(host);
    return refusal;
}

enum panel_refusal panel_host_give_password(struct panel_host *host, uint32_t password)
{
    enum panel_refusal refusal;

    panel_host_lock(host);
    refusal = takt_panel_client_unlock(&host->seat[PANEL_HOST_CONSOLE].client, password);
    panel_host_unlock(host);
    return refusal;
}

void panel_host_lock(struct panel_host *host)
{
    (void)pthread_mutex_lock(&host->lock);
}

void panel_host_unlock(struct panel_host *host)
{
    (void)pthread_mutex_unlock(&host->lock);
}

void panel_host_look(struct panel_host *host, struct panel_snapshot *snapshot)
{
    const struct panel_port *port = &host->panel.config.port;

    panel_host_lock(host);
    port->look(port->context, snapshot);
    panel_host_unlock(host);
}

enum panel_control panel_host_get_control(struct panel_host *host, unsigned page,
                                          const struct panel_snapshot *snapshot)
{
    if (snapshot->value[REGISTER_WATCHDOG] == 0)
        return PANEL_CONTROL_FREE;
    return keeps(host, SERVER_PLACES + page) ? PANEL_CONTROL_MINE : PANEL_CONTROL_OTHER;
}

enum panel_refusal panel_host_get_refusal(struct panel_host *host, unsigned page)
{
    enum panel_refusal refusal;

    panel_host_lock(host);
    refusal = host->seat[SERVER_PLACES + page].client.refusal;
    panel_host_unlock(host);
    return refusal;
}

enum panel_refusal panel_host_check_page(struct panel_host *host, unsigned page)
{
    const struct panel_client *client = &host->seat[SERVER_PLACES + page].client;
    enum panel_refusal refusal = PANEL_REFUSAL_NONE;
    struct panel_snapshot snapshot;

    panel_host_lock(host);
    panel_host_look(host, &snapshot);
    if (panel_host_get_control(host, page, &snapshot) == PANEL_CONTROL_OTHER)
        refusal = PANEL_REFUSAL_CONTROL;
    else if (host->panel.config.password != 0 && !client->unlocked)
        refusal = PANEL_REFUSAL_LOCKED;
    panel_host_unlock(host);
    return refusal;
}

#include "serve/panel_host.h"

static struct modbus_map enter(void *context, unsigned place)
{
    struct panel_host *host = context;

    panel_client_enter(&host->client[place], &host->panel);
    return panel_client_map(&host->client[place]);
}

static void leave(void *context, unsigned place)
{
    struct panel_host *host = context;

    panel_client_leave(&host->client[place]);
}

/* The panel in control stays. */
static bool keeps(void *context, unsigned place)
{
    const struct panel_host *host = context;

    return host->panel.owner == &host->client[place];
}

void panel_host_init(struct panel_host *host, const struct panel_config *config)
{
    panel_init(&host->panel, config);
}

struct server_host panel_host_get(struct panel_host *host)
{
    return (struct server_host){.enter = enter, .leave = leave, .keeps = keeps, .context = host};
}

/*
 * Built where libmodbus is missing.
 */
#include "client/client.h"

#include <stdio.h>

bool client_open(struct client *client, const struct client_config *config)
{
    (void)config;
    *client = (struct client){0};
    (void)snprintf(client->problem, sizeof client->problem, "built without libmodbus");
    return false;
}

void client_close(struct client *client)
{
    (void)client;
}

bool client_read(struct client *client, enum client_table table, uint16_t address, unsigned count,
                 uint16_t *word)
{
    (void)client;
    (void)table;
    (void)address;
    (void)count;
    (void)word;
    return false;
}

bool client_write(struct client *client, enum client_table table, uint16_t address, unsigned count,
                  const uint16_t *word)
{
    (void)client;
    (void)table;
    (void)address;
    (void)count;
    (void)word;
    return false;
}

const char *client_get_problem(const struct client *client)
{
    return client->problem;
}

int client_get_exception(const struct client *client)
{
    return client->exception;
}

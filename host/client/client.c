#include "client/client.h"

#include <errno.h>
#include <modbus.h>
#include <stdio.h>
#include <string.h>

#define US_PER_MS 1000

/* An exception code of libmodbus is this plus its number. */
#define EXCEPTION_BASE MODBUS_ENOBASE

static void remember_problem(struct client *client)
{
    const int reason = errno;

    client->exception = reason > EXCEPTION_BASE && reason < EXCEPTION_BASE + MODBUS_EXCEPTION_MAX
                            ? reason - EXCEPTION_BASE
                            : 0;
    (void)snprintf(client->problem, sizeof client->problem, "%s", modbus_strerror(reason));
}

static modbus_t *new_context(const struct client_config *config)
{
    if (config->host != NULL)
        return modbus_new_tcp_pi(config->host, config->port);
    return modbus_new_rtu(config->path, (int)config->bauds, config->parity, 8,
                          config->parity == 'N' ? 2 : 1);
}

/*
 * A pause within an answer may be as long as that before it: a busy computer makes pauses where
 * the line has none, and what comes after would be taken for the next answer.
 */
static bool connect_context(modbus_t *context, const struct client_config *config)
{
    const uint32_t seconds = config->timeout_ms / 1000;
    const uint32_t us = config->timeout_ms % 1000 * US_PER_MS;

    return modbus_set_slave(context, config->unit) == 0 &&
           modbus_set_response_timeout(context, seconds, us) == 0 &&
           modbus_set_byte_timeout(context, seconds, us) == 0 && modbus_connect(context) == 0;
}

bool client_open(struct client *client, const struct client_config *config)
{
    modbus_t *context = new_context(config);

    memset(client, 0, sizeof *client);
    if (context != NULL && connect_context(context, config)) {
        client->context = context;
        return true;
    }
    remember_problem(client);
    if (context != NULL)
        modbus_free(context);
    return false;
}

void client_close(struct client *client)
{
    if (client->context == NULL)
        return;
    modbus_close(client->context);
    modbus_free(client->context);
    client->context = NULL;
}

static int read_coils(modbus_t *context, int address, int count, uint16_t *word)
{
    uint8_t bit[CLIENT_READ_MAX];
    const int got = modbus_read_bits(context, address, count, bit);

    for (int i = 0; i < got; i++)
        word[i] = bit[i];
    return got;
}

static int write_coils(modbus_t *context, int address, int count, const uint16_t *word)
{
    uint8_t bit[CLIENT_WRITE_MAX];

    for (int i = 0; i < count; i++)
        bit[i] = word[i] != 0;
    if (count == 1)
        return modbus_write_bit(context, address, bit[0]);
    return modbus_write_bits(context, address, count, bit);
}

static bool end_request(struct client *client, int done, unsigned count)
{
    client->exception = 0;
    if (done == (int)count)
        return true;
    remember_problem(client);
    return false;
}

bool client_read(struct client *client, enum client_table table, uint16_t address, unsigned count,
                 uint16_t *word)
{
    int done = -1;

    switch (table) {
    case CLIENT_COILS:
        done = read_coils(client->context, address, (int)count, word);
        break;
    case CLIENT_INPUTS:
        done = modbus_read_input_registers(client->context, address, (int)count, word);
        break;
    case CLIENT_HOLDINGS:
        done = modbus_read_registers(client->context, address, (int)count, word);
        break;
    }
    return end_request(client, done, count);
}

bool client_write(struct client *client, enum client_table table, uint16_t address, unsigned count,
                  const uint16_t *word)
{
    int done;

    if (table == CLIENT_COILS)
        done = write_coils(client->context, address, (int)count, word);
    else if (count == 1)
        done = modbus_write_register(client->context, address, word[0]);
    else
        done = modbus_write_registers(client->context, address, (int)count, word);
    return end_request(client, done, count);
}

const char *client_get_problem(const struct client *client)
{
    return client->problem;
}

int client_get_exception(const struct client *client)
{
    return client->exception;
}

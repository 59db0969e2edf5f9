/*
 * A Modbus client over libmodbus: TCP, or RTU on a serial line. Calls wait for the answer.
 */
#ifndef TAKT_CLIENT_CLIENT_H
#define TAKT_CLIENT_CLIENT_H

#include <stdbool.h>
#include <stdint.h>

#define CLIENT_PROBLEM_MAX 255

/* Most that one request may name; more is an error. */
#define CLIENT_READ_MAX  125
#define CLIENT_WRITE_MAX 123

enum client_table { CLIENT_COILS, CLIENT_INPUTS, CLIENT_HOLDINGS };

struct client_config {
    const char *host, *port; /* TCP; NULL: the serial line */
    const char *path;
    uint32_t bauds;
    char parity; /* 'E', 'O', 'N': two stop bits */
    uint8_t unit;
    uint32_t timeout_ms; /* of connecting, of an answer, and of a pause within it */
};

struct client {
    void *context; /* libmodbus's */
    int exception; /* of the last request; 0: it is no exception that went wrong */
    char problem[CLIENT_PROBLEM_MAX + 1];
};

/* False: client_get_problem says why; nothing is open. */
bool client_open(struct client *client, const struct client_config *config);
void client_close(struct client *client);

/* count registers from address; of coils one word each, 0 or 1. False: problem or exception. */
bool client_read(struct client *client, enum client_table table, uint16_t address, unsigned count,
                 uint16_t *word);
bool client_write(struct client *client, enum client_table table, uint16_t address, unsigned count,
                  const uint16_t *word);

/* What went wrong last, as a text. */
const char *client_get_problem(const struct client *client);

/* Code of the exception the last request was answered by; 0: it was not. */
int client_get_exception(const struct client *client);

#endif

/*
 * The host's port of hal/registers.h: a thread with libmodbus, so that whoever asks never waits. A
 * line that is lost is opened again, until it is there.
 */
#ifndef TAKT_CLIENT_REGISTERS_CLIENT_H
#define TAKT_CLIENT_REGISTERS_CLIENT_H

#include "client/client.h"
#include "hal/registers.h"

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* Between two attempts to open the line, ms. */
#define REGISTERS_CLIENT_RETRY_MS 500

struct registers_client {
    struct client_config config;
    struct client client;
    bool is_open; /* the line; the thread's */
    pthread_t thread;
    bool is_running;
    atomic_bool ends;
    sem_t asked;
    atomic_uint stage;

    bool writes; /* the request */
    uint16_t address, count;
    uint16_t word[REGISTERS_MAX];
    bool good; /* the answer */
};

/* Starts the thread; texts of the configuration stay the caller's. False: the system has none. */
bool registers_client_start(struct registers_client *client, const struct client_config *config);
void registers_client_stop(struct registers_client *client);

struct registers_port registers_client_get_port(struct registers_client *client);

#endif

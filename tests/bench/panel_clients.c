/*
 * Clients of a panel that poll as fast as they can, each a thread with libmodbus: how long their
 * replies take.
 *
 *     panel_clients PORT CLIENTS SECONDS
 */
#define _POSIX_C_SOURCE 200809L

#include "client/client.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define CLIENTS_MAX 200
#define WORDS       50
#define STEP_US     10
#define STEPS       100000

struct poller {
    const char *port;
    pthread_t thread;
    unsigned long requests, failures;
};

static atomic_bool is_over;
static atomic_uint steps[STEPS + 1]; /* of STEP_US; the last holds everything beyond */

static double now_us(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static void poll_once(struct poller *poller, struct client *client)
{
    uint16_t word[WORDS];
    const double start_us = now_us();
    unsigned step;

    if (!client_read(client, CLIENT_INPUTS, 0, WORDS, word))
        poller->failures++;
    step = (unsigned)((now_us() - start_us) / STEP_US);
    steps[step < STEPS ? step : STEPS]++;
    poller->requests++;
}

static void *run(void *context)
{
    struct poller *poller = context;
    const struct client_config config = {
        .host = "127.0.0.1", .port = poller->port, .unit = 1, .timeout_ms = 10000};
    struct client client;

    if (!client_open(&client, &config)) {
        poller->failures++;
        return NULL;
    }
    while (!atomic_load(&is_over))
        poll_once(poller, &client);
    client_close(&client);
    return NULL;
}

/* The time that a part of all replies did not exceed. */
static double quantile_us(unsigned long total, double part)
{
    unsigned long seen = 0;

    for (unsigned i = 0; i < STEPS; i++) {
        seen += steps[i];
        if ((double)seen >= part * (double)total)
            return (double)(i + 1) * STEP_US;
    }
    return (double)STEPS * STEP_US;
}

static void report(const struct poller *poller, unsigned count, double time_s)
{
    unsigned long requests = 0, failures = 0;

    for (unsigned i = 0; i < count; i++) {
        requests += poller[i].requests;
        failures += poller[i].failures;
    }
    (void)printf("%u clients, %.0f s: %lu requests (%.0f a second), %lu failed\n", count, time_s,
                 requests, (double)requests / time_s, failures);
    (void)printf("  reply: median %.2f ms, 99 %%: %.2f ms, 99.9 %%: %.2f ms, max: %.2f ms\n",
                 1e-3 * quantile_us(requests, 0.5), 1e-3 * quantile_us(requests, 0.99),
                 1e-3 * quantile_us(requests, 0.999), 1e-3 * quantile_us(requests, 1.0));
}

int main(int argc, char **argv)
{
    static struct poller poller[CLIENTS_MAX];
    const unsigned count = argc == 4 ? (unsigned)strtoul(argv[2], NULL, 10) : 0;
    const double time_s = argc == 4 ? strtod(argv[3], NULL) : 0;
    const struct timespec time = {.tv_sec = (time_t)time_s};

    if (count < 1 || count > CLIENTS_MAX || time_s < 1) {
        (void)fprintf(stderr, "usage: panel_clients PORT CLIENTS SECONDS\n");
        return 2;
    }
    for (unsigned i = 0; i < count; i++) {
        poller[i].port = argv[1];
        if (pthread_create(&poller[i].thread, NULL, run, &poller[i]) != 0)
            return 3;
    }
    (void)nanosleep(&time, NULL);
    atomic_store(&is_over, true);
    for (unsigned i = 0; i < count; i++)
        (void)pthread_join(poller[i].thread, NULL);
    report(poller, count, time_s);
    return 0;
}

#define _POSIX_C_SOURCE 200809L

#include "client/registers_client.h"

#include <signal.h>
#include <string.h>
#include <time.h>

/* Whose turn it is. */
enum { STAGE_FREE, STAGE_ASKED, STAGE_ANSWERED };

#define NS_PER_MS 1000000L

/* The line is opened when it is needed. */
static bool is_ready(struct registers_client *c)
{
    const struct timespec pause = {.tv_nsec = REGISTERS_CLIENT_RETRY_MS * NS_PER_MS};

    if (!c->is_open)
        c->is_open = client_open(&c->client, &c->config);
    if (!c->is_open)
        (void)nanosleep(&pause, NULL);
    return c->is_open;
}

static bool ask(struct registers_client *c)
{
    if (c->writes)
        return client_write(&c->client, CLIENT_HOLDINGS, c->address, c->count, c->word);
    return client_read(&c->client, CLIENT_HOLDINGS, c->address, c->count, c->word);
}

/* An exception is an answer of the line; anything else that fails may be the line's end. */
static void serve(struct registers_client *c)
{
    c->good = is_ready(c) && ask(c);
    if (c->is_open && !c->good && client_get_exception(&c->client) == 0) {
        client_close(&c->client);
        c->is_open = false;
    }
    atomic_store(&c->stage, STAGE_ANSWERED);
}

static void *run(void *context)
{
    struct registers_client *c = context;

    while (!atomic_load(&c->ends)) {
        if (sem_wait(&c->asked) == 0 && !atomic_load(&c->ends))
            serve(c);
    }
    return NULL;
}

bool registers_client_start(struct registers_client *c, const struct client_config *config)
{
    sigset_t all, before;

    memset(c, 0, sizeof *c);
    c->config = *config;
    atomic_init(&c->ends, false);
    atomic_init(&c->stage, STAGE_FREE);
    if (sem_init(&c->asked, 0, 0) != 0)
        return false;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    c->is_running = pthread_create(&c->thread, NULL, run, c) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return c->is_running;
}

void registers_client_stop(struct registers_client *c)
{
    if (!c->is_running)
        return;
    atomic_store(&c->ends, true);
    (void)sem_post(&c->asked);
    (void)pthread_join(c->thread, NULL);
    (void)sem_destroy(&c->asked);
    if (c->is_open)
        client_close(&c->client);
    c->is_running = false;
}

static void begin(struct registers_client *c, bool writes, uint16_t address, uint16_t count)
{
    c->writes = writes;
    c->address = address;
    c->count = count;
    atomic_store(&c->stage, STAGE_ASKED);
    (void)sem_post(&c->asked);
}

static void begin_read(void *context, uint16_t address, uint16_t count)
{
    begin(context, false, address, count);
}

static void begin_write(void *context, uint16_t address, uint16_t count, const uint16_t *word)
{
    struct registers_client *c = context;

    memcpy(c->word, word, count * sizeof word[0]);
    begin(c, true, address, count);
}

static enum registers_answer take(void *context, uint16_t *word)
{
    struct registers_client *c = context;

    if (atomic_load(&c->stage) != STAGE_ANSWERED)
        return REGISTERS_WAITING;
    atomic_store(&c->stage, STAGE_FREE);
    memcpy(word, c->word, sizeof c->word);
    return c->good ? REGISTERS_DONE : REGISTERS_FAILED;
}

struct registers_port registers_client_get_port(struct registers_client *client)
{
    return (struct registers_port){
        .read = begin_read, .write = begin_write, .take = take, .context = client};
}

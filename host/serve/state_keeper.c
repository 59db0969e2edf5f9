#define _POSIX_C_SOURCE 200809L

#include "serve/state_keeper.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

static bool is_kept(const struct store *store, const char *text, size_t length)
{
    const uint8_t *bytes;
    uint32_t size;

    return takt_store_get(store, &bytes, &size) && size == length &&
           memcmp(bytes, text, length) == 0;
}

bool state_keeper_keep(struct store *store, const struct state *state)
{
    size_t length = 0;
    char *text = state_write(state, &length);
    bool good = text != NULL && length <= takt_store_room(store);

    if (good && !is_kept(store, text, length))
        good = takt_store_begin(store, (uint32_t)length) &&
               takt_store_write(store, (const uint8_t *)text, length) && takt_store_commit(store);
    free(text);
    return good;
}

bool state_keeper_open(struct state_keeper *k, const char *folder, size_t tools_max)
{
    struct flash_port port;

    memset(k, 0, sizeof *k);
    k->offered.tools_max = tools_max;
    k->offered.tools = calloc(tools_max > 0 ? tools_max : 1, sizeof *k->offered.tools);
    if (k->offered.tools == NULL || !state_disk_open(&k->disk, folder, STATE_KEEPER_BYTES)) {
        free(k->offered.tools);
        return false;
    }
    port = state_disk_get_port(&k->disk);
    takt_store_open(&k->store, &port);
    atomic_init(&k->is_full, false);
    atomic_init(&k->has_failed, false);
    return true;
}

const char *state_keeper_get(const struct state_keeper *k, size_t *length)
{
    const uint8_t *bytes;
    uint32_t size;

    if (!takt_store_get(&k->store, &bytes, &size))
        return NULL;
    *length = size;
    return (const char *)bytes;
}

bool state_keeper_has_lost(const struct state_keeper *k)
{
    size_t length;

    return k->disk.was_there && state_keeper_get(k, &length) == NULL;
}

static void wait_for_wake(struct state_keeper *k)
{
    while (sem_wait(&k->wake) != 0 && errno == EINTR) {
    }
}

static void *run(void *context)
{
    struct state_keeper *k = context;

    for (;;) {
        wait_for_wake(k);
        if (!atomic_load(&k->is_full))
            return NULL;
        atomic_store(&k->has_failed, !state_keeper_keep(&k->store, &k->offered));
        atomic_store(&k->is_full, false);
    }
}

bool state_keeper_start(struct state_keeper *k)
{
    sigset_t all, before;

    if (sem_init(&k->wake, 0, 0) != 0)
        return false;
    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    k->is_running = pthread_create(&k->thread, NULL, run, k) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return k->is_running;
}

struct state *state_keeper_wants(struct state_keeper *k, uint64_t now_ns)
{
    if (!k->is_running || now_ns - k->offered_ns < STATE_KEEPER_OFFER_NS ||
        atomic_load(&k->is_full))
        return NULL;
    k->offered_ns = now_ns;
    return &k->offered;
}

void state_keeper_offer(struct state_keeper *k)
{
    atomic_store(&k->is_full, true);
    (void)sem_post(&k->wake);
}

bool state_keeper_has_failed(const struct state_keeper *k)
{
    return atomic_load(&k->has_failed);
}

/* A wake without an offer ends the thread: what was offered before has been kept by then. */
static void stop(struct state_keeper *k)
{
    if (!k->is_running)
        return;
    (void)sem_post(&k->wake);
    (void)pthread_join(k->thread, NULL);
    (void)sem_destroy(&k->wake);
    k->is_running = false;
}

bool state_keeper_close(struct state_keeper *k, const struct state *last)
{
    bool good = true;

    stop(k);
    if (last != NULL)
        good = state_keeper_keep(&k->store, last);
    state_disk_close(&k->disk);
    free(k->offered.tools);
    return good;
}

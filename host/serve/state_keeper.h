/*
 * Keeps a state on the disk, in a thread of its own: the control cycle hands over a copy now and
 * then and never waits.
 *
 *     offer (control thread)  ->  text  ->  store, of two generations  ->  disk
 *
 * A change is offered within STATE_KEEPER_OFFER_NS; what fails is told once and tried again with
 * the next offer.
 */
#ifndef TAKT_SERVE_STATE_KEEPER_H
#define TAKT_SERVE_STATE_KEEPER_H

#include "serve/state.h"
#include "serve/state_disk.h"
#include "storage/store.h"

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/*
 * After a power cut a state is at most so old, or as old as the write takes that a change had to
 * wait for, and as long as its own write takes, which was cut: a second, where a write takes half
 * of one.
 */
#define STATE_KEEPER_OFFER_NS UINT64_C(250000000)

/* Room of a generation: all parameters take 32 KiB, a tool 0.2 KiB. */
#define STATE_KEEPER_BYTES 1048576U

/* It must not be moved once opened. Private. */
struct state_keeper {
    struct state_disk disk;
    struct store store;
    struct state offered; /* the thread's while it is full */
    atomic_bool is_full;
    atomic_bool has_failed; /* the last write has */
    bool is_running;
    sem_t wake;
    pthread_t thread;
    uint64_t offered_ns;
};

/*
 * folder: is there. tools_max: that a state has. False: errno says why.
 */
bool state_keeper_open(struct state_keeper *keeper, const char *folder, size_t tools_max);
/* What was kept last. NULL: nothing. Valid until the first offer. */
const char *state_keeper_get(const struct state_keeper *keeper, size_t *length);
/* Something was kept, and neither generation of it is whole. */
bool state_keeper_has_lost(const struct state_keeper *keeper);

bool state_keeper_start(struct state_keeper *keeper);
/*
 * Control thread: the place for a state, when it is time and the last one has been kept; followed
 * by state_keeper_offer.
 */
struct state *state_keeper_wants(struct state_keeper *keeper, uint64_t now_ns);
void state_keeper_offer(struct state_keeper *keeper);
bool state_keeper_has_failed(const struct state_keeper *keeper);

/*
 * Ends the thread after what has been offered; then keeps this last state, and closes. NULL: none.
 * False: not kept.
 */
bool state_keeper_close(struct state_keeper *keeper, const struct state *last);

/* Writes a state into a store, unless it is what the store has. False: it could not be kept. */
bool state_keeper_keep(struct store *store, const struct state *state);

#endif

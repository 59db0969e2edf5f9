/*
 * A program planned ahead (takt compile) on its way in: streamed through the panel's mailbox,
 * checked as soon as its header is there, and replayed while it comes.
 *
 * The panel brings bytes, the controller's background takes them: these two may be two threads.
 * Everything else is called by the control thread, between two cycles, and for what the panel has
 * ordered while the panel waits.
 */
#ifndef TAKT_PORT_PLAN_QUEUE_H
#define TAKT_PORT_PLAN_QUEUE_H

#include "panel/upload.h"
#include "replay/fit.h"
#include "replay/intake.h"
#include "service/service.h"

#include <stdalign.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/*
 * Bytes, a power of two: some 1.3 s of motion beside the 2 s that the replay itself holds. A build
 * may have others, for two chunks of the panel at least.
 */
#ifndef PLAN_QUEUE_MAX
#define PLAN_QUEUE_MAX 4096
#endif

enum plan_queue_state {
    PLAN_QUEUE_NONE,    /* what still comes is dropped */
    PLAN_QUEUE_COMING,  /* announced, its header is not there yet */
    PLAN_QUEUE_FITS,    /* it may be started, once */
    PLAN_QUEUE_REFUSED, /* it does not fit */
    PLAN_QUEUE_LOST     /* the end has come too early, or it was not what was announced */
};

struct plan_queue {
    const struct service *service; /* whose machine and program it has to fit: */
    struct replay_fit fit;         /* as they were when it was announced */
    atomic_uint state;
    atomic_uint written; /* bytes so far */
    atomic_uint read;
    uint8_t header[REPLAY_HEADER_BYTES];
    alignas(8) uint8_t byte[PLAN_QUEUE_MAX];
    struct diagnostic why; /* it was refused; TAKT_OK: it was not */
};

void takt_plan_queue_init(struct plan_queue *q, const struct service *service);

/* What the panel brings its bytes to. */
struct panel_store takt_plan_queue_get_store(struct plan_queue *q);

/*
 * Its PLAN_QUEUE_MAX bytes, at a multiple of 8, for something else while no program runs; a plan
 * that waits is given up.
 */
void *takt_plan_queue_lend(struct plan_queue *q);

/* What the service starts. */
struct service_plans takt_plan_queue_get_plans(struct plan_queue *q);

#endif

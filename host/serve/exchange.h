/*
 * Between the thread of the control cycle and the thread of the panel: snapshots one way, orders
 * the other.
 *
 * The control cycle never waits here: it writes snapshots into a buffer that nobody else holds, and
 * looks whether an order lies there. The panel waits for the answer to its order, a cycle at most,
 * or gives it up.
 */
#ifndef TAKT_SERVE_EXCHANGE_H
#define TAKT_SERVE_EXCHANGE_H

#include "panel/snapshot.h"

#include <semaphore.h>
#include <stdatomic.h>
#include <stdbool.h>

/* So long the panel waits for the control cycle to take an order. */
#define EXCHANGE_PATIENCE_MS 250

struct exchange {
    /* One is the writer's, one the reader's, one in between: it holds the latest when fresh. */
    struct panel_snapshot snapshot[3];
    unsigned writing; /* of the control thread */
    unsigned reading; /* of the panel's thread */
    atomic_uint between;

    struct panel_order order;
    void (*task)(void *context); /* asked instead of an order; NULL: an order is */
    void *task_context;
    enum panel_verdict verdict;
    atomic_uint stage;
    sem_t answered;
    atomic_bool heard;
};

/* False: the system refuses. */
bool exchange_open(struct exchange *exchange);
void exchange_close(struct exchange *exchange);

/* Control thread. The snapshot to fill, followed by exchange_publish. */
struct panel_snapshot *exchange_next_snapshot(struct exchange *exchange);
void exchange_publish(struct exchange *exchange);
/*
 * Control thread. Does the task that has been asked for. An order, to be answered once a snapshot
 * that shows it is published; NULL: there is none.
 */
const struct panel_order *exchange_take_order(struct exchange *exchange);
void exchange_answer(struct exchange *exchange, enum panel_verdict verdict);
/* Control thread. The panel in control has been heard since the last call. */
bool exchange_take_alive(struct exchange *exchange);

/*
 * Panel thread: has the control thread do something short, between two cycles. False: it has not.
 */
bool exchange_ask(struct exchange *exchange, void (*task)(void *context), void *context);

/* Panel thread: what a panel stands on. */
struct panel_port exchange_get_port(struct exchange *exchange);

#endif

#define _POSIX_C_SOURCE 200809L

#include "serve/exchange.h"

#include <errno.h>
#include <string.h>
#include <time.h>

/* Flag in the middle index: set when the reader has not seen it. */
#define FRESH      4U
#define INDEX_MASK 3U

/* Stages of an order. */
enum { STAGE_EMPTY, STAGE_ASKED, STAGE_TAKEN };

#define NS_PER_MS     1000000L
#define NS_PER_SECOND 1000000000L

bool exchange_open(struct exchange *exchange)
{
    memset(exchange, 0, sizeof *exchange);
    exchange->writing = 0;
    exchange->reading = 1;
    atomic_init(&exchange->between, 2U);
    atomic_init(&exchange->stage, STAGE_EMPTY);
    atomic_init(&exchange->heard, false);
    return sem_init(&exchange->answered, 0, 0) == 0;
}

void exchange_close(struct exchange *exchange)
{
    (void)sem_destroy(&exchange->answered);
}

struct panel_snapshot *exchange_next_snapshot(struct exchange *exchange)
{
    return &exchange->snapshot[exchange->writing];
}

void exchange_publish(struct exchange *exchange)
{
    exchange->writing = atomic_exchange(&exchange->between, exchange->writing | FRESH) & INDEX_MASK;
}

const struct panel_order *exchange_take_order(struct exchange *exchange)
{
    unsigned asked = STAGE_ASKED;

    if (!atomic_compare_exchange_strong(&exchange->stage, &asked, STAGE_TAKEN))
        return NULL;
    if (exchange->task == NULL)
        return &exchange->order;
    exchange->task(exchange->task_context);
    exchange_answer(exchange, PANEL_DONE);
    return NULL;
}

void exchange_answer(struct exchange *exchange, enum panel_verdict verdict)
{
    exchange->verdict = verdict;
    atomic_store(&exchange->stage, STAGE_EMPTY);
    (void)sem_post(&exchange->answered);
}

bool exchange_take_alive(struct exchange *exchange)
{
    return atomic_exchange(&exchange->heard, false);
}

static void look(void *context, struct panel_snapshot *snapshot)
{
    struct exchange *exchange = context;

    if ((atomic_load(&exchange->between) & FRESH) != 0)
        exchange->reading = atomic_exchange(&exchange->between, exchange->reading) & INDEX_MASK;
    *snapshot = exchange->snapshot[exchange->reading];
}

/* False: not answered in time. */
static bool wait_for_answer(struct exchange *exchange)
{
    struct timespec until;

    (void)clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += EXCHANGE_PATIENCE_MS * NS_PER_MS;
    until.tv_sec += until.tv_nsec / NS_PER_SECOND;
    until.tv_nsec %= NS_PER_SECOND;
    while (sem_timedwait(&exchange->answered, &until) != 0) {
        if (errno != EINTR)
            return false;
    }
    return true;
}

/* What is asked stands there. */
static enum panel_verdict ask(struct exchange *exchange)
{
    unsigned asked = STAGE_ASKED;

    atomic_store(&exchange->stage, STAGE_ASKED);
    if (wait_for_answer(exchange))
        return exchange->verdict;
    if (atomic_compare_exchange_strong(&exchange->stage, &asked, STAGE_EMPTY))
        return PANEL_TRY_AGAIN;
    /* It was taken at the last moment: the answer comes before the cycle is over. */
    while (sem_wait(&exchange->answered) != 0) {
    }
    return exchange->verdict;
}

static enum panel_verdict give_order(void *context, const struct panel_order *order)
{
    struct exchange *exchange = context;

    exchange->order = *order;
    exchange->task = NULL;
    return ask(exchange);
}

bool exchange_ask(struct exchange *exchange, void (*task)(void *context), void *context)
{
    exchange->task = task;
    exchange->task_context = context;
    return ask(exchange) == PANEL_DONE;
}

static void hear(void *context)
{
    struct exchange *exchange = context;

    atomic_store(&exchange->heard, true);
}

struct panel_port exchange_get_port(struct exchange *exchange)
{
    return (struct panel_port){
        .look = look, .order = give_order, .alive = hear, .context = exchange};
}

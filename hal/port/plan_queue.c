#include "port/plan_queue.h"

#include <string.h>

void takt_plan_queue_init(struct plan_queue *q, const struct service *service)
{
    memset(q, 0, sizeof *q);
    q->service = service;
}

static enum plan_queue_state state_of(struct plan_queue *q)
{
    return (enum plan_queue_state)atomic_load(&q->state);
}

/* -- panel -- */

/* The order that goes before has emptied it. */
static bool begin_stream(void *context, uint32_t size)
{
    struct plan_queue *q = context;

    return size >= REPLAY_HEADER_BYTES && state_of(q) == PLAN_QUEUE_COMING;
}

static uint32_t room(void *context)
{
    struct plan_queue *q = context;

    return PLAN_QUEUE_MAX - (atomic_load(&q->written) - atomic_load(&q->read));
}

/* The header is there: what is wrong with it? */
static bool check(struct plan_queue *q)
{
    struct replay_header header;
    const bool fits = takt_replay_fit_read(&header, q->header, &q->why) &&
                      takt_replay_fit_machine(&header, &q->fit, &q->why) &&
                      takt_replay_fit_text(&header, &q->fit, &q->why);

    atomic_store(&q->state, fits ? PLAN_QUEUE_FITS : PLAN_QUEUE_REFUSED);
    return fits;
}

static void copy_in(struct plan_queue *q, uint32_t at, const uint8_t *data, size_t length)
{
    const size_t place = at % PLAN_QUEUE_MAX;
    const size_t first = length < PLAN_QUEUE_MAX - place ? length : PLAN_QUEUE_MAX - place;

    memcpy(q->byte + place, data, first);
    memcpy(q->byte, data + first, length - first);
}

static void keep_header(struct plan_queue *q, uint32_t offset, const uint8_t *data, size_t length)
{
    for (size_t i = 0; i < length && offset + i < REPLAY_HEADER_BYTES; i++)
        q->header[offset + i] = data[i];
}

/* What comes after the program has ended is of no use to anybody, and no fault. */
static bool bring(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct plan_queue *q = context;
    const uint32_t written = atomic_load(&q->written);

    if (state_of(q) == PLAN_QUEUE_NONE)
        return true;
    if (state_of(q) == PLAN_QUEUE_REFUSED || offset != written || length > room(q))
        return false;
    copy_in(q, written, data, length);
    keep_header(q, offset, data, length);
    atomic_store(&q->written, written + (uint32_t)length);
    return state_of(q) != PLAN_QUEUE_COMING || offset + length < REPLAY_HEADER_BYTES || check(q);
}

static void end_stream(void *context, bool right)
{
    struct plan_queue *q = context;

    if (!right && state_of(q) != PLAN_QUEUE_NONE)
        atomic_store(&q->state, PLAN_QUEUE_LOST);
}

static void why(void *context, char *text)
{
    const struct plan_queue *q = context;

    _Static_assert(DIAGNOSTIC_TEXT_MAX <= PANEL_ALARM_TEXT_MAX, "there is room for it");
    if (q->why.code != TAKT_OK)
        (void)takt_diagnostic_text(&q->why, text);
}

struct panel_store takt_plan_queue_get_store(struct plan_queue *q)
{
    return (struct panel_store){.write = bring,
                                .begin_stream = begin_stream,
                                .end_stream = end_stream,
                                .why = why,
                                .room = room,
                                .context = q};
}

/* -- control -- */

static size_t take(void *context, uint8_t *bytes, size_t size)
{
    struct plan_queue *q = context;
    const uint32_t read = atomic_load(&q->read);
    const uint32_t there = atomic_load(&q->written) - read;
    const size_t count = size < there ? size : there;

    for (size_t i = 0; i < count; i++)
        bytes[i] = q->byte[(read + i) % PLAN_QUEUE_MAX];
    atomic_store(&q->read, read + (uint32_t)count);
    return count;
}

static bool is_lost(void *context)
{
    return state_of(context) == PLAN_QUEUE_LOST;
}

static void announce(void *context)
{
    struct plan_queue *q = context;
    const struct service *s = q->service;

    q->fit = (struct replay_fit){.cycle_us = s->controller.machine.cycle_us,
                                 .limits = s->controller.path.limits,
                                 .text_size = s->program_size,
                                 .text_crc = s->program_crc};
    q->why.code = TAKT_OK;
    atomic_store(&q->read, 0);
    atomic_store(&q->written, 0);
    atomic_store(&q->state, PLAN_QUEUE_COMING);
}

static void forget(void *context)
{
    atomic_store(&((struct plan_queue *)context)->state, PLAN_QUEUE_NONE);
}

static enum service_plan open(void *context, struct replay_source *source)
{
    struct plan_queue *q = context;

    *source = (struct replay_source){.context = q, .read = take, .is_lost = is_lost};
    switch (state_of(q)) {
    case PLAN_QUEUE_NONE:
        return SERVICE_PLAN_NONE;
    case PLAN_QUEUE_FITS:
        return SERVICE_PLAN_READY;
    case PLAN_QUEUE_COMING:
    case PLAN_QUEUE_REFUSED:
    case PLAN_QUEUE_LOST:
        break;
    }
    return SERVICE_PLAN_UNFIT;
}

struct service_plans takt_plan_queue_get_plans(struct plan_queue *q)
{
    return (struct service_plans){
        .announce = announce, .open = open, .forget = forget, .context = q};
}

void *takt_plan_queue_lend(struct plan_queue *q)
{
    forget(q);
    atomic_store(&q->read, atomic_load(&q->written));
    return q->byte;
}

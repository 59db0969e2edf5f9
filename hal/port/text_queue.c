#include "port/text_queue.h"

#include <string.h>

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

void takt_text_queue_init(struct text_queue *q)
{
    memset(q, 0, sizeof *q);
}

void takt_text_queue_use(struct text_queue *q, bool in_use)
{
    q->in_use = in_use;
}

static bool begin_any(struct text_queue *q, uint32_t size, bool is_stream)
{
    if (q->in_use)
        return false;
    q->size = size;
    q->written = 0;
    q->read = 0;
    q->at = 0;
    q->is_stream = is_stream;
    q->is_wrong = false;
    q->is_whole = false;
    q->has_program = false;
    return true;
}

/* What was there before is gone: there is no memory for two. */
static bool begin(void *context, uint32_t size)
{
    return size <= TEXT_QUEUE_MAX && begin_any(context, size, false);
}

static bool begin_stream(void *context, uint32_t size)
{
    return begin_any(context, size, true);
}

static uint32_t room(void *context)
{
    const struct text_queue *q = context;

    return least(TEXT_QUEUE_MAX - (q->written - q->read), q->size - q->written);
}

/* From one place of the ring on: two pieces where it begins again. */
static void copy_in(struct text_queue *q, const uint8_t *data, size_t length)
{
    const size_t at = q->written % TEXT_QUEUE_MAX;
    const size_t first = length < TEXT_QUEUE_MAX - at ? length : TEXT_QUEUE_MAX - at;

    memcpy(q->byte + at, data, first);
    memcpy(q->byte, data + first, length - first);
}

static bool bring(void *context, uint32_t offset, const uint8_t *data, size_t length)
{
    struct text_queue *q = context;

    if (offset != q->written || length > room(q))
        return false;
    copy_in(q, data, length);
    q->written += (uint32_t)length;
    return true;
}

/* Memory that forgets at power-off has nothing to make durable. */
static bool prepare(void *context)
{
    (void)context;
    return true;
}

static void end(void *context, bool right)
{
    struct text_queue *q = context;

    q->is_whole = right;
    q->is_wrong = !right;
}

struct panel_store takt_text_queue_get_store(struct text_queue *q)
{
    return (struct panel_store){.begin = begin,
                                .write = bring,
                                .prepare = prepare,
                                .place = prepare,
                                .begin_stream = begin_stream,
                                .end_stream = end,
                                .room = room,
                                .context = q};
}

/* Where the last whole line that has come ends; reading is before it or there. */
static uint32_t end_of_lines(const struct text_queue *q)
{
    uint32_t to = q->written;

    while (to != q->at && q->byte[(to - 1) % TEXT_QUEUE_MAX] != '\n')
        to--;
    return to;
}

/*
 * How far may be read: a program is read in whole lines, so a streamed one is handed out up to the
 * end of a line. One that fills the queue is too long for any program: it is handed out as it is,
 * to be refused.
 */
static uint32_t readable(const struct text_queue *q)
{
    const bool is_full = q->written - q->read == TEXT_QUEUE_MAX;
    const uint32_t to = end_of_lines(q);

    if (!q->is_stream || q->is_whole || (is_full && to == q->at))
        return q->written;
    return to;
}

static long read_bytes(void *context, char *buffer, size_t size)
{
    struct text_queue *q = context;
    const uint32_t place = q->at % TEXT_QUEUE_MAX;
    uint32_t count;

    if (q->is_wrong)
        return SOURCE_ERROR;
    count = least(readable(q) - q->at, TEXT_QUEUE_MAX - place);
    if (count == 0)
        return q->at == q->size ? SOURCE_END : SOURCE_LATER;
    count = count < size ? count : (uint32_t)size;
    memcpy(buffer, q->byte + place, count);
    q->at += count;
    if (q->is_stream)
        q->read = q->at;
    return (long)count;
}

static bool seek(void *context, uint64_t offset)
{
    struct text_queue *q = context;

    if (offset > q->size)
        return false;
    q->at = (uint32_t)offset;
    return true;
}

bool takt_text_queue_open(void *queue, struct source *source)
{
    struct text_queue *q = queue;

    if (!q->has_program || q->read != 0)
        return false;
    q->at = 0;
    *source = (struct source){.read = read_bytes, .seek = q->is_stream ? NULL : seek, .context = q};
    return true;
}

void takt_text_queue_adopt(void *queue)
{
    struct text_queue *q = queue;

    q->has_program = true;
}

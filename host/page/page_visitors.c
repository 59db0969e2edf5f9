#define _POSIX_C_SOURCE 200809L

#include "page/page_visitors.h"

#include "page/page_json.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Longest message of a page: pieces of an upload are shorter. */
#define MESSAGE_MAX 65536

#define US_PER_MS 1000

static_assert(PAGE_TEXT_HEAD >= LWS_PRE, "texts can be sent as they are");

static double now_ms(clockid_t clock)
{
    struct timespec now;

    (void)clock_gettime(clock, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* ---- texts to pages ---- */

static void queue_text(struct page_visitor *s, const struct page_text *text)
{
    struct page_waiting *place = &s->queue[s->queued];

    if (text->length == 0 || text->has_failed)
        return;
    if (s->queued == PAGE_QUEUE_MAX) {
        lws_set_timeout(s->wsi, PENDING_TIMEOUT_CLOSE_SEND, LWS_TO_KILL_ASYNC);
        return;
    }
    place->bytes = malloc(LWS_PRE + text->length);
    if (place->bytes == NULL)
        return;
    memcpy(place->bytes + LWS_PRE, page_text_get(text), text->length);
    place->length = text->length;
    s->queued++;
    lws_callback_on_writable(s->wsi);
}

static void tell_all(void *context, const struct page_text *text)
{
    struct page_visitors *all = context;

    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        if (all->visitor[i] != NULL)
            queue_text(all->visitor[i], text);
    }
}

static void tell_one(void *context, unsigned page, const struct page_text *text)
{
    struct page_visitors *all = context;

    if (page < PANEL_HOST_PAGES && all->visitor[page] != NULL)
        queue_text(all->visitor[page], text);
}

static int next_watched(void *context, int drive)
{
    const struct page_visitors *all = context;
    int next = -1, first = -1;

    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        const int watched = all->visitor[i] != NULL ? all->visitor[i]->client.watched : -1;

        if (watched > drive && (next < 0 || watched < next))
            next = watched;
        if (watched >= 0 && (first < 0 || watched < first))
            first = watched;
    }
    return next >= 0 ? next : first;
}

/* Frames are not queued: who reads slowly sees fewer of them. */
static int send_frame(struct page_visitors *all, struct page_visitor *s)
{
    const struct page_data *data = &all->data;
    struct page_text *text = &all->text;

    s->shown = data->number;
    page_text_clear(text);
    page_text_add(text, "%s,\"c\":%u}", page_text_get(&data->frame),
                  (unsigned)panel_host_get_control(data->panel, s->client.number, &data->snapshot));
    if (text->has_failed)
        return 0;
    return lws_write(s->wsi, (unsigned char *)text->room + PAGE_TEXT_HEAD, text->length,
                     LWS_WRITE_TEXT) < 0
               ? -1
               : 0;
}

static int send_queued(struct page_visitor *s)
{
    struct page_waiting first = s->queue[0];
    int written;

    s->queued--;
    memmove(s->queue, s->queue + 1, s->queued * sizeof s->queue[0]);
    written = lws_write(s->wsi, first.bytes + LWS_PRE, first.length, LWS_WRITE_TEXT);
    free(first.bytes);
    return written < 0 ? -1 : 0;
}

int page_visitor_send(struct page_visitors *all, struct page_visitor *s)
{
    int result = 0;

    if (s->queued > 0)
        result = send_queued(s);
    else if (s->shown != all->data.number)
        result = send_frame(all, s);
    if (s->queued > 0 || s->shown != all->data.number)
        lws_callback_on_writable(s->wsi);
    return result;
}

/* ---- pages come and go ---- */

static void greet(struct page_visitors *all, struct page_visitor *s)
{
    struct page_text *text = &all->text;

    page_text_clear(text);
    page_json_hello(text, all->setup);
    queue_text(s, text);
    page_data_greet(&all->data, text);
    queue_text(s, text);
    page_data_describe_path(&all->data, text);
    queue_text(s, text);
    lws_set_timer_usecs(s->wsi, (lws_usec_t)PAGE_TICK_MS * US_PER_MS);
}

int page_visitor_enter(struct page_visitors *all, struct lws *wsi, struct page_visitor *s)
{
    unsigned number = 0;

    while (number < PANEL_HOST_PAGES && all->visitor[number] != NULL)
        number++;
    memset(s, 0, sizeof *s);
    s->wsi = wsi;
    s->message = malloc(MESSAGE_MAX);
    if (number == PANEL_HOST_PAGES || s->message == NULL) {
        free(s->message);
        return -1;
    }
    s->is_open = true;
    all->visitor[number] = s;
    page_client_open(&s->client, number, all->panel, all->setup);
    greet(all, s);
    return 0;
}

void page_visitor_leave(struct page_visitors *all, struct page_visitor *s)
{
    if (!s->is_open)
        return;
    all->visitor[s->client.number] = NULL;
    page_data_forget(&all->data, s->client.number);
    page_client_close(&s->client);
    for (unsigned i = 0; i < s->queued; i++)
        free(s->queue[i].bytes);
    free(s->message);
    s->is_open = false;
}

void page_visitors_tick(struct page_visitors *all, struct page_visitor *s)
{
    const double now = now_ms(CLOCK_MONOTONIC);

    lws_set_timer_usecs(s->wsi, (lws_usec_t)PAGE_TICK_MS * US_PER_MS);
    if (now < (double)all->ticked_ms + PAGE_TICK_MS - 1)
        return;
    all->ticked_ms = (uint64_t)now;
    page_data_tick(&all->data, now_ms(CLOCK_REALTIME));
    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        if (all->visitor[i] != NULL)
            lws_callback_on_writable(all->visitor[i]->wsi);
    }
}

/* ---- what pages say ---- */

static void take_text(struct page_visitors *all, struct page_visitor *s)
{
    struct page_text *text = &all->text;
    struct page_command command = {0};

    page_text_clear(text);
    if (page_orders_take(&s->client, (const char *)s->message, s->received, text, &command) &&
        !page_data_command(&all->data, &command))
        page_orders_reply(text, command.id, "too many orders wait: try again");
    queue_text(s, text);
    if (!s->client.is_new_watch)
        return;
    s->client.is_new_watch = false;
    page_text_clear(text);
    page_json_objects(text, &all->setup->drive[s->client.watched], (unsigned)s->client.watched);
    queue_text(s, text);
}

int page_visitor_receive(struct page_visitors *all, struct page_visitor *s, const void *bytes,
                         size_t length)
{
    if (length > MESSAGE_MAX - s->received) {
        lws_close_reason(s->wsi, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE, NULL, 0);
        return -1;
    }
    if (length > 0)
        memcpy(s->message + s->received, bytes, length);
    s->received += length;
    if (!lws_is_final_fragment(s->wsi) || lws_remaining_packet_payload(s->wsi) > 0)
        return 0;
    if (lws_frame_is_binary(s->wsi))
        page_orders_take_bytes(&s->client, s->message, s->received);
    else
        take_text(all, s);
    s->received = 0;
    return 0;
}

/* ---- all of them ---- */

bool page_visitors_open(struct page_visitors *all, const struct page_server_config *config)
{
    struct page_data *data = &all->data;

    all->panel = config->panel;
    all->setup = config->setup;
    data->panel = config->panel;
    data->link = config->link;
    data->setup = config->setup;
    data->owner = config->owner;
    data->listener = (struct page_listener){tell_all, tell_one, next_watched, all};
    return page_data_open(data, config->tools_max);
}

void page_visitors_close(struct page_visitors *all)
{
    page_data_close(&all->data);
    page_text_free(&all->text);
}

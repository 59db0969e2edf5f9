#define _GNU_SOURCE

#include "page/page_server.h"

#include "page/page_access.h"
#include "page/page_answer.h"
#include "page/page_asset.h"
#include "page/page_data.h"

#include <assert.h>
#include <libwebsockets.h>
#include <limits.h>
#include <netdb.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

/* Longest message of a page: pieces of an upload are shorter. */
#define MESSAGE_MAX 65536

/* Texts that wait for a page that does not read them; then it is sent away. */
#define QUEUE_MAX 64

/* A request must be whole so long after its first byte. */
#define REQUEST_S 5

/* Open at once, requests among them: others of this process have need of files too (1024 as a rule). */
#define CONNECTIONS_MAX 512

#define US_PER_MS    1000
#define RECEIVED_MAX 16384
#define HEADER_MAX   512
#define ADDRESS_MAX  63

static_assert(PAGE_TEXT_HEAD >= LWS_PRE, "texts can be sent as they are");

struct waiting {
    unsigned char *bytes; /* LWS_PRE, then the text */
    size_t length;
};

struct session {
    struct lws *wsi;
    bool is_open;
    struct page_client client;
    struct waiting queue[QUEUE_MAX];
    unsigned queued;
    unsigned char *message; /* being received; MESSAGE_MAX */
    size_t received;
    uint32_t shown; /* frame */
};

struct page_server {
    struct page_server_config config;
    struct page_data data;
    struct lws_context *context;
    struct lws_vhost *host;
    struct session *session[PANEL_HOST_PAGES]; /* NULL: free */
    char address[ADDRESS_MAX + 1];
    char name[HOST_NAME_MAX + 1]; /* of this computer */
    struct page_text text;
    uint64_t ticked_ms;
    atomic_bool is_to_end;
    bool is_running;
    pthread_t thread;
};

static struct page_server *server_of(struct lws *wsi)
{
    return lws_context_user(lws_get_context(wsi));
}

static double now_ms(clockid_t clock)
{
    struct timespec now;

    (void)clock_gettime(clock, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

/* ---- texts to pages ---- */

static void queue_text(struct session *s, const struct page_text *text)
{
    struct waiting *place = &s->queue[s->queued];

    if (text->length == 0 || text->has_failed)
        return;
    if (s->queued == QUEUE_MAX) {
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
    struct page_server *server = context;

    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        if (server->session[i] != NULL)
            queue_text(server->session[i], text);
    }
}

static void tell_one(void *context, unsigned page, const struct page_text *text)
{
    struct page_server *server = context;

    if (page < PANEL_HOST_PAGES && server->session[page] != NULL)
        queue_text(server->session[page], text);
}

static int next_watched(void *context, int drive)
{
    const struct page_server *server = context;
    int next = -1, first = -1;

    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        const int watched = server->session[i] != NULL ? server->session[i]->client.watched : -1;

        if (watched > drive && (next < 0 || watched < next))
            next = watched;
        if (watched >= 0 && (first < 0 || watched < first))
            first = watched;
    }
    return next >= 0 ? next : first;
}

/* Frames are not queued: who reads slowly sees fewer of them. */
static int send_frame(struct page_server *server, struct session *s)
{
    const struct page_data *data = &server->data;
    struct page_text *text = &server->text;

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

static int send_queued(struct session *s)
{
    struct waiting first = s->queue[0];
    int written;

    s->queued--;
    memmove(s->queue, s->queue + 1, s->queued * sizeof s->queue[0]);
    written = lws_write(s->wsi, first.bytes + LWS_PRE, first.length, LWS_WRITE_TEXT);
    free(first.bytes);
    return written < 0 ? -1 : 0;
}

static int send_next(struct page_server *server, struct session *s)
{
    int result = 0;

    if (s->queued > 0)
        result = send_queued(s);
    else if (s->shown != server->data.number)
        result = send_frame(server, s);
    if (s->queued > 0 || s->shown != server->data.number)
        lws_callback_on_writable(s->wsi);
    return result;
}

/* ---- pages come and go ---- */

static void greet(struct page_server *server, struct session *s)
{
    struct page_text *text = &server->text;

    page_text_clear(text);
    page_json_hello(text, server->config.setup);
    queue_text(s, text);
    page_data_greet(&server->data, text);
    queue_text(s, text);
    page_data_describe_path(&server->data, text);
    queue_text(s, text);
    lws_set_timer_usecs(s->wsi, (lws_usec_t)PAGE_TICK_MS * US_PER_MS);
}

/* -1: all places are taken. */
static int enter(struct page_server *server, struct lws *wsi, struct session *s)
{
    unsigned number = 0;

    while (number < PANEL_HOST_PAGES && server->session[number] != NULL)
        number++;
    memset(s, 0, sizeof *s);
    s->wsi = wsi;
    s->message = malloc(MESSAGE_MAX);
    if (number == PANEL_HOST_PAGES || s->message == NULL) {
        free(s->message);
        return -1;
    }
    s->is_open = true;
    server->session[number] = s;
    page_client_open(&s->client, number, server->config.panel, server->config.setup);
    greet(server, s);
    return 0;
}

static void leave(struct page_server *server, struct session *s)
{
    if (!s->is_open)
        return;
    server->session[s->client.number] = NULL;
    page_data_forget(&server->data, s->client.number);
    page_client_close(&s->client);
    for (unsigned i = 0; i < s->queued; i++)
        free(s->queue[i].bytes);
    free(s->message);
    s->is_open = false;
}

static void tick(struct page_server *server, struct session *s)
{
    const double now = now_ms(CLOCK_MONOTONIC);

    lws_set_timer_usecs(s->wsi, (lws_usec_t)PAGE_TICK_MS * US_PER_MS);
    if (now < (double)server->ticked_ms + PAGE_TICK_MS - 1)
        return;
    server->ticked_ms = (uint64_t)now;
    page_data_tick(&server->data, now_ms(CLOCK_REALTIME));
    for (unsigned i = 0; i < PANEL_HOST_PAGES; i++) {
        if (server->session[i] != NULL)
            lws_callback_on_writable(server->session[i]->wsi);
    }
}

/* ---- what pages say ---- */

static void take_text(struct page_server *server, struct session *s)
{
    struct page_text *text = &server->text;
    struct page_command command = {0};

    page_text_clear(text);
    if (page_orders_take(&s->client, (const char *)s->message, s->received, text, &command) &&
        !page_data_command(&server->data, &command))
        page_orders_reply(text, command.id, "too many orders wait: try again");
    queue_text(s, text);
    if (!s->client.is_new_watch)
        return;
    s->client.is_new_watch = false;
    page_text_clear(text);
    page_json_objects(text, &server->config.setup->drive[s->client.watched],
                      (unsigned)s->client.watched);
    queue_text(s, text);
}

static int receive(struct page_server *server, struct session *s, const void *bytes, size_t length)
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
        take_text(server, s);
    s->received = 0;
    return 0;
}

/* ---- who may ---- */

/* False: the header is missing or too long. */
static bool get_header(struct lws *wsi, enum lws_token_indexes which, char text[HEADER_MAX])
{
    return lws_hdr_copy(wsi, text, HEADER_MAX, which) > 0;
}

static bool is_good_host(struct page_server *server, struct lws *wsi)
{
    char host[HEADER_MAX];

    return get_header(wsi, WSI_TOKEN_HOST, host) && page_access_is_host(host, server->name);
}

static bool is_good_page(struct page_server *server, struct lws *wsi)
{
    char host[HEADER_MAX], origin[HEADER_MAX];

    return is_good_host(server, wsi) && get_header(wsi, WSI_TOKEN_HOST, host) &&
           get_header(wsi, WSI_TOKEN_ORIGIN, origin) && page_access_is_origin(origin, host);
}

static bool is_allowed(const struct page_server *server, int file)
{
    struct sockaddr_storage address;
    socklen_t size = sizeof address;

    return getpeername(file, (struct sockaddr *)&address, &size) == 0 &&
           allow_list_has(&server->config.allowed, &address);
}

/* ---- files ---- */

static int answer_program(struct page_server *server, struct lws *wsi, struct page_answer *r)
{
    const struct page_owner *owner = &server->config.owner;
    const char *text = "";
    size_t size = 0;
    int result;

    panel_host_lock(server->config.panel);
    if (!owner->get_program(owner->context, &text, &size))
        size = 0;
    result = page_answer_copy(wsi, r, text, size);
    panel_host_unlock(server->config.panel);
    return result;
}

static int answer(struct page_server *server, struct lws *wsi, struct page_answer *r,
                  const char *path)
{
    struct page_asset asset;

    memset(r, 0, sizeof *r);
    if (!is_good_host(server, wsi))
        return page_answer_refuse(wsi, r, HTTP_STATUS_FORBIDDEN,
                                  "this is not the name of this computer\n");
    if (lws_hdr_total_length(wsi, WSI_TOKEN_GET_URI) == 0)
        return page_answer_refuse(wsi, r, HTTP_STATUS_METHOD_NOT_ALLOWED, "GET alone\n");
    if (strcmp(path, "/program") == 0)
        return answer_program(server, wsi, r);
    if (strcmp(path, "/path") == 0)
        return page_answer_copy(wsi, r, server->data.ready.point,
                                server->data.ready.count * sizeof *server->data.ready.point);
    if (!page_asset_find(path, &asset))
        return page_answer_refuse(wsi, r, HTTP_STATUS_NOT_FOUND, "there is no such file\n");
    r->bytes = asset.asset->bytes;
    r->size = asset.asset->size;
    return page_answer_begin(wsi, HTTP_STATUS_OK, asset.type, r->size);
}

/* ---- the library calls these ---- */

static int on_http(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                   size_t length)
{
    struct page_answer *r = user;

    switch ((int)reason) {
    case LWS_CALLBACK_FILTER_NETWORK_CONNECTION:
        return is_allowed(server_of(wsi), (int)(intptr_t)in) ? 0 : -1;
    case LWS_CALLBACK_HTTP:
        return answer(server_of(wsi), wsi, r, in);
    case LWS_CALLBACK_HTTP_WRITEABLE:
        return page_answer_send(wsi, r);
    case LWS_CALLBACK_HTTP_BODY:
    case LWS_CALLBACK_HTTP_BODY_COMPLETION:
        return -1; /* nobody is asked to send any */
    case LWS_CALLBACK_CLOSED_HTTP:
    case LWS_CALLBACK_HTTP_DROP_PROTOCOL:
        page_answer_free(r);
        return 0;
    default:
        return lws_callback_http_dummy(wsi, reason, user, in, length);
    }
}

static int on_page(struct lws *wsi, enum lws_callback_reasons reason, void *user, void *in,
                   size_t length)
{
    struct session *s = user;

    switch ((int)reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return is_good_page(server_of(wsi), wsi) ? 0 : -1;
    case LWS_CALLBACK_ESTABLISHED:
        return enter(server_of(wsi), wsi, s);
    case LWS_CALLBACK_TIMER:
        tick(server_of(wsi), s);
        return 0;
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return send_next(server_of(wsi), s);
    case LWS_CALLBACK_RECEIVE:
        return receive(server_of(wsi), s, in, length);
    case LWS_CALLBACK_CLOSED:
        leave(server_of(wsi), s);
        return 0;
    default:
        return 0;
    }
}

static const struct lws_protocols protocols[] = {
    {.name = "http", .callback = on_http, .per_session_data_size = sizeof(struct page_answer)},
    {.name = "takt",
     .callback = on_page,
     .per_session_data_size = sizeof(struct session),
     .rx_buffer_size = RECEIVED_MAX},
    {0},
};

/* ---- open and close ---- */

/* As a number: the library takes names for those of network devices. */
static const char *find_address(struct page_server *server)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    const struct page_server_config *config = &server->config;
    struct addrinfo *found = NULL;
    int failed = getaddrinfo(config->address, config->port, &wanted, &found);

    if (failed == 0)
        failed = getnameinfo(found->ai_addr, found->ai_addrlen, server->address,
                             sizeof server->address, NULL, 0, NI_NUMERICHOST);
    if (found != NULL)
        freeaddrinfo(found);
    return failed != 0 ? gai_strerror(failed) : NULL;
}

static void set_info(struct page_server *server, struct lws_context_creation_info *info)
{
    memset(info, 0, sizeof *info);
    info->port = CONTEXT_PORT_NO_LISTEN;
    info->iface = server->address;
    info->protocols = protocols;
    info->user = server;
    info->fd_limit_per_thread = CONNECTIONS_MAX;
    info->timeout_secs = REQUEST_S;
    info->keepalive_timeout = REQUEST_S;
    info->options = LWS_SERVER_OPTION_EXPLICIT_VHOSTS | LWS_SERVER_OPTION_FAIL_UPON_UNABLE_TO_BIND |
                    (strchr(server->address, ':') == NULL ? LWS_SERVER_OPTION_DISABLE_IPV6 : 0);
}

static const char *listen_there(struct page_server *server)
{
    const char *problem = find_address(server);
    struct lws_context_creation_info info;

    if (problem != NULL)
        return problem;
    lws_set_log_level(0, NULL);
    set_info(server, &info);
    server->context = lws_create_context(&info);
    if (server->context == NULL)
        return "out of memory";
    info.port = atoi(server->config.port);
    server->host = lws_create_vhost(server->context, &info);
    return server->host != NULL ? NULL : "it cannot be listened on; another program may use it";
}

static void *run(void *context)
{
    const struct sched_param last = {.sched_priority = 0};
    struct page_server *server = context;

    /* The first place in the queue for the processor is the control thread's alone; it has been passed on. */
    (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &last);
    while (!atomic_load(&server->is_to_end) && lws_service(server->context, 0) >= 0) {
    }
    return NULL;
}

/* Signals are for the control thread. */
static const char *start(struct page_server *server)
{
    sigset_t all, before;

    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    server->is_running = pthread_create(&server->thread, NULL, run, server) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return server->is_running ? NULL : "no thread";
}

static const char *open_data(struct page_server *server)
{
    struct page_data *data = &server->data;

    data->panel = server->config.panel;
    data->link = server->config.link;
    data->setup = server->config.setup;
    data->owner = server->config.owner;
    data->listener = (struct page_listener){tell_all, tell_one, next_watched, server};
    (void)gethostname(server->name, sizeof server->name - 1);
    return page_data_open(data, server->config.tools_max) ? NULL : "out of memory";
}

bool page_server_is_there(void)
{
    return true;
}

struct page_server *page_server_open(const struct page_server_config *config, const char **problem)
{
    struct page_server *server = calloc(1, sizeof *server);

    *problem = "out of memory";
    if (server == NULL)
        return NULL;
    server->config = *config;
    *problem = open_data(server);
    if (*problem == NULL)
        *problem = listen_there(server);
    if (*problem == NULL)
        *problem = start(server);
    if (*problem == NULL)
        return server;
    page_server_close(server);
    return NULL;
}

void page_server_close(struct page_server *server)
{
    if (server == NULL)
        return;
    atomic_store(&server->is_to_end, true);
    if (server->is_running) {
        lws_cancel_service(server->context);
        (void)pthread_join(server->thread, NULL);
    }
    if (server->context != NULL)
        lws_context_destroy(server->context);
    page_data_close(&server->data);
    page_text_free(&server->text);
    free(server);
}

uint16_t page_server_get_port(const struct page_server *server)
{
    return (uint16_t)lws_get_vhost_listen_port(server->host);
}

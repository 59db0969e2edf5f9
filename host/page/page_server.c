#define _GNU_SOURCE

#include "page/page_server.h"

#include "page/page_access.h"
#include "page/page_answer.h"
#include "page/page_asset.h"
#include "page/page_visitors.h"

#include <libwebsockets.h>
#include <limits.h>
#include <netdb.h>
#include <netinet/in.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* A request must be whole so long after its first byte. */
#define REQUEST_S 5

/*
 * Open at once, requests among them: others of this process have need of files too (1024 as a
 * rule).
 */
#define CONNECTIONS_MAX 512

#define RECEIVED_MAX 16384
#define HEADER_MAX   512
#define ADDRESS_MAX  63

struct page_server {
    struct page_server_config config;
    struct page_visitors visitors;
    struct lws_context *context;
    struct lws_vhost *host;
    char address[ADDRESS_MAX + 1];
    char name[HOST_NAME_MAX + 1]; /* of this computer */
    atomic_bool is_to_end;
    bool is_running;
    pthread_t thread;
};

static struct page_server *server_of(struct lws *wsi)
{
    return lws_context_user(lws_get_context(wsi));
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
        return page_answer_copy(wsi, r, server->visitors.data.ready.point,
                                server->visitors.data.ready.count *
                                    sizeof *server->visitors.data.ready.point);
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
    struct page_visitor *s = user;

    switch ((int)reason) {
    case LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION:
        return is_good_page(server_of(wsi), wsi) ? 0 : -1;
    case LWS_CALLBACK_ESTABLISHED:
        return page_visitor_enter(&server_of(wsi)->visitors, wsi, s);
    case LWS_CALLBACK_TIMER:
        page_visitors_tick(&server_of(wsi)->visitors, s);
        return 0;
    case LWS_CALLBACK_SERVER_WRITEABLE:
        return page_visitor_send(&server_of(wsi)->visitors, s);
    case LWS_CALLBACK_RECEIVE:
        return page_visitor_receive(&server_of(wsi)->visitors, s, in, length);
    case LWS_CALLBACK_CLOSED:
        page_visitor_leave(&server_of(wsi)->visitors, s);
        return 0;
    default:
        return 0;
    }
}

static const struct lws_protocols protocols[] = {
    {.name = "http", .callback = on_http, .per_session_data_size = sizeof(struct page_answer)},
    {.name = "takt",
     .callback = on_page,
     .per_session_data_size = sizeof(struct page_visitor),
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

    /*
     * The first place in the queue for the processor is the control thread's alone; it has been
     * passed on.
     */
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
    (void)gethostname(server->name, sizeof server->name - 1);
    if (page_visitors_open(&server->visitors, config))
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
    page_visitors_close(&server->visitors);
    free(server);
}

uint16_t page_server_get_port(const struct page_server *server)
{
    return (uint16_t)lws_get_vhost_listen_port(server->host);
}

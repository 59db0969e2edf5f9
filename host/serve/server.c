#define _DEFAULT_SOURCE

#include "serve/server.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define BACKLOG       128
#define NS_PER_SECOND UINT64_C(1000000000)
#define NS_PER_MS     UINT64_C(1000000)
#define NS_PER_US     1000

/* The longest sleep: to look for requests that never become whole. */
#define SLEEP_MS 500

/* Clients that may come before those that are there have their turn. */
#define ACCEPT_TURN 16

/* Places of struct pollfd, before those of the connections. */
enum { POLL_WAKE, POLL_LISTENER, POLL_SERIAL, POLL_FIRST };

static uint64_t now_ns(void)
{
    struct timespec now;

    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * NS_PER_SECOND + (uint64_t)now.tv_nsec;
}

static bool bind_listener(int file, const struct addrinfo *address)
{
    const int yes = 1;

    return setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
           bind(file, address->ai_addr, address->ai_addrlen) == 0 && listen(file, BACKLOG) == 0 &&
           fcntl(file, F_SETFL, O_NONBLOCK) == 0 && fcntl(file, F_SETFD, FD_CLOEXEC) == 0;
}

int server_listen(const char *address, const char *port, const char **problem)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE};
    struct addrinfo *found = NULL;
    const int failed = getaddrinfo(address, port, &wanted, &found);
    int file;

    if (failed != 0) {
        *problem = gai_strerror(failed);
        return -1;
    }
    file = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    if (file < 0 || !bind_listener(file, found)) {
        *problem = strerror(errno);
        if (file >= 0)
            (void)close(file);
        file = -1;
    }
    freeaddrinfo(found);
    return file;
}

uint16_t server_port_of(int listener)
{
    struct sockaddr_storage address;
    socklen_t size = sizeof address;

    if (getsockname(listener, (struct sockaddr *)&address, &size) != 0)
        return 0;
    return ntohs(address.ss_family == AF_INET6 ? ((const struct sockaddr_in6 *)&address)->sin6_port
                                               : ((const struct sockaddr_in *)&address)->sin_port);
}

static void open_line(struct server *server)
{
    struct modbus_map map;

    map = server->config.host.enter(server->config.host.context, SERVER_CLIENTS_MAX);
    takt_modbus_rtu_init(&server->line, &map, server->config.unit, server->config.serial_gap_us);
}

bool server_open(struct server *server, const struct server_config *config, const char **problem)
{
    memset(server, 0, sizeof *server);
    server->config = *config;
    server->listener = -1;
    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++)
        server->connection[i].socket = -1;
    open_line(server);
    if (pipe(server->wake) != 0) {
        *problem = strerror(errno);
        return false;
    }
    if (config->address == NULL)
        return true;
    server->listener = server_listen(config->address, config->port, problem);
    server->port = server->listener >= 0 ? server_port_of(server->listener) : 0;
    return server->listener >= 0;
}

uint16_t server_get_port(const struct server *server)
{
    return server->port;
}

static unsigned place_of(const struct server *server, const struct connection *connection)
{
    return (unsigned)(connection - server->connection);
}

static bool keeps(const struct server *server, const struct connection *connection)
{
    const struct server_host *host = &server->config.host;

    return host->keeps(host->context, place_of(server, connection));
}

static void dismiss(struct server *server, struct connection *connection)
{
    const struct server_host *host = &server->config.host;

    host->leave(host->context, place_of(server, connection));
    connection_close(connection);
}

/* A free place, else that of the client who has been silent for longest. */
static struct connection *find_place(struct server *server)
{
    struct connection *oldest = NULL;

    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++) {
        struct connection *c = &server->connection[i];

        if (c->socket < 0)
            return c;
        if (!keeps(server, c) && (oldest == NULL || c->served_ns < oldest->served_ns))
            oldest = c;
    }
    dismiss(server, oldest);
    server->dropped++;
    return oldest;
}

static void set_up_client(int file)
{
    const int yes = 1;

    (void)setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    (void)setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
    (void)fcntl(file, F_SETFD, FD_CLOEXEC);
}

static void admit_client(struct server *server, int file)
{
    const struct server_host *host = &server->config.host;
    struct connection *place = find_place(server);
    struct modbus_map map;

    set_up_client(file);
    map = host->enter(host->context, place_of(server, place));
    connection_open(place, file, &map, now_ns());
    server->accepted++;
}

/* False: there is none. */
static bool accept_client(struct server *server)
{
    struct sockaddr_storage address;
    socklen_t size = sizeof address;
    const int file = accept(server->listener, (struct sockaddr *)&address, &size);

    if (file < 0)
        return false;
    if (!allow_list_has(&server->config.allowed, &address)) {
        server->refused++;
        (void)close(file);
        return true;
    }
    admit_client(server, file);
    return true;
}

static void accept_clients(struct server *server)
{
    for (unsigned turn = 0; turn < ACCEPT_TURN && accept_client(server); turn++) {
    }
}

/* A reply fits into the line's buffer; if it does not, the client asks again. */
static void send_on_line(struct server *server, const uint8_t *reply, size_t length)
{
    if (length > 0 && write(server->config.serial, reply, length) == (ssize_t)length)
        server->answered++;
}

static void serve_line(struct server *server, short events)
{
    uint8_t reply[MODBUS_RTU_MAX];
    uint8_t bytes[MODBUS_RTU_MAX];
    const uint64_t time_ns = now_ns();
    const uint32_t now_us = (uint32_t)(time_ns / NS_PER_US);
    const ssize_t received =
        (events & POLLIN) != 0 ? read(server->config.serial, bytes, sizeof bytes) : 0;

    for (ssize_t i = 0; i < received; i++)
        send_on_line(server, reply, takt_modbus_rtu_take(&server->line, bytes[i], now_us, reply));
    if (received <= 0)
        send_on_line(server, reply, takt_modbus_rtu_idle(&server->line, now_us, reply));
    if (received <= 0 && (events & (POLLHUP | POLLERR)) != 0)
        server->line_rest_ns = time_ns + SLEEP_MS * NS_PER_MS;
}

static void serve_connection(struct server *server, struct connection *c, short events)
{
    uint64_t answered = 0;
    const uint64_t time_ns = now_ns();
    const bool late = c->begun_ns != 0 && time_ns - c->begun_ns > SERVER_REQUEST_MS * NS_PER_MS;
    const bool readable = (events & (POLLIN | POLLHUP | POLLERR)) != 0;

    if (late || !connection_serve(c, readable, time_ns, &answered)) {
        server->dropped += late;
        dismiss(server, c);
    }
    server->answered += answered;
}

static short wanted_events(const struct connection *c)
{
    return connection_is_sending(c) ? POLLOUT : POLLIN;
}

/* How long nothing has to be done unless something comes. */
static int sleep_ms(const struct server *server)
{
    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++) {
        if (server->connection[i].socket >= 0 && connection_is_waiting(&server->connection[i]))
            return 0;
    }
    return server->line.length > 0 ? (int)(server->config.serial_gap_us / 1000 + 1) : SLEEP_MS;
}

static void fill_poll(const struct server *server, struct pollfd *files)
{
    const int serial = now_ns() < server->line_rest_ns ? -1 : server->config.serial;

    files[POLL_WAKE] = (struct pollfd){.fd = server->wake[0], .events = POLLIN};
    files[POLL_LISTENER] = (struct pollfd){.fd = server->listener, .events = POLLIN};
    files[POLL_SERIAL] = (struct pollfd){.fd = serial, .events = POLLIN};
    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++) {
        const struct connection *c = &server->connection[i];

        files[POLL_FIRST + i] = (struct pollfd){.fd = c->socket, .events = wanted_events(c)};
    }
}

/* One round over everything that is open. False: the thread is to end. */
static bool serve_round(struct server *server)
{
    struct pollfd files[POLL_FIRST + SERVER_CLIENTS_MAX];

    fill_poll(server, files);
    if (poll(files, POLL_FIRST + SERVER_CLIENTS_MAX, sleep_ms(server)) < 0)
        return errno == EINTR;
    if (files[POLL_WAKE].revents != 0)
        return false;
    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++) {
        if (files[POLL_FIRST + i].fd >= 0)
            serve_connection(server, &server->connection[i], files[POLL_FIRST + i].revents);
    }
    if (server->config.serial >= 0)
        serve_line(server, files[POLL_SERIAL].revents);
    if (files[POLL_LISTENER].revents != 0)
        accept_clients(server);
    return true;
}

static void *run(void *context)
{
    struct server *server = context;

    while (serve_round(server)) {
    }
    return NULL;
}

/* Signals are for the control thread. */
bool server_start(struct server *server)
{
    sigset_t all, before;

    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    server->is_running = pthread_create(&server->thread, NULL, run, server) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return server->is_running;
}

static void close_file(int *file)
{
    if (*file >= 0)
        (void)close(*file);
    *file = -1;
}

void server_close(struct server *server)
{
    if (server->is_running) {
        (void)!write(server->wake[1], "", 1);
        (void)pthread_join(server->thread, NULL);
    }
    server->is_running = false;
    for (unsigned i = 0; i < SERVER_CLIENTS_MAX; i++) {
        if (server->connection[i].socket >= 0)
            dismiss(server, &server->connection[i]);
    }
    close_file(&server->listener);
    close_file(&server->config.serial);
    close_file(&server->wake[0]);
    close_file(&server->wake[1]);
}

#define _XOPEN_SOURCE 700
#define _DEFAULT_SOURCE

#include "serve/console_server.h"

#include "serve/server.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

/*
 * How long it sleeps: while a line waits for its answer, and otherwise, to look for alarms and who
 * has come.
 */
#define WAITING_MS 1
#define IDLE_MS    20

#define INPUT_MAX 256

enum { POLL_WAKE, POLL_LISTENER, POLL_SENDER, POLL_COUNT };

/* ---- open ---- */

static void set_raw(int terminal)
{
    struct termios settings;

    if (tcgetattr(terminal, &settings) != 0)
        return;
    cfmakeraw(&settings);
    (void)tcsetattr(terminal, TCSANOW, &settings);
}

/* Where the link leads; "" if it is none. */
static void read_link(const char *link, char target[PATH_MAX])
{
    const ssize_t length = readlink(link, target, PATH_MAX - 1);

    target[length > 0 ? length : 0] = '\0';
}

static bool leads_to(const char *link, const char *terminal)
{
    char target[PATH_MAX];

    read_link(link, target);
    return strcmp(target, terminal) == 0;
}

/* An earlier service has left it: it leads to where terminals are, and none is there any more. */
static bool is_left_over(const char *link, const char *terminal)
{
    const size_t folder = (size_t)(strrchr(terminal, '/') + 1 - terminal);
    char target[PATH_MAX];

    read_link(link, target);
    return strncmp(target, terminal, folder) == 0 && access(target, F_OK) != 0;
}

/* NULL, or why not: what is not ours stays. A terminal that is gone may be ours by its number. */
static const char *place_link(const char *terminal, const char *link)
{
    if (leads_to(link, terminal) || is_left_over(link, terminal))
        (void)unlink(link);
    if (symlink(terminal, link) == 0)
        return NULL;
    return errno == EEXIST ? "something else is there, or a service that runs: remove it, or name "
                             "another link"
                           : strerror(errno);
}

/*
 * Opened and closed once: only then is it known to the system that nobody is at the other end.
 * NULL, or why not.
 */
static const char *open_terminal(struct console_server *s)
{
    const char *name, *problem;
    int other;

    s->terminal = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (s->terminal < 0 || grantpt(s->terminal) != 0 || unlockpt(s->terminal) != 0)
        return strerror(errno);
    name = ptsname(s->terminal);
    if (name == NULL)
        return strerror(errno);
    problem = place_link(name, s->config.link);
    if (problem != NULL)
        return problem;
    other = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (other < 0)
        return strerror(errno);
    (void)close(other);
    return NULL;
}

/* What another has put there by now stays. */
static void remove_link(const struct console_server *s)
{
    const char *name = ptsname(s->terminal);

    if (name != NULL && leads_to(s->config.link, name))
        (void)unlink(s->config.link);
}

static void write_output(void *context, const char *text, size_t length)
{
    struct console_server *s = context;

    if (s->sender < 0)
        return;
    if (length > sizeof s->output - s->output_size) {
        s->overflows = true;
        return;
    }
    memcpy(s->output + s->output_size, text, length);
    s->output_size += length;
}

/* The console's port, which passes everything on but what goes to the sender. */

static void look(void *context, struct panel_snapshot *snapshot)
{
    const struct console_port *port = &((struct console_server *)context)->port;

    port->look(port->context, snapshot);
}

static enum panel_refusal order(void *context, const struct panel_order *wanted)
{
    const struct console_port *port = &((struct console_server *)context)->port;

    return port->order(port->context, wanted);
}

static enum panel_refusal unlock(void *context, uint32_t password)
{
    const struct console_port *port = &((struct console_server *)context)->port;

    return port->unlock(port->context, password);
}

static bool tell(void *context, enum console_fact fact, double value[AXIS_COUNT])
{
    const struct console_port *port = &((struct console_server *)context)->port;

    return port->tell(port->context, fact, value);
}

static enum takt_error check(void *context, const char *line, bool begins)
{
    const struct console_port *port = &((struct console_server *)context)->port;

    return port->check(port->context, line, begins);
}

static void open_console(struct console_server *s)
{
    struct console_config config = s->config.console;

    s->port = config.port;
    config.port = (struct console_port){look, order, unlock, tell, check, write_output, s};
    config.lines = &s->lines;
    takt_lines_init(&s->lines, s->text, sizeof s->text);
    takt_console_init(&s->console, &config);
}

bool console_server_open(struct console_server *s, const struct console_server_config *config,
                         const char **problem)
{
    memset(s, 0, sizeof *s);
    s->config = *config;
    s->listener = s->terminal = s->sender = -1;
    open_console(s);
    if (pipe(s->wake) != 0) {
        s->wake[0] = s->wake[1] = -1;
        *problem = strerror(errno);
        return false;
    }
    if (config->address != NULL) {
        s->listener = server_listen(config->address, config->port, problem);
        return s->listener >= 0;
    }
    *problem = open_terminal(s);
    return *problem == NULL;
}

uint16_t console_server_get_port(const struct console_server *s)
{
    return server_port_of(s->listener);
}

/* ---- senders ---- */

static void begin_sender(struct console_server *s, int file)
{
    s->sender = file;
    s->output_size = 0;
    s->overflows = false;
    s->senders++;
    s->config.enter(s->config.context);
    takt_console_enter(&s->console);
}

static void end_sender(struct console_server *s)
{
    takt_console_leave(&s->console);
    s->config.leave(s->config.context);
    if (s->sender != s->terminal)
        (void)close(s->sender);
    s->sender = -1;
}

static void turn_away(int file)
{
    static const char text[] = "[MSG:another sender is there]\r\n";

    (void)!send(file, text, sizeof text - 1, MSG_NOSIGNAL | MSG_DONTWAIT);
    (void)close(file);
}

static void accept_sender(struct console_server *s)
{
    const int yes = 1;
    struct sockaddr_storage address;
    socklen_t size = sizeof address;
    const int file = accept(s->listener, (struct sockaddr *)&address, &size);

    if (file < 0)
        return;
    (void)fcntl(file, F_SETFD, FD_CLOEXEC);
    (void)fcntl(file, F_SETFL, O_NONBLOCK);
    if (!allow_list_has(&s->config.allowed, &address)) {
        (void)close(file);
    } else if (s->sender >= 0) {
        turn_away(file);
    } else {
        (void)setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        (void)setsockopt(file, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
        begin_sender(s, file);
    }
}

/* Somebody has opened the other end of the terminal: it echoes nothing from now on. */
static void look_at_terminal(struct console_server *s)
{
    struct pollfd file = {.fd = s->terminal, .events = POLLIN};

    if (s->terminal < 0 || s->sender >= 0 || poll(&file, 1, 0) < 0 || (file.revents & POLLHUP) != 0)
        return;
    set_raw(s->terminal);
    begin_sender(s, s->terminal);
}

/* ---- bytes ---- */

static bool is_for_later(void)
{
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
}

/* False: the sender is gone. */
static bool send_output(struct console_server *s)
{
    ssize_t sent;

    if (s->output_size == 0)
        return true;
    sent = write(s->sender, s->output, s->output_size);
    if (sent < 0)
        return is_for_later();
    s->output_size -= (size_t)sent;
    memmove(s->output, s->output + sent, s->output_size);
    return true;
}

/* As many as find room, so that none is lost. False: the sender is gone. */
static bool receive(struct console_server *s)
{
    const uint32_t room = takt_lines_room(&s->lines);
    uint8_t bytes[INPUT_MAX];
    const ssize_t received =
        read(s->sender, bytes, room < sizeof bytes ? (size_t)room : sizeof bytes);

    for (ssize_t i = 0; i < received; i++) {
        s->lines_taken += bytes[i] == '\n';
        takt_console_take(&s->console, bytes[i]);
    }
    return received > 0 || (received < 0 && is_for_later());
}

static void serve_sender(struct console_server *s, short events)
{
    bool is_there = true;

    if ((events & (POLLIN | POLLHUP | POLLERR)) != 0)
        is_there = receive(s);
    if (is_there)
        is_there = send_output(s) && !s->overflows;
    if (!is_there)
        end_sender(s);
}

static short wanted_events(const struct console_server *s)
{
    const int in = takt_console_has_room(&s->console) ? POLLIN : 0;

    return (short)(in | (s->output_size > 0 ? POLLOUT : 0));
}

/* False: the thread is to end. */
static bool serve_round(struct console_server *s)
{
    struct pollfd files[POLL_COUNT] = {
        {.fd = s->wake[0], .events = POLLIN},
        {.fd = s->listener, .events = POLLIN},
        {.fd = s->sender, .events = wanted_events(s)},
    };

    if (poll(files, POLL_COUNT, takt_console_is_waiting(&s->console) ? WAITING_MS : IDLE_MS) < 0)
        return errno == EINTR;
    if (files[POLL_WAKE].revents != 0)
        return false;
    if (files[POLL_SENDER].fd >= 0)
        serve_sender(s, files[POLL_SENDER].revents);
    if (files[POLL_LISTENER].revents != 0)
        accept_sender(s);
    look_at_terminal(s);
    takt_console_step(&s->console);
    if (s->sender >= 0 && !send_output(s))
        end_sender(s);
    return true;
}

static void *run(void *context)
{
    while (serve_round(context)) {
    }
    return NULL;
}

/* Signals are for the control thread. */
bool console_server_start(struct console_server *s)
{
    sigset_t all, before;

    (void)sigfillset(&all);
    (void)pthread_sigmask(SIG_SETMASK, &all, &before);
    s->is_running = pthread_create(&s->thread, NULL, run, s) == 0;
    (void)pthread_sigmask(SIG_SETMASK, &before, NULL);
    return s->is_running;
}

static void close_file(int *file)
{
    if (*file >= 0)
        (void)close(*file);
    *file = -1;
}

void console_server_close(struct console_server *s)
{
    if (s->is_running) {
        (void)!write(s->wake[1], "", 1);
        (void)pthread_join(s->thread, NULL);
    }
    s->is_running = false;
    if (s->sender >= 0 && s->sender != s->terminal)
        close_file(&s->sender);
    if (s->terminal >= 0)
        remove_link(s);
    close_file(&s->terminal);
    close_file(&s->listener);
    close_file(&s->wake[0]);
    close_file(&s->wake[1]);
}

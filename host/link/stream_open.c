/* How streams come into being. */
#define _DEFAULT_SOURCE
#define _XOPEN_SOURCE 700

#include "link/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#define BACKLOG 4

static const struct {
    unsigned baud;
    speed_t speed;
} speeds[] = {{9600, B9600},     {19200, B19200},     {38400, B38400},     {57600, B57600},
              {115200, B115200}, {230400, B230400},   {460800, B460800},   {500000, B500000},
              {921600, B921600}, {1000000, B1000000}, {2000000, B2000000}, {3000000, B3000000}};

static const speed_t *find_speed(unsigned baud)
{
    for (size_t i = 0; i < sizeof speeds / sizeof speeds[0]; i++)
        if (speeds[i].baud == baud)
            return &speeds[i].speed;
    return NULL;
}

bool stream_knows_baud(unsigned baud)
{
    return find_speed(baud) != NULL;
}

/* Bytes as they are, in both directions: no echo, no line ends, no signals. */
static bool set_raw(int fd, speed_t speed)
{
    struct termios mode;
    if (tcgetattr(fd, &mode) != 0)
        return false;
    cfmakeraw(&mode);
    mode.c_cflag |= CLOCAL | CREAD;
    return cfsetspeed(&mode, speed) == 0 && tcsetattr(fd, TCSANOW, &mode) == 0;
}

static int close_keeping_errno(int fd)
{
    int error = errno;
    (void)close(fd);
    errno = error;
    return -1;
}

int stream_open_serial(const char *path, unsigned baud)
{
    int fd = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
        return -1;
    return set_raw(fd, *find_speed(baud)) ? fd : close_keeping_errno(fd);
}

int stream_hold_pty(const char *name)
{
    int fd = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (fd < 0)
        return -1;
    return set_raw(fd, B115200) ? fd : close_keeping_errno(fd);
}

int stream_open_pty(char *name, size_t size, int *other_end)
{
    int fd = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (fd < 0)
        return -1;
    const char *path = grantpt(fd) == 0 && unlockpt(fd) == 0 ? ptsname(fd) : NULL;
    if (path == NULL)
        return close_keeping_errno(fd);
    (void)snprintf(name, size, "%s", path);
    *other_end = stream_hold_pty(name);
    if (*other_end < 0)
        return close_keeping_errno(fd);
    if (fcntl(fd, F_SETFL, O_RDWR | O_NONBLOCK) != 0) {
        (void)close_keeping_errno(*other_end);
        return close_keeping_errno(fd);
    }
    return fd;
}

static struct addrinfo *resolve(const char *host, const char *port, int flags, const char **problem)
{
    struct addrinfo hints = {.ai_family = AF_UNSPEC, .ai_socktype = SOCK_STREAM, .ai_flags = flags};
    struct addrinfo *found = NULL;
    int error = getaddrinfo(host, port, &hints, &found);
    if (error == 0)
        return found;
    *problem = gai_strerror(error);
    return NULL;
}

/* Small messages are what goes back and forth: none may wait for another. */
static void set_no_delay(int fd)
{
    int on = 1;
    (void)setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

static bool is_connected(int fd, int timeout_ms)
{
    struct pollfd wait = {.fd = fd, .events = POLLOUT};
    int error = 0;
    socklen_t size = sizeof error;
    if (poll(&wait, 1, timeout_ms) != 1) {
        errno = ETIMEDOUT;
        return false;
    }
    (void)getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
    errno = error;
    return error == 0;
}

static int connect_to(const struct addrinfo *to, int timeout_ms)
{
    int fd = socket(to->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, to->ai_protocol);
    if (fd < 0)
        return -1;
    set_no_delay(fd);
    if (connect(fd, to->ai_addr, to->ai_addrlen) == 0 ||
        (errno == EINPROGRESS && is_connected(fd, timeout_ms)))
        return fd;
    return close_keeping_errno(fd);
}

int stream_connect(const char *host, const char *port, int timeout_ms, const char **problem)
{
    struct addrinfo *found = resolve(host, port, 0, problem);
    int fd = -1;
    for (const struct addrinfo *to = found; to != NULL && fd < 0; to = to->ai_next)
        fd = connect_to(to, timeout_ms);
    if (found == NULL)
        return -1;
    *problem = strerror(errno);
    freeaddrinfo(found);
    return fd;
}

static int listen_at(const struct addrinfo *at)
{
    int on = 1;
    int fd = socket(at->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, at->ai_protocol);
    if (fd < 0)
        return -1;
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(fd, at->ai_addr, at->ai_addrlen) == 0 && listen(fd, BACKLOG) == 0)
        return fd;
    return close_keeping_errno(fd);
}

static void write_address(int fd, const char *host, char *address, size_t size)
{
    struct sockaddr_storage name;
    socklen_t length = sizeof name;
    char port[NI_MAXSERV] = "?";
    if (getsockname(fd, (struct sockaddr *)&name, &length) == 0)
        (void)getnameinfo((struct sockaddr *)&name, length, NULL, 0, port, sizeof port,
                          NI_NUMERICSERV);
    (void)snprintf(address, size, "%s:%s", host, port);
}

int stream_listen(const char *host, const char *port, char *address, size_t size,
                  const char **problem)
{
    struct addrinfo *found = resolve(host, port, AI_PASSIVE, problem);
    if (found == NULL)
        return -1;
    int fd = listen_at(found);
    *problem = strerror(errno);
    freeaddrinfo(found);
    if (fd >= 0)
        write_address(fd, host, address, size);
    return fd;
}

int stream_accept(int listener)
{
    int fd = accept(listener, NULL, NULL);
    if (fd < 0)
        return -1;
    if (fcntl(fd, F_SETFL, O_RDWR | O_NONBLOCK) != 0 || fcntl(fd, F_SETFD, FD_CLOEXEC) != 0)
        return close_keeping_errno(fd);
    set_no_delay(fd);
    return fd;
}

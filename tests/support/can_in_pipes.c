/*
 * Preloaded into programs that use SocketCAN: CAN interfaces made of pipes, for programs that
 * cannot run where a real one is. tests/with_can --sanitized makes the folder TAKT_CAN: in it a
 * folder for each interface, in that a named pipe for each socket bound to it, and a file "down"
 * while the interface is down.
 *
 * A frame goes into the pipes of all other sockets; the reader filters, as the kernel does for it.
 * A pipe that is full loses frames, as a socket does. Raw sockets only, and of them what
 * host/bus/link_socketcan.c uses.
 */
#define _GNU_SOURCE

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define SOCKETS_MAX 1024 /* descriptors above are not looked at */
#define FILTERS_MAX 64
#define PIPE_BYTES  (1 << 20)

/* The function of this name behind ours. */
#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

/* What a pipe carries; shorter than PIPE_BUF, so each is written and read whole. */
struct record {
    size_t size; /* of the frame: CAN_MTU or CANFD_MTU */
    struct timespec time;
    struct canfd_frame frame;
};

struct can_socket {
    bool open, takes_fd;
    unsigned filter_count; /* 0: everything */
    struct can_filter filter[FILTERS_MAX];
    char interface[IFNAMSIZ]; /* asked for last; bound to */
    char path[512];           /* of its pipe; empty: not bound */
};

static struct can_socket sockets[SOCKETS_MAX];

static struct can_socket *find(int fd)
{
    return fd >= 0 && fd < SOCKETS_MAX && sockets[fd].open ? &sockets[fd] : NULL;
}

static const char *folder(void)
{
    return getenv("TAKT_CAN");
}

/* Path of a file of an interface. */
static const char *place(char text[512], const char *interface, const char *name)
{
    (void)snprintf(text, 512, "%s/%s/%s", folder(), interface, name);
    return text;
}

static bool is_down(const struct can_socket *s)
{
    char path[512];

    return access(place(path, s->interface, "down"), F_OK) == 0;
}

/* A descriptor to hold the place; bind puts the pipe there. */
int socket(int domain, int type, int protocol)
{
    int fd;

    if (domain != PF_CAN || folder() == NULL)
        return REAL(socket)(domain, type, protocol);
    fd = open("/dev/null", O_RDWR | O_CLOEXEC);
    if (fd < 0 || fd >= SOCKETS_MAX)
        return -1;
    sockets[fd] = (struct can_socket){.open = true};
    return fd;
}

static int ask_interface(struct can_socket *s, unsigned long request, struct ifreq *answer)
{
    char path[512];

    (void)snprintf(s->interface, sizeof s->interface, "%.15s", answer->ifr_name);
    if (access(place(path, s->interface, "."), F_OK) != 0) {
        errno = ENODEV;
        return -1;
    }
    if (request == SIOCGIFFLAGS)
        answer->ifr_flags = is_down(s) ? 0 : IFF_UP;
    if (request == SIOCGIFMTU)
        answer->ifr_mtu = CANFD_MTU;
    if (request == SIOCGIFINDEX)
        answer->ifr_ifindex = 1; /* the next bind is meant for it */
    return 0;
}

int ioctl(int fd, unsigned long request, ...)
{
    va_list arguments;
    void *argument;

    va_start(arguments, request);
    argument = va_arg(arguments, void *);
    va_end(arguments);
    return find(fd) != NULL ? ask_interface(find(fd), request, argument)
                            : REAL(ioctl)(fd, request, argument);
}

int setsockopt(int fd, int level, int name, const void *value, socklen_t size)
{
    struct can_socket *s = find(fd);

    if (s == NULL)
        return REAL(setsockopt)(fd, level, name, value, size);
    if (level == SOL_CAN_RAW && name == CAN_RAW_FD_FRAMES)
        s->takes_fd = *(const int *)value != 0;
    if (level == SOL_CAN_RAW && name == CAN_RAW_FILTER && size <= sizeof s->filter) {
        memcpy(s->filter, value, size);
        s->filter_count = (unsigned)(size / sizeof s->filter[0]);
    }
    return 0;
}

/* From now on others find the pipe. */
int bind(int fd, const struct sockaddr *address, socklen_t size)
{
    struct can_socket *s = find(fd);
    char name[32];
    int pipe;

    if (s == NULL)
        return REAL(bind)(fd, address, size);
    (void)snprintf(name, sizeof name, "%d.%d", (int)getpid(), fd);
    if (mkfifo(place(s->path, s->interface, name), 0600) != 0)
        return -1;
    pipe = open(s->path, O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (pipe < 0 || dup3(pipe, fd, O_CLOEXEC) < 0)
        return -1;
    (void)fcntl(fd, F_SETPIPE_SZ, PIPE_BYTES);
    return close(pipe);
}

/* Into one pipe; opened for both ways, so that no signal comes if its reader has just gone. */
static void deliver(const char *path, const struct record *record)
{
    int pipe = open(path, O_RDWR | O_NONBLOCK | O_CLOEXEC);

    if (pipe < 0)
        return;
    (void)REAL(write)(pipe, record, sizeof *record);
    (void)close(pipe);
}

static void deliver_to_others(const struct can_socket *s, const struct record *record)
{
    char path[512];
    DIR *others = opendir(place(path, s->interface, "."));
    struct dirent *entry;

    while (others != NULL && (entry = readdir(others)) != NULL)
        if (entry->d_type == DT_FIFO &&
            strcmp(place(path, s->interface, entry->d_name), s->path) != 0)
            deliver(path, record);
    if (others != NULL)
        (void)closedir(others);
}

ssize_t write(int fd, const void *bytes, size_t size)
{
    struct can_socket *s = find(fd);
    struct record record = {.size = size};

    if (s == NULL)
        return REAL(write)(fd, bytes, size);
    if (is_down(s) || (size != CAN_MTU && size != CANFD_MTU)) {
        errno = is_down(s) ? ENETDOWN : EINVAL;
        return -1;
    }
    memcpy(&record.frame, bytes, size);
    (void)clock_gettime(CLOCK_REALTIME, &record.time);
    deliver_to_others(s, &record);
    return (ssize_t)size;
}

static bool is_wanted(const struct can_socket *s, const struct record *record)
{
    if (record->size == CANFD_MTU && !s->takes_fd)
        return false;
    for (unsigned i = 0; i < s->filter_count; i++)
        if ((record->frame.can_id & s->filter[i].can_mask) ==
            (s->filter[i].can_id & s->filter[i].can_mask))
            return true;
    return s->filter_count == 0;
}

/* The frame, and the time it was sent at. */
static ssize_t hand_over(const struct record *record, struct msghdr *message)
{
    struct cmsghdr *time = CMSG_FIRSTHDR(message);

    memcpy(message->msg_iov[0].iov_base, &record->frame, record->size);
    time->cmsg_level = SOL_SOCKET;
    time->cmsg_type = SCM_TIMESTAMPNS;
    time->cmsg_len = CMSG_LEN(sizeof record->time);
    memcpy(CMSG_DATA(time), &record->time, sizeof record->time);
    message->msg_controllen = CMSG_SPACE(sizeof record->time);
    return (ssize_t)record->size;
}

ssize_t recvmsg(int fd, struct msghdr *message, int flags)
{
    struct record record;

    if (find(fd) == NULL)
        return REAL(recvmsg)(fd, message, flags);
    if (is_down(find(fd))) {
        errno = ENETDOWN;
        return -1;
    }
    while (read(fd, &record, sizeof record) == (ssize_t)sizeof record) {
        if (is_wanted(find(fd), &record))
            return hand_over(&record, message);
    }
    return -1; /* errno is that of read: nothing more has come */
}

int close(int fd)
{
    struct can_socket *s = find(fd);

    if (s != NULL) {
        s->open = false;
        (void)unlink(s->path);
    }
    return REAL(close)(fd);
}

/*
 * Raw sockets on a CAN interface of the Linux kernel.
 */
#define _DEFAULT_SOURCE

#include "link/link_private.h"

#include <errno.h>
/* The kernel's frame has the name of the firmware's. */
#define can_frame kernel_can_frame
#include <linux/can.h>
#undef can_frame
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

/* Frames kept while the interface's own queue is full (ENOBUFS); more are refused. */
#define PENDING_MAX 64

#define RECEIVE_BUFFER (1 << 20)

#define CLASSICAL_SIZE sizeof(struct kernel_can_frame)
#define FD_SIZE        sizeof(struct canfd_frame)

/* Time between two attempts on a full queue, which does not tell when it has room again. */
#define RETRY_NS 200000u

struct socketcan_link {
    int fd;
    unsigned pending_count;
    struct wire_frame pending[PENDING_MAX]; /* the oldest first */
};

static void to_kernel(struct canfd_frame *kernel, const struct wire_frame *frame)
{
    memset(kernel, 0, sizeof *kernel);
    kernel->can_id = frame->id;
    if (frame->flags & WIRE_EXTENDED)
        kernel->can_id |= CAN_EFF_FLAG;
    if (frame->flags & WIRE_REMOTE)
        kernel->can_id |= CAN_RTR_FLAG;
    if (frame->flags & WIRE_RATE_SWITCH)
        kernel->flags |= CANFD_BRS;
    kernel->len = frame->length;
    memcpy(kernel->data, frame->data, frame->flags & WIRE_REMOTE ? 0 : frame->length);
}

static void from_kernel(struct wire_frame *frame, const struct canfd_frame *kernel, bool is_fd)
{
    bool extended = kernel->can_id & CAN_EFF_FLAG;
    frame->id = kernel->can_id & (extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame->flags = extended ? WIRE_EXTENDED : 0;
    if (kernel->can_id & CAN_RTR_FLAG)
        frame->flags |= WIRE_REMOTE;
    if (kernel->can_id & CAN_ERR_FLAG) {
        frame->flags = WIRE_ERROR;
        frame->id = kernel->can_id & CAN_ERR_MASK;
    }
    if (is_fd)
        frame->flags |= (uint8_t)(WIRE_FD | (kernel->flags & CANFD_BRS ? WIRE_RATE_SWITCH : 0) |
                                  (kernel->flags & CANFD_ESI ? WIRE_PASSIVE : 0));
    frame->length = kernel->len <= WIRE_DATA_MAX ? kernel->len : WIRE_DATA_MAX;
    memcpy(frame->data, kernel->data, frame->length);
}

/* False: not now. Whatever else goes wrong is the end of the bus. */
static bool write_frame(struct link *link, const struct wire_frame *frame)
{
    const struct socketcan_link *s = link->state;
    struct canfd_frame kernel;
    to_kernel(&kernel, frame);
    if (write(s->fd, &kernel, frame->flags & WIRE_FD ? FD_SIZE : CLASSICAL_SIZE) >= 0)
        return true;
    if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR)
        return false;
    link_fail(link, "bus %s: sending failed: %s", link->address, strerror(errno));
    return false;
}

static void write_pending(struct link *link)
{
    struct socketcan_link *s = link->state;
    unsigned done = 0;
    while (done < s->pending_count && write_frame(link, &s->pending[done]))
        done++;
    s->pending_count -= done;
    memmove(s->pending, s->pending + done, s->pending_count * sizeof s->pending[0]);
    link->wake_ns = s->pending_count > 0 ? link_clock_ns() + RETRY_NS : 0;
}

static bool socketcan_send(struct link *link, const struct wire_frame *frame)
{
    struct socketcan_link *s = link->state;
    if (s->pending_count > 0)
        write_pending(link);
    if (s->pending_count == 0 && write_frame(link, frame))
        return true;
    if (link->broken || s->pending_count == PENDING_MAX)
        return false;
    s->pending[s->pending_count++] = *frame;
    link->wake_ns = link_clock_ns() + RETRY_NS;
    return true;
}

static unsigned socketcan_prepare(struct link *link, struct pollfd fds[LINK_FDS_MAX])
{
    const struct socketcan_link *s = link->state;
    fds[0] = (struct pollfd){.fd = s->fd, .events = POLLIN};
    return 1;
}

static uint64_t time_of(struct msghdr *message)
{
    struct timespec time;
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c != NULL; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS)
            continue;
        memcpy(&time, CMSG_DATA(c), sizeof time);
        return (uint64_t)time.tv_sec * 1000000000u + (uint64_t)time.tv_nsec;
    }
    return 0;
}

/* A bus that has switched itself off stays so until somebody restarts the interface. */
static void take_error(struct link *link, const struct wire_frame *frame)
{
    if (frame->id & CAN_ERR_BUSOFF)
        link_fail(link,
                  "bus %s: the interface is bus-off; check cable and bit rate, then restart "
                  "it with ip link",
                  link->address);
}

/* False: nothing more has come. */
static bool read_frame(struct link *link)
{
    const struct socketcan_link *s = link->state;
    struct canfd_frame kernel;
    struct iovec data = {.iov_base = &kernel, .iov_len = sizeof kernel};
    _Alignas(struct cmsghdr) char control[128];
    struct msghdr message = {.msg_iov = &data,
                             .msg_iovlen = 1,
                             .msg_control = control,
                             .msg_controllen = sizeof control};
    struct wire_frame frame;
    ssize_t size = recvmsg(s->fd, &message, 0);
    if (size < 0 && (errno == EAGAIN || errno == EINTR))
        return false;
    if (size < 0) {
        link_fail(link, "bus %s: %s", link->address,
                  errno == ENETDOWN ? "the interface has gone down" : strerror(errno));
        return false;
    }
    from_kernel(&frame, &kernel, (size_t)size == FD_SIZE);
    link_take(link, &frame, time_of(&message));
    if (frame.flags & WIRE_ERROR)
        take_error(link, &frame);
    return !link->broken;
}

static void socketcan_serve(struct link *link, const struct pollfd *fds, unsigned count)
{
    const struct socketcan_link *s = link->state;
    (void)count;
    if (s->pending_count > 0)
        write_pending(link);
    if (fds[0].revents == 0 || link->broken)
        return;
    while (read_frame(link))
        ;
}

static bool socketcan_has_pending(const struct link *link)
{
    const struct socketcan_link *s = link->state;
    return s->pending_count > 0;
}

static bool socketcan_has_peer(const struct link *link)
{
    return !link->broken;
}

static void socketcan_close(struct link *link)
{
    struct socketcan_link *s = link->state;
    (void)close(s->fd);
    free(s);
}

static const struct link_kind_ops ops = {
    .send = socketcan_send,
    .prepare = socketcan_prepare,
    .serve = socketcan_serve,
    .has_peer = socketcan_has_peer,
    .has_pending = socketcan_has_pending,
    .close = socketcan_close,
};

static bool find_interface(struct link *link, int fd, struct ifreq *request,
                           struct link_error *error)
{
    if (ioctl(fd, SIOCGIFFLAGS, request) != 0)
        return link_refuse(error, "bus %s: there is no such interface: %s", link->address,
                           strerror(errno));
    if (!(request->ifr_flags & IFF_UP))
        return link_refuse(error,
                           "bus %s: the interface is down; `ip link set %s up` as root starts it",
                           link->address, request->ifr_name);
    if (!link->config.fd)
        return true;
    if (ioctl(fd, SIOCGIFMTU, request) == 0 && request->ifr_mtu >= (int)FD_SIZE)
        return true;
    return link_refuse(error, "bus %s: the interface has no CAN FD", link->address);
}

static bool set_options(const struct link *link, int fd)
{
    int on = 1, buffer = RECEIVE_BUFFER;
    can_err_mask_t errors = CAN_ERR_MASK;
    if (link->config.fd && setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) != 0)
        return false;
    if (link->config.filter_count > 0 &&
        setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, link->config.filters,
                   (socklen_t)(link->config.filter_count * sizeof(struct can_filter))) != 0)
        return false;
    /*
     * As much as the system allows: a process that is not run for a while should not lose frames.
     */
    (void)setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
    return setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) == 0 &&
           setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) == 0;
}

static bool bind_to(int fd, struct ifreq *request)
{
    struct sockaddr_can address = {.can_family = AF_CAN};
    if (ioctl(fd, SIOCGIFINDEX, request) != 0)
        return false;
    address.can_ifindex = request->ifr_ifindex;
    return bind(fd, (struct sockaddr *)&address, sizeof address) == 0;
}

static bool open_socket(struct link *link, int fd, const char *interface, struct link_error *error)
{
    struct ifreq request = {0};
    (void)snprintf(request.ifr_name, sizeof request.ifr_name, "%.15s", interface);
    if (!find_interface(link, fd, &request, error))
        return false;
    return (set_options(link, fd) && bind_to(fd, &request)) ||
           link_refuse(error, "bus %s: the interface cannot be used: %s", link->address,
                       strerror(errno));
}

bool link_open_socketcan(struct link *link, const struct link_spec *spec, struct link_error *error)
{
    struct socketcan_link *s;
    int fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (fd < 0)
        return link_refuse(error, "bus %s: this kernel has no CAN: %s", link->address,
                           strerror(errno));
    s = calloc(1, sizeof *s);
    if (s == NULL)
        (void)link_refuse(error, "bus %s: out of memory", link->address);
    if (s == NULL || !open_socket(link, fd, spec->name, error)) {
        (void)close(fd);
        free(s);
        return false;
    }
    s->fd = fd;
    link->ops = &ops;
    link->state = s;
    return true;
}

/*
 * A bus outside of this process, opened by a text:
 *
 *     embedded                            none: the bus is inside the process (bus.h)
 *     socketcan:INTERFACE                 an interface of the kernel: can0, vcan0
 *     slcan:PATH                          a serial adapter (Lawicel's ASCII): /dev/ttyACM0
 *     slcan:HOST:PORT                     the same behind TCP
 *     slcan:pty[:NAME]                    be the adapter, on a new pseudo-terminal; NAME: a link
 *                                         to it is made there
 *     slcan:listen:[HOST:]PORT            be the adapter, on TCP, for one peer at a time
 *     socketcand:HOST:PORT[:BUS]          client of a socketcand server; its bus, can0 by default
 *     socketcand:listen:[HOST:]PORT[:BUS] be the server, for several clients
 *
 * HOST of a listener is 127.0.0.1 by default; port 0 takes any that is free: link_get_address says
 * which.
 *
 *     struct link_error error;
 *     struct link_config config = {.bitrate = 1000000};
 *     struct link *link = link_open("socketcan:vcan0", &config, &error);
 *     struct can_port port = link_get_port(link);
 *     ... port.send(port.context, &frame) ...
 *     while (link_wait(link, link_clock_ns() + 100000000) == LINK_READY)
 *         while (port.receive(port.context, &frame))
 *             ...
 *
 * Nothing waits but link_open, link_wait and link_flush. One thread. Frames of this process do not
 * come back to it.
 */
#ifndef TAKT_HOST_LINK_H
#define TAKT_HOST_LINK_H

#include "bus/wire_frame.h"
#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

enum link_kind { LINK_EMBEDDED, LINK_SOCKETCAN, LINK_SLCAN, LINK_SOCKETCAND };

#define LINK_ERROR_MAX 255

struct link_error {
    bool is_environment;           /* the text was good, the world was not: exit status 3, else 2 */
    char text[LINK_ERROR_MAX + 1]; /* names the spec, what is wrong and what to do; no line end */
};

/* Layout of the kernel's struct can_filter: frames whose id & mask equals this id & mask. */
struct link_filter {
    uint32_t id, mask;
};

struct link_config {
    /* bit/s. Set on serial adapters, which know 10k ... 1M; interfaces and servers have theirs. */
    uint32_t bitrate;
    bool fd; /* CAN FD frames are wanted too, where the bus has them */
    /*
     * bit/s. > 0: the port speaks CAN FD. Serial adapters are told, as they know whole Mbit/s; else
     * 5 of them.
     */
    uint32_t data_bitrate;
    /* Frames wanted; count 0: all. Only interfaces filter, in the kernel; others bring all. */
    const struct link_filter *filters;
    unsigned filter_count;
};

struct link_counts {
    uint64_t sent, received;
    uint64_t refused;      /* sends without room */
    uint64_t receive_lost; /* frames that a full queue could not hold */
    uint64_t garbled;      /* lines or messages that could not be read */
    uint64_t error_frames; /* error messages of the interface */
    uint64_t departures;   /* peers that have gone; an interface does not know of any */
};

enum link_wait_result {
    LINK_READY,   /* at least one frame can be received */
    LINK_TIMEOUT, /* until_ns has come, or a signal */
    LINK_BROKEN   /* the other side is gone or the interface down: see link_get_problem */
};

struct link;

/* Reads the text alone. False: *error says what is wrong with it. error may not be NULL. */
bool link_check(const char *spec, enum link_kind *kind, struct link_error *error);

/* NULL: *error says why; also for `embedded`, which is opened with bus_init. */
struct link *link_open(const char *spec, const struct link_config *config,
                       struct link_error *error);
void link_close(
    struct link *link); /* NULL: nothing. What is queued is tried once, without waiting */

/*
 * The bus as the firmware and drives see it: data frames with 11-bit identifiers; all that it sends
 * are of one kind. What is sent to a bus that has gone is lost: link_wait tells that.
 */
struct can_port link_get_port(struct link *link);

/*
 * Every kind of frame. Non-blocking, as in hal/can.h. Mix with the port's functions at will: one
 * queue.
 */
bool link_send(struct link *link, const struct wire_frame *frame);
bool link_receive(struct link *link, struct wire_frame *frame);

/* Sends what is queued and waits for a frame until link_clock_ns() reaches until_ns. */
enum link_wait_result link_wait(struct link *link, uint64_t until_ns);

/*
 * Waits until all that is queued has been sent. False: not by until_ns. What comes meanwhile is
 * kept.
 */
bool link_flush(struct link *link, uint64_t until_ns);

/* Monotonic clock, ns. */
uint64_t link_clock_ns(void);

/*
 * Calls listener for every frame sent and received, with the real time (ns since 1970) as logs have
 * it.
 */
void link_observe(struct link *link, const struct wire_listener *listener);

/* Where others find what link_open made: "/dev/pts/5", "127.0.0.1:29536"; else the spec. */
const char *link_get_address(const struct link *link);

/* A peer is there to hear us: false before somebody has opened the channel of a pty or a server. */
bool link_has_peer(const struct link *link);

/* Peers that go are counted. */
bool link_hears_departures(const struct link *link);

/* What has gone wrong, for a message; empty: nothing. Stays after LINK_BROKEN. */
const char *link_get_problem(const struct link *link);

const struct link_counts *link_get_counts(const struct link *link);

#endif

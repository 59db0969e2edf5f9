/*
 * A CAN bus in virtual time: arbitration by identifier, every frame takes its exact time on the
 * wire, every port but the sender's receives it at its end. Deterministic: the same calls give the
 * same frames at the same nanoseconds.
 *
 *     struct bus bus;
 *     bus_init(&bus, 1000000);
 *     struct can_port controller = bus_attach(&bus, NULL);
 *     ... controller.send(controller.context, &frame) ...
 *     bus_run_until(&bus, 1000000);
 *     ... controller.receive(controller.context, &frame) ...
 *
 * One thread. The bus owns the memory behind its ports; it must not be moved after the first
 * bus_attach.
 */
#ifndef TAKT_BUS_BUS_H
#define TAKT_BUS_BUS_H

#include "bus/frame_bits.h"
#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define BUS_PORT_MAX     32
#define BUS_TRANSMIT_MAX 32  /* frames a port may have waiting for the bus; more are refused */
#define BUS_RECEIVE_MAX  256 /* frames a collecting port holds, a power of two; more are lost */
#define BUS_WAITING_MAX  256 /* frames of all ports that may wait for the bus; more are refused */

#define BUS_BITRATE_MIN 10000
#define BUS_BITRATE_MAX 1000000

/*
 * What a node does with a frame, at the moment the frame ends. It may send through its own port; it
 * must not run the bus. time_ns: end of the frame. The frame is the bus's own and valid during the
 * call.
 */
struct bus_listener {
    void (*on_frame)(void *context, const struct can_frame *frame, uint64_t time_ns);
    void *context;
};

struct bus_counts {
    uint64_t frames;       /* that have ended */
    uint64_t busy_ns;      /* bus occupied by them, intermission included */
    uint64_t refused;      /* send calls without room */
    uint64_t receive_lost; /* frames that a full receive queue could not hold */
};

/* A frame that waits for the bus. */
struct bus_waiting {
    uint64_t order; /* identifier, then the order of sending: the lowest wins arbitration */
    uint16_t port;
    struct can_frame frame;
};

struct bus_port {
    struct bus *bus;
    struct bus_listener listener; /* without on_frame: received is filled */
    unsigned waiting;             /* frames in bus->waiting */
    unsigned read, written;       /* count up; index modulo BUS_RECEIVE_MAX */
    struct can_frame received[BUS_RECEIVE_MAX];
};

/* Private but for counts. */
struct bus {
    struct bus_counts counts;
    uint64_t now_ns;
    uint64_t bit_ns;
    uint64_t idle_ns; /* the bus is free from here on */
    uint64_t sent;    /* send calls that were accepted */

    bool on_wire; /* a frame is being sent: it cannot be overtaken any more */
    uint64_t frame_end_ns;
    struct bus_waiting wire;

    unsigned waiting_count;
    struct bus_waiting waiting[BUS_WAITING_MAX]; /* in falling order: the winner is the last */

    unsigned port_count;
    struct bus_port port[BUS_PORT_MAX];
    struct bus_listener observer;
    struct frame_bits tables;
};

/*
 * bitrate: bit/s, BUS_BITRATE_MIN ... BUS_BITRATE_MAX; the bit time is rounded to a nanosecond.
 * False: out of range, and the bus unusable.
 */
bool bus_init(struct bus *bus, uint32_t bitrate);

/*
 * A port for one more node. listener: copied; NULL: received frames are collected for receive(). A
 * port with a listener has nothing to receive. At most BUS_PORT_MAX ports (asserted).
 */
struct can_port bus_attach(struct bus *bus, const struct bus_listener *listener);

/* Calls listener for every frame at its end, before the nodes get it. NULL: nobody any more. */
void bus_observe(struct bus *bus, const struct bus_listener *listener);

/*
 * Lets the bus work until time_ns, which must not lie in the past. Frames that end at or before it
 * are delivered; one that is still on the wire then stays there.
 */
void bus_run_until(struct bus *bus, uint64_t time_ns);

/* Virtual time: within on_frame the end of that frame, else the time bus_run_until reached. */
uint64_t bus_now_ns(const struct bus *bus);

/* No frame waits or is on the wire. */
bool bus_is_quiet(const struct bus *bus);

/* Time the bus has been occupied, in percent of the time since bus_init; 0 at time 0. */
double bus_load_percent(const struct bus *bus);

/*
 * Load of frames with these data lengths (bytes), all of them sent once a cycle, with worst-case
 * stuffing: percent of the cycle. Above 100 the bus cannot carry them.
 */
double bus_predict_load_percent(uint32_t bitrate, uint32_t cycle_us, const uint8_t length[],
                                unsigned count);

#endif

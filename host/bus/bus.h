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

#include "bus/bus_fault.h"
#include "bus/frame_bits.h"
#include "hal/can.h"

#include <stdbool.h>
#include <stdint.h>

#define BUS_PORT_MAX     32
#define BUS_TRANSMIT_MAX 32  /* frames a port may have waiting for the bus; more are refused */
#define BUS_RECEIVE_MAX  256 /* frames a collecting port holds, a power of two; more are lost */
#define BUS_WAITING_MAX  256 /* frames of all ports that may wait for the bus; more are refused */

#define BUS_FAULTS_MAX 64
#define BUS_ID_COUNT   2048

#define BUS_BITRATE_MIN      10000
#define BUS_BITRATE_MAX      1000000
#define BUS_DATA_BITRATE_MAX 8000000 /* of CAN FD */

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
    /* What faults have done. */
    uint64_t error_frames; /* frames broken off on the wire and sent again */
    uint64_t dropped;      /* frames that ended and that nobody took */
    uint64_t duplicated;   /* frames that were taken and sent again all the same */
    uint64_t delayed;      /* frames whose sender was late */
    uint64_t off_lost;     /* frames that waited at a port when it went off the bus */
};

/* A frame that waits for the bus. */
struct bus_waiting {
    uint64_t order;    /* identifier, then the order of sending: the lowest wins arbitration */
    uint64_t since_ns; /* when it began to wait */
    uint16_t port;
    bool is_repeat; /* it has been on the wire before */
    struct can_frame frame;
};

/* CAN fault confinement (ISO 11898-1). */
enum bus_confinement { BUS_ACTIVE, BUS_PASSIVE, BUS_OFF };

struct bus_port {
    struct bus *bus;
    struct bus_listener listener; /* the caller's, or what fills received */
    const uint32_t *filter;       /* of frames for it; NULL: all */
    unsigned index;               /* in bus->port */
    unsigned waiting;             /* frames in bus->waiting */
    unsigned transmit_errors;     /* error counters of its controller */
    unsigned receive_errors;
    uint64_t off_until_ns;     /* off the bus by its own errors; 0: it is not */
    uint64_t suspend_until_ns; /* error passive, it has just sent: others may go first */
    unsigned read, written;    /* count up; index modulo BUS_RECEIVE_MAX */
    struct can_frame received[BUS_RECEIVE_MAX];
};

/* A fault and what has become of it. */
struct bus_fault_state {
    struct bus_fault fault;
    uint64_t passed, struck; /* matching frames let through, and hit */
    uint64_t random;
    bool done; /* it will never do anything again */
};

/* What a fault has decided about the frame on the wire. */
struct bus_verdict {
    bool is_dropped, is_duplicated;
    unsigned corrupt_bit; /* 0: none; the first bits, of arbitration, are never hit */
};

/* Private but for counts. */
struct bus {
    struct bus_counts counts;
    uint64_t now_ns;
    struct frame_times times;
    uint64_t idle_ns; /* the bus is free from here on */
    uint64_t sent;    /* send calls that were accepted */

    bool on_wire; /* a frame is being sent: it cannot be overtaken any more */
    uint64_t frame_end_ns;
    struct bus_waiting *wire;   /* that frame, or the last one that was sent */
    struct bus_verdict verdict; /* on it */

    struct bus_listener observer;
    struct frame_bits tables;

    unsigned fault_count;
    struct bus_fault_state fault[BUS_FAULTS_MAX];
    uint64_t fault_from_ns;   /* no fault does anything before */
    bool is_unwell;           /* faults have left something behind: error counters, late frames */
    bool has_ended_responses; /* no more count */
    uint32_t response_max_ns[BUS_ID_COUNT];

    unsigned waiting_count, port_count;
    /*
     * In falling order: the winner is the last; behind them is room for others. One more: the frame
     * on the wire may come back. Frames stay where they are, only their order changes.
     */
    struct bus_waiting *waiting[BUS_WAITING_MAX + 1];
    struct bus_waiting place[BUS_WAITING_MAX + 2]; /* those and the wire's */
    struct bus_port port[BUS_PORT_MAX];
};

/*
 * bitrate: bit/s, BUS_BITRATE_MIN ... BUS_BITRATE_MAX; the bit time is rounded to a nanosecond.
 * False: out of range, and the bus unusable.
 */
bool bus_init(struct bus *bus, uint32_t bitrate);
/*
 * The same; with rates->data > 0 for ports that speak CAN FD: every data frame is one, with the
 * data at that rate, from the nominal one to BUS_DATA_BITRATE_MAX.
 */
bool bus_init_rates(struct bus *bus, const struct frame_rates *rates);
/* Its ports speak CAN FD. */
static inline bool bus_is_fd(const struct bus *bus)
{
    return bus->times.data_ns > 0;
}

/*
 * A port for one more node. listener: copied; NULL: received frames are collected for receive(). A
 * port with a listener has nothing to receive. At most BUS_PORT_MAX ports (asserted).
 */
struct can_port bus_attach(struct bus *bus, const struct bus_listener *listener);

/*
 * The same with a filter, as CAN controllers have it in hardware: the listener hears no other
 * frames. filter: must stay, and may change; NULL: there is none.
 */
struct can_port bus_attach_filtered(struct bus *bus, const struct bus_listener *listener,
                                    const uint32_t filter[CAN_FILTER_WORDS]);

/* Calls listener for every frame at its end, before the nodes get it. NULL: nobody any more. */
void bus_observe(struct bus *bus, const struct bus_listener *listener);

/*
 * Lets the bus work until time_ns, which must not lie in the past. Frames that end at or before it
 * are delivered; one that is still on the wire then stays there.
 */
void bus_run_until(struct bus *bus, uint64_t time_ns);

/* Adds a fault; copied. False: there are BUS_FAULTS_MAX already. */
bool bus_add_fault(struct bus *bus, const struct bus_fault *fault);

/* Every fault that has not ended ends now. */
void bus_end_faults(struct bus *bus);

/* State of a port's controller, by order of bus_attach. */
enum bus_confinement bus_get_confinement(const struct bus *bus, unsigned port);

/*
 * Longest time from a send call to the end of the frame, of frames with this identifier, since
 * bus_init or bus_clear_responses and before bus_end_responses, ns; 0: none was sent. id: below
 * BUS_ID_COUNT.
 */
uint32_t bus_get_response_max_ns(const struct bus *bus, unsigned id);
void bus_clear_responses(struct bus *bus);
void bus_end_responses(struct bus *bus);

/* Virtual time: within on_frame the end of that frame, else the time bus_run_until reached. */
uint64_t bus_now_ns(const struct bus *bus);

/* No frame waits or is on the wire. */
bool bus_is_quiet(const struct bus *bus);

/* Time the bus has been occupied, in percent of the time since bus_init; 0 at time 0. */
double bus_load_percent(const struct bus *bus);

#endif

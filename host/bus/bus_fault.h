/*
 * Faults of the embedded bus, as data: which frames, when, and what happens to them.
 *
 *     bus_add_fault(&bus, &(struct bus_fault){.kind = BUS_FAULT_DROP,
 *                                             .id = 0x182,
 *                                             .id_mask = 0x7FF,
 *                                             .from_ns = 2000000000,
 *                                             .count = 10});
 *
 * A fault looks at the frames that match it, from from_ns on: it lets `skip` of them pass, then
 * strikes `count` of the next; of those only the share `probability` if that is above 0, drawn from
 * `seed`.
 */
#ifndef TAKT_BUS_BUS_FAULT_H
#define TAKT_BUS_BUS_FAULT_H

#include <stdint.h>

enum bus_fault_kind {
    /* On the wire, but no other node takes it: its receivers' buffers were full. */
    BUS_FAULT_DROP,
    /* One bit is flipped on the wire: error frame, error counters, sent again. */
    BUS_FAULT_CORRUPT,
    /* Error in the last bit of the frame: receivers keep it, the sender sends it again. */
    BUS_FAULT_DUPLICATE,
    /* Its sender is late: it begins to compete for the bus delay_ns after it was given. */
    BUS_FAULT_DELAY,
    /* For ports, at from_ns: their transmit error counter reaches 128. */
    BUS_FAULT_ERROR_PASSIVE,
    /* For ports, from from_ns until until_ns: controller off the bus; what waits is lost. */
    BUS_FAULT_BUS_OFF,
    /* For ports, from from_ns until until_ns: cable cut there; what waits goes on waiting. */
    BUS_FAULT_CUT
};

#define BUS_FAULT_ALWAYS UINT64_MAX

struct bus_fault {
    enum bus_fault_kind kind;
    uint16_t id,
        id_mask; /* frames whose id & id_mask equals id; mask 0: all. For faults of frames */
    uint32_t
        ports; /* bit i: port i. Faults of ports: those; of frames: only of theirs, 0: of any */
    uint64_t from_ns;   /* virtual time */
    uint64_t until_ns;  /* 0: for good */
    uint64_t skip;      /* matching frames to let pass first */
    uint64_t count;     /* frames struck at most; 0: one, BUS_FAULT_ALWAYS: all */
    double probability; /* 0: every one */
    uint64_t seed;
    uint64_t delay_ns; /* BUS_FAULT_DELAY */
};

#endif

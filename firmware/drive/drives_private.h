/*
 * Shared by the sources of this room.
 */
#ifndef TAKT_DRIVE_DRIVES_PRIVATE_H
#define TAKT_DRIVE_DRIVES_PRIVATE_H

#include "canopen/cia402.h"
#include "canopen/nmt.h"
#include "drive/drives.h"
#include "drive/word.h"

/*
 * Statusword and actual position in one TPDO. That of error code and following error is of the same
 * length.
 */
#define DRIVES_STATUS_LENGTH 6

/* Period of TPDO2. */
#define DRIVES_EVENT_MS 100

/*
 * A fault of the drive at this index: ends DRIVES_STARTING and DRIVES_ENABLED. The first fault
 * stays, since what follows is its consequence. meaning: of the value, a constant; NULL: it has
 * none.
 */
void takt_drives_raise(struct drives *d, unsigned index, enum takt_error error, double value,
                       const char *meaning);
/* The same about an object of the drive. */
void takt_drives_raise_object(struct drives *d, unsigned index, uint32_t object,
                              enum takt_error error, double value, const char *meaning);
/*
 * An emergency or error code has come after the statusword that told of the fault: it completes the
 * diagnostic.
 */
void takt_drives_complete_fault(struct drives *d, unsigned index, uint16_t code);

/* DRIVE_FAULT, by the code of an emergency; EMCY_NONE: none has come. */
void takt_drives_raise_reported(struct drives *d, unsigned index, uint16_t code);

/* Drives are enabled and watched: in operation, and while axes are homed. */
bool takt_drives_are_watched(const struct drives *d);

static inline bool drives_is_second(const struct drives *d, unsigned index)
{
    bool is_second = false;
    for (unsigned i = 0; i < d->gantry_count; i++)
        is_second = is_second || index == d->gantry[i].second;
    return is_second;
}

/* Setpoints cannot be followed any more: DRIVES_BRAKING. */
void takt_drives_brake(struct drives *d);
/* A cycle of DRIVES_STOPPING, with its setpoints, and one of DRIVES_BRAKING. */
void takt_drives_watch_stop(struct drives *d);
void takt_drives_watch_brakes(struct drives *d);

/* For people: a rotary axis in degrees. */
double takt_drives_axis_shown(const struct drives_axis *axis, double value_mm);
bool takt_drives_axis_is_enabled(const struct drives_axis *axis);
double takt_drives_cycles_ms(const struct drives *d, uint32_t cycles);

/* Setpoints of all drives, of this many cycles ago: mm or rad. */
static inline const double *drives_sent(const struct drives *d, unsigned ago)
{
    return d->sent_mm[(d->cycle - ago) & (DRIVES_HISTORY - 1)];
}

/*
 * The bus of a drive, and of an I/O node. Where there can be but one it is no matter of run time.
 */
static inline unsigned drives_axis_bus(const struct drives_axis *axis)
{
    return CAN_BUSES_MAX > 1 ? axis->config.bus : 0;
}
static inline unsigned drives_bus_of(const struct drives *d, unsigned index)
{
    return drives_axis_bus(&d->axis[index]);
}
static inline unsigned drives_io_bus_of(const struct drives *d, unsigned i)
{
    return CAN_BUSES_MAX > 1 ? d->wiring[i].bus : 0;
}
static inline unsigned drives_bus_count(const struct drives *d)
{
    return CAN_BUSES_MAX > 1 ? d->bus_count : 1;
}

/* "node 20"; of another bus than the first with that: "node 1:20". */
void takt_drives_name_node(struct word *word, unsigned bus, unsigned node);

/* Cycles since the last TPDO1, 0: one came in this cycle; and since the last heartbeat. */
static inline uint32_t drives_silent_cycles(const struct drives *d, const struct drives_axis *axis)
{
    return d->cycle - axis->reported;
}
static inline bool drives_is_silent(const struct drives *d, const struct drives_axis *axis)
{
    return drives_silent_cycles(d, axis) > d->answer_timeout_cycles;
}
static inline uint32_t drives_heartbeat_age_cycles(const struct drives *d,
                                                   const struct drives_axis *axis)
{
    return d->cycle - axis->heartbeat;
}

/* A fault that is not of a drive: name says of whom. The same otherwise as takt_drives_raise. */
void takt_drives_raise_named(struct drives *d, const struct word *name, enum takt_error error,
                             double value, const char *meaning);

/* A cycle of DRIVES_STARTING after its frames have been received. */
void takt_drives_start(struct drives *d);
/* A drive has booted while the drives are being started. */
void takt_drives_start_again(struct drives *d, unsigned index);
void takt_drives_enter_phase(struct drives *d, enum drives_phase phase);

/* One request to the drive that is being configured, and what it has come to. */
struct drives_step {
    uint32_t object; /* SDO_OBJECT */
    uint8_t length;  /* bytes to write; 0: it is read */
    uint32_t value;  /* to write */
};
struct drives_answer {
    uint32_t abort_code; /* SDO_ABORT_NONE: it has been done */
    uint32_t value;      /* that has been read */
};

/*
 * The parts of a configuration, enum drives_part. next: its next request; false: there is none.
 * take: what has come of that; a drive that cannot be used has raised its fault.
 */
bool takt_drives_next_ask(struct drives *d, struct drives_step *step);
void takt_drives_take_ask(struct drives *d, const struct drives_answer *answer);
bool takt_drives_ask_dcf(struct drives *d); /* asks at once; false: there is nothing to be asked */
void takt_drives_take_dcf(struct drives *d);
bool takt_drives_next_set(struct drives *d, struct drives_step *step);
void takt_drives_take_set(struct drives *d, const struct drives_answer *answer);
bool takt_drives_next_map(struct drives *d, struct drives_step *step);
void takt_drives_take_map(struct drives *d, const struct drives_answer *answer);

/* The drive that is being configured is to be configured anew, or is the next one. */
void takt_drives_begin_axis(struct drives *d, unsigned index);

/* Nothing is known of its PDOs. */
void takt_drives_forget_pdos(struct drives_axis *axis);

void takt_drives_give_up(struct drives *d, unsigned index, enum drives_given_up what);

static inline bool drives_has_given_up(const struct drives_axis *axis, enum drives_given_up what)
{
    return axis->given_up >> what & 1;
}

/* Its mode goes by SDO, and has not been told yet. */
bool takt_drives_tells_mode(const struct drives_axis *axis);
/* The controlword that brings a drive on its way. */
uint16_t takt_drives_controlword(const struct drives *d, const struct drives_axis *axis);

/*
 * I/O nodes, drives_io.c and drives_io_boot.c: before anything else; a frame of one of them; what
 * is watched in every cycle. boot: true when all have booted.
 */
void takt_drives_io_init(struct drives *d, const struct drives_config *config);
void takt_drives_io_take(struct drives *d, unsigned index, const struct can_frame *frame);
void takt_drives_io_check(struct drives *d);
bool takt_drives_io_boot(struct drives *d);
/* Bytes that what is wired takes, eight a byte. */
static inline unsigned drives_io_bytes_of(const uint8_t bit[IO_BITS_MAX])
{
    return (io_wired_bits(bit) + 7U) / 8U;
}
/* "node 20", "node 1:20", and a fault that begins with it. */
struct word takt_drives_io_name(const struct drives *d, unsigned i);
void takt_drives_io_raise(struct drives *d, unsigned i, enum takt_error error, double value,
                          const char *meaning);
/* A cycle of DRIVES_IO, and what it sends. */
void takt_drives_io_start(struct drives *d);
void takt_drives_io_send_start(struct drives *d, const struct can_port *port);
void takt_drives_io_send_resets(struct drives *d, const struct can_port *port);
/* Bits of their frames on a bus in a cycle, at worst. */
uint32_t takt_drives_io_bits(const struct drives *d, unsigned bus);
/* The same of nodes that have no more than what is wired. */
uint32_t takt_drives_io_wired_bits(const struct io_wiring *wiring, unsigned count, unsigned bus,
                                   const struct drives_rates *rates);
/*
 * Node guarding. Every node that is guarded is asked in one of this many cycles: a heartbeat's
 * period, or as many as there are nodes. life_ms: after which the node takes us for lost, and too
 * soon where that is less than two periods.
 */
uint32_t takt_drives_guard_cycles(const struct drives *d);
uint32_t takt_drives_guard_ms(const struct drives *d);
static inline bool drives_guards_in_time(const struct drives *d, uint32_t life_ms)
{
    return life_ms == 0 || life_ms >= 2 * takt_drives_guard_ms(d);
}
void takt_drives_begin_guard(struct drives *d, struct drives_guard *guard);
/* A heartbeat counts; an answer of a guarded node does when its toggle bit has changed. */
static inline bool drives_takes_beat(struct drives_guard *guard, const struct can_frame *frame)
{
    const uint8_t toggle = frame->data[0] & NMT_TOGGLE;

    if (!guard->is_on)
        return true;
    const bool counts = toggle != guard->toggle;

    guard->toggle = toggle;
    return counts;
}
void takt_drives_send_guard(struct drives *d, const struct can_port *port);
/* Bits of a question and its answer at worst; 0: nobody is guarded on this bus. */
uint32_t takt_drives_guard_bits(const struct drives *d, unsigned bus);

static inline bool drives_send_frame(const struct can_port *port, const struct can_frame *frame)
{
    return port->send(port->context, frame);
}
/* port: of the node's bus. */
bool takt_drives_send_nmt(const struct can_port *port, enum nmt_command command, uint8_t node);
/*
 * Drives that follow by velocity, drives_velocity.c. The target of a drive that stays where it is;
 * and of one on its way: what the setpoint moves in this cycle, and what the position lags behind
 * its setpoint.
 */
static inline bool drives_is_by_velocity(const struct drives_axis *axis)
{
    return cia402_is_velocity(axis->follow_mode);
}
void takt_drives_rest(struct drives_axis *axis);
void takt_drives_steer(struct drives *d, unsigned index, double step_mm, double lag_mm);
/*
 * The next mode in which a drive may follow targets after this one, CIA402_MODE_NONE before the
 * first; none: that.
 */
uint8_t takt_drives_mode_after(const struct drives_axis *axis, uint8_t mode);

/* One request, of the client that all nodes share. */
void takt_drives_ask(struct drives *d, unsigned bus, uint8_t node, const struct drives_step *step);
/* An answer, if it has come on the bus of the node that is asked. */
static inline void drives_take_sdo(struct drives *d, unsigned bus, const struct can_frame *frame)
{
    if (CAN_BUSES_MAX == 1 || bus == d->sdo_bus)
        takt_sdo_client_take(&d->sdo, frame);
}

static inline const char *drives_nmt_text(enum nmt_state state)
{
    if (state == NMT_BOOTED)
        return "restarted";
    return state == NMT_STOPPED ? "stopped" : "pre-operational";
}

/* Bits of a frame with n bytes at worst. A remote one is classical on any bus. */
uint32_t takt_drives_frame_bits(const struct drives_rates *rates, uint32_t n);
uint32_t takt_drives_remote_bits(void);
static inline uint32_t drives_bits(const struct drives *d, uint32_t n)
{
    return takt_drives_frame_bits(&d->rates, n);
}

/* Drives to a frame of targets: those of a bus, in their order. */
unsigned takt_drives_group_of(const struct drives_rates *rates);
static inline bool drives_are_grouped(const struct drives *d, unsigned i, unsigned k)
{
    return drives_bus_of(d, i) == drives_bus_of(d, k) &&
           d->axis[i].place / d->group == d->axis[k].place / d->group;
}
/* RPDO2 of the drive that is being configured, as its group has it. */
void takt_drives_set_target_pdo(const struct drives *d, struct pdo *pdo);
static inline bool drives_ends_group(const struct drives *d, unsigned i)
{
    const unsigned next = d->axis[i].place + 1U;
    return next % d->group == 0 || next == d->on_bus[drives_bus_of(d, i)];
}

/* A cycle of the phases DRIVES_SELECT, DRIVES_HOME and DRIVES_FOLLOW. */
void takt_drives_select(struct drives *d);
void takt_drives_home(struct drives *d);
void takt_drives_follow(struct drives *d);
/* A drive has booted, by our reset or not; a cycle of DRIVES_FAULTED. */
void takt_drives_doubt_home(struct drives *d, unsigned index);
void takt_drives_doubt_homes(struct drives *d);
/* The next order of axes that are homed; none: all drives are ready. */
void takt_drives_home_next(struct drives *d);

/* Gantries: drives_square.c. A cycle of DRIVES_SQUARE; what is watched in operation. */
void takt_drives_gantry_init(struct drives *d, const struct drives_config *config);
void takt_drives_begin_square(struct drives *d);
void takt_drives_square(struct drives *d);
void takt_drives_check_skew(struct drives *d);
/* The axis of a gantry is where its first drive is. */
void takt_drives_place_gantries(struct drives *d);
void takt_drives_enter_enabled(struct drives *d);
void takt_drives_check_all_links(struct drives *d);

/* Enabled, and neither reports nor heartbeats have ceased. */
static inline bool drives_is_linked(const struct drives *d, const struct drives_axis *axis)
{
    return cia402_is_enabled(axis->statusword) && !drives_is_silent(d, axis) &&
           drives_heartbeat_age_cycles(d, axis) <= d->heartbeat_age_max_cycles;
}

/* Touch probes: a cycle in which they are armed or read. */
void takt_drives_probe_next(struct drives *d);

/* Supervision, once a cycle. */
void takt_drives_check_operation(struct drives *d);
/*
 * The same as far as it concerns drives that hold a position while others are homed. True: no
 * fault.
 */
bool takt_drives_check_links(struct drives *d, unsigned index);

#endif

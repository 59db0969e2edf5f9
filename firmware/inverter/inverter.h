/*
 * The spindle behind a frequency converter with the registers of the Delta VFD-B and MS300 series: commanded speed in,
 * speed, load, trip and loss of the line out.
 *
 * Called once a control cycle; it never waits. Requests follow each other as fast as the line answers: the command when it
 * has changed, else what the converter reports.
 */
#ifndef TAKT_INVERTER_INVERTER_H
#define TAKT_INVERTER_INVERTER_H

#include "hal/inputs.h"
#include "hal/registers.h"

#include <stdbool.h>
#include <stdint.h>

/* Registers (Delta VFD-B user manual, communication addresses; MS300 has the same). */
#define INVERTER_COMMAND   0x2000 /* INVERTER_STOP, _FORWARD, _REVERSE, and one of 2002 */
#define INVERTER_FREQUENCY 0x2001 /* commanded, 0.01 Hz */
#define INVERTER_CONTROL   0x2002 /* bit 1: reset a trip */
#define INVERTER_ERROR     0x2100 /* low byte: number of the trip, 0: none; high byte: of a warning */
#define INVERTER_STATUS    0x2101
#define INVERTER_COMMANDED 0x2102 /* frequency, 0.01 Hz */
#define INVERTER_OUTPUT    0x2103 /* frequency, 0.01 Hz */
#define INVERTER_CURRENT   0x2104 /* 0.1 A */
#define INVERTER_TORQUE    0x210B /* 0.1 % of rated */
#define INVERTER_RPM       0x210C

#define INVERTER_STOP    0x01
#define INVERTER_FORWARD 0x12
#define INVERTER_REVERSE 0x22
#define INVERTER_RESET   0x02 /* of INVERTER_CONTROL */

#define INVERTER_ERROR_MASK 0x00FFU

/* Bits of INVERTER_STATUS. Direction in bits 4 and 3: 00 forward, 01 from reverse to forward, 10 from forward to reverse,
 * 11 reverse: so bit 3 tells how it turns, bit 4 what is commanded. */
#define INVERTER_RUNS             0x0003U /* bits 1 and 0: 00 stopped, 01 stopping, 10 standby, 11 running */
#define INVERTER_STOPS            0x0001U
#define INVERTER_TURNS_REVERSE    0x0008U
#define INVERTER_REVERSE_ORDERED  0x0010U
#define INVERTER_FREQUENCY_REMOTE 0x0100U /* frequency and command come over the line */
#define INVERTER_COMMAND_REMOTE   0x0400U

struct inverter_config {
    uint32_t cycle_us;
    double pole_pairs;       /* of the motor; with a gear, times its ratio: 60 f = rpm pole_pairs */
    double max_hz;           /* commanded at most */
    double ramp_rpm_s;       /* of the commanded speed; the converter's own ramp comes after it */
    double at_speed_percent; /* closer to the command than this is at speed */
    uint32_t silent_after_us; /* without an answer the converter counts as lost */
};

/* What a request under way is. */
enum inverter_request {
    INVERTER_NOTHING,
    INVERTER_WRITES_COMMAND,
    INVERTER_READS_STATUS, /* INVERTER_ERROR ... INVERTER_CURRENT */
    INVERTER_READS_LOAD,   /* INVERTER_TORQUE, INVERTER_RPM */
    INVERTER_RESETS
};

struct inverter {
    struct inverter_config config;
    enum inverter_request request;
    double ramp_rpm;     /* commanded now */
    uint16_t command[2]; /* as last written: command, frequency */
    bool is_written;     /* command[] has been acknowledged since the line is there */
    bool wants_reset;
    uint64_t quiet_us; /* since the last answer */
    bool heard;        /* ever */
    uint16_t error;    /* number of the trip; 0: none */
    double current_a;
    struct spindle_feedback feedback;
};

void takt_inverter_init(struct inverter *inverter, const struct inverter_config *config);

/*
 * One control cycle. commanded_rpm: positive clockwise. The angle is the integral of the reported speed, no
 * measurement: threads need an encoder.
 */
struct spindle_feedback takt_inverter_cycle(struct inverter *inverter,
                                            const struct registers_port *port,
                                            double commanded_rpm);

/* Stops without the ramp of the commands, by the converter's own: STOP is the next that is written. */
void takt_inverter_stop(struct inverter *inverter);
/* It has been written, or the converter does not answer. */
bool takt_inverter_is_stopped(const struct inverter *inverter);

/* Acknowledges a trip: the converter is reset once. */
void takt_inverter_reset(struct inverter *inverter);

#endif

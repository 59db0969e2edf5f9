/*
 * The spindle behind a frequency converter with the registers of the Delta VFD-B and MS300 series:
 * commanded speed in, speed, load, trip and loss of the line out.
 *
 * Called once a control cycle; it never waits. Requests follow each other as fast as the line
 * answers: the command when it has changed, else what the converter reports.
 */
#ifndef TAKT_VFD_VFD_H
#define TAKT_VFD_VFD_H

#include "hal/inputs.h"
#include "hal/registers.h"

#include <stdbool.h>
#include <stdint.h>

/* Registers (Delta VFD-B user manual, communication addresses; MS300 has the same). */
#define VFD_COMMAND   0x2000 /* VFD_STOP, _FORWARD, _REVERSE, and one of 2002 */
#define VFD_FREQUENCY 0x2001 /* commanded, 0.01 Hz */
#define VFD_CONTROL   0x2002 /* bit 1: reset a trip */
#define VFD_ERROR     0x2100 /* low byte: number of the trip, 0: none; high byte: of a warning */
#define VFD_STATUS    0x2101
#define VFD_COMMANDED 0x2102 /* frequency, 0.01 Hz */
#define VFD_OUTPUT    0x2103 /* frequency, 0.01 Hz */
#define VFD_CURRENT   0x2104 /* 0.1 A */
#define VFD_TORQUE    0x210B /* 0.1 % of rated */
#define VFD_RPM       0x210C

#define VFD_STOP    0x01
#define VFD_FORWARD 0x12
#define VFD_REVERSE 0x22
#define VFD_RESET   0x02 /* of VFD_CONTROL */

#define VFD_ERROR_MASK 0x00FFU

/*
 * Bits of VFD_STATUS. Direction in bits 4 and 3: 00 forward, 01 from reverse to forward, 10 from
 * forward to reverse, 11 reverse: so bit 3 tells how it turns, bit 4 what is commanded.
 */
/* bits 1 and 0: 00 stopped, 01 stopping, 10 standby, 11 running */
#define VFD_RUNS             0x0003U
#define VFD_STOPS            0x0001U
#define VFD_TURNS_REVERSE    0x0008U
#define VFD_REVERSE_ORDERED  0x0010U
#define VFD_FREQUENCY_REMOTE 0x0100U /* frequency and command come over the line */
#define VFD_COMMAND_REMOTE   0x0400U

struct vfd_config {
    uint32_t cycle_us;
    double pole_pairs;       /* of the motor; with a gear, times its ratio: 60 f = rpm pole_pairs */
    double max_hz;           /* commanded at most */
    double ramp_rpm_s;       /* of the commanded speed; the converter's own ramp comes after it */
    double at_speed_percent; /* closer to the command than this is at speed */
    uint32_t silent_after_us; /* without an answer the converter counts as lost */
};

/* What a request under way is. */
enum vfd_request {
    VFD_NOTHING,
    VFD_WRITES_COMMAND,
    VFD_READS_STATUS, /* VFD_ERROR ... VFD_CURRENT */
    VFD_READS_LOAD,   /* VFD_TORQUE, VFD_RPM */
    VFD_RESETS
};

struct vfd {
    struct vfd_config config;
    enum vfd_request request;
    double ramp_rpm;     /* commanded now */
    uint16_t command[2]; /* as last written: command, frequency */
    bool is_written;     /* command[] has been acknowledged since the line is there */
    bool is_refused;     /* the command was the last time */
    uint8_t resets;      /* that may still be tried */
    uint64_t quiet_us;   /* since the last answer */
    bool heard;          /* ever */
    uint16_t error;      /* number of the trip; 0: none */
    double current_a;
    struct spindle_feedback feedback;
};

void takt_vfd_init(struct vfd *vfd, const struct vfd_config *config);

/*
 * One control cycle. commanded_rpm: positive clockwise. The angle is the integral of the reported
 * speed, no measurement: threads need an encoder.
 */
struct spindle_feedback takt_vfd_cycle(struct vfd *vfd, const struct registers_port *port,
                                       double commanded_rpm);

/*
 * Stops without the ramp of the commands, by the converter's own: STOP is the next that is written.
 */
void takt_vfd_stop(struct vfd *vfd);
/* It has been written, or the converter does not answer. */
bool takt_vfd_is_stopped(const struct vfd *vfd);

/* Acknowledges a trip: the converter is reset; where it does not acknowledge that, three times. */
void takt_vfd_reset(struct vfd *vfd);

#endif

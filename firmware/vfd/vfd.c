#include "vfd/vfd.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

#define US_PER_S 1e6

/* Closer to standstill than this counts as standing, rpm. */
#define STANDSTILL_RPM 1.0

#define HZ_PER_COUNT      0.01
#define PERCENT_PER_COUNT 0.1
#define AMPERE_PER_COUNT  0.1
#define WORD_MAX          65535.0

/* Requests to reset: an answer may get lost, a refusal stays one. */
#define RESETS_MAX 3

void takt_vfd_init(struct vfd *vfd, const struct vfd_config *config)
{
    TAKT_ASSERT(config->cycle_us > 0 && config->pole_pairs > 0);
    memset(vfd, 0, sizeof *vfd);
    vfd->config = *config;
}

static double seconds(const struct vfd *v)
{
    return (double)v->config.cycle_us / US_PER_S;
}

/* The commanded speed moves by at most ramp dt, through 0 when it turns round. */
static void follow_ramp(struct vfd *v, double commanded_rpm)
{
    const double most_rpm = v->config.ramp_rpm_s * seconds(v);

    TAKT_ASSERT(most_rpm >= 0.0);
    v->ramp_rpm += maths_clamp(commanded_rpm - v->ramp_rpm, -most_rpm, most_rpm);
}

/* f = rpm pole pairs / 60 */
static uint16_t frequency_of(const struct vfd *v, double rpm)
{
    TAKT_ASSERT(v->config.max_hz >= 0.0);
    const double hz = maths_min(maths_abs(rpm) * v->config.pole_pairs / 60.0, v->config.max_hz);

    return (uint16_t)maths_min(takt_maths_round(hz / HZ_PER_COUNT), WORD_MAX);
}

/* What the registers COMMAND and FREQUENCY should hold. */
static void wanted_command(const struct vfd *v, double commanded_rpm, uint16_t word[2])
{
    const bool stands = maths_abs(v->ramp_rpm) < STANDSTILL_RPM && commanded_rpm == 0.0;

    word[1] = frequency_of(v, v->ramp_rpm);
    word[0] = v->ramp_rpm > 0.0 ? VFD_FORWARD : VFD_REVERSE;
    if (stands) {
        word[0] = VFD_STOP;
        word[1] = 0;
    }
}

static double rpm_of(const struct vfd *v, uint16_t frequency)
{
    TAKT_ASSERT(v->config.pole_pairs > 0);
    return (double)frequency * HZ_PER_COUNT * 60.0 / v->config.pole_pairs;
}

/* VFD_ERROR and the four registers behind it. */
static void take_status(struct vfd *v, const uint16_t *word)
{
    const double speed_rpm = rpm_of(v, word[VFD_OUTPUT - VFD_ERROR]);
    const bool reverse = (word[VFD_STATUS - VFD_ERROR] & VFD_TURNS_REVERSE) != 0;

    v->error = word[0] & VFD_ERROR_MASK;
    v->feedback.tripped = v->error != 0;
    v->feedback.speed_rpm = reverse ? -speed_rpm : speed_rpm;
    v->current_a = (double)word[VFD_CURRENT - VFD_ERROR] * AMPERE_PER_COUNT;
}

static void take_load(struct vfd *v, const uint16_t *word)
{
    v->feedback.load_percent = maths_abs((double)(int16_t)word[0]) * PERCENT_PER_COUNT;
}

static void take_answer(struct vfd *v, const uint16_t *word)
{
    TAKT_ASSERT(v->request != VFD_NOTHING);
    v->quiet_us = 0;
    v->heard = true;
    switch (v->request) {
    case VFD_WRITES_COMMAND:
        v->is_written = true;
        break;
    case VFD_READS_STATUS:
        take_status(v, word);
        break;
    case VFD_READS_LOAD:
        take_load(v, word);
        break;
    case VFD_RESETS:
        v->resets = 0;
        v->is_written = false;
        break;
    case VFD_NOTHING:
        break;
    }
}

/* True: nothing is under way any more. A converter that was away may have forgotten its command. */
static bool end_request(struct vfd *v, const struct registers_port *port)
{
    uint16_t word[REGISTERS_MAX] = {0};

    if (v->request == VFD_NOTHING)
        return true;
    switch (port->take(port->context, word)) {
    case REGISTERS_WAITING:
        return false;
    case REGISTERS_DONE:
        take_answer(v, word);
        return true;
    case REGISTERS_FAILED:
        break;
    }
    v->is_refused = v->request == VFD_WRITES_COMMAND;
    v->is_written = false;
    return true;
}

static void write_command(struct vfd *v, const struct registers_port *port, const uint16_t word[2])
{
    TAKT_ASSERT(v->request != VFD_WRITES_COMMAND);
    memcpy(v->command, word, sizeof v->command);
    v->is_written = false;
    v->request = VFD_WRITES_COMMAND;
    port->write(port->context, VFD_COMMAND, 2, word);
}

static void read_report(struct vfd *v, const struct registers_port *port)
{
    if (v->request == VFD_READS_STATUS) {
        v->request = VFD_READS_LOAD;
        port->read(port->context, VFD_TORQUE, 1);
    } else {
        v->request = VFD_READS_STATUS;
        port->read(port->context, VFD_ERROR, VFD_CURRENT - VFD_ERROR + 1);
    }
}

static void reset(struct vfd *v, const struct registers_port *port)
{
    static const uint16_t word = VFD_RESET;

    TAKT_ASSERT(v->resets > 0 && v->resets <= RESETS_MAX);
    v->resets--;
    v->is_refused = false;
    v->request = VFD_RESETS;
    port->write(port->context, VFD_CONTROL, 1, &word);
}

/*
 * After each command, and each reset, comes a report, so that neither a ramp nor a converter that
 * refuses silences the reports. The command is first, for it may be STOP; where it is refused, as
 * of one that has tripped, the reset.
 */
static void begin_request(struct vfd *v, const struct registers_port *port, double commanded_rpm)
{
    const bool reported = v->request != VFD_WRITES_COMMAND && v->request != VFD_RESETS;
    uint16_t word[2];

    wanted_command(v, commanded_rpm, word);
    const bool is_due = !v->is_written || memcmp(word, v->command, sizeof v->command) != 0;

    if (reported && v->resets > 0 && (!is_due || v->is_refused)) {
        reset(v, port);
    } else if (reported && is_due) {
        write_command(v, port, word);
    } else {
        read_report(v, port);
    }
}

static bool is_at_speed(const struct vfd *v, double commanded_rpm)
{
    const double room_rpm =
        maths_max(STANDSTILL_RPM, 0.01 * v->config.at_speed_percent * maths_abs(commanded_rpm));

    return !v->feedback.tripped && !v->feedback.silent &&
           maths_abs(v->feedback.speed_rpm - commanded_rpm) <= room_rpm;
}

/* Silence counts from power-on too: a converter that never answers is lost. */
static void watch_silence(struct vfd *v)
{
    v->quiet_us += v->config.cycle_us;
    v->feedback.silent = v->quiet_us > v->config.silent_after_us;
}

struct spindle_feedback takt_vfd_cycle(struct vfd *v, const struct registers_port *port,
                                       double commanded_rpm)
{
    watch_silence(v);
    follow_ramp(v, commanded_rpm);
    if (end_request(v, port))
        begin_request(v, port, commanded_rpm);
    v->feedback.angle_rev += v->feedback.speed_rpm / 60.0 * seconds(v);
    v->feedback.at_speed = is_at_speed(v, commanded_rpm);
    return v->feedback;
}

void takt_vfd_stop(struct vfd *vfd)
{
    vfd->ramp_rpm = 0.0;
}

bool takt_vfd_is_stopped(const struct vfd *vfd)
{
    return vfd->feedback.silent || (vfd->is_written && vfd->command[0] == VFD_STOP);
}

void takt_vfd_reset(struct vfd *vfd)
{
    vfd->resets = RESETS_MAX;
}

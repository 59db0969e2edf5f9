#include "stm32/servo_motor.h"

#include "base/maths.h"
#include "stm32/pwm.h"
#include "stm32/timers.h"

#include <string.h>

#define HOME_BIT 2U /* of MOTOR_HOME: it has its edge from the timer */

static double encoder_mm(const struct servo_motor *m, int64_t counts)
{
    return (double)counts * m->config.encoder_step_mm;
}

static void read_encoder(struct servo_motor *m)
{
    m->counts_before = m->counts;
    m->counts = takt_quadrature_read(&m->encoder);
}

static struct motor_latch latch_at(const struct servo_motor *m, int64_t counts)
{
    return (struct motor_latch){encoder_mm(m, counts),
                                (m->counts > m->counts_before) - (m->counts < m->counts_before)};
}

/* width = torque / whole torque */
static int32_t width_of(const struct servo_motor *m, double torque_mm_s2)
{
    const double counts = takt_maths_round(torque_mm_s2 * m->counts_per_mm_s2);

    return (int32_t)maths_clamp(counts, -m->whole_counts, m->whole_counts);
}

static uint32_t read_switches(const struct servo_motor *m)
{
    uint32_t inputs = 0;

    for (unsigned i = 0; i < MOTOR_INPUTS; i++)
        inputs |= takt_gpio_read(m->config.switches[i]) ? 1U << i : 0;
    return inputs;
}

/* Limit switches have their edges where the encoder is at the end of the step. */
static void latch_switches(struct servo_motor *m)
{
    const uint32_t inputs = read_switches(m), changed = inputs ^ m->sense.inputs;
    int64_t counts = m->counts;

    (void)takt_quadrature_take_edge(&m->encoder, QUADRATURE_SWITCH, &counts);
    for (unsigned i = 0; i < MOTOR_INPUTS; i++) {
        if ((changed >> i & 1U) != 0)
            m->sense.edge[i] = latch_at(m, i == HOME_BIT ? counts : m->counts);
    }
    m->sense.inputs = inputs;
}

static void latch_index(struct servo_motor *m)
{
    int64_t counts;

    if (!takt_quadrature_take_edge(&m->encoder, QUADRATURE_INDEX, &counts))
        return;
    m->sense.pulses++;
    m->sense.pulse = latch_at(m, counts);
}

/* The watchdog ends it if there is no timer. */
static void wait_for_step(struct servo_motor *m)
{
    m->is_late = m->is_late || takt_timers_cycle_is_due();
    while (!takt_timers_cycle_is_due()) {
    }
    takt_timers_take_cycle();
}

static double turn_motor(void *context, double torque_mm_s2, double step_s)
{
    struct servo_motor *m = context;

    (void)step_s;
    takt_pwm_set(width_of(m, torque_mm_s2));
    wait_for_step(m);
    read_encoder(m);
    latch_switches(m);
    latch_index(m);
    return encoder_mm(m, m->counts);
}

/* There is no sensor of temperature. */
static void sense_motor(void *context, uint32_t cycle_ns, struct motor_sense *sense)
{
    struct servo_motor *m = context;

    (void)cycle_ns;
    m->sense.encoder_mm = encoder_mm(m, m->counts);
    *sense = m->sense;
}

void takt_servo_motor_open(struct servo_motor *motor, const struct servo_motor_config *config)
{
    struct servo_motor *m = motor;

    memset(m, 0, sizeof *m);
    m->config = *config;
    m->sense.torque_ratio = 1;
    takt_quadrature_open(&m->encoder);
    m->whole_counts = (int32_t)takt_pwm_open(config->timer_hz, config->pulses_hz);
    m->counts_per_mm_s2 = m->whole_counts / config->whole_mm_s2;
    m->sense.inputs = read_switches(m);
}

struct motor_port takt_servo_motor_get_port(struct servo_motor *motor)
{
    return (struct motor_port){.turn = turn_motor, .sense = sense_motor, .context = motor};
}

void takt_servo_motor_arm(struct servo_motor *motor, bool on)
{
    if (on != motor->is_armed)
        takt_pwm_arm(on);
    motor->is_armed = on;
}

bool takt_servo_motor_has_failed(const struct servo_motor *motor)
{
    return motor->is_armed && takt_pwm_is_broken();
}

bool takt_servo_motor_take_late(struct servo_motor *motor)
{
    const bool was = motor->is_late;

    motor->is_late = false;
    return was;
}

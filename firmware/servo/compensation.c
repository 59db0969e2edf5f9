#include "servo/compensation.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

void takt_compensation_init(struct compensation *compensation, const struct motor_port *motor)
{
    memset(compensation, 0, sizeof *compensation);
    if (motor != NULL)
        compensation->motor = *motor;
}

static double play_mm(const struct compensation *c)
{
    TAKT_ASSERT(c->direction >= -1 && c->direction <= 1);
    return c->direction * c->backlash_mm / 2;
}

void takt_compensation_set_backlash(struct compensation *compensation, double backlash_mm)
{
    compensation->backlash_mm = backlash_mm;
    compensation->play_mm = (struct fade){.value = play_mm(compensation)};
    compensation->followed_mm = compensation->play_mm.value;
}

/* x = y + K(y - origin),  y = encoder - play */
static double axis_mm(const struct compensation *c, double encoder_mm)
{
    double motor_mm = encoder_mm - c->play_mm.value;
    return c->is_homed ? motor_mm + takt_pitch_at(&c->pitch, motor_mm - c->origin_mm) : motor_mm;
}

double takt_compensation_get_axis_mm(const struct compensation *compensation)
{
    return axis_mm(compensation, compensation->encoder_mm);
}

/* Most drives have no such table: the motor is the axis. */
static bool takes_nothing(const struct compensation *c)
{
    return c->backlash_mm == 0 && c->pitch.points == 0;
}

static double turn_axis(void *context, double torque_mm_s2, double step_s)
{
    struct compensation *c = context;
    c->encoder_mm = c->motor.turn(c->motor.context, torque_mm_s2, step_s);
    if (takes_nothing(c))
        return c->encoder_mm;
    (void)fade_cycle(&c->play_mm, play_mm(c), &c->pace);
    return takt_compensation_get_axis_mm(c);
}

static void sense_axis(void *context, uint32_t cycle_ns, struct motor_sense *sense)
{
    struct compensation *c = context;
    c->motor.sense(c->motor.context, cycle_ns, sense);
    c->encoder_mm = sense->encoder_mm;
    if (takes_nothing(c))
        return;
    sense->encoder_mm = takt_compensation_get_axis_mm(c);
    sense->pulse.encoder_mm = axis_mm(c, sense->pulse.encoder_mm);
    for (unsigned i = 0; i < MOTOR_INPUTS; i++)
        sense->edge[i].encoder_mm = axis_mm(c, sense->edge[i].encoder_mm);
}

struct motor_port takt_compensation_get_port(struct compensation *compensation)
{
    return (struct motor_port){.turn = turn_axis, .sense = sense_axis, .context = compensation};
}

/*
 * A fade of b over the time T has accelerations of A b / T2 at most, A being those of 1 over a
 * second.
 */
static double crossing_s(double backlash_mm, double acceleration_mm_s2)
{
    struct fade_pace second;
    TAKT_ASSERT(backlash_mm >= 0.0);
    takt_fade_pace_set(&second, 1, 1.0 / FADE_CYCLES_MIN);
    return maths_sqrt(takt_fade_acceleration_per_s2(&second) * backlash_mm / acceleration_mm_s2);
}

/*
 * Where the motor is to be lies in a window as wide as the resolution, which it pushes along: at
 * which end is the direction. The motor's way is that of the axis and of the play: a play that
 * fades is no way back.
 */
void takt_compensation_follow(struct compensation *compensation, const struct compensation_way *way)
{
    struct compensation *c = compensation;
    double slack_mm = c->slack_mm + way->way_mm + (c->play_mm.value - c->followed_mm);
    double before = c->direction;
    c->followed_mm = c->play_mm.value;
    c->slack_mm = maths_clamp(slack_mm, 0, way->resolution_mm);
    if (slack_mm != c->slack_mm)
        c->direction = slack_mm > c->slack_mm ? 1 : -1;
    if (c->direction != before)
        takt_fade_pace_set(&c->pace, crossing_s(c->backlash_mm, way->acceleration_mm_s2),
                           way->step_s);
}

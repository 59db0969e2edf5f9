/*
 * Homing mode (CiA 402-2): methods 1 to 14 and, without the index pulse, 17 to 30 by a switch, 33
 * and 34 by an index pulse, 35 and 37 here and now; and -1 to -4, as several makers have them, by a
 * hard stop.
 *
 *     SEARCH --switch--> (PASS --left again-->) EDGE --switch--> (INDEX --pulse-->) STOP --stands--> IDLE, homed
 *     PUSH --hard stop--> (INDEX --pulse-->) STOP
 *       (fast)                (fast)           (slow)             (slow)
 *
 * The encoder is latched where switch and pulse truly are (hal/motor.h), not where the cycle
 * happens to see them.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "servo/servo_private.h"

#include <stddef.h>

#define INPUT_NEGATIVE_LIMIT MOTOR_NEGATIVE_LIMIT
#define INPUT_POSITIVE_LIMIT MOTOR_POSITIVE_LIMIT
#define INPUT_HOME           MOTOR_HOME
#define INPUT_PROBE          0x10000u
#define INPUT_STOP           0x20000u /* of methods alone: a hard stop is felt, not seen */

#define HOMING_BEGUN       0
#define HOMING_ATTAINED    1
#define HOMING_INTERRUPTED 2
#define HOMING_WENT_WRONG  3

#define METHOD_HERE     37
#define METHOD_HERE_OLD 35

/* A motor that stands for so long with so much torque (2003) is at a hard stop. */
#define PUSH_NS (UINT64_C(10) * MILLISECOND_NS)

/*
 * First fast in direction `search` until the input is as `search_until`; then, where the edge is
 * that from outside, on in direction `pass` until it is no longer; then slowly in direction `edge`
 * until it changes, then on to the next index pulse. A method without search has only the pulse.
 * The home switch of 7 to 14 and 23 to 30 lies between the ends of the axis: an end that is met
 * first turns the search round.
 *
 *                     ________            edge that counts, and on which side of it the pulse is
 *     _______________|  home  |______         7, 8: left edge, left and right of it; 9, 10: right edge
 *      --search-->                           14, 13:                                12, 11:         <--search--
 */
struct method {
    int8_t number;
    uint32_t input; /* 0: no switch */
    int8_t search;
    bool search_until;
    int8_t pass; /* 0: not */
    int8_t edge;
    bool has_index, turns_round;
};

#define END(number, input, search, has_index)                                                      \
    {                                                                                              \
        number, input, search, true, 0, -(search), has_index, false                                \
    }
#define CAM(number, search, pass, edge, has_index)                                                 \
    {                                                                                              \
        number, INPUT_HOME, search, true, pass, edge, has_index, true                              \
    }

static const struct method methods[] = {
    END(1, INPUT_NEGATIVE_LIMIT, -1, true),
    END(17, INPUT_NEGATIVE_LIMIT, -1, false),
    END(2, INPUT_POSITIVE_LIMIT, 1, true),
    END(18, INPUT_POSITIVE_LIMIT, 1, false),
    END(3, INPUT_HOME, 1, true),
    END(19, INPUT_HOME, 1, false),
    {4, INPUT_HOME, -1, false, 0, 1, true, false},
    {20, INPUT_HOME, -1, false, 0, 1, false, false},
    END(5, INPUT_HOME, -1, true),
    END(21, INPUT_HOME, -1, false),
    {6, INPUT_HOME, 1, false, 0, -1, true, false},
    {22, INPUT_HOME, 1, false, 0, -1, false, false},
    CAM(7, 1, 0, -1, true),
    CAM(23, 1, 0, -1, false),
    CAM(8, 1, -1, 1, true),
    CAM(24, 1, -1, 1, false),
    CAM(9, 1, 1, -1, true),
    CAM(25, 1, 1, -1, false),
    CAM(10, 1, 0, 1, true),
    CAM(26, 1, 0, 1, false),
    CAM(11, -1, 0, 1, true),
    CAM(27, -1, 0, 1, false),
    CAM(12, -1, 1, -1, true),
    CAM(28, -1, 1, -1, false),
    CAM(13, -1, -1, 1, true),
    CAM(29, -1, -1, 1, false),
    CAM(14, -1, 0, -1, true),
    CAM(30, -1, 0, -1, false),
    {33, 0, 0, false, 0, -1, true, false},
    {34, 0, 0, false, 0, 1, true, false},
    END(-1, INPUT_STOP, -1, true),
    END(-2, INPUT_STOP, 1, true),
    END(-3, INPUT_STOP, 1, false),
    END(-4, INPUT_STOP, -1, false),
};

static const struct method *find_method(int32_t number)
{
    for (unsigned i = 0; i < sizeof methods / sizeof methods[0]; i++)
        if (methods[i].number == number)
            return &methods[i];
    return NULL;
}

bool takt_servo_has_homing_method(int32_t method)
{
    return method == METHOD_HERE || method == METHOD_HERE_OLD || find_method(method);
}

uint32_t takt_servo_inputs(const struct servo *drive)
{
    return drive->loop.sense.inputs | (drive->probe.touches ? INPUT_PROBE : 0);
}

/*
 * The pulse comes once a turn of the motor; the next one that is passed in this direction counts.
 */
static void await_index(struct servo *drive, double direction)
{
    TAKT_ASSERT(direction != 0.0);
    drive->homing.index_direction = direction > 0 ? 1 : -1;
    drive->homing.pulses = drive->loop.sense.pulses;
    drive->homing.phase = HOMING_INDEX;
}

static void tell(const struct servo *drive, uint32_t what)
{
    takt_servo_tell(drive, DRIVE_EVENT_HOMING, what, (uint8_t)drive->homing.method);
}

static void latch(struct servo *drive, double at_encoder_mm)
{
    drive->homing.encoder_mm = at_encoder_mm;
    drive->homing.phase = HOMING_STOP;
}

void takt_servo_begin_homing(struct servo *drive)
{
    const struct method *method = find_method(drive->objects.settings.homing_method);
    drive->homing.method = drive->objects.settings.homing_method;
    drive->homing.is_homed = false;
    takt_servo_take_origin(drive);
    drive->homing.push_ns = 0;
    tell(drive, HOMING_BEGUN);
    if (!method) {
        latch(drive, drive->loop.measured_mm);
        return;
    }
    drive->homing.search = method->search;
    if (!method->input)
        await_index(drive, method->edge * servo_sign(drive));
    else
        drive->homing.phase = method->input == INPUT_STOP ? HOMING_PUSH : HOMING_SEARCH;
}

void takt_servo_interrupt_homing(struct servo *drive)
{
    if (drive->homing.phase == HOMING_IDLE)
        return;
    if (drive->homing.phase != HOMING_FAILED)
        tell(drive, HOMING_INTERRUPTED);
    drive->homing.phase = HOMING_IDLE;
}

static double speed_mm_s(const struct servo *drive, unsigned i)
{
    TAKT_ASSERT(i < 2);
    return drive->objects.settings.homing_velocity[i] / servo_velocity_scale(drive);
}

static void run_towards(struct servo *drive, int8_t direction, double velocity_mm_s,
                        uint32_t cycle_ns)
{
    double acceleration_mm_s2 =
        drive->objects.settings.homing_acceleration / servo_velocity_scale(drive);
    TAKT_ASSERT(velocity_mm_s >= 0.0 && cycle_ns > 0);
    takt_servo_run_at(drive, direction * servo_sign(drive) * velocity_mm_s, acceleration_mm_s2,
                      cycle_ns);
}

/*
 * Directions of a method are those of the drive. An end of the axis that the method does not want
 * is where it fails.
 */
static bool hits_other_end(const struct servo *drive, const struct method *method, int8_t direction)
{
    uint32_t end = direction < 0 ? INPUT_NEGATIVE_LIMIT : INPUT_POSITIVE_LIMIT;
    return method->input != end && takt_servo_inputs(drive) & end;
}

/* What was latched when the switch of the method changed last. */
static const struct motor_latch *edge_of(const struct servo *drive, const struct method *method)
{
    const struct motor_latch *edge = drive->loop.sense.edge;
    if (method->input == INPUT_HOME)
        return &edge[2];
    return method->input == INPUT_POSITIVE_LIMIT ? &edge[1] : &edge[0];
}

static bool moved_in(const struct servo *drive, const struct method *method, int8_t direction)
{
    return edge_of(drive, method)->direction * direction * servo_sign(drive) > 0;
}

static void fail(struct servo *drive)
{
    drive->homing.phase = HOMING_FAILED;
    tell(drive, HOMING_WENT_WRONG);
}

static bool is_active(const struct servo *drive, const struct method *method)
{
    return takt_servo_inputs(drive) & method->input;
}

/*
 * The switch has just become so, and the motor runs in this direction. Where it has overrun a short
 * one it meets the other edge first, and in the other direction.
 */
static bool becomes(struct servo *drive, const struct method *method, bool level, int8_t direction)
{
    bool was = drive->homing.was_active;
    bool is = is_active(drive, method);
    drive->homing.was_active = is;
    return is == level && was != level && moved_in(drive, method, direction);
}

/* An end of the axis that is met turns the search round, once, where the method says so. */
static void meet_end(struct servo *drive, const struct method *method)
{
    if (method->turns_round && drive->homing.search == method->search)
        drive->homing.search = (int8_t)-method->search;
    else
        fail(drive);
}

static void search(struct servo *drive, const struct method *method, uint32_t cycle_ns)
{
    drive->homing.was_active = is_active(drive, method);
    if (drive->homing.was_active == method->search_until) {
        drive->homing.phase = method->pass != 0 ? HOMING_PASS : HOMING_EDGE;
        return;
    }
    run_towards(drive, drive->homing.search, speed_mm_s(drive, 0), cycle_ns);
    if (hits_other_end(drive, method, drive->homing.search))
        meet_end(drive, method);
}

/* Out of the switch, on the side from which its edge counts. */
static void pass(struct servo *drive, const struct method *method, uint32_t cycle_ns)
{
    run_towards(drive, method->pass, speed_mm_s(drive, 0), cycle_ns);
    if (hits_other_end(drive, method, method->pass))
        fail(drive);
    else if (becomes(drive, method, !method->search_until, method->pass))
        drive->homing.phase = HOMING_EDGE;
}

/* The edge counts when it is crossed in the direction of the method. */
static void find_edge(struct servo *drive, const struct method *method, uint32_t cycle_ns)
{
    bool level = method->pass != 0 ? method->search_until : !method->search_until;
    run_towards(drive, method->edge, speed_mm_s(drive, 1), cycle_ns);
    if (hits_other_end(drive, method, method->edge)) {
        fail(drive);
        return;
    }
    if (!becomes(drive, method, level, method->edge))
        return;
    if (method->has_index)
        await_index(drive, method->edge * servo_sign(drive));
    else
        latch(drive, edge_of(drive, method)->encoder_mm);
}

static void leave_stop(struct servo *drive)
{
    takt_servo_loop_let_go(&drive->loop);
    drive->velocity_mm_s = 0;
}

/* Until the motor stands with the torque of 2003. */
static void push(struct servo *drive, const struct method *method, uint32_t cycle_ns)
{
    const struct servo_loop *loop = &drive->loop;
    double sign = method->search * servo_sign(drive);
    double threshold = drive->objects.settings.homing_torque / TORQUE_PER_RATED;
    run_towards(drive, method->search, speed_mm_s(drive, 0), cycle_ns);
    bool pushes = sign * takt_servo_loop_torque_ratio(loop) >= threshold &&
                  maths_abs(loop->measured_velocity_mm_s) <= loop->standstill_mm_s;
    drive->homing.push_ns = pushes ? drive->homing.push_ns + cycle_ns : 0;
    if (drive->homing.push_ns < PUSH_NS)
        return;
    leave_stop(drive);
    if (method->has_index)
        await_index(drive, -sign);
    else
        latch(drive, loop->measured_mm);
}

static void find_index(struct servo *drive, const struct method *method, uint32_t cycle_ns)
{
    const struct motor_sense *sense = &drive->loop.sense;
    run_towards(drive, method->edge, speed_mm_s(drive, 1), cycle_ns);
    bool is_passed = sense->pulses != drive->homing.pulses &&
                     sense->pulse.direction == drive->homing.index_direction;
    drive->homing.pulses = sense->pulses;
    if (is_passed)
        latch(drive, sense->pulse.encoder_mm);
    else if (hits_other_end(drive, method, method->edge))
        fail(drive);
}

/* Position 0 is where home offset (607C) says: home itself is at minus the offset. */
static void stop(struct servo *drive, uint32_t cycle_ns)
{
    run_towards(drive, 1, 0, cycle_ns);
    if (drive->velocity_mm_s != 0)
        return;
    double home_mm = -(double)drive->objects.settings.home_offset / drive->increments_per_mm;
    drive->origin_mm =
        drive->homing.encoder_mm - takt_pitch_get_motor_mm(&drive->compensation.pitch, home_mm);
    drive->homing.is_homed = true;
    takt_servo_take_origin(drive);
    drive->homing.phase = HOMING_IDLE;
    takt_servo_hold(drive);
    tell(drive, HOMING_ATTAINED);
}

void takt_servo_run_homing(struct servo *drive, uint32_t cycle_ns)
{
    const struct method *method = find_method(drive->homing.method);
    switch (drive->homing.phase) {
    case HOMING_SEARCH:
        search(drive, method, cycle_ns);
        break;
    case HOMING_PASS:
        pass(drive, method, cycle_ns);
        break;
    case HOMING_PUSH:
        push(drive, method, cycle_ns);
        break;
    case HOMING_EDGE:
        find_edge(drive, method, cycle_ns);
        break;
    case HOMING_INDEX:
        find_index(drive, method, cycle_ns);
        break;
    case HOMING_STOP:
        stop(drive, cycle_ns);
        break;
    case HOMING_IDLE:
    case HOMING_FAILED:
        run_towards(drive, 1, 0, cycle_ns);
        break;
    }
}

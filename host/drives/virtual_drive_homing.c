/*
 * Homing mode (CiA 402-2): methods 1 to 14 and, without the index pulse, 17 to 30 by a switch, 33 and 34 by an index pulse,
 * 35 and 37 here and now; and -1 to -4, as several makers have them, by a hard stop.
 *
 *     SEARCH --switch--> (PASS --left again-->) EDGE --switch--> (INDEX --pulse-->) STOP --stands--> IDLE, homed
 *     PUSH --hard stop--> (INDEX --pulse-->) STOP
 *       (fast)                (fast)           (slow)             (slow)
 *
 * The encoder is latched where switch and pulse truly are, as the hardware of a drive does it, not
 * where the cycle happens to see them.
 */
#include "base/maths.h"
#include "drives/virtual_drive_private.h"

#include <stddef.h>

#define INPUT_NEGATIVE_LIMIT 0x1u
#define INPUT_POSITIVE_LIMIT 0x2u
#define INPUT_HOME           0x4u
#define INPUT_PROBE          0x10000u
#define INPUT_STOP           0x20000u /* of methods alone: a hard stop is felt, not seen */

#define HOMING_BEGUN       0
#define HOMING_ATTAINED    1
#define HOMING_INTERRUPTED 2
#define HOMING_WENT_WRONG  3

#define TORQUE_PER_RATED 1000.0

#define METHOD_HERE     37
#define METHOD_HERE_OLD 35

/* A motor that stands for so long with so much torque (2003) is at a hard stop. */
#define PUSH_NS (UINT64_C(10) * MILLISECOND_NS)

/*
 * First fast in direction `search` until the input is as `search_until`; then, where the edge is that from outside, on in
 * direction `pass` until it is no longer; then slowly in direction `edge` until it changes, then on to the next index pulse.
 * A method without search has only the pulse. The home switch of 7 to 14 and 23 to 30 lies between the ends of the axis: an
 * end that is met first turns the search round.
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

bool virtual_drive_has_homing_method(int32_t method)
{
    return method == METHOD_HERE || method == METHOD_HERE_OLD || find_method(method);
}

/* How far the table is beyond the beginning of the home switch, in the drive's own direction. */
static double into_home_mm(const struct virtual_drive *drive)
{
    double table_mm = drive_plant_table_mm(&drive->plant);
    return virtual_drive_sign(drive) * (table_mm - drive->config.plant.home_switch_mm);
}

static bool is_in_home(const struct virtual_drive *drive)
{
    double length_mm = drive->config.plant.home_switch_length_mm;
    double into_mm = into_home_mm(drive);
    return into_mm >= 0 && (length_mm <= 0 || into_mm <= length_mm);
}

uint32_t virtual_drive_inputs(const struct virtual_drive *drive)
{
    const struct drive_plant_config *c = &drive->config.plant;
    double table_mm = drive_plant_table_mm(&drive->plant);
    bool is_turned = virtual_drive_sign(drive) < 0;
    uint32_t inputs = 0;
    if (table_mm <= c->limit_switch_min_mm)
        inputs |= is_turned ? INPUT_POSITIVE_LIMIT : INPUT_NEGATIVE_LIMIT;
    if (table_mm >= c->limit_switch_max_mm)
        inputs |= is_turned ? INPUT_NEGATIVE_LIMIT : INPUT_POSITIVE_LIMIT;
    if (is_in_home(drive))
        inputs |= INPUT_HOME;
    if (drive->probe.touches)
        inputs |= INPUT_PROBE;
    return inputs;
}

/* How far the table is beyond the edge that has been crossed in this direction of the drive, as the axis counts. */
static double past_edge_mm(const struct virtual_drive *drive, uint32_t input, int8_t direction,
                           bool is_active)
{
    const struct drive_plant_config *c = &drive->config.plant;
    double table_mm = drive_plant_table_mm(&drive->plant);
    double sign = virtual_drive_sign(drive);
    bool is_far_edge = (direction > 0) != is_active;
    if (input == INPUT_HOME)
        return sign * (into_home_mm(drive) - (is_far_edge ? c->home_switch_length_mm : 0));
    bool is_lower = (input == INPUT_NEGATIVE_LIMIT) == (sign > 0);
    return table_mm - (is_lower ? c->limit_switch_min_mm : c->limit_switch_max_mm);
}

/* What the encoder reads at a position of the motor. */
static double encoder_mm(const struct virtual_drive *drive, double motor_mm)
{
    return motor_mm + drive->plant.encoder_shift_mm;
}

/* The pulse comes once a turn, where the motor's angle is 0. */
static void await_index(struct virtual_drive *drive, double direction)
{
    double turn_mm = drive->config.plant.travel_per_revolution_mm;
    double turns = drive->plant.position_mm / turn_mm;
    double next = direction > 0 ? maths_floor(turns) + 1 : maths_ceil(turns) - 1;
    drive->homing.index_mm = next * turn_mm;
    drive->homing.phase = HOMING_INDEX;
}

static void tell(const struct virtual_drive *drive, uint32_t what)
{
    virtual_drive_tell(drive, DRIVE_EVENT_HOMING, what, (uint8_t)drive->homing.method);
}

static void latch(struct virtual_drive *drive, double at_encoder_mm)
{
    drive->homing.encoder_mm = at_encoder_mm;
    drive->homing.phase = HOMING_STOP;
}

void virtual_drive_begin_homing(struct virtual_drive *drive)
{
    const struct method *method = find_method(drive->objects.settings.homing_method);
    drive->homing.method = drive->objects.settings.homing_method;
    drive->homing.is_homed = false;
    drive->homing.push_ns = 0;
    tell(drive, HOMING_BEGUN);
    if (!method) {
        latch(drive, drive->plant.measured_mm);
        return;
    }
    drive->homing.search = method->search;
    if (!method->input)
        await_index(drive, method->edge * virtual_drive_sign(drive));
    else
        drive->homing.phase = method->input == INPUT_STOP ? HOMING_PUSH : HOMING_SEARCH;
}

void virtual_drive_interrupt_homing(struct virtual_drive *drive)
{
    if (drive->homing.phase == HOMING_IDLE)
        return;
    if (drive->homing.phase != HOMING_FAILED)
        tell(drive, HOMING_INTERRUPTED);
    drive->homing.phase = HOMING_IDLE;
}

static double speed_mm_s(const struct virtual_drive *drive, unsigned i)
{
    return drive->objects.settings.homing_velocity[i] / virtual_drive_velocity_scale(drive);
}

static void run_towards(struct virtual_drive *drive, int8_t direction, double velocity_mm_s,
                        uint32_t cycle_ns)
{
    double acceleration_mm_s2 =
        drive->objects.settings.homing_acceleration / virtual_drive_velocity_scale(drive);
    virtual_drive_run_at(drive, direction * virtual_drive_sign(drive) * velocity_mm_s,
                         acceleration_mm_s2, cycle_ns);
}

/* Directions of a method are those of the drive. An end of the axis that the method does not want is where it fails. */
static bool hits_other_end(const struct virtual_drive *drive, const struct method *method,
                           int8_t direction)
{
    uint32_t end = direction < 0 ? INPUT_NEGATIVE_LIMIT : INPUT_POSITIVE_LIMIT;
    return method->input != end && virtual_drive_inputs(drive) & end;
}

static bool moves_in(const struct virtual_drive *drive, int8_t direction)
{
    return drive->plant.velocity_mm_s * direction * virtual_drive_sign(drive) > 0;
}

static void fail(struct virtual_drive *drive)
{
    drive->homing.phase = HOMING_FAILED;
    tell(drive, HOMING_WENT_WRONG);
}

static bool is_active(const struct virtual_drive *drive, const struct method *method)
{
    return virtual_drive_inputs(drive) & method->input;
}

/*
 * The switch has just become so, and the motor runs in this direction. Where it has overrun a short one it meets the other
 * edge first, and in the other direction.
 */
static bool becomes(struct virtual_drive *drive, const struct method *method, bool level,
                    int8_t direction)
{
    bool was = drive->homing.was_active;
    bool is = is_active(drive, method);
    drive->homing.was_active = is;
    return is == level && was != level && moves_in(drive, direction);
}

/* An end of the axis that is met turns the search round, once, where the method says so. */
static void meet_end(struct virtual_drive *drive, const struct method *method)
{
    if (method->turns_round && drive->homing.search == method->search)
        drive->homing.search = (int8_t)-method->search;
    else
        fail(drive);
}

static void search(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
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
static void pass(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    run_towards(drive, method->pass, speed_mm_s(drive, 0), cycle_ns);
    if (hits_other_end(drive, method, method->pass))
        fail(drive);
    else if (becomes(drive, method, !method->search_until, method->pass))
        drive->homing.phase = HOMING_EDGE;
}

/* The edge counts when it is crossed in the direction of the method. */
static void find_edge(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    bool level = method->pass != 0 ? method->search_until : !method->search_until;
    run_towards(drive, method->edge, speed_mm_s(drive, 1), cycle_ns);
    if (hits_other_end(drive, method, method->edge)) {
        fail(drive);
        return;
    }
    if (!becomes(drive, method, level, method->edge))
        return;
    double past_mm = past_edge_mm(drive, method->input, method->edge, level);
    if (method->has_index)
        await_index(drive, method->edge * virtual_drive_sign(drive));
    else
        latch(drive, encoder_mm(drive, drive->plant.position_mm - past_mm));
}

/* The command has gone on while the motor stood: it comes back, and nothing pushes any more. */
static void leave_stop(struct virtual_drive *drive)
{
    drive->plant.command_mm = drive->plant.measured_mm;
    drive->plant.command_velocity_mm_s = drive->velocity_mm_s = 0;
    drive->plant.integral_mm_s2 = 0;
}

/* Until the motor stands with the torque of 2003. */
static void push(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    const struct drive_plant *plant = &drive->plant;
    double sign = method->search * virtual_drive_sign(drive);
    double threshold = drive->objects.settings.homing_torque / TORQUE_PER_RATED;
    run_towards(drive, method->search, speed_mm_s(drive, 0), cycle_ns);
    bool pushes = sign * drive_plant_torque_ratio(plant) >= threshold &&
                  maths_abs(plant->measured_velocity_mm_s) <= plant->standstill_mm_s;
    drive->homing.push_ns = pushes ? drive->homing.push_ns + cycle_ns : 0;
    if (drive->homing.push_ns < PUSH_NS)
        return;
    leave_stop(drive);
    if (method->has_index)
        await_index(drive, -sign);
    else
        latch(drive, plant->measured_mm);
}

static void find_index(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    double index_mm = drive->homing.index_mm;
    run_towards(drive, method->edge, speed_mm_s(drive, 1), cycle_ns);
    if ((drive->plant.position_mm - index_mm) * method->edge * virtual_drive_sign(drive) >= 0)
        latch(drive, encoder_mm(drive, index_mm));
    else if (hits_other_end(drive, method, method->edge))
        fail(drive);
}

/* Position 0 is where home offset (607C) says: home itself is at minus the offset. */
static void stop(struct virtual_drive *drive, uint32_t cycle_ns)
{
    run_towards(drive, 1, 0, cycle_ns);
    if (drive->velocity_mm_s != 0)
        return;
    drive->origin_mm =
        drive->homing.encoder_mm + drive->objects.settings.home_offset / drive->increments_per_mm;
    drive->homing.is_homed = true;
    drive->homing.phase = HOMING_IDLE;
    virtual_drive_hold(drive);
    tell(drive, HOMING_ATTAINED);
}

void virtual_drive_run_homing(struct virtual_drive *drive, uint32_t cycle_ns)
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

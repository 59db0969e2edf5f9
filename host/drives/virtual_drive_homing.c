/*
 * Homing mode: methods 1 to 4 and 17 to 20 by a switch, 33 and 34 by an index pulse, 35 and 37 here
 * and now (CiA 402-2, homing mode).
 *
 *     SEARCH --switch--> EDGE --switch--> INDEX --pulse--> STOP --stands--> IDLE, homed
 *       (fast)           (slow)            (slow)
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

#define HOMING_BEGUN       0
#define HOMING_ATTAINED    1
#define HOMING_INTERRUPTED 2
#define HOMING_WENT_WRONG  3

#define METHOD_HERE     37
#define METHOD_HERE_OLD 35

/*
 * First fast in direction `search` until the input is as `search_until`, then slowly in direction
 * `edge` until it is the other way round, then on to the next index pulse. A method without search
 * has only the pulse.
 */
struct method {
    int8_t number;
    uint32_t input; /* 0: no switch */
    int8_t search;
    bool search_until;
    int8_t edge;
    bool has_index;
};

static const struct method methods[] = {
    {1, INPUT_NEGATIVE_LIMIT, -1, true, 1, true},
    {17, INPUT_NEGATIVE_LIMIT, -1, true, 1, false},
    {2, INPUT_POSITIVE_LIMIT, 1, true, -1, true},
    {18, INPUT_POSITIVE_LIMIT, 1, true, -1, false},
    {3, INPUT_HOME, 1, true, -1, true},
    {19, INPUT_HOME, 1, true, -1, false},
    {4, INPUT_HOME, -1, false, 1, true},
    {20, INPUT_HOME, -1, false, 1, false},
    {33, 0, 0, false, -1, true},
    {34, 0, 0, false, 1, true},
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
    if (is_turned ? table_mm <= c->home_switch_mm : table_mm >= c->home_switch_mm)
        inputs |= INPUT_HOME;
    if (drive->probe.touches)
        inputs |= INPUT_PROBE;
    return inputs;
}

static double switch_mm(const struct virtual_drive *drive, uint32_t input)
{
    const struct drive_plant_config *c = &drive->config.plant;
    uint32_t lower = virtual_drive_sign(drive) < 0 ? INPUT_POSITIVE_LIMIT : INPUT_NEGATIVE_LIMIT;
    if (input == INPUT_HOME)
        return c->home_switch_mm;
    return input == lower ? c->limit_switch_min_mm : c->limit_switch_max_mm;
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
    tell(drive, HOMING_BEGUN);
    if (!method) {
        latch(drive, drive->plant.measured_mm);
        return;
    }
    if (!method->input)
        await_index(drive, method->edge * virtual_drive_sign(drive));
    else
        drive->homing.phase = HOMING_SEARCH;
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
    return drive->objects.settings.homing_velocity[i] / virtual_drive_scale(drive);
}

static void run_towards(struct virtual_drive *drive, int8_t direction, double velocity_mm_s,
                        uint32_t cycle_ns)
{
    double acceleration_mm_s2 =
        drive->objects.settings.homing_acceleration / virtual_drive_scale(drive);
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

static void search(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    bool is_active = virtual_drive_inputs(drive) & method->input;
    if (is_active == method->search_until) {
        drive->homing.phase = HOMING_EDGE;
        return;
    }
    run_towards(drive, method->search, speed_mm_s(drive, 0), cycle_ns);
    if (hits_other_end(drive, method, method->search))
        fail(drive);
}

/* The edge counts when it is crossed in the direction of the method. */
static void find_edge(struct virtual_drive *drive, const struct method *method, uint32_t cycle_ns)
{
    run_towards(drive, method->edge, speed_mm_s(drive, 1), cycle_ns);
    bool is_active = virtual_drive_inputs(drive) & method->input;
    if (hits_other_end(drive, method, method->edge)) {
        fail(drive);
        return;
    }
    if (is_active == method->search_until || !moves_in(drive, method->edge))
        return;
    double past_mm = drive_plant_table_mm(&drive->plant) - switch_mm(drive, method->input);
    if (method->has_index)
        await_index(drive, method->edge * virtual_drive_sign(drive));
    else
        latch(drive, encoder_mm(drive, drive->plant.position_mm - past_mm));
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

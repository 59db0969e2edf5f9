#include "controller/approach.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

/* Nobody has asked for this move in a program: it is slow. */
#define VELOCITY_RATIO 0.1

/* Axes that are not homed come after all orders. */
#define NOT_HOMED (UINT8_MAX + 1U)

/*
 * A move over D in the time T,
 *     x(t) = D (10 u^3 - 15 u^4 + 6 u^5),   u = t / T,
 * begins and ends at rest with no acceleration. Its extremes, of the derivatives in u at 1/2, at
 * 1/2 -+ sqrt(3)/6 and at the ends:
 *     v = 15/8 D / T,   a = 10/sqrt(3) D / T^2,   j = 60 D / T^3
 */
#define PEAK_VELOCITY     1.875
#define PEAK_ACCELERATION 5.773502691896258
#define PEAK_JERK         60.0

void takt_approach_init(struct approach *approach, const struct point *start)
{
    memset(approach, 0, sizeof(*approach));
    approach->to = *start;
}

static double time_for(const struct machine_axis *axis, double way_mm)
{
    const double velocity_mm_s = VELOCITY_RATIO * axis->max_velocity_mm_s;
    const double by_velocity_s = PEAK_VELOCITY * way_mm / velocity_mm_s;
    const double by_acceleration_s =
        maths_sqrt(PEAK_ACCELERATION * way_mm / axis->max_acceleration_mm_s2);
    const double by_jerk_s = takt_maths_cbrt(PEAK_JERK * way_mm / axis->max_jerk_mm_s3);

    TAKT_ASSERT(way_mm >= 0.0 && axis->max_velocity_mm_s > 0.0);
    return maths_max(by_velocity_s, maths_max(by_acceleration_s, by_jerk_s));
}

static unsigned order_of(const struct machine_axis *axis)
{
    return axis->home_order != 0 ? axis->home_order : NOT_HOMED;
}

/* True: the axis has to move. Closer than the controller's resolution it is there. */
static bool is_away(const struct approach *approach, const struct machine *machine, unsigned i)
{
    const double way_mm = approach->to.at[i] - approach->at.at[i];

    TAKT_ASSERT(i < AXIS_COUNT);
    return machine->axis[i].present && maths_abs(way_mm) * machine->resolution_per_mm > 1.0;
}

/* Lowest order with an axis that has to move; above NOT_HOMED: none. */
static unsigned next_order(const struct approach *approach, const struct machine *machine)
{
    unsigned next = NOT_HOMED + 1;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (is_away(approach, machine, i)) {
            const unsigned order = order_of(&machine->axis[i]);

            next = order < next ? order : next;
        }
    }
    return next;
}

static void begin_move(struct approach *approach, const struct machine *machine, unsigned order)
{
    double time_s = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool moves = is_away(approach, machine, i) && order_of(&machine->axis[i]) == order;

        approach->way_mm[i] = moves ? approach->to.at[i] - approach->at.at[i] : 0.0;
        if (moves) {
            time_s = maths_max(time_s, time_for(&machine->axis[i], maths_abs(approach->way_mm[i])));
        }
    }
    approach->cycle = 0;
    approach->cycles = 1 + (uint32_t)takt_maths_ceil(1e6 * time_s / (double)machine->cycle_us);
}

static void make_cycle(struct approach *approach, struct point *setpoint)
{
    const double u = (double)++approach->cycle / (double)approach->cycles;
    const double part = u * u * u * (10.0 + u * (6.0 * u - 15.0));

    TAKT_ASSERT(approach->cycle <= approach->cycles);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        setpoint->at[i] = approach->at.at[i] + approach->way_mm[i] * part;
    }
    if (approach->cycle < approach->cycles) {
        return;
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (approach->way_mm[i] != 0.0) {
            approach->at.at[i] = approach->to.at[i];
        }
    }
    *setpoint = approach->at;
    approach->cycles = 0;
}

bool takt_approach_cycle(struct approach *approach, const struct machine *machine,
                         const struct point *actual, struct point *setpoint)
{
    unsigned order;

    if (!approach->begun) {
        approach->at = *actual;
        approach->begun = true;
    }
    if (approach->cycles == 0) {
        order = next_order(approach, machine);
        if (order > NOT_HOMED) {
            *setpoint = approach->to;
            return true;
        }
        begin_move(approach, machine, order);
    }
    make_cycle(approach, setpoint);
    return false;
}

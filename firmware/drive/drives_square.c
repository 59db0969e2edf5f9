/*
 * Gantries: two drives of one axis. Each is homed by its own switch; then the second one is brought
 * to where the first one stands, which squares the axis. From then on both get the same setpoint,
 * and their positions are compared.
 *
 *     skew = actual position of the second - actual position of the first,      |skew| <= skew_max_mm
 */
#include "base/assert.h"
#include "base/maths.h"
#include "drive/drives_private.h"

#define SQRT_3 1.7320508075688772

void takt_drives_gantry_init(struct drives *d, const struct drives_config *config)
{
    TAKT_ASSERT(config->gantry_count <= DRIVES_GANTRIES_MAX);
    d->gantry_count = (uint8_t)config->gantry_count;
    for (unsigned i = 0; i < d->gantry_count; i++) {
        const struct drives_gantry *gantry = &config->gantry[i];
        TAKT_ASSERT(gantry->first < config->count && gantry->second < config->count &&
                    config->axis[gantry->first].axis == config->axis[gantry->second].axis &&
                    config->axis[gantry->second].homing.zero_mm_s > 0 &&
                    config->axis[gantry->second].homing.acceleration_mm_s2 > 0);
        d->gantry[i] = *gantry;
    }
}

void takt_drives_place_gantries(struct drives *d)
{
    for (unsigned i = 0; i < d->gantry_count; i++) {
        const struct drives_axis *first = &d->axis[d->gantry[i].first];
        d->actual.at[first->config.axis] = first->actual_mm;
    }
}

static void check_skew(struct drives *d, const struct drives_gantry *gantry, double skew_mm)
{
    if (maths_abs(skew_mm) > gantry->skew_max_mm)
        takt_drives_raise(d, gantry->second, TAKT_ERROR_DRIVE_SKEW, maths_abs(skew_mm), NULL);
}

/* Positions are compared that were sampled by the same SYNC. */
void takt_drives_check_skew(struct drives *d)
{
    for (unsigned i = 0; i < d->gantry_count; i++) {
        const struct drives_gantry *gantry = &d->gantry[i];
        const struct drives_axis *first = &d->axis[gantry->first];
        const struct drives_axis *second = &d->axis[gantry->second];
        if (drives_silent_cycles(d, first) == 0 && drives_silent_cycles(d, second) == 0)
            check_skew(d, gantry, second->actual_mm - first->actual_mm);
    }
}

/* Where it has been told to stay, or stays. */
static int32_t stands_inc(const struct drives_axis *axis)
{
    return drives_is_by_velocity(axis) ? axis->actual_inc : axis->target_inc;
}

void takt_drives_begin_square(struct drives *d)
{
    if (d->gantry_count == 0) {
        takt_drives_enter_enabled(d);
        return;
    }
    takt_drives_enter_phase(d, DRIVES_SQUARE);
    for (unsigned i = 0; i < d->gantry_count; i++) {
        struct drives_axis *second = &d->axis[d->gantry[i].second];
        second->braking_inc = stands_inc(second);
    }
}

/*
 * Cycles for a way D at rest to rest, x = D (10 u^3 - 15 u^4 + 6 u^5): its peaks are 15/8 D/T in
 * velocity and 10/sqrt(3) D/T^2 in acceleration, not above those of homing:
 *     T = max(15/8 D / v,  sqrt(10/sqrt(3) D / a))
 */
static double square_cycles(const struct drives *d, const struct drives_axis *second, double way_mm)
{
    const struct drives_homing *homing = &second->config.homing;
    const double by_velocity_s = 1.875 * way_mm / homing->zero_mm_s;
    const double by_acceleration_s = maths_sqrt(10 / SQRT_3 * way_mm / homing->acceleration_mm_s2);
    return 1e6 / d->cycle_us * maths_max(by_velocity_s, by_acceleration_s);
}

/* u this many cycles after the beginning. */
static double part_of_way(double cycles, double whole_cycles)
{
    const double u = cycles < whole_cycles ? maths_max(cycles, 0) / whole_cycles : 1;
    return u * u * u * (10 + u * (6 * u - 15));
}

/* To where it is in this cycle, on a way that takes this many cycles. */
static void move_second(struct drives *d, unsigned index, double way_inc, double cycles)
{
    struct drives_axis *second = &d->axis[index];
    const double now_inc = part_of_way(d->phase_cycles, cycles) * way_inc;
    const double before_inc = part_of_way((double)d->phase_cycles - 1, cycles) * way_inc;
    const double shown_inc =
        part_of_way((double)d->phase_cycles - DRIVES_LATENCY_CYCLES, cycles) * way_inc;
    const double lag_inc = second->braking_inc + shown_inc - second->actual_inc;
    const double scale = second->config.increments_per_mm;
    if (drives_is_by_velocity(second))
        takt_drives_steer(d, index, (now_inc - before_inc) / scale, lag_inc / scale);
    else
        second->target_inc = (int32_t)takt_maths_round(second->braking_inc + now_inc);
}

/* A cycle of one of them; true: it is square. */
static bool square(struct drives *d, const struct drives_gantry *gantry)
{
    const struct drives_axis *first = &d->axis[gantry->first];
    const struct drives_axis *second = &d->axis[gantry->second];
    const double goal_mm = stands_inc(first) / first->config.increments_per_mm;
    const double way_inc = goal_mm * second->config.increments_per_mm - second->braking_inc;
    const double way_mm = maths_abs(way_inc / second->config.increments_per_mm);
    const double cycles = square_cycles(d, second, way_mm);
    check_skew(d, gantry, way_mm);
    if (d->state == DRIVES_STARTING)
        move_second(d, gantry->second, way_inc, cycles);
    return d->phase_cycles >= cycles + DRIVES_LATENCY_CYCLES;
}

void takt_drives_square(struct drives *d)
{
    bool all = true;
    takt_drives_check_all_links(d);
    for (unsigned i = 0; i < d->gantry_count; i++)
        all = square(d, &d->gantry[i]) && all;
    if (all && d->state == DRIVES_STARTING)
        takt_drives_enter_enabled(d);
}

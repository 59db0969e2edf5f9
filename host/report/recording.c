#include "report/recording.h"

#include "base/maths.h"

#include <math.h>
#include <string.h>

#define SECONDS_PER_MINUTE 60.0
#define DEGREES_PER_RADIAN (180.0 / MATHS_PI)

static double limits_velocity_max(const struct plan_limits *limits)
{
    double velocity = 0.0;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (limits->axes & 1u << i)
            velocity = maths_max(velocity, limits->velocity_mm_s[i]);
    }
    return velocity;
}

bool recording_open(struct recording *rec, const struct plan_limits *limits)
{
    *rec = (struct recording){.limits = *limits};
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        const bool is_rotary = i >= AXIS_LINEAR_COUNT;
        if (!(limits->axes & 1u << i))
            continue;
        rec->axis[rec->axis_count++] = (struct axis_history){
            .axis = (enum axis)i, .edge_ratio = is_rotary ? DEGREES_PER_RADIAN : 1.0};
        rec->has_rotary |= is_rotary;
    }
    const bool has_trail = trail_open(&rec->trail, limits_velocity_max(limits));
    return thin_open(&rec->thin, RUN_SERIES_COUNT + rec->axis_count * AXIS_SERIES_COUNT) &&
           has_trail;
}

void recording_close(struct recording *rec)
{
    thin_close(&rec->thin);
    trail_close(&rec->trail);
}

/* The feed counts along X, Y, Z if any of them moves, else along the rotary axes. */
static double feed_edge_ratio(const struct recording *rec, const struct cycle_record *record)
{
    if (!rec->has_rotary || rec->consecutive == 0)
        return SECONDS_PER_MINUTE;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (record->cmd.at[i] != rec->linear_mm[i])
            return SECONDS_PER_MINUTE;
    }
    return SECONDS_PER_MINUTE * DEGREES_PER_RADIAN;
}

/* v_k = (x_k - x_(k-1)) / tau, a_k = (v_k - v_(k-1)) / tau, j_k = (a_k - a_(k-1)) / tau */
static void axis_difference(struct axis_history *axis, double set, double cycle_s,
                            uint64_t consecutive, float value[AXIS_SERIES_COUNT])
{
    const double velocity = (set - axis->set) / cycle_s;
    const double acceleration = (velocity - axis->velocity) / cycle_s;
    const double jerk = (acceleration - axis->acceleration) / cycle_s;
    value[AXIS_VELOCITY] = consecutive >= 1 ? (float)(velocity * axis->edge_ratio) : NAN;
    value[AXIS_ACCELERATION] = consecutive >= 2 ? (float)(acceleration * axis->edge_ratio) : NAN;
    value[AXIS_JERK] = consecutive >= 3 ? (float)(jerk * axis->edge_ratio) : NAN;
    axis->set = set;
    axis->velocity = velocity;
    axis->acceleration = acceleration;
}

/* The position a drive reports answers the setpoint of DRIVES_LATENCY_CYCLES before. */
static float axis_following(const struct recording *rec, const struct axis_history *axis,
                            const struct cycle_record *record)
{
    const struct point *answered = &rec->sent[record->cycle % DRIVES_LATENCY_CYCLES];
    if (rec->consecutive < DRIVES_LATENCY_CYCLES)
        return NAN;
    return (float)((answered->at[axis->axis] - record->act.at[axis->axis]) * axis->edge_ratio);
}

static void recording_add_series(struct recording *rec, const struct cycle_record *record,
                                 uint32_t cycle)
{
    float value[RECORDING_SERIES_MAX];
    value[RUN_FEED_MM_MIN] = (float)(record->feed_mm_s * feed_edge_ratio(rec, record));
    value[RUN_OVERRIDE_PERCENT] = (float)record->override_percent;
    value[RUN_LIMITER_PERCENT] = (float)(record->limiter * 100.0);
    for (unsigned i = 0; i < rec->axis_count; i++) {
        struct axis_history *axis = &rec->axis[i];
        const double set = record->set.at[axis->axis];
        float *of_axis = value + recording_axis_series(i, AXIS_VELOCITY);
        axis_difference(axis, set, rec->limits.cycle_s, rec->consecutive, of_axis);
        of_axis[AXIS_FOLLOWING] = axis_following(rec, axis, record);
    }
    thin_add(&rec->thin, cycle, value);
}

static void recording_add_trail(struct recording *rec, const struct cycle_record *record,
                                uint32_t cycle, bool rapid)
{
    struct trail_point point = {
        .feed_mm_s = record->feed_mm_s, .cycle = cycle, .line = record->line, .rapid = rapid};
    memcpy(point.at_mm, record->cmd.at, sizeof point.at_mm);
    trail_add(&rec->trail, &point);
}

void recording_add(struct recording *rec, const struct cycle_record *record, bool rapid)
{
    if (rec->cycles == 0)
        rec->first_cycle = record->cycle;
    const uint64_t cycle = record->cycle - rec->first_cycle;
    if (cycle > UINT32_MAX)
        return;
    if (cycle != rec->cycles)
        rec->consecutive = 0;
    recording_add_series(rec, record, (uint32_t)cycle);
    recording_add_trail(rec, record, (uint32_t)cycle, rapid);
    memcpy(rec->linear_mm, record->cmd.at, sizeof rec->linear_mm);
    rec->sent[record->cycle % DRIVES_LATENCY_CYCLES] = record->set;
    rec->consecutive++;
    rec->cycles = cycle + 1;
}

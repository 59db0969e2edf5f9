/*
 * Writes a report of a made-up run: report_sample CYCLES OUTPUT.html
 *
 * Four axes cut a rising spiral: rapid out, plunge, spiral, retract, rapid home, over and over
 * until CYCLES are made, with drives that lag. A run of few cycles is kept whole, so the number of
 * points in every plot is known.
 */
#include "base/maths.h"
#include "report/report.h"

#include <errno.h>
#include <stdlib.h>

#define CYCLE_S 0.001

struct stage {
    double share; /* of the time of one part */
    bool rapid;
    uint32_t line;
};

static const struct stage stages[] = {
    {0.08, true, 12}, {0.07, false, 13}, {0.65, false, 14}, {0.06, true, 20}, {0.14, true, 21},
};
#define STAGES (sizeof stages / sizeof stages[0])

/* From 0 to 1 with velocity and acceleration 0 at both ends. */
static double ease(double t)
{
    return t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
}

static struct point mix(struct point a, struct point b, double u)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        a.at[i] += (b.at[i] - a.at[i]) * u;
    return a;
}

static struct point spiral(double u)
{
    const double angle_rad = 5.0 * MATHS_TWO_PI * u;
    const double radius_mm = 12.0 + 28.0 * u;
    return (struct point){{60.0 + radius_mm * takt_maths_cos(angle_rad),
                           50.0 + radius_mm * takt_maths_sin(angle_rad), -6.0 + 4.0 * u,
                           MATHS_PI * u}};
}

static struct point place(size_t stage, double u)
{
    const struct point home = {{0.0, 0.0, 25.0, 0.0}};
    struct point above_start = spiral(0.0);
    struct point above_end = spiral(1.0);
    above_start.at[AXIS_Z] = 3.0;
    above_end.at[AXIS_Z] = 25.0;
    switch (stage) {
    case 0:
        return mix(home, above_start, u);
    case 1:
        return mix(above_start, spiral(0.0), u);
    case 2:
        return spiral(u);
    case 3:
        return mix(spiral(1.0), above_end, u);
    default:
        return mix(above_end, home, u);
    }
}

static double distance(const struct point *a, const struct point *b)
{
    double sum = 0.0;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        sum += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return maths_sqrt(sum);
}

/* Where in the part a cycle is: the stage and how much of it is done. */
static size_t find_stage(double share, double *done)
{
    size_t stage = 0;
    while (stage + 1 < STAGES && share > stages[stage].share)
        share -= stages[stage++].share;
    *done = share / stages[stage].share;
    return stage;
}

static void add_cycles(struct report *r, uint64_t cycles, uint64_t part_cycles)
{
    struct cycle_record record = {.override_percent = 100.0, .limiter = 1.0, .act = place(0, 0.0)};
    struct point before = record.act;
    for (uint64_t k = 0; k < cycles; k++) {
        double done;
        const size_t stage = find_stage((double)(k % part_cycles) / (double)part_cycles, &done);
        record.cycle = k;
        record.line = stages[stage].line;
        record.cmd = place(stage, ease(done));
        record.set = record.cmd;
        record.feed_mm_s = distance(&record.cmd, &before) / CYCLE_S;
        record.override_percent = k > cycles / 2 ? 80.0 : 100.0;
        record.act = mix(record.act, before, 0.12);
        before = record.cmd;
        report_add(r, &record, stages[stage].rapid);
    }
}

static const char summary[] =
    "{\"program\":\"spiral <pocket> \\\"A\\\".ngc\",\"machine\":\"demo "
    "mill\",\"outcome\":\"completed\",\"fault\":null,"
    "\"blocks\":5,\"cycles\":4000,\"cycle_time_s\":0.001,\"program_time_s\":4.0,\"wall_time_s\":0."
    "0123,"
    "\"realtime_ratio\":325.2,\"path_length_mm\":1524.309,\"axes\":["
    "{\"name\":\"X\",\"max_velocity_mm_s\":312.5,\"max_acceleration_mm_s2\":2210.4,\"max_jerk_mm_"
    "s3\":38021,"
    "\"max_following_error_mm\":2.1},"
    "{\"name\":\"Y\",\"max_velocity_mm_s\":309.1,\"max_acceleration_mm_s2\":2189.9,\"max_jerk_mm_"
    "s3\":39990,"
    "\"max_following_error_mm\":2.05},"
    "{\"name\":\"Z\",\"max_velocity_mm_s\":171.9,\"max_acceleration_mm_s2\":4420.0,\"max_jerk_mm_"
    "s3\":61000,"
    "\"max_following_error_mm\":1.1},"
    "{\"name\":\"A\",\"max_velocity_deg_s\":129.8,\"max_acceleration_deg_s2\":153.0,\"max_jerk_deg_"
    "s3\":1597,"
    "\"max_following_error_deg\":0.8}],"
    "\"chord_error_max_mm\":0.00031,\"path_error_max_mm\":4.1e-13,\"landing_error_max_mm\":0,"
    "\"joint_feed_step_max_mm_s\":0.02,\"correction_max_mm\":null,"
    "\"bus\":{\"frames\":36012,\"load_percent\":61.4,\"predicted_load_percent\":61.9},"
    "\"cycle_ns\":{\"min\":410,\"mean\":598,\"p99\":1210,\"max\":20155},\"checks\":["
    "{\"name\":\"velocity.X\",\"held\":true,\"value\":312.5,\"limit\":500},"
    "{\"name\":\"jerk.Z\",\"held\":false,\"value\":61000,\"limit\":60000},"
    "{\"name\":\"landing\",\"held\":true,\"value\":0,\"limit\":1e-9},"
    "{\"name\":\"following.X\",\"held\":true,\"value\":2.1,\"limit\":3},"
    "{\"name\":\"bus_load\",\"held\":true,\"value\":61.4,\"limit\":90}],"
    "\"setpoint_digest\":\"9f86d081884c7d65</script><b>\"}";

int main(int argc, char **argv)
{
    const struct plan_limits limits = {
        .axes = 1u << AXIS_X | 1u << AXIS_Y | 1u << AXIS_Z | 1u << AXIS_A,
        .velocity_mm_s = {800.0, 800.0, 250.0, 12.0},
        .acceleration_mm_s2 = {15000.0, 15000.0, 5000.0, 60.0},
        .jerk_mm_s3 = {4e5, 4e5, 6e4, 2000.0},
        .cycle_s = CYCLE_S,
    };
    const uint64_t cycles = argc == 3 ? strtoull(argv[1], NULL, 10) : 0;
    struct report *r = cycles > 0 ? report_open(&limits) : NULL;
    if (r == NULL)
        return 2;
    add_cycles(r, cycles, cycles < 10000 ? 4000 : 20000);
    FILE *file = fopen(argv[2], "wb");
    report_set_shares(r, "{\"board\": {\"time_s\": 2, \"velocity\": 0.1, \"acceleration\": 0.2, "
                         "\"jerk\": 0}, \"ahead\": {\"time_s\": 1.5, \"velocity\": 0.4, "
                         "\"acceleration\": 0.5, \"jerk\": 0.25}}");
    int error = file != NULL ? report_write(r, file, summary) : errno;
    if (file != NULL && fclose(file) != 0)
        error = errno;
    report_close(r);
    return error == 0 ? 0 : 1;
}

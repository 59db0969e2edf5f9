#include "ahead/modes.h"

#include "base/maths.h"

#include <string.h>

/*
 * A drive's velocity changes once a cycle: by that an oscillator of frequency w lags (w
 * cycle)^2 / 12 (host/vibration).
 */
static double lag_of(const struct vibration_config *config, double cycle_s)
{
    const double angle = cycle_s / modes_step_s(config);

    return angle * angle / 12;
}

/* From a free oscillator's step between knots. */
static struct modes_stage stage_of(const struct vibration_mode *mode, double angle)
{
    const double(*a)[2] = mode->advance;
    const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    const double sum = 1 - (a[0][0] + a[1][1]) + determinant;

    return (struct modes_stage){.slope = (1 - determinant) / sum,
                                .bend = (1 + determinant) / (2 * sum),
                                .away = -mode->part / (angle * angle)};
}

/* Of the first mode of an axis; without one E is 0. */
static struct modes_stray stray_of(const struct vibration_mode *mode, double step_s)
{
    const double(*a)[2] = mode->advance;
    const double angle = mode->w_per_s * step_s;
    const double trace = a[0][0] + a[1][1];
    const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];

    if (!(angle > 0))
        return (struct modes_stray){0};
    return (struct modes_stray){.trace = trace,
                                .determinant = determinant,
                                .pull = mode->part * (1 - trace + determinant) / (angle * angle),
                                .part = mode->part,
                                .drag = mode->damping * angle};
}

static void set_strays(struct ahead_modes *modes, const struct vibration_config *config,
                       double step_s)
{
    modes->strays = vibration_is_uncertain(config) ? MODES_STRAYS : 0;
    for (int s = 0; s < MODES_STRAYS; s++) {
        struct vibration_config other = *config;
        struct vibration v;

        vibration_shift(&other, s == 0 ? -1 : 1);
        vibration_init(&v, &other, step_s);
        for (int i = 0; i < AXIS_LINEAR_COUNT; i++)
            modes->stray[s][i] = stray_of(&v.axis[i].mode[0], step_s);
        for (int i = 0; i < AXIS_LINEAR_COUNT && modes->strays > 0; i++) {
            const double angle = v.axis[i].mode[0].w_per_s * step_s;

            if (angle > 0 && MATHS_PI / angle > (double)modes->rest)
                modes->rest = (size_t)takt_maths_ceil(MATHS_PI / angle);
        }
    }
}

void modes_init(struct ahead_modes *modes, const struct vibration_config *config, double step_s,
                double cycle_s)
{
    struct vibration v;

    memset(modes, 0, sizeof *modes);
    modes->lag = lag_of(config, cycle_s);
    vibration_init(&v, config, step_s);
    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        unsigned count = 0;

        for (size_t n = 0; n < VIBRATION_MODES; n++) {
            const double hz = config->mode[i][n * VIBRATION_NUMBERS + VIBRATION_HZ];

            if (hz > 0)
                modes->stage[i][count++] = stage_of(&v.axis[i].mode[n], 2 * MATHS_PI * hz * step_s);
        }
        modes->count = count > modes->count ? count : modes->count;
    }
    set_strays(modes, config, step_s);
}

double modes_step_s(const struct vibration_config *config)
{
    double hz = 0;

    for (int i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (size_t n = 0; n < VIBRATION_MODES; n++)
            hz = maths_max(hz, config->mode[i][n * VIBRATION_NUMBERS + VIBRATION_HZ]);
    }
    return hz > 0 ? 1 / (2 * MATHS_PI * hz) : MATHS_INFINITY;
}

/* to = a - 2 b + c by bend, (c - a) / 2 by slope, b itself by own. */
static double combine(double own, double slope, double bend, double a, double b, double c)
{
    return own * b + 0.5 * slope * (c - a) + bend * (a - 2 * b + c);
}

/* One point of own w + slope w' + bend w" from three, whose middle one is point k of the window. */
static struct modes_point differ(const struct modes_point p[3], double own, double slope,
                                 double bend, size_t k)
{
    const double first = 0.5 * (p[2].at_mm - p[0].at_mm);
    const double second = p[0].at_mm - 2 * p[1].at_mm + p[2].at_mm;
    struct modes_point to;

    to.at_mm = combine(own, slope, bend, p[0].at_mm, p[1].at_mm, p[2].at_mm);
    for (size_t i = 0; i < MODES_REACH_MAX; i++) {
        to.by_curve[i] =
            combine(own, slope, bend, p[0].by_curve[i], p[1].by_curve[i], p[2].by_curve[i]);
        to.by_time[i] =
            combine(own, slope, bend, p[0].by_time[i], p[1].by_time[i], p[2].by_time[i]);
    }
    to.by_time[k] += 0.5 * slope * first + bend * second;
    to.by_time[k + 1] += 0.25 * bend * first;
    to.by_time[k - 1] -= 0.25 * bend * first;
    return to;
}

/*
 * A stage on all of a window, which becomes shorter by a point on each side; gone: points lost
 * there before.
 */
static void apply(struct modes_point *window, size_t points, size_t gone, double own, double slope,
                  double bend)
{
    for (size_t k = 0; k + 2 < points; k++)
        window[k] = differ(window + k, own, slope, bend, k + 1 + gone);
}

static void begin(struct modes_point *window, size_t points, double (*w)[3], int axis)
{
    memset(window, 0, points * sizeof *window);
    for (size_t k = 0; k < points; k++) {
        window[k].at_mm = w[k][axis];
        window[k].by_curve[k] = 1;
    }
}

/* All stages but `last`, and at last own w + slope w' + bend w" of what has come of them. */
static struct modes_point chain(const struct ahead_modes *modes, int axis, double (*w)[3],
                                unsigned last, double own, const struct modes_stage *as)
{
    struct modes_point window[MODES_REACH_MAX];
    size_t points = 1 + 2 * (size_t)modes->count;
    size_t gone = 0;

    begin(window, points, w, axis);
    for (unsigned m = 0; m < modes->count; m++) {
        const struct modes_stage *stage = &modes->stage[axis][m];

        if (m == last)
            continue;
        apply(window, points, gone++, 1, stage->slope, stage->bend);
        points -= 2;
    }
    apply(window, points, gone, own, as->slope, as->bend);
    return window[0];
}

static void add(struct modes_point *to, const struct modes_point *p)
{
    to->at_mm += p->at_mm;
    for (size_t i = 0; i < MODES_REACH_MAX; i++) {
        to->by_curve[i] += p->by_curve[i];
        to->by_time[i] += p->by_time[i];
    }
}

void modes_at(const struct ahead_modes *modes, int axis, double (*w)[3], struct modes_point *motor,
              struct modes_point *tool)
{
    const struct modes_stage *stage = modes->stage[axis];

    *motor = chain(modes, axis, w, 0, 1, &stage[0]);
    *tool = *motor;
    for (unsigned m = 0; m < modes->count; m++) {
        const struct modes_stage away = {.bend = stage[m].away};
        const struct modes_point of_mode = chain(modes, axis, w, m, 0, &away);

        add(tool, &of_mode);
    }
}

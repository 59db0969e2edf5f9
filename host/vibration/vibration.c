#include "vibration/vibration.h"

#include "base/maths.h"

#include <stddef.h>

/* Above any that a machine tool is measured for. */
#define HZ_MAX   10000.0
#define PART_MAX 10.0

static const char *check_mode(const double number[VIBRATION_NUMBERS])
{
    if (!(number[VIBRATION_HZ] >= 0 && number[VIBRATION_HZ] <= HZ_MAX))
        return "the frequency of a mode is 0 to 10000 Hz";
    if (!(number[VIBRATION_HZ] > 0))
        return NULL;
    if (!(number[VIBRATION_DAMPING] >= 0 && number[VIBRATION_DAMPING] < 1))
        return "the damping ratio of a mode is 0 to below 1";
    if (!(maths_abs(number[VIBRATION_PART]) <= PART_MAX) ||
        !(maths_abs(number[VIBRATION_PART]) > 0))
        return "the part of a mode that the tool sees (its third number) is not 0, and at most 10";
    return NULL;
}

const char *vibration_check(const struct vibration_config *config, unsigned *axis)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < VIBRATION_MODES; n++) {
            const char *wrong = check_mode(&config->mode[i][(size_t)n * VIBRATION_NUMBERS]);

            if (wrong != NULL) {
                *axis = i;
                return wrong;
            }
        }
    }
    return NULL;
}

static void multiply(double a[2][2], double b[2][2], double product[2][2])
{
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++)
            product[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k];
    }
}

static void copy(double from[2][2], double to[2][2])
{
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++)
            to[i][k] = from[i][k];
    }
}

/* exp(B) = 1 + B + B B / 2 + ..., for a B of at most 1/4 to the last bit of a double. */
#define EXPONENTIAL_TERMS 12

static void add_terms(double b[2][2], double sum[2][2])
{
    double term[2][2] = {{1, 0}, {0, 1}}, next[2][2];

    copy(term, sum);
    for (int n = 1; n <= EXPONENTIAL_TERMS; n++) {
        multiply(term, b, next);
        for (int i = 0; i < 2; i++) {
            for (int k = 0; k < 2; k++) {
                term[i][k] = next[i][k] / n;
                sum[i][k] += term[i][k];
            }
        }
    }
}

/*
 * away'' + 2 d w away' + w^2 away = 0 over a cycle, with the rate counted in w: exp(w t [0 1; -1 -2d]), by a part of the
 * cycle that is small against the oscillation, and doubled (Moler and Van Loan 2003, method 3).
 */
static void set_advance(struct vibration_mode *mode, double w, double damping, double cycle_s)
{
    double angle = w * cycle_s;
    double now[2][2], next[2][2];
    int doublings = 0;

    for (; angle > 0.0625; doublings++)
        angle *= 0.5;
    double b[2][2] = {{0, angle}, {-angle, -2.0 * damping * angle}};

    add_terms(b, now);
    for (; doublings > 0; doublings--) {
        multiply(now, now, next);
        copy(next, now);
    }
    copy(now, mode->advance);
    mode->advance[0][1] /= w;
    mode->advance[1][0] *= w;
}

void vibration_init(struct vibration *v, const struct vibration_config *config, double cycle_s)
{
    *v = (struct vibration){.cycle_s = cycle_s};
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < VIBRATION_MODES; n++) {
            const double *number = &config->mode[i][(size_t)n * VIBRATION_NUMBERS];
            struct vibration_mode *mode = &v->axis[i].mode[n];

            if (!(number[VIBRATION_HZ] > 0))
                continue;
            mode->part = number[VIBRATION_PART];
            set_advance(mode, 2.0 * MATHS_PI * number[VIBRATION_HZ], number[VIBRATION_DAMPING],
                        cycle_s);
            v->any = true;
        }
    }
}

/* The foot goes at one velocity from cycle to cycle; where that changes, the oscillator is left behind by as much. */
static double follow_mode(struct vibration_mode *mode, double change_mm_s)
{
    const double away = mode->away_mm;
    const double rate = mode->rate_mm_s - change_mm_s;

    mode->away_mm = mode->advance[0][0] * away + mode->advance[0][1] * rate;
    mode->rate_mm_s = mode->advance[1][0] * away + mode->advance[1][1] * rate;
    return mode->part * mode->away_mm;
}

static double follow_axis(struct vibration_axis *axis, double at_mm, double cycle_s)
{
    const double velocity_mm_s = (at_mm - axis->foot_mm) / cycle_s;
    double away_mm = 0;

    for (unsigned n = 0; n < VIBRATION_MODES; n++)
        away_mm += follow_mode(&axis->mode[n], velocity_mm_s - axis->foot_mm_s);
    axis->foot_mm = at_mm;
    axis->foot_mm_s = velocity_mm_s;
    return away_mm;
}

void vibration_follow(struct vibration *v, struct point *at)
{
    if (!v->has_foot) {
        for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
            v->axis[i].foot_mm = at->at[i];
        v->has_foot = true;
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        at->at[i] += follow_axis(&v->axis[i], at->at[i], v->cycle_s);
}

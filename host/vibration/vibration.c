#include "vibration/vibration.h"

#include "base/maths.h"

#include <stdbool.h>
#include <stddef.h>

/* Above any that a machine tool is measured for. */
#define HZ_MAX   10000.0
#define PART_MAX 10.0

/* Of a frequency along an axis, over that of its mode. */
#define RATIO_MIN 0.1
#define RATIO_MAX 10.0

#define UNCERTAIN_MAX_PERCENT 50.0

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

static bool has_mode(const struct vibration_config *config, unsigned axis, unsigned mode)
{
    return config->mode[axis][(size_t)mode * VIBRATION_NUMBERS + VIBRATION_HZ] > 0;
}

static bool has_table(const struct vibration_table *table)
{
    return table->places_mm[1] > table->places_mm[0];
}

static const char *check_modes(const struct vibration_config *config, unsigned axis)
{
    const char *wrong = NULL;

    for (unsigned n = 0; n < VIBRATION_MODES && wrong == NULL; n++)
        wrong = check_mode(&config->mode[axis][(size_t)n * VIBRATION_NUMBERS]);
    return wrong;
}

static const char *check_places(const struct vibration_table *table)
{
    const double length_mm = table->places_mm[1] - table->places_mm[0];

    if (!(length_mm >= 0))
        return "the last of _places_mm is not before the first";
    if (!maths_is_finite(length_mm))
        return "_places_mm are finite";
    if (length_mm > 0 && table->along >= AXIS_LINEAR_COUNT)
        return "with _places_mm an axis is needed that they are on: _along";
    return NULL;
}

static const char *check_ratios(const struct vibration_config *config, unsigned axis, unsigned mode)
{
    const double *ratio = config->table[axis].ratio[mode];
    const double hz = config->mode[axis][(size_t)mode * VIBRATION_NUMBERS + VIBRATION_HZ];

    if (!has_table(&config->table[axis]) || !has_mode(config, axis, mode))
        return NULL;
    for (unsigned n = 0; n < VIBRATION_PLACES; n++) {
        if (!(ratio[n] >= RATIO_MIN && ratio[n] <= RATIO_MAX))
            return "a _ratio of a mode that is there is 0.1 to 10";
        if (!(ratio[n] * hz <= HZ_MAX))
            return "the frequency of a mode is at most 10000 Hz, with its _ratio, too";
    }
    return NULL;
}

static const char *check_across(const struct vibration_config *config, unsigned axis)
{
    bool any = false;

    for (unsigned to = 0; to < AXIS_LINEAR_COUNT; to++) {
        const double part = config->across[axis][to];

        if (!(maths_abs(part) <= PART_MAX))
            return "a number of _across is at most 10";
        if (to == axis && maths_abs(part) > 0)
            return "the number of _across for the axis itself is 0";
        any = any || maths_abs(part) > 0;
    }
    return any && !has_mode(config, axis, 0) && !has_mode(config, axis, 1)
               ? "without a mode nothing swings across: _across is 0"
               : NULL;
}

static const char *check_uncertain(const struct vibration_config *config, unsigned axis)
{
    const double percent = config->uncertain_percent[axis];

    if (!(percent >= 0 && percent <= UNCERTAIN_MAX_PERCENT))
        return "what a frequency is uncertain by is 0 to 50 %";
    if (percent > 0 && has_mode(config, axis, 1))
        return "of an axis with two modes no mode_uncertainty_percent is planned for: it is 0";
    return NULL;
}

static const char *check_axis(const struct vibration_config *config, unsigned axis)
{
    const char *wrong = check_modes(config, axis);

    if (wrong == NULL)
        wrong = check_places(&config->table[axis]);
    for (unsigned n = 0; n < VIBRATION_MODES && wrong == NULL; n++)
        wrong = check_ratios(config, axis, n);
    if (wrong == NULL)
        wrong = check_uncertain(config, axis);
    return wrong != NULL ? wrong : check_across(config, axis);
}

const char *vibration_check(const struct vibration_config *config, unsigned *axis)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const char *wrong = check_axis(config, i);

        if (wrong != NULL) {
            *axis = i;
            return wrong;
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
 * away'' + 2 d w away' + w^2 away = 0 over a cycle, with the rate counted in w: exp(w t [0 1; -1
 * -2d]), by a part of the cycle that is small against the oscillation, and doubled (Moler and Van
 * Loan 2003, method 3).
 */
static void set_advance(struct vibration_mode *mode, double ratio, double cycle_s)
{
    const double w = mode->w_per_s * ratio, damping = mode->damping;
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
    mode->ratio = ratio;
}

bool vibration_is_uncertain(const struct vibration_config *config)
{
    bool any = false;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        any = any || (config->uncertain_percent[i] > 0 && has_mode(config, i, 0));
    return any;
}

void vibration_shift(struct vibration_config *config, double part)
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        for (unsigned n = 0; n < VIBRATION_MODES; n++)
            config->mode[i][n * VIBRATION_NUMBERS + VIBRATION_HZ] *=
                1 + 0.01 * part * config->uncertain_percent[i];
    }
}

void vibration_init(struct vibration *v, const struct vibration_config *config, double cycle_s)
{
    *v = (struct vibration){.cycle_s = cycle_s};
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        v->table[i] = config->table[i];
        for (unsigned n = 0; n < AXIS_LINEAR_COUNT; n++)
            v->across[i][n] = config->across[i][n];
        for (unsigned n = 0; n < VIBRATION_MODES; n++) {
            const double *number = &config->mode[i][(size_t)n * VIBRATION_NUMBERS];
            struct vibration_mode *mode = &v->axis[i].mode[n];

            if (!(number[VIBRATION_HZ] > 0))
                continue;
            mode->part = number[VIBRATION_PART];
            mode->w_per_s = 2.0 * MATHS_PI * number[VIBRATION_HZ];
            mode->damping = number[VIBRATION_DAMPING];
            set_advance(mode, 1, cycle_s);
            v->any = true;
        }
    }
}

/* Straight between two places; beyond the ends as there. */
static double ratio_at(const struct vibration_table *table, unsigned mode, const struct point *foot)
{
    const double length_mm = table->places_mm[1] - table->places_mm[0];
    const double *ratio = table->ratio[mode];
    double at, part;
    unsigned piece;

    if (!has_table(table))
        return 1;
    at = (foot->at[table->along] - table->places_mm[0]) / length_mm;
    at = maths_clamp(at, 0, 1) * (VIBRATION_PLACES - 1);
    piece = at < VIBRATION_PLACES - 2 ? (unsigned)at : VIBRATION_PLACES - 2;
    part = at - piece;
    return (1 - part) * ratio[piece] + part * ratio[piece + 1];
}

/*
 * The foot goes at one velocity from cycle to cycle; where that changes, the oscillator is left
 * behind by as much. Where it is and how fast it goes stay what they are when its frequency
 * changes.
 */
static double follow_mode(struct vibration_mode *mode, double ratio, double change_mm_s,
                          double cycle_s)
{
    const double away = mode->away_mm;
    const double rate = mode->rate_mm_s - change_mm_s;

    if (ratio < mode->ratio || ratio > mode->ratio)
        set_advance(mode, ratio, cycle_s);
    mode->away_mm = mode->advance[0][0] * away + mode->advance[0][1] * rate;
    mode->rate_mm_s = mode->advance[1][0] * away + mode->advance[1][1] * rate;
    return mode->part * mode->away_mm;
}

/* Over a cycle a frequency is that of its middle. */
static double follow_axis(struct vibration *v, unsigned i, double at_mm, const struct point *middle)
{
    struct vibration_axis *axis = &v->axis[i];
    const double velocity_mm_s = (at_mm - axis->foot_mm) / v->cycle_s;
    double away_mm = 0;

    for (unsigned n = 0; n < VIBRATION_MODES; n++) {
        struct vibration_mode *mode = &axis->mode[n];

        if (mode->w_per_s > 0)
            away_mm += follow_mode(mode, ratio_at(&v->table[i], n, middle),
                                   velocity_mm_s - axis->foot_mm_s, v->cycle_s);
    }
    axis->foot_mm = at_mm;
    axis->foot_mm_s = velocity_mm_s;
    return away_mm;
}

void vibration_follow(struct vibration *v, struct point *at)
{
    const struct point foot = *at;
    struct point middle = foot;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        if (!v->has_foot)
            v->axis[i].foot_mm = foot.at[i];
        middle.at[i] = (v->axis[i].foot_mm + foot.at[i]) / 2;
    }
    v->has_foot = true;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double away_mm = follow_axis(v, i, foot.at[i], &middle);

        at->at[i] += away_mm;
        for (unsigned to = 0; to < AXIS_LINEAR_COUNT; to++)
            at->at[to] += v->across[i][to] * away_mm;
    }
}

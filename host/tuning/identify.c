/*
 * With lead h per radian, inertia J, viscous friction b, dry friction c, weight g and delay D:
 *
 *     x'' = h/J (M(t - D) - g) - b/J x' - h c/J sign x'
 *
 * integrated twice, so that no reading is differentiated (Unbehauen and Rao 1987, section 5):
 *
 *     x = x0 + v0 t + h/J MM(t - D) - b/J X - h c/J SS - h g/J t^2/2
 *
 * MM is the torque's second integral, exact since it is constant over a cycle; X the integral of x,
 * SS the second integral of the sign of x'. What is wrong of x' once would be wrong of x ever
 * after. So all of them are compared by their second differences
 *
 *     x(t + m) - 2 x(t) + x(t - m)
 *
 * m being half of the time from one turn of the torque to the next: x0 and v0 are gone, and every
 * reading counts as what it has been for 2 m. All but D is linear: least squares for every D of a
 * grid, and of finer ones about the best.
 */
#include "tuning/identify.h"

#include "base/maths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum number { TORQUE, WAY, SIGN, FALL, NUMBERS };

/*
 * Delays: up to 24 cycles, first in quarters of one; then REFINEMENTS times about the best, each
 * FINER times finer.
 */
#define DELAYS      99
#define DELAY_PARTS 4
#define REFINEMENTS 6
#define FINER       4

/* The semi-implicit step of a simulated motor is early by half a step; half a cycle at most. */
#define DELAY_MIN_CYCLES (-0.5)

/* Cycles without which nothing is said, and the part of the way that may stay unexplained. */
#define CYCLES_MIN 50
#define LEFT_MAX   0.1

struct problem {
    const struct tuning_record *record;
    size_t apart;            /* m, cycles */
    size_t rows;             /* second differences: all cycles but m at either end */
    double *first, *second;  /* integrals of the torque at the beginning of each cycle */
    double *column[NUMBERS]; /* second differences, by row */
    double *position;        /* the same of the position */
    double answer[NUMBERS];
    double torque_variance; /* of answer[TORQUE], in the variance of a row */
};

/* Integrals of numbers that are constant over each cycle. */
static void integrate_twice(const double *of, size_t count, double cycle_s, double *first,
                            double *second)
{
    first[0] = second[0] = 0;
    for (size_t k = 0; k + 1 < count; k++) {
        first[k + 1] = first[k] + of[k] * cycle_s;
        second[k + 1] = second[k] + first[k] * cycle_s + of[k] * cycle_s * cycle_s / 2;
    }
}

/* The torque's second integral at a time; before the first cycle there was none. */
static double torque_integral(const struct problem *p, double cycles)
{
    const double last = (double)(p->record->count - 1), T = p->record->cycle_s;

    if (!(cycles > 0))
        return 0;
    const size_t k = (size_t)fmin(cycles, last);
    const double into_s = (cycles - (double)k) * T;

    return p->second[k] + p->first[k] * into_s + p->record->input[k] * into_s * into_s / 2;
}

static double moved_in(const struct tuning_record *r, size_t k)
{
    return k + 1 < r->count ? r->position[k + 1] - r->position[k] : 0;
}

/*
 * Mean of the velocity's sign over a cycle. Where it turns round it goes straight through 0, as
 * both cycles beside it have it: a cycle that is taken for one sign as a whole would leave an error
 * of velocity behind, and of the way ever after.
 */
static double direction(const struct tuning_record *r, size_t k)
{
    const double moved = moved_in(r, k), next = moved_in(r, k + 1);
    const double before = k > 0 ? moved_in(r, k - 1) : 0;
    const double half = fmax(fabs(next - before) / 4, r->step / 2);

    return fmin(fmax(moved / half, -1), 1);
}

/* Second differences of numbers by cycle. */
static void difference(const struct problem *p, const double *of, double *to)
{
    const size_t m = p->apart;

    for (size_t i = 0; i < p->rows; i++)
        to[i] = (of[i + 2 * m] - of[i + m]) - (of[i + m] - of[i]);
}

/* Everything but the torque, whose delay is not known yet. scratch: room for three more columns. */
static void set_columns(struct problem *p, double *scratch)
{
    const struct tuning_record *r = p->record;
    const double span_s = (double)p->apart * r->cycle_s;
    double *sign = scratch, *first = sign + r->count, *second = first + r->count;

    second[0] = 0;
    for (size_t k = 0; k + 1 < r->count; k++)
        second[k + 1] =
            second[k] - r->cycle_s * ((r->position[k] + r->position[k + 1]) / 2 - r->position[0]);
    difference(p, second, p->column[WAY]);
    for (size_t k = 0; k < r->count; k++)
        sign[k] = -direction(r, k);
    integrate_twice(sign, r->count, r->cycle_s, first, second);
    difference(p, second, p->column[SIGN]);
    difference(p, r->position, p->position);
    for (size_t i = 0; i < p->rows; i++)
        p->column[FALL][i] = -span_s * span_s;
}

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0;

    for (size_t k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

/*
 * Gauss and Jordan with the largest pivot of a column. False: the columns say nothing about a
 * number.
 */
static bool solve(double m[NUMBERS][2 * NUMBERS + 1])
{
    for (unsigned k = 0; k < NUMBERS; k++) {
        unsigned best = k;

        for (unsigned i = k + 1; i < NUMBERS; i++)
            best = fabs(m[i][k]) > fabs(m[best][k]) ? i : best;
        if (!(fabs(m[best][k]) > 1e-13))
            return false;
        for (unsigned j = 0; j <= 2 * NUMBERS; j++) {
            const double held = m[k][j];

            m[k][j] = m[best][j];
            m[best][j] = held;
        }
        for (unsigned i = 0; i < NUMBERS; i++) {
            const double times = i == k ? 0 : m[i][k] / m[k][k];

            for (unsigned j = 0; j <= 2 * NUMBERS && i != k; j++)
                m[i][j] -= times * m[k][j];
        }
    }
    return true;
}

/* The normal equations, columns scaled to length 1, and their inverse beside them. */
static bool answer_of(struct problem *p)
{
    const size_t count = p->rows;
    double m[NUMBERS][2 * NUMBERS + 1] = {{0}}, length[NUMBERS];

    for (unsigned i = 0; i < NUMBERS; i++) {
        length[i] = sqrt(dot(p->column[i], p->column[i], count));
        length[i] = length[i] > 0 ? length[i] : 1;
    }
    for (unsigned i = 0; i < NUMBERS; i++) {
        for (unsigned j = 0; j < NUMBERS; j++)
            m[i][j] = dot(p->column[i], p->column[j], count) / (length[i] * length[j]);
        m[i][i] += m[i][i] > 0 ? 0 : 1; /* a column of zeros: its number is 0 */
        m[i][NUMBERS] = dot(p->column[i], p->position, count) / length[i];
        m[i][NUMBERS + 1 + i] = 1;
    }
    if (!solve(m))
        return false;
    for (unsigned i = 0; i < NUMBERS; i++)
        p->answer[i] = m[i][NUMBERS] / m[i][i] / length[i];
    p->torque_variance =
        m[TORQUE][NUMBERS + 1 + TORQUE] / m[TORQUE][TORQUE] / (length[TORQUE] * length[TORQUE]);
    return true;
}

/* Mean square that is left with this delay; infinite: there is no answer. */
static double left_with(struct problem *p, double delay_cycles)
{
    const double m = (double)p->apart;
    double sum = 0;

    for (size_t i = 0; i < p->rows; i++) {
        const double at = (double)i + m - delay_cycles;

        p->column[TORQUE][i] =
            torque_integral(p, at + m) - 2 * torque_integral(p, at) + torque_integral(p, at - m);
    }
    if (!answer_of(p))
        return MATHS_INFINITY;
    for (size_t i = 0; i < p->rows; i++) {
        double left = p->position[i];

        for (unsigned n = 0; n < NUMBERS; n++)
            left -= p->answer[n] * p->column[n][i];
        sum += left * left;
    }
    return sum / (double)p->rows;
}

/* The best delay from one on, of this many. */
static double best_delay(struct problem *p, double from, double step, unsigned count)
{
    double best = from, least = MATHS_INFINITY;

    for (unsigned i = 0; i < count; i++) {
        const double delay = from + i * step;
        const double left = left_with(p, delay);

        if (left < least) {
            least = left;
            best = delay;
        }
    }
    return best;
}

static double find_delay(struct problem *p)
{
    double step = 1.0 / DELAY_PARTS;
    double delay = best_delay(p, DELAY_MIN_CYCLES, step, DELAYS);

    for (unsigned i = 0; i < REFINEMENTS; i++) {
        delay = best_delay(p, delay - step, step / FINER, 2 * FINER + 1);
        step /= FINER;
    }
    return delay;
}

/* False: what is left is too much, or the torque drives it backwards. */
static bool take(struct problem *p, double travel_per_rad, struct tuning_plant *plant)
{
    const double delay = find_delay(p);
    const double left = left_with(p, delay);
    const double per_torque = p->answer[TORQUE]; /* h/J */

    if (!isfinite(left) || !(per_torque > 0))
        return false;
    const double inertia = travel_per_rad / per_torque;

    /*
     * Readings that are rounded to steps are off by step/sqrt(12) at least, a second difference by
     * sqrt(6) times that.
     */
    const double step = p->record->step;
    const double variance = fmax(left, step * step / 2);

    *plant = (struct tuning_plant){
        .travel_per_rad = travel_per_rad,
        .inertia_kg_m2 = inertia,
        .inertia_deviation_kg_m2 =
            inertia / per_torque * sqrt(fmax(variance * p->torque_variance, 0)),
        .viscous_nm_s_per_rad = fmax(p->answer[WAY] * inertia, 0),
        .dry_nm = fmax(p->answer[SIGN] / per_torque, 0),
        .weight_nm = p->answer[FALL] / per_torque,
        .delay_s = delay * p->record->cycle_s,
        .left = sqrt(left),
        .swing = sqrt(dot(p->position, p->position, p->rows) / (double)p->rows),
    };
    return plant->left <= LEFT_MAX * plant->swing + step;
}

/* Half of the mean time from one turn of the torque to the next. */
static size_t apart_of(const struct tuning_record *r)
{
    size_t turns = 1;

    for (size_t k = 1; k < r->count; k++)
        turns += (r->input[k] > 0) != (r->input[k - 1] > 0);
    return r->count / (2 * turns) + 1;
}

bool tuning_identify(const struct tuning_record *record, double travel_per_rad,
                     struct tuning_plant *plant)
{
    const size_t count = record->count;
    struct problem p = {.record = record};
    double *room;
    bool good = false;

    if (record->failed || count < CYCLES_MIN)
        return false;
    p.apart = apart_of(record);
    if (count < 2 * p.apart + CYCLES_MIN)
        return false;
    p.rows = count - 2 * p.apart;
    room = calloc((NUMBERS + 6) * count, sizeof *room);
    if (room == NULL)
        return false;
    for (unsigned i = 0; i < NUMBERS; i++)
        p.column[i] = room + i * count;
    p.position = room + NUMBERS * count;
    p.first = p.position + count;
    p.second = p.first + count;
    integrate_twice(record->input, count, record->cycle_s, p.first, p.second);
    set_columns(&p, p.second + count);
    good = take(&p, travel_per_rad, plant);
    free(room);
    return good;
}

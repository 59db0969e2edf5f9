/*
 * Least squares: y = sum of part_m A(hz_m, damping_m), y what the tool is accelerated beside its
 * foot, A what a mode makes of the foot's way (model.h).
 *
 * A mode is looked for on a grid of frequencies and dampings, with the best part for each; then all
 * numbers of all modes together by Gauss and Newton, in ln hz, ln damping and part. Another mode is
 * there if that lowers n ln(y'y/n) + k ln n of k numbers and n cycles (Schwarz 1978) by more than 2
 * ln g, g being the places of the grid: the best of g finds that much in noise. Deviations are
 * those of the inverse of the normal matrix times the variance left.
 */
#include "resonance/fit.h"

#include "resonance/model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NUMBERS     3 /* of a mode */
#define NUMBERS_MAX ((unsigned)NUMBERS * VIBRATION_MODES)

/*
 * The grid: from the lowest frequency to this part of a cycle's, each higher by this ratio; and
 * dampings.
 */
#define HZ_LOW     2.0
#define CYCLE_PART 0.4
#define HZ_RATIO   1.06

#define DAMPINGS 3
static const double dampings[DAMPINGS] = {0.01, 0.04, 0.15};

/* Step of a number's logarithm, for a derivative. */
#define SMALL 1e-4

#define STEPS    30
#define HALVINGS 20

struct problem {
    const struct resonance_record *record;
    size_t count;
    double *beside;              /* y */
    double *left;                /* what is left of it */
    double *column[NUMBERS_MAX]; /* derivatives by the numbers */
    double *answer;              /* room for one more */
};

/* The numbers of all modes: ln hz, ln damping, part. */
struct numbers {
    unsigned modes;
    double of[NUMBERS_MAX];
};

static double dot(const double *a, const double *b, size_t count)
{
    double sum = 0;

    for (size_t k = 0; k < count; k++)
        sum += a[k] * b[k];
    return sum;
}

static void answer_of(const struct problem *p, double ln_hz, double ln_damping, double *answer)
{
    resonance_answer(p->record, exp(ln_hz), fmin(exp(ln_damping), 0.999), answer);
}

/* Sets what is left of y, and returns its square. */
static double leave(struct problem *p, const struct numbers *n)
{
    memcpy(p->left, p->beside, p->count * sizeof *p->left);
    for (unsigned m = 0; m < n->modes; m++) {
        const double *of = &n->of[(size_t)NUMBERS * m];

        answer_of(p, of[0], of[1], p->answer);
        for (size_t k = 0; k < p->count; k++)
            p->left[k] -= of[2] * p->answer[k];
    }
    return dot(p->left, p->left, p->count);
}

/* -- a mode more -- */

static double highest_ln_hz(const struct problem *p)
{
    return log(CYCLE_PART / p->record->cycle_s);
}

static unsigned frequencies(const struct problem *p)
{
    return (unsigned)((highest_ln_hz(p) - log(HZ_LOW)) / log(HZ_RATIO));
}

/* How much of the square of what is left a mode explains, with the best part of it. */
static double explain(const struct problem *p, double ln_hz, double ln_damping, double *part)
{
    answer_of(p, ln_hz, ln_damping, p->answer);
    const double square = dot(p->answer, p->answer, p->count);
    const double along = dot(p->answer, p->left, p->count);

    *part = square > 0 ? along / square : 0;
    return along * *part;
}

/* Adds the mode of the grid that explains most of what is left. False: none explains anything. */
static bool add_mode(struct problem *p, struct numbers *n)
{
    double *of = &n->of[(size_t)NUMBERS * n->modes];
    double most = 0;

    (void)leave(p, n);
    for (unsigned i = 0; i < DAMPINGS * frequencies(p); i++) {
        const unsigned row = i / DAMPINGS;
        const double ln_hz = log(HZ_LOW) + row * log(HZ_RATIO);
        const double ln_damping = log(dampings[i % DAMPINGS]);
        double part;
        const double explained = explain(p, ln_hz, ln_damping, &part);

        if (explained > most) {
            most = explained;
            of[0] = ln_hz;
            of[1] = ln_damping;
            of[2] = part;
        }
    }
    n->modes += most > 0;
    return most > 0;
}

/* -- Gauss and Newton -- */

static void set_columns(struct problem *p, const struct numbers *n)
{
    for (unsigned m = 0; m < n->modes; m++) {
        const double *of = &n->of[(size_t)NUMBERS * m];
        double **column = &p->column[(size_t)NUMBERS * m];

        answer_of(p, of[0], of[1], column[2]);
        answer_of(p, of[0] + SMALL, of[1], column[0]);
        answer_of(p, of[0], of[1] + SMALL, column[1]);
        for (unsigned i = 0; i < 2; i++) {
            for (size_t k = 0; k < p->count; k++)
                column[i][k] = of[2] * (column[i][k] - column[2][k]) / SMALL;
        }
    }
}

/* The inverse of a symmetric positive matrix, by elimination beside 1. False: it has none. */
static bool invert(double m[NUMBERS_MAX][NUMBERS_MAX], double inverse[NUMBERS_MAX][NUMBERS_MAX],
                   unsigned size)
{
    for (unsigned i = 0; i < size; i++) {
        for (unsigned j = 0; j < size; j++)
            inverse[i][j] = i == j;
    }
    for (unsigned k = 0; k < size; k++) {
        const double pivot = m[k][k];

        if (!(pivot > 0))
            return false;
        for (unsigned j = 0; j < size; j++) {
            m[k][j] /= pivot;
            inverse[k][j] /= pivot;
        }
        for (unsigned i = 0; i < size; i++) {
            const double part = i != k ? m[i][k] : 0;

            for (unsigned j = 0; j < size && part != 0; j++) {
                m[i][j] -= part * m[k][j];
                inverse[i][j] -= part * inverse[k][j];
            }
        }
    }
    return true;
}

/* Inverse of the columns' normal matrix. */
static bool invert_normal(const struct problem *p, unsigned size,
                          double inverse[NUMBERS_MAX][NUMBERS_MAX])
{
    double m[NUMBERS_MAX][NUMBERS_MAX];

    for (unsigned i = 0; i < size; i++) {
        for (unsigned j = 0; j < size; j++)
            m[i][j] = dot(p->column[i], p->column[j], p->count);
    }
    return invert(m, inverse, size);
}

/* One step, as long as it leaves less; returns what is left then. */
static double improve(struct problem *p, struct numbers *n, double left)
{
    const unsigned size = NUMBERS * n->modes;
    double inverse[NUMBERS_MAX][NUMBERS_MAX], step[NUMBERS_MAX] = {0}, part = 1;

    set_columns(p, n);
    if (!invert_normal(p, size, inverse))
        return left;
    for (unsigned i = 0; i < size; i++) {
        for (unsigned j = 0; j < size; j++)
            step[i] += inverse[i][j] * dot(p->column[j], p->left, p->count);
    }
    for (unsigned halving = 0; halving < HALVINGS; halving++, part /= 2) {
        struct numbers tried = *n;

        for (unsigned i = 0; i < size; i++)
            tried.of[i] += part * step[i];
        const double now = leave(p, &tried);

        if (now < left) {
            *n = tried;
            return now;
        }
    }
    return leave(p, n);
}

static double refine(struct problem *p, struct numbers *n)
{
    double left = leave(p, n), before;
    unsigned steps = 0;

    do {
        before = left;
        left = improve(p, n, before);
    } while (left < before * (1 - 1e-12) && ++steps < STEPS);
    return left;
}

/* -- how many -- */

static double criterion(const struct problem *p, unsigned modes, double left)
{
    const double n = (double)p->count;
    const double places = DAMPINGS * (double)frequencies(p);

    return n * log(fmax(left, 1e-300) / n) + modes * (NUMBERS * log(n) + 2 * log(places));
}

/* Not so far from the grid that it is another thing than a mode. */
static bool are_modes(const struct problem *p, const struct numbers *n)
{
    bool good = true;

    for (unsigned m = 0; m < n->modes; m++) {
        const double *of = &n->of[(size_t)NUMBERS * m];

        good = good && of[0] >= log(HZ_LOW) && of[0] <= highest_ln_hz(p) && of[1] < 0;
    }
    return good;
}

static double find_modes(struct problem *p, struct numbers *n)
{
    double left = leave(p, n);

    while (n->modes < VIBRATION_MODES) {
        struct numbers more = *n;

        if (!add_mode(p, &more))
            break;
        const double then = refine(p, &more);

        if (!are_modes(p, &more) || criterion(p, more.modes, then) >= criterion(p, n->modes, left))
            break;
        *n = more;
        left = then;
    }
    return left;
}

static void swap_into_order(struct resonance_fit *fit)
{
    if (fit->modes == 2 && fit->mode[0].hz.value > fit->mode[1].hz.value) {
        const struct resonance_mode first = fit->mode[0];

        fit->mode[0] = fit->mode[1];
        fit->mode[1] = first;
    }
}

static void set_fit(struct problem *p, const struct numbers *n, double left,
                    struct resonance_fit *fit)
{
    double inverse[NUMBERS_MAX][NUMBERS_MAX] = {{0}};
    const double variance = left / (double)p->count;

    *fit = (struct resonance_fit){.modes = n->modes, .left_mm_s2 = sqrt(variance)};
    set_columns(p, n);
    (void)invert_normal(p, NUMBERS * n->modes, inverse);
    for (unsigned m = 0; m < n->modes; m++) {
        const double *of = &n->of[(size_t)NUMBERS * m];
        double deviation[NUMBERS];

        for (unsigned i = 0; i < NUMBERS; i++)
            deviation[i] = sqrt(variance * inverse[NUMBERS * m + i][NUMBERS * m + i]);
        fit->mode[m] = (struct resonance_mode){
            .hz = {exp(of[0]), exp(of[0]) * deviation[0]},
            .damping = {exp(of[1]), exp(of[1]) * deviation[1]},
            .part = {of[2], deviation[2]},
        };
    }
    swap_into_order(fit);
}

bool resonance_fit(const struct resonance_record *record, struct resonance_fit *fit)
{
    const size_t columns = 3 + NUMBERS_MAX;
    double *room = record->count > 0 ? calloc(columns * record->count, sizeof *room) : NULL;
    struct problem p = {.record = record, .count = record->count};
    struct numbers n = {0};

    if (room == NULL)
        return false;
    p.beside = room;
    p.left = room + record->count;
    p.answer = room + 2 * record->count;
    for (unsigned i = 0; i < NUMBERS_MAX; i++)
        p.column[i] = room + (3 + i) * record->count;
    resonance_beside(record, p.beside);
    const double left = find_modes(&p, &n);

    set_fit(&p, &n, left, fit);
    free(room);
    return true;
}

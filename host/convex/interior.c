#include "convex/interior.h"

#include "base/maths.h"
#include "convex/band.h"
#include "convex/image.h"

#include <stdlib.h>
#include <string.h>

/* What a row broken by its whole limit costs, in knots of time. */
#define PRICE 50.0

/* The first slack, at least, and the first product of slack and multiplier. */
#define SLACK_START 0.05
#define MU_START    0.1

/* Ends when this much time a knot could still be won, or after so many iterations. */
#define GAP_END        2e-4
#define ITERATIONS_MAX 30

/* Part of the way to the bound that a step goes at most. */
#define STEP_PART 0.99

/*
 * Second derivative of the time by e; and what keeps changes of the curve small where nothing else
 * does.
 */
#define TIME_SQUARE 0.75
#define MOVE_SQUARE 0.03
#define STAY_SQUARE 1e9

/*
 * Price of half the square of what the swing of a stray tool is not what follows from the curve, in
 * a knot, in tolerances.
 */
#define SWING_SQUARE 1e6

/*
 * Price of half the square of e's second difference: a change of time that trembles from knot to
 * knot and a change of the curve along itself that undoes it would cost nothing else, and are not
 * what their first order says.
 */
#define SMOOTH_SQUARE 300.0

struct row {
    double m, s, t; /* multiplier, slack, break */
    double dm, ds, dt;
    double w;    /* 1 / (s / m + t / (PRICE - m)) */
    double c, r; /* value, and c - s + t */
};

struct interior {
    size_t cells_max;
    const struct problem *problem;
    size_t ends;  /* control points at either end that may not change, */
    size_t free;  /* and those between them that may */
    size_t width; /* of the band */
    size_t each;  /* unknowns of a control point */
    int rows;     /* of a cell */
    double *z;
    double *dz;
    double *slope; /* of the Lagrangian, negative */
    double *right;
    double *band;
    double (*change)[4];
    struct row (*row)[ROWS_MAX];
    double move_square;
    double swing_square;
};

struct interior *interior_new(size_t cells_max, unsigned modes, unsigned strays)
{
    const struct problem as = {.modes = modes, .strays = strays};
    const size_t unknowns = problem_each(&as) * cells_max;
    struct interior *w = calloc(1, sizeof *w);

    if (w == NULL)
        return NULL;
    w->cells_max = cells_max;
    w->z = calloc(unknowns, sizeof *w->z);
    w->dz = calloc(unknowns, sizeof *w->dz);
    w->slope = calloc(unknowns, sizeof *w->slope);
    w->right = calloc(unknowns, sizeof *w->right);
    w->band = calloc(problem_unknowns(&as) * unknowns, sizeof *w->band);
    w->change = calloc(cells_max, sizeof *w->change);
    w->row = calloc(cells_max, sizeof *w->row);
    if (w->z != NULL && w->dz != NULL && w->slope != NULL && w->right != NULL && w->band != NULL &&
        w->change != NULL && w->row != NULL)
        return w;
    interior_free(w);
    return NULL;
}

void interior_free(struct interior *w)
{
    if (w == NULL)
        return;
    free(w->z);
    free(w->dz);
    free(w->slope);
    free(w->right);
    free(w->band);
    free(w->change);
    free(w->row);
    free(w);
}

/* The first of a cell's control points that may change, and one past the last. */
static size_t first_free(const struct interior *w, size_t cell)
{
    return cell < w->ends ? w->ends - cell : 0;
}

static size_t end_free(const struct interior *w, size_t cell)
{
    const size_t left = w->free + w->ends - cell;

    return left < w->width / w->each ? left : w->width / w->each;
}

static void gather(const struct interior *w, const double *from, size_t cell,
                   double x[IMAGE_UNKNOWNS])
{
    const size_t begin = first_free(w, cell);
    const size_t end = end_free(w, cell);

    memset(x, 0, w->width * sizeof *x);
    for (size_t k = begin; k < end; k++)
        memcpy(x + w->each * k, from + w->each * (cell + k - w->ends), w->each * sizeof *x);
}

static void scatter(const struct interior *w, const double b[IMAGE_UNKNOWNS], size_t cell,
                    double *to)
{
    const size_t end = end_free(w, cell);

    for (size_t k = first_free(w, cell); k < end; k++) {
        for (size_t i = 0; i < w->each; i++)
            to[w->each * (cell + k - w->ends) + i] += b[w->each * k + i];
    }
}

static void scatter_square(struct interior *w, const double *k, size_t cell)
{
    const size_t begin = w->each * first_free(w, cell);
    const size_t end = w->each * end_free(w, cell);

    for (size_t j = begin; j < end; j++) {
        double *column = w->band + (w->each * cell + j - w->each * w->ends) * w->width;

        for (size_t i = j; i < end; i++)
            column[i - j] += k[i * w->width + j];
    }
}

static void start(struct interior *w)
{
    const struct problem *p = w->problem;
    static const double nothing[CELL_UNKNOWNS];
    const struct rows_at z = {nothing, nothing, {nothing, nothing}};

    memset(w->z, 0, w->each * w->free * sizeof *w->z);
    for (size_t i = 0; i < p->cells; i++) {
        double c[ROWS_MAX];

        rows_value(p, i, &z, c);
        for (int j = 0; j < w->rows; j++) {
            struct row *row = &w->row[i][j];

            row->s = maths_max(c[j], SLACK_START);
            row->t = maths_max(row->s - c[j], MU_START / PRICE);
            row->m = maths_min(MU_START / row->s, 0.5 * PRICE);
        }
    }
}

/* Values of all rows at z; the mean product of slacks and multipliers is returned. */
static double take_values(struct interior *w)
{
    const struct problem *p = w->problem;
    double sum = 0;

    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double c[ROWS_MAX];
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        rows_value(p, i, &z, c);
        for (int j = 0; j < w->rows; j++) {
            struct row *row = &w->row[i][j];

            row->c = c[j];
            row->r = c[j] - row->s + row->t;
            row->w = 1 / (row->s / row->m + row->t / (PRICE - row->m));
            sum += row->s * row->m + row->t * (PRICE - row->m);
        }
    }
    return sum / (2.0 * w->rows * (double)p->cells);
}

/* The second difference about f - 1; e is 0 beyond the curve's ends. */
static void smooth_at(struct interior *w, size_t f)
{
    static const double second[3] = {1, -2, 1};
    const size_t begin = f < 2 ? 2 - f : 0;
    const size_t end = w->free + 2 - f < 3 ? w->free + 2 - f : 3;
    double bend = 0;

    for (size_t i = begin; i < end; i++)
        bend += second[i] * w->z[w->each * (f + i - 2) + 3];
    for (size_t i = begin; i < end; i++) {
        const size_t at = f + i - 2;

        w->slope[w->each * at + 3] -= SMOOTH_SQUARE * second[i] * bend;
        for (size_t j = i; j < end; j++)
            w->band[(w->each * at + 3) * w->width + w->each * (j - i)] +=
                SMOOTH_SQUARE * second[i] * second[j];
    }
}

static void smooth_time(struct interior *w)
{
    for (size_t f = 0; f < w->free + 2; f++)
        smooth_at(w, f);
}

/* What stays has a price that nothing else comes near to. */
static void keep_rest(struct interior *w)
{
    const size_t rest = w->problem->rest < w->free ? w->problem->rest : w->free;

    for (size_t f = w->free - rest; f < w->free; f++) {
        for (size_t i = 0; i < 3; i++)
            w->band[(w->each * f + i) * w->width] = STAY_SQUARE * w->move_square;
        w->band[(w->each * f + 3) * w->width] = STAY_SQUARE;
    }
}

/* Does the third of a cell's points of stray tools belong to what may change? */
static bool swings(const struct interior *w, size_t cell)
{
    const size_t slot = cell + 2 + 2 * (size_t)w->problem->modes;

    return slot >= w->ends && slot < w->ends + w->free;
}

/* The normal matrix and its right side without the rows' targets. */
static void assemble(struct interior *w)
{
    const struct problem *p = w->problem;
    const double time_square = p->timed ? TIME_SQUARE : STAY_SQUARE;

    memset(w->band, 0, w->each * w->free * w->width * sizeof *w->band);
    for (size_t f = 0; f < w->free; f++) {
        for (size_t i = 0; i < w->each; i++) {
            w->band[(w->each * f + i) * w->width] = w->move_square;
            w->slope[w->each * f + i] = -w->move_square * w->z[w->each * f + i];
        }
        w->band[(w->each * f + 3) * w->width] = time_square;
        w->slope[w->each * f + 3] = (p->timed ? 0.5 : 0) - time_square * w->z[w->each * f + 3];
    }
    keep_rest(w);
    smooth_time(w);
    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double k[IMAGE_UNKNOWNS * IMAGE_UNKNOWNS];
        double b[IMAGE_UNKNOWNS] = {0};
        double weight[ROWS_MAX];
        double m[ROWS_MAX];
        double back[ROWS_MAX];
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        for (int j = 0; j < w->rows; j++) {
            weight[j] = w->row[i][j].w;
            m[j] = w->row[i][j].m;
            back[j] = -m[j];
        }
        image_normal(p, i, &z, weight, m, k);
        if (swings(w, i))
            image_swing(p, i, x, w->swing_square, k, b);
        scatter_square(w, k, i);
        image_transpose(p, i, &z, back, b);
        scatter(w, b, i, w->slope);
    }
    band_factor(w->band, w->width, w->each * w->free);
}

/*
 * What the products of a row should change by; a second step takes the first one's product into
 * account.
 */
static void targets(const struct row *row, double mu, bool again, double *with_s, double *with_t)
{
    const double extra_s = again ? row->ds * row->dm : 0;
    const double extra_t = again ? -row->dt * row->dm : 0;

    *with_s = mu - row->s * row->m - extra_s;
    *with_t = mu - row->t * (PRICE - row->m) - extra_t;
}

/* R_s / m - R_t / (PRICE - m) - r: what a row asks of its multiplier. */
static double asked(const struct row *row, double with_s, double with_t)
{
    return with_s / row->m - with_t / (PRICE - row->m) - row->r;
}

/* The longest part of the step 1 that keeps v > 0. */
static double longest(double v, double dv, double so_far)
{
    return dv < 0 ? maths_min(so_far, -v / dv) : so_far;
}

/* The right side of the Newton step: the slope, and what the rows ask for. */
static void set_right(struct interior *w, double mu, bool again)
{
    const struct problem *p = w->problem;

    memcpy(w->right, w->slope, w->each * w->free * sizeof *w->right);
    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double v[ROWS_MAX];
        double b[IMAGE_UNKNOWNS] = {0};
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        for (int j = 0; j < w->rows; j++) {
            double with_s;
            double with_t;

            targets(&w->row[i][j], mu, again, &with_s, &with_t);
            v[j] = -w->row[i][j].w * asked(&w->row[i][j], with_s, with_t);
        }
        image_transpose(p, i, &z, v, b);
        scatter(w, b, i, w->right);
    }
}

/* How slacks and multipliers of a cell change with dz, and how far they may. */
static void follow_step(struct interior *w, size_t cell, double mu, bool again, double *primal,
                        double *dual)
{
    const struct problem *p = w->problem;
    double x[IMAGE_UNKNOWNS];
    double dx[IMAGE_UNKNOWNS];
    double product[ROWS_MAX];
    struct image image;
    struct image step;

    gather(w, w->z, cell, x);
    gather(w, w->dz, cell, dx);
    const struct rows_at z = image_of(p, cell, x, &image);
    const struct rows_at dz = image_of(p, cell, dx, &step);

    rows_product(p, cell, &z, &dz, product);
    for (int j = 0; j < w->rows; j++) {
        struct row *row = &w->row[cell][j];
        double with_s;
        double with_t;

        targets(row, mu, again, &with_s, &with_t);
        row->dm = row->w * (asked(row, with_s, with_t) + product[j]);
        row->ds = (with_s - row->s * row->dm) / row->m;
        row->dt = (with_t + row->t * row->dm) / (PRICE - row->m);
        *primal = longest(row->s, row->ds, *primal);
        *primal = longest(row->t, row->dt, *primal);
        *dual = longest(row->m, row->dm, *dual);
        *dual = longest(PRICE - row->m, -row->dm, *dual);
    }
}

/* One direction; how far slacks and multipliers may go along it. */
static void direction(struct interior *w, double mu, bool again, double *primal, double *dual)
{
    set_right(w, mu, again);
    memcpy(w->dz, w->right, w->each * w->free * sizeof *w->dz);
    band_solve(w->band, w->width, w->each * w->free, w->dz);
    *primal = 1;
    *dual = 1;
    for (size_t i = 0; i < w->problem->cells; i++)
        follow_step(w, i, mu, again, primal, dual);
}

/* The mean product after a step. */
static double mean_after(const struct interior *w, double primal, double dual)
{
    double sum = 0;

    for (size_t i = 0; i < w->problem->cells; i++) {
        for (int j = 0; j < w->rows; j++) {
            const struct row *row = &w->row[i][j];
            const double m = row->m + dual * row->dm;

            sum += (row->s + primal * row->ds) * m;
            sum += (row->t + primal * row->dt) * (PRICE - m);
        }
    }
    return sum / (2.0 * w->rows * (double)w->problem->cells);
}

static void advance(struct interior *w, double primal, double dual)
{
    for (size_t i = 0; i < w->problem->cells; i++) {
        for (int j = 0; j < w->rows; j++) {
            struct row *row = &w->row[i][j];

            row->s += primal * row->ds;
            row->t += primal * row->dt;
            row->m += dual * row->dm;
        }
    }
    for (size_t f = 0; f < w->each * w->free; f++)
        w->z[f] += primal * w->dz[f];
}

/* Numbers too far apart for the matrix leave no direction. */
static bool has_direction(const struct interior *w)
{
    double sum = 0;

    for (size_t f = 0; f < w->each * w->free; f++)
        sum += maths_abs(w->dz[f]);
    return maths_is_finite(sum);
}

/*
 * Mehrotra's centring: the cube of what a step straight to the end would leave. False: it cannot be
 * taken.
 */
static bool iterate(struct interior *w, double mu)
{
    double primal;
    double dual;
    double part;

    assemble(w);
    direction(w, 0, false, &primal, &dual);
    part = mean_after(w, primal, dual) / mu;
    direction(w, mu * maths_max(part * part * part, 1e-3), true, &primal, &dual);
    if (!has_direction(w))
        return false;
    advance(w, maths_min(1, STEP_PART * primal), maths_min(1, STEP_PART * dual));
    return true;
}

double (*interior_solve(struct interior *w, const struct problem *p))[4]
{
    double radius_mm = MATHS_INFINITY;

    w->problem = p;
    w->ends = problem_ends(p);
    w->free = p->cells - w->ends;
    w->width = problem_unknowns(p);
    w->each = problem_each(p);
    w->rows = rows_count(p);
    for (size_t i = 0; i < p->cells; i++)
        radius_mm = maths_min(radius_mm, p->cell[i].ball[0].radius_mm);
    w->move_square = MOVE_SQUARE / (radius_mm * radius_mm);
    w->swing_square = SWING_SQUARE / (radius_mm * radius_mm);
    start(w);
    for (int i = 0; i < ITERATIONS_MAX; i++) {
        const double mu = take_values(w);

        if (mu * 2 * w->rows < GAP_END || !iterate(w, mu))
            break;
    }
    for (size_t f = 0; f < w->free; f++)
        memcpy(w->change[f], w->z + w->each * f, sizeof w->change[f]);
    return w->change;
}

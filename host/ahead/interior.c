#include "ahead/interior.h"

#include "ahead/band.h"
#include "ahead/image.h"
#include "base/maths.h"

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

/* Second derivative of the time by e; and what keeps changes of the curve small where nothing else does. */
#define TIME_SQUARE 0.75
#define MOVE_SQUARE 0.03

/*
 * Price of half the square of e's second difference: a change of time that trembles from knot to knot and a change of the
 * curve along itself that undoes it would cost nothing else, and are not what their first order says.
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
    double (*z)[4];
    double (*dz)[4];
    double (*slope)[4]; /* of the Lagrangian, negative */
    double (*right)[4];
    double *band;
    struct row (*row)[CELL_ROWS];
    double move_square;
};

struct interior *interior_new(size_t cells_max, unsigned modes)
{
    struct interior *w = calloc(1, sizeof *w);

    if (w == NULL)
        return NULL;
    w->cells_max = cells_max;
    w->z = calloc(cells_max, sizeof *w->z);
    w->dz = calloc(cells_max, sizeof *w->dz);
    w->slope = calloc(cells_max, sizeof *w->slope);
    w->right = calloc(cells_max, sizeof *w->right);
    w->band = calloc(4 * (4 + 2 * (size_t)modes) * 4 * cells_max, sizeof *w->band);
    w->row = calloc(cells_max, sizeof *w->row);
    if (w->z != NULL && w->dz != NULL && w->slope != NULL && w->right != NULL && w->band != NULL &&
        w->row != NULL)
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

    return left < w->width / 4 ? left : w->width / 4;
}

static void gather(const struct interior *w, double (*from)[4], size_t cell,
                   double x[IMAGE_UNKNOWNS])
{
    const size_t begin = first_free(w, cell);
    const size_t end = end_free(w, cell);

    memset(x, 0, w->width * sizeof *x);
    for (size_t k = begin; k < end; k++)
        memcpy(x + 4 * k, from[cell + k - w->ends], sizeof from[0]);
}

static void scatter(const struct interior *w, const double b[IMAGE_UNKNOWNS], size_t cell,
                    double (*to)[4])
{
    const size_t end = end_free(w, cell);

    for (size_t k = first_free(w, cell); k < end; k++) {
        for (int i = 0; i < 4; i++)
            to[cell + k - w->ends][i] += b[4 * k + (size_t)i];
    }
}

static void scatter_square(struct interior *w, const double *k, size_t cell)
{
    const size_t begin = 4 * first_free(w, cell);
    const size_t end = 4 * end_free(w, cell);

    for (size_t j = begin; j < end; j++) {
        double *column = w->band + (4 * cell + j - 4 * w->ends) * w->width;

        for (size_t i = j; i < end; i++)
            column[i - j] += k[i * w->width + j];
    }
}

static void start(struct interior *w)
{
    const struct problem *p = w->problem;
    static const double nothing[CELL_UNKNOWNS];
    const struct rows_at z = {nothing, nothing};

    memset(w->z, 0, w->free * sizeof *w->z);
    for (size_t i = 0; i < p->cells; i++) {
        double c[CELL_ROWS];

        rows_value(p, &p->cell[i], &z, c);
        for (int j = 0; j < CELL_ROWS; j++) {
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
        double c[CELL_ROWS];
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        rows_value(p, &p->cell[i], &z, c);
        for (int j = 0; j < CELL_ROWS; j++) {
            struct row *row = &w->row[i][j];

            row->c = c[j];
            row->r = c[j] - row->s + row->t;
            row->w = 1 / (row->s / row->m + row->t / (PRICE - row->m));
            sum += row->s * row->m + row->t * (PRICE - row->m);
        }
    }
    return sum / (2.0 * CELL_ROWS * (double)p->cells);
}

/* The second difference about f - 1; e is 0 beyond the window's ends. */
static void smooth_at(struct interior *w, size_t f)
{
    static const double second[3] = {1, -2, 1};
    const size_t begin = f < 2 ? 2 - f : 0;
    const size_t end = w->free + 2 - f < 3 ? w->free + 2 - f : 3;
    double bend = 0;

    for (size_t i = begin; i < end; i++)
        bend += second[i] * w->z[f + i - 2][3];
    for (size_t i = begin; i < end; i++) {
        const size_t at = f + i - 2;

        w->slope[at][3] -= SMOOTH_SQUARE * second[i] * bend;
        for (size_t j = i; j < end; j++)
            w->band[(4 * at + 3) * w->width + 4 * (j - i)] += SMOOTH_SQUARE * second[i] * second[j];
    }
}

static void smooth_time(struct interior *w)
{
    for (size_t f = 0; f < w->free + 2; f++)
        smooth_at(w, f);
}

/* The normal matrix and its right side without the rows' targets. */
static void assemble(struct interior *w)
{
    const struct problem *p = w->problem;
    const double time_square = p->timed ? TIME_SQUARE : 1e9;

    memset(w->band, 0, 4 * w->free * w->width * sizeof *w->band);
    for (size_t f = 0; f < w->free; f++) {
        for (int i = 0; i < 3; i++) {
            w->band[(4 * f + (size_t)i) * w->width] = w->move_square;
            w->slope[f][i] = -w->move_square * w->z[f][i];
        }
        w->band[(4 * f + 3) * w->width] = time_square;
        w->slope[f][3] = (p->timed ? 0.5 : 0) - time_square * w->z[f][3];
    }
    smooth_time(w);
    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double k[IMAGE_UNKNOWNS * IMAGE_UNKNOWNS];
        double b[IMAGE_UNKNOWNS] = {0};
        double weight[CELL_ROWS];
        double m[CELL_ROWS];
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        for (int j = 0; j < CELL_ROWS; j++) {
            weight[j] = w->row[i][j].w;
            m[j] = w->row[i][j].m;
        }
        image_normal(p, i, &z, weight, m, k);
        scatter_square(w, k, i);
        for (int j = 0; j < CELL_ROWS; j++)
            m[j] = -m[j];
        image_transpose(p, i, &z, m, b);
        scatter(w, b, i, w->slope);
    }
    band_factor(w->band, w->width, 4 * w->free);
}

/* What the products of a row should change by; a second step takes the first one's product into account. */
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

/* One direction; how far slacks and multipliers may go along it. */
static void direction(struct interior *w, double mu, bool again, double *primal, double *dual)
{
    const struct problem *p = w->problem;

    memcpy(w->right, w->slope, w->free * sizeof *w->right);
    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double v[CELL_ROWS];
        double b[IMAGE_UNKNOWNS] = {0};
        struct image image;

        gather(w, w->z, i, x);
        const struct rows_at z = image_of(p, i, x, &image);

        for (int j = 0; j < CELL_ROWS; j++) {
            double with_s;
            double with_t;

            targets(&w->row[i][j], mu, again, &with_s, &with_t);
            v[j] = -w->row[i][j].w * asked(&w->row[i][j], with_s, with_t);
        }
        image_transpose(p, i, &z, v, b);
        scatter(w, b, i, w->right);
    }
    memcpy(w->dz, w->right, w->free * sizeof *w->dz);
    band_solve(w->band, w->width, 4 * w->free, &w->dz[0][0]);
    *primal = 1;
    *dual = 1;
    for (size_t i = 0; i < p->cells; i++) {
        double x[IMAGE_UNKNOWNS];
        double dx[IMAGE_UNKNOWNS];
        double product[CELL_ROWS];
        struct image image;
        struct image step;

        gather(w, w->z, i, x);
        gather(w, w->dz, i, dx);
        const struct rows_at z = image_of(p, i, x, &image);
        const struct rows_at dz = image_of(p, i, dx, &step);

        rows_product(p, &p->cell[i], &z, &dz, product);
        for (int j = 0; j < CELL_ROWS; j++) {
            struct row *row = &w->row[i][j];
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
}

/* The mean product after a step. */
static double mean_after(const struct interior *w, double primal, double dual)
{
    double sum = 0;

    for (size_t i = 0; i < w->problem->cells; i++) {
        for (int j = 0; j < CELL_ROWS; j++) {
            const struct row *row = &w->row[i][j];
            const double m = row->m + dual * row->dm;

            sum += (row->s + primal * row->ds) * m;
            sum += (row->t + primal * row->dt) * (PRICE - m);
        }
    }
    return sum / (2.0 * CELL_ROWS * (double)w->problem->cells);
}

static void advance(struct interior *w, double primal, double dual)
{
    for (size_t i = 0; i < w->problem->cells; i++) {
        for (int j = 0; j < CELL_ROWS; j++) {
            struct row *row = &w->row[i][j];

            row->s += primal * row->ds;
            row->t += primal * row->dt;
            row->m += dual * row->dm;
        }
    }
    for (size_t f = 0; f < w->free; f++) {
        for (int i = 0; i < 4; i++)
            w->z[f][i] += primal * w->dz[f][i];
    }
}

/* Numbers too far apart for the matrix leave no direction. */
static bool has_direction(const struct interior *w)
{
    double sum = 0;

    for (size_t f = 0; f < w->free; f++) {
        for (int i = 0; i < 4; i++)
            sum += maths_abs(w->dz[f][i]);
    }
    return maths_is_finite(sum);
}

/* Mehrotra's centring: the cube of what a step straight to the end would leave. False: it cannot be taken. */
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
    w->ends = trail_ends(p->modes);
    w->free = p->cells - w->ends;
    w->width = problem_unknowns(p);
    for (size_t i = 0; i < p->cells; i++)
        radius_mm = maths_min(radius_mm, p->cell[i].ball[0].radius_mm);
    w->move_square = MOVE_SQUARE / (radius_mm * radius_mm);
    start(w);
    for (int i = 0; i < ITERATIONS_MAX; i++) {
        const double mu = take_values(w);

        if (mu * 2 * CELL_ROWS < GAP_END || !iterate(w, mu))
            break;
    }
    return w->z;
}

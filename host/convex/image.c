#include "convex/image.h"

#include <string.h>

/* An unknown, and how a control point's coordinate goes with it. */
struct term {
    size_t unknown;
    double weight;
};

#define TERMS_MAX (2 * PROBLEM_REACH_MAX)

/*
 * Coordinate `which` of point j as a sum of terms; their number is returned. Time is what it is at
 * the point itself.
 */
static size_t terms_of(const struct problem *p, const struct problem_side *side, size_t j,
                       size_t which, struct term *term)
{
    const size_t reach = 1 + 2 * (size_t)p->modes;
    const size_t each = problem_each(p);

    if (which == 3) {
        *term = (struct term){each * (j + p->modes) + 3, 1};
        return 1;
    }
    for (size_t k = 0; k < reach; k++) {
        term[2 * k] = (struct term){each * (j + k) + which, side->by_curve[j][which][k]};
        term[2 * k + 1] = (struct term){each * (j + k) + 3, side->by_time[j][which][k]};
    }
    return 2 * reach;
}

static void map_side(const struct problem *p, const struct problem_side *side, const double *x,
                     double z[CELL_UNKNOWNS])
{
    for (size_t a = 0; a < CELL_UNKNOWNS; a++) {
        struct term term[TERMS_MAX];
        const size_t terms = terms_of(p, side, a / 4, a % 4, term);

        z[a] = 0;
        for (size_t i = 0; i < terms; i++)
            z[a] += term[i].weight * x[term[i].unknown];
    }
}

/* The unknown of coordinate `which` of point j of a stray tool. */
static size_t stray_unknown(const struct problem *p, size_t s, size_t j, size_t which)
{
    return problem_each(p) * (j + 2 * (size_t)p->modes) + 4 + 3 * s + which;
}

static void gather_stray(const struct problem *p, size_t s, const double *x,
                         double z[CELL_UNKNOWNS])
{
    for (size_t a = 0; a < CELL_UNKNOWNS; a++)
        z[a] = a % 4 < 3 ? x[stray_unknown(p, s, a / 4, a % 4)] : 0;
}

struct rows_at image_of(const struct problem *p, size_t cell, const double *x, struct image *image)
{
    if (p->modes == 0)
        return (struct rows_at){x, x, {NULL}};
    map_side(p, &p->map[cell].motor, x, image->motor);
    map_side(p, &p->map[cell].tool, x, image->tool);
    for (size_t s = 0; s < p->strays; s++)
        gather_stray(p, s, x, image->stray[s]);
    return (struct rows_at){image->motor, image->tool, {image->stray[0], image->stray[1]}};
}

/* b += M^T v */
static void transpose_side(const struct problem *p, const struct problem_side *side,
                           const double v[CELL_UNKNOWNS], double *b)
{
    for (size_t a = 0; a < CELL_UNKNOWNS; a++) {
        struct term term[TERMS_MAX];
        const size_t terms = terms_of(p, side, a / 4, a % 4, term);

        for (size_t i = 0; i < terms; i++)
            b[term[i].unknown] += term[i].weight * v[a];
    }
}

void image_transpose(const struct problem *p, size_t cell, const struct rows_at *z,
                     const double v[ROWS_MAX], double *b)
{
    struct image sum = {{0}, {0}, {{0}}};

    if (p->modes == 0) {
        rows_transpose(p, cell, z, v, &(struct rows_sum){b, b, {NULL}});
        return;
    }
    rows_transpose(p, cell, z, v,
                   &(struct rows_sum){sum.motor, sum.tool, {sum.stray[0], sum.stray[1]}});
    transpose_side(p, &p->map[cell].motor, sum.motor, b);
    transpose_side(p, &p->map[cell].tool, sum.tool, b);
    for (size_t s = 0; s < p->strays; s++) {
        for (size_t a = 0; a < CELL_UNKNOWNS; a++) {
            if (a % 4 < 3)
                b[stray_unknown(p, s, a / 4, a % 4)] += sum.stray[s][a];
        }
    }
}

/* Both triangles, from the lower one. */
static void mirror(double (*k)[CELL_UNKNOWNS])
{
    for (size_t i = 0; i < CELL_UNKNOWNS; i++) {
        for (size_t j = 0; j < i; j++)
            k[j][i] = k[i][j];
    }
}

/* row of M^T a: the unknowns' part of one row of a side's square */
static void map_row(const struct problem *p, const struct problem_side *side,
                    const double row[CELL_UNKNOWNS], double *to)
{
    memset(to, 0, problem_unknowns(p) * sizeof *to);
    transpose_side(p, side, row, to);
}

/* The lower triangle of k += M^T square M */
static void square_side(const struct problem *p, const struct problem_side *side,
                        double (*square)[CELL_UNKNOWNS], double *k)
{
    const size_t unknowns = problem_unknowns(p);

    mirror(square);
    for (size_t a = 0; a < CELL_UNKNOWNS; a++) {
        struct term term[TERMS_MAX];
        const size_t terms = terms_of(p, side, a / 4, a % 4, term);
        double row[IMAGE_UNKNOWNS];

        map_row(p, side, square[a], row);
        for (size_t i = 0; i < terms; i++) {
            double *to = k + term[i].unknown * unknowns;

            for (size_t j = 0; j <= term[i].unknown; j++)
                to[j] += term[i].weight * row[j];
        }
    }
}

static void square_stray(const struct problem *p, size_t s, double (*square)[CELL_UNKNOWNS],
                         double *k)
{
    const size_t unknowns = problem_unknowns(p);

    for (size_t a = 0; a < CELL_UNKNOWNS; a++) {
        for (size_t b = 0; b <= a; b++) {
            if (a % 4 < 3 && b % 4 < 3)
                k[stray_unknown(p, s, a / 4, a % 4) * unknowns +
                  stray_unknown(p, s, b / 4, b % 4)] += square[a][b];
        }
    }
}

void image_normal(const struct problem *p, size_t cell, const struct rows_at *z,
                  const double w[ROWS_MAX], const double m[ROWS_MAX], double *k)
{
    double motor[CELL_UNKNOWNS][CELL_UNKNOWNS] = {{0}};
    double tool[CELL_UNKNOWNS][CELL_UNKNOWNS];
    double stray[PROBLEM_STRAYS][CELL_UNKNOWNS][CELL_UNKNOWNS];

    if (p->modes == 0) {
        rows_normal(p, cell, z, w, m, &(struct rows_square){motor, motor, {NULL}});
        memcpy(k, motor, sizeof motor);
        return;
    }
    memset(tool, 0, sizeof tool);
    memset(stray, 0, sizeof stray);
    memset(k, 0, problem_unknowns(p) * problem_unknowns(p) * sizeof *k);
    rows_normal(p, cell, z, w, m, &(struct rows_square){motor, tool, {stray[0], stray[1]}});
    square_side(p, &p->map[cell].motor, motor, k);
    square_side(p, &p->map[cell].tool, tool, k);
    for (size_t s = 0; s < p->strays; s++)
        square_stray(p, s, stray[s], k);
}

#define SWING_TERMS (3 + 2 * (3 + 2 * PROBLEM_MODES_MAX))

static size_t swing_terms(const struct problem *p, size_t cell, size_t s, size_t axis,
                          struct term *term)
{
    const struct problem_swing *row = &p->stray[cell][s].swing[axis];
    const size_t each = problem_each(p);
    size_t count = 0;

    for (size_t k = 0; k < 3 + 2 * (size_t)p->modes; k++) {
        term[count++] = (struct term){each * k + axis, row->by_curve[k]};
        term[count++] = (struct term){each * k + 3, row->by_time[k]};
    }
    for (size_t k = 0; k < 3; k++)
        term[count++] = (struct term){stray_unknown(p, s, k, axis), row->by_own[k]};
    return count;
}

static void add_swing(const struct term *term, size_t terms, size_t unknowns, const double *x,
                      double weight, double *k, double *b)
{
    double value = 0;

    for (size_t i = 0; i < terms; i++)
        value += term[i].weight * x[term[i].unknown];
    for (size_t i = 0; i < terms; i++) {
        b[term[i].unknown] -= weight * value * term[i].weight;
        for (size_t j = 0; j < terms; j++) {
            if (term[j].unknown <= term[i].unknown)
                k[term[i].unknown * unknowns + term[j].unknown] +=
                    weight * term[i].weight * term[j].weight;
        }
    }
}

void image_swing(const struct problem *p, size_t cell, const double *x, double weight, double *k,
                 double *b)
{
    for (size_t s = 0; s < p->strays; s++) {
        for (size_t axis = 0; axis < 3; axis++) {
            struct term term[SWING_TERMS];
            const size_t terms = swing_terms(p, cell, s, axis, term);

            add_swing(term, terms, problem_unknowns(p), x, weight, k, b);
        }
    }
}

#include "ahead/image.h"

#include <string.h>

/* An unknown, and how a control point's coordinate goes with it. */
struct term {
    size_t unknown;
    double weight;
};

#define TERMS_MAX (2 * MODES_REACH_MAX)

/* Coordinate `which` of point j as a sum of terms; their number is returned. Time is what it is at the point itself. */
static size_t terms_of(const struct problem *p, const struct problem_side *side, size_t j,
                       size_t which, struct term *term)
{
    const size_t reach = 1 + 2 * (size_t)p->modes;

    if (which == 3) {
        *term = (struct term){4 * (j + p->modes) + 3, 1};
        return 1;
    }
    for (size_t k = 0; k < reach; k++) {
        term[2 * k] = (struct term){4 * (j + k) + which, side->by_curve[j][which][k]};
        term[2 * k + 1] = (struct term){4 * (j + k) + 3, side->by_time[j][which][k]};
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

struct rows_at image_of(const struct problem *p, size_t cell, const double *x, struct image *image)
{
    if (p->modes == 0)
        return (struct rows_at){x, x};
    map_side(p, &p->map[cell].motor, x, image->motor);
    map_side(p, &p->map[cell].tool, x, image->tool);
    return (struct rows_at){image->motor, image->tool};
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
                     const double v[CELL_ROWS], double *b)
{
    struct image sum = {{0}, {0}};

    if (p->modes == 0) {
        rows_transpose(p, &p->cell[cell], z, v, &(struct rows_sum){b, b});
        return;
    }
    rows_transpose(p, &p->cell[cell], z, v, &(struct rows_sum){sum.motor, sum.tool});
    transpose_side(p, &p->map[cell].motor, sum.motor, b);
    transpose_side(p, &p->map[cell].tool, sum.tool, b);
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

void image_normal(const struct problem *p, size_t cell, const struct rows_at *z,
                  const double w[CELL_ROWS], const double m[CELL_ROWS], double *k)
{
    const struct problem_cell *c = &p->cell[cell];
    double motor[CELL_UNKNOWNS][CELL_UNKNOWNS] = {{0}};
    double tool[CELL_UNKNOWNS][CELL_UNKNOWNS];

    if (p->modes == 0) {
        rows_normal(p, c, z, w, m, &(struct rows_square){motor, motor});
        memcpy(k, motor, sizeof motor);
        return;
    }
    memset(tool, 0, sizeof tool);
    memset(k, 0, problem_unknowns(p) * problem_unknowns(p) * sizeof *k);
    rows_normal(p, c, z, w, m, &(struct rows_square){motor, tool});
    square_side(p, &p->map[cell].motor, motor, k);
    square_side(p, &p->map[cell].tool, tool, k);
}

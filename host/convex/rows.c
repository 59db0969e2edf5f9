#include "convex/rows.h"

#include "convex/vector.h"

#include <string.h>

/* -LOW <= e <= HIGH: how far one step changes the square of the rate. */
#define TIME_LOW  0.5
#define TIME_HIGH 1.0

/* Weights of the change of the curve in each form; of e in what jerk may be more or less. */
static const double form_weight[FORM_COUNT][4] = {{-1, 1, 0, 0}, {1, -2, 1, 0}, {-1, 3, -3, 1}};
static const double difference_value[4] = {0.5, 0.5, 0, 0};
static const double middle_value[4] = {1.0 / 48, 23.0 / 48, 23.0 / 48, 1.0 / 48};

/* sum_k weight_k z of unknown which of point k */
static double sum_of(const double z[CELL_UNKNOWNS], const double weight[4], int which)
{
    return weight[0] * z[which] + weight[1] * z[4 + which] + weight[2] * z[8 + which] +
           weight[3] * z[12 + which];
}

static double form_of(const struct problem *p, const struct problem_cell *cell, int axis, int form,
                      const double z[CELL_UNKNOWNS])
{
    return p->scale[axis][form] * sum_of(z, form_weight[form], axis) +
           sum_of(z, cell->time[axis][form], 3);
}

/* J / sqrt(y) is about J (1 - e / 2). */
static double room_of(int form, const double z[CELL_UNKNOWNS])
{
    return form == FORM_JERK ? 0.5 * sum_of(z, middle_value, 3) : 0;
}

/* sum_k weight_k d_k */
static void ball_move(const struct problem_ball *ball, const double z[CELL_UNKNOWNS],
                      double move[3])
{
    for (int i = 0; i < 3; i++)
        move[i] = sum_of(z, ball->weight, i);
}

/* v = N v */
static void ball_project(const struct problem_ball *ball, double v[3])
{
    const double along = vector_dot(v, ball->along);

    for (int i = 0; i < 3; i++)
        v[i] -= along * ball->along[i];
}

/* Where it is from the ball's centre, in radii. */
static void ball_place(const struct problem_ball *ball, const double z[CELL_UNKNOWNS],
                       double place[3])
{
    ball_move(ball, z, place);
    for (int i = 0; i < 3; i++)
        place[i] += ball->offset[i];
    ball_project(ball, place);
    for (int i = 0; i < 3; i++)
        place[i] /= ball->radius_mm;
}

/* The velocity's change over the feed. */
static void feed_change(const struct problem_cell *cell, const double z[CELL_UNKNOWNS],
                        double change[3])
{
    const double time = 0.5 * sum_of(z, difference_value, 3);

    for (int i = 0; i < 3; i++)
        change[i] =
            cell->feed_scale * sum_of(z, form_weight[FORM_VELOCITY], i) + cell->feed_now[i] * time;
}

/* The velocity, over the feed. */
static void feed_of(const struct problem_cell *cell, const double z[CELL_UNKNOWNS],
                    double velocity[3])
{
    feed_change(cell, z, velocity);
    for (int i = 0; i < 3; i++)
        velocity[i] += cell->feed_now[i];
}

static double ball_value(const struct problem_ball *ball, const double z[CELL_UNKNOWNS])
{
    double place[3];

    if (!(ball->radius_mm > 0))
        return 1;
    ball_place(ball, z, place);
    return 0.5 * (1 - vector_dot(place, place));
}

void rows_value(const struct problem *p, size_t at, const struct rows_at *z, double c[ROWS_MAX])
{
    const struct problem_cell *cell = &p->cell[at];
    double *row = c;

    for (int axis = 0; axis < 3; axis++) {
        for (int form = 0; form < FORM_COUNT; form++) {
            const double value = cell->now[axis][form] + form_of(p, cell, axis, form, z->motor);
            const double limit = 1 - room_of(form, z->motor);

            *row++ = limit - value;
            *row++ = limit + value;
        }
    }
    *row = 1;
    if (cell->feed_scale > 0) {
        double velocity[3];

        feed_of(cell, z->motor, velocity);
        *row = 0.5 * (1 - vector_dot(velocity, velocity));
    }
    row++;
    for (int i = 0; i < CELL_BALLS; i++)
        *row++ = ball_value(&cell->ball[i], z->tool);
    *row++ = TIME_HIGH - z->motor[15];
    *row++ = TIME_LOW + z->motor[15];
    for (size_t s = 0; s < p->strays; s++) {
        for (int i = 0; i < STRAY_BALLS; i++)
            *row++ = ball_value(&p->stray[at][s].ball[i], z->stray[s]);
    }
}

static double ball_product(const struct problem_ball *ball, const double z[CELL_UNKNOWNS],
                           const double dz[CELL_UNKNOWNS])
{
    double place[3];
    double move[3];

    if (!(ball->radius_mm > 0))
        return 0;
    ball_place(ball, z, place);
    ball_move(ball, dz, move);
    return vector_dot(place, move) / ball->radius_mm;
}

void rows_product(const struct problem *p, size_t at, const struct rows_at *z,
                  const struct rows_at *dz, double product[ROWS_MAX])
{
    const struct problem_cell *cell = &p->cell[at];
    double *row = product;

    for (int axis = 0; axis < 3; axis++) {
        for (int form = 0; form < FORM_COUNT; form++) {
            const double value = form_of(p, cell, axis, form, dz->motor);
            const double room = room_of(form, dz->motor);

            *row++ = room + value;
            *row++ = room - value;
        }
    }
    *row = 0;
    if (cell->feed_scale > 0) {
        double velocity[3];
        double change[3];

        feed_of(cell, z->motor, velocity);
        feed_change(cell, dz->motor, change);
        *row = vector_dot(velocity, change);
    }
    row++;
    for (int i = 0; i < CELL_BALLS; i++)
        *row++ = ball_product(&cell->ball[i], z->tool, dz->tool);
    *row++ = dz->motor[15];
    *row++ = -dz->motor[15];
    for (size_t s = 0; s < p->strays; s++) {
        for (int i = 0; i < STRAY_BALLS; i++)
            *row++ = ball_product(&p->stray[at][s].ball[i], z->stray[s], dz->stray[s]);
    }
}

static void add_ball(const struct problem_ball *ball, const double z[CELL_UNKNOWNS], double v,
                     double b[CELL_UNKNOWNS])
{
    double place[3];

    if (!(ball->radius_mm > 0))
        return;
    ball_place(ball, z, place);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 3; i++)
            b[4 * k + i] += ball->weight[k] * place[i] * v / ball->radius_mm;
    }
}

static void add_velocity(const struct problem_cell *cell, const double z[CELL_UNKNOWNS], double v,
                         double b[CELL_UNKNOWNS])
{
    double velocity[3];

    feed_of(cell, z, velocity);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < 3; i++)
            b[4 * k + i] += v * cell->feed_scale * form_weight[FORM_VELOCITY][k] * velocity[i];
        b[4 * k + 3] += v * 0.5 * difference_value[k] * vector_dot(velocity, cell->feed_now);
    }
}

void rows_transpose(const struct problem *p, size_t at, const struct rows_at *z,
                    const double v[ROWS_MAX], const struct rows_sum *b)
{
    const struct problem_cell *cell = &p->cell[at];
    const double *row = v;

    for (int axis = 0; axis < 3; axis++) {
        for (int form = 0; form < FORM_COUNT; form++, row += 2) {
            const double value = row[0] - row[1];
            const double room = form == FORM_JERK ? 0.5 * (row[0] + row[1]) : 0;

            for (int k = 0; k < 4; k++) {
                b->motor[4 * k + axis] += value * p->scale[axis][form] * form_weight[form][k];
                b->motor[4 * k + 3] += value * cell->time[axis][form][k] + room * middle_value[k];
            }
        }
    }
    if (cell->feed_scale > 0)
        add_velocity(cell, z->motor, *row, b->motor);
    row++;
    for (int i = 0; i < CELL_BALLS; i++)
        add_ball(&cell->ball[i], z->tool, *row++, b->tool);
    b->motor[15] += row[0] - row[1];
    row += 2;
    for (size_t s = 0; s < p->strays; s++) {
        for (int i = 0; i < STRAY_BALLS; i++)
            add_ball(&p->stray[at][s].ball[i], z->stray[s], *row++, b->stray[s]);
    }
}

/* k += w g g^T of one axis's row: g is a of the axis's unknowns and b of e's. */
static void add_square(double k[CELL_UNKNOWNS][CELL_UNKNOWNS], int axis, double w,
                       const double a[4], const double b[4])
{
    for (int i = 0; i < 4; i++) {
        const double wa = w * a[i];
        const double wb = w * b[i];

        for (int j = 0; j <= i; j++) {
            k[4 * i + axis][4 * j + axis] += wa * a[j];
            k[4 * i + 3][4 * j + 3] += wb * b[j];
            k[4 * i + 3][4 * j + axis] += wb * a[j];
        }
        for (int j = 0; j < i; j++)
            k[4 * i + axis][4 * j + 3] += wa * b[j];
    }
}

static void add_axis(const struct problem *p, const struct problem_cell *cell, int axis,
                     const double *w, double k[CELL_UNKNOWNS][CELL_UNKNOWNS])
{
    for (int form = 0; form < FORM_COUNT; form++, w += 2) {
        double a[4];
        double high[4];
        double low[4];

        for (int i = 0; i < 4; i++) {
            const double room = form == FORM_JERK ? 0.5 * middle_value[i] : 0;

            a[i] = p->scale[axis][form] * form_weight[form][i];
            high[i] = cell->time[axis][form][i] + room;
            low[i] = cell->time[axis][form][i] - room;
        }
        if (form == FORM_JERK) {
            add_square(k, axis, w[0], a, high);
            add_square(k, axis, w[1], a, low);
        } else {
            add_square(k, axis, w[0] + w[1], a, high);
        }
    }
}

/* k += w (V^T v)(V^T v)^T + m V^T V, V the velocity's derivative by the unknowns */
static void add_feed(const struct problem_cell *cell, const double z[CELL_UNKNOWNS], double w,
                     double m, double k[CELL_UNKNOWNS][CELL_UNKNOWNS])
{
    double g[CELL_UNKNOWNS] = {0};

    add_velocity(cell, z, 1, g);
    for (int i = 0; i < CELL_UNKNOWNS; i++) {
        for (int j = 0; j <= i; j++)
            k[i][j] += w * g[i] * g[j];
    }
    for (int axis = 0; axis < 3; axis++) {
        double along[4];
        double time[4];

        for (int i = 0; i < 4; i++) {
            along[i] = cell->feed_scale * form_weight[FORM_VELOCITY][i];
            time[i] = 0.5 * difference_value[i] * cell->feed_now[axis];
        }
        add_square(k, axis, m, along, time);
    }
}

/* (b b^T) x (w place place^T + m N) / radius^2 */
static void add_ball_square(const struct problem_ball *ball, const double z[CELL_UNKNOWNS],
                            double w, double m, double k[CELL_UNKNOWNS][CELL_UNKNOWNS])
{
    const double square = 1 / (ball->radius_mm * ball->radius_mm);
    double place[3];
    double block[3][3];

    if (!(ball->radius_mm > 0))
        return;
    ball_place(ball, z, place);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            block[i][j] = square * (w * place[i] * place[j] +
                                    m * ((i == j ? 1 : 0) - ball->along[i] * ball->along[j]));
    }
    for (int a = 0; a < 4; a++) {
        for (int b = 0; b <= a; b++) {
            const double part = ball->weight[a] * ball->weight[b];

            for (int i = 0; i < 3; i++) {
                for (int j = 0; j < 3; j++)
                    k[4 * a + i][4 * b + j] += part * block[i][j];
            }
        }
    }
}

void rows_normal(const struct problem *p, size_t at, const struct rows_at *z,
                 const double w[ROWS_MAX], const double m[ROWS_MAX], const struct rows_square *k)
{
    const struct problem_cell *cell = &p->cell[at];
    for (int axis = 0; axis < 3; axis++)
        add_axis(p, cell, axis, w + ROWS_AXIS + (size_t)2 * FORM_COUNT * (size_t)axis, k->motor);
    if (cell->feed_scale > 0)
        add_feed(cell, z->motor, w[ROWS_FEED], m[ROWS_FEED], k->motor);
    for (int i = 0; i < CELL_BALLS; i++)
        add_ball_square(&cell->ball[i], z->tool, w[ROWS_BALL + i], m[ROWS_BALL + i], k->tool);
    k->motor[15][15] += w[ROWS_TIME] + w[ROWS_TIME + 1];
    for (size_t s = 0; s < p->strays; s++) {
        for (size_t i = 0; i < STRAY_BALLS; i++) {
            const size_t row = CELL_ROWS + s * STRAY_BALLS + i;

            add_ball_square(&p->stray[at][s].ball[i], z->stray[s], w[row], m[row], k->stray[s]);
        }
    }
}

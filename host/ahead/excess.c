#include "ahead/excess.h"

#include "convex/vector.h"

/* What rounding and the solver's last step may leave above the limits the optimiser is given. */
#define LIMIT_SLACK 3e-4

/* Junctions may be farther off than their ball's radius by the solver's last step. */
#define JUNCTION_PART 0.99

/* Likewise stray tools. */
#define STRAY_PART 0.99

/* Places of an interval at which the distance is measured. */
#define PARTS 12

/* Differences of control points over their limits. */
static double limits_of(const struct ahead_limits *l, double (*c)[3])
{
    const double h = l->step_s;
    double most = 0;

    for (int i = 0; i < 3; i++) {
        const double first = c[1][i] - c[0][i];
        const double second = c[2][i] - 2 * c[1][i] + c[0][i];
        const double third = c[3][i] - 3 * c[2][i] + 3 * c[1][i] - c[0][i];

        most = maths_max(most, maths_abs(first) / (l->velocity_mm_s[i] * h));
        most = maths_max(most, maths_abs(second) / (l->acceleration_mm_s2[i] * h * h));
        most = maths_max(most, maths_abs(third) / (l->jerk_mm_s3[i] * h * h * h));
    }
    return most / (1 + LIMIT_SLACK);
}

static double feed_of(const struct ahead_limits *l, double (*c)[3], double feed_mm_s)
{
    double way[3];

    vector_from_to(c[0], c[1], way);
    return vector_length(way) / (feed_mm_s * l->step_s * (1 + LIMIT_SLACK));
}

/* The distance from the path at some places of an interval, over the tolerance. */
static double distance_of(const struct window *w, size_t interval, size_t *hint)
{
    const struct trail *t = w->trail;
    const double from_mm = t->place_mm[2 * interval];
    const double way_mm = t->place_mm[2 * interval + 2] - from_mm;
    double most = 0;

    for (int i = 0; i < PARTS; i++) {
        const double part = (double)i / PARTS;
        struct ahead_closest closest;
        double x[3];

        trail_at(t, t->tool, (double)interval + part, x);
        ahead_path_closest(w->path, x, from_mm + part * way_mm, EXCESS_REACH_MM, *hint, &closest);
        *hint = closest.element;
        most =
            maths_max(most, closest.distance_mm / w->path->element[closest.element].tolerance_mm);
    }
    return most / EXCESS_TOLERANCE_PART;
}

/* Junctions that the curve has to come close to, as the problem has them. */
static double junction_of(const struct problem_cell *cell)
{
    double most = 0;

    for (int i = 2; i < CELL_BALLS; i++) {
        if (cell->ball[i].radius_mm > 0)
            most = maths_max(most, vector_length(cell->ball[i].offset) / cell->ball[i].radius_mm);
    }
    return most * JUNCTION_PART;
}

/* Stray tools at two half knots; that they bend away between them is in the radius. */
static double strays_of(const struct problem *p, size_t i)
{
    double most = 0;

    for (size_t s = 0; s < p->strays; s++) {
        for (int k = 0; k < STRAY_BALLS; k++) {
            const struct problem_ball *ball = &p->stray[i][s].ball[k];

            if (ball->radius_mm > 0)
                most = maths_max(most, vector_length(ball->offset) / ball->radius_mm);
        }
    }
    return most * STRAY_PART;
}

double excess_measure(const struct window *w, const struct problem *p)
{
    size_t hint = ahead_path_find(w->path, w->trail->place_mm[2 * w->first], 0);
    double most = 0;

    for (size_t i = 0; i < p->cells; i++) {
        double(*control)[3] = w->trail->motor + w->first + i;
        const size_t at = ahead_path_find(w->path, w->trail->place_mm[2 * (w->first + i)], hint);
        const double feed_mm_s = w->path->element[at].feed_mm_s;
        double here = distance_of(w, w->first + i, &hint);

        here = maths_max(here, limits_of(w->limits, control));
        here = maths_max(here, feed_of(w->limits, control, feed_mm_s));
        here = maths_max(here, junction_of(&p->cell[i]));
        here = maths_max(here, strays_of(p, i));
        w->trail->beyond[w->first + i] = here;
        most = maths_max(most, here);
    }
    return most;
}

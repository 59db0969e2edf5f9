#include "circle/figures.h"

#include "base/maths.h"

/*
 * Around a reversal, in degrees: the deviation is taken for straight between these two, and for the
 * turning's up to the first.
 */
#define NEAR_DEG 10.0
#define FAR_DEG  15.0

/* 1, cos, sin of an angle. */
static void harmonics(double angle_rad, double h[3])
{
    h[0] = 1;
    takt_maths_sincos(angle_rad, &h[2], &h[1]);
}

/* m x = b, m symmetric and positive, by elimination. */
static void solve(double m[3][3], double b[3], double x[3])
{
    for (unsigned k = 0; k < 3; k++) {
        for (unsigned i = k + 1; i < 3; i++) {
            const double part = m[i][k] / m[k][k];

            for (unsigned j = k; j < 3; j++)
                m[i][j] -= part * m[k][j];
            b[i] -= part * b[k];
        }
    }
    for (unsigned i = 3; i-- > 0;) {
        x[i] = b[i];
        for (unsigned j = i + 1; j < 3; j++)
            x[i] -= m[i][j] * x[j];
        x[i] /= m[i][i];
    }
}

static void add_to_sums(const struct circle_turn *turn, double m[3][3], double b[3])
{
    for (size_t k = 0; k < turn->count; k++) {
        double h[3];

        harmonics(turn->place[k].angle_rad, h);
        for (unsigned i = 0; i < 3; i++) {
            for (unsigned j = 0; j < 3; j++)
                m[i][j] += h[i] * h[j];
            b[i] += h[i] * turn->place[k].out_mm;
        }
    }
}

/* Deviations are small beside the radius: out = r + x cos + y sin, least squares. */
static void fit(const struct circle_turn *const turn[], unsigned turns, struct circle_figures *f)
{
    double m[3][3] = {{0}}, b[3] = {0}, x[3];

    for (unsigned t = 0; t < turns; t++)
        add_to_sums(turn[t], m, b);
    if (m[0][0] < 3)
        return;
    solve(m, b, x);
    f->radius_out_mm = x[0];
    f->centre_mm[0] = x[1];
    f->centre_mm[1] = x[2];
}

/* How far outside of the circle of least squares. */
static double beyond(const struct circle_figures *f, const struct circle_place *place)
{
    double h[3];

    harmonics(place->angle_rad, h);
    return place->out_mm - f->radius_out_mm - f->centre_mm[0] * h[1] - f->centre_mm[1] * h[2];
}

static void find_extremes(const struct circle_turn *const turn[], unsigned turns,
                          struct circle_figures *f)
{
    double out = -MATHS_INFINITY, in = MATHS_INFINITY;

    f->most_mm = -MATHS_INFINITY;
    f->least_mm = MATHS_INFINITY;
    for (unsigned t = 0; t < turns; t++) {
        for (size_t k = 0; k < turn[t]->count; k++) {
            const double off = beyond(f, &turn[t]->place[k]);

            out = maths_max(out, off);
            in = maths_min(in, off);
            f->most_mm = maths_max(f->most_mm, turn[t]->place[k].out_mm);
            f->least_mm = maths_min(f->least_mm, turn[t]->place[k].out_mm);
        }
    }
    f->deviation_mm = out - in;
}

/* From the quadrant, -180 ... 180. */
static double degrees_behind(const struct circle_place *place, unsigned quadrant)
{
    const double turns = place->angle_rad / MATHS_TWO_PI - quadrant / (double)CIRCLE_QUADRANTS;

    return 360.0 * (turns - takt_maths_round(turns));
}

static double mean_between(const struct circle_turn *turn, const struct circle_figures *f,
                           unsigned quadrant, double from_deg, double to_deg)
{
    double sum = 0, count = 0;

    for (size_t k = 0; k < turn->count; k++) {
        const double at = degrees_behind(&turn->place[k], quadrant);

        if (at >= from_deg && at <= to_deg) {
            sum += beyond(f, &turn->place[k]);
            count++;
        }
    }
    return count > 0 ? sum / count : 0;
}

static struct circle_reversal reversal_at(const struct circle_turn *turn,
                                          const struct circle_figures *f, unsigned quadrant)
{
    const double before = mean_between(turn, f, quadrant, -FAR_DEG, -NEAR_DEG);
    const double after = mean_between(turn, f, quadrant, NEAR_DEG, FAR_DEG);
    struct circle_reversal r = {.step_mm = after - before};

    for (size_t k = 0; k < turn->count; k++) {
        const double off = beyond(f, &turn->place[k]) - (before + after) / 2;

        if (maths_abs(degrees_behind(&turn->place[k], quadrant)) < NEAR_DEG &&
            maths_abs(off) > maths_abs(r.spike_mm))
            r.spike_mm = off;
    }
    return r;
}

void circle_figures_of(const struct circle_turn *const turn[], unsigned turns,
                       struct circle_figures *figures)
{
    size_t count = 0;

    *figures = (struct circle_figures){0};
    for (unsigned t = 0; t < turns; t++)
        count += turn[t]->count;
    if (count == 0)
        return;
    fit(turn, turns, figures);
    find_extremes(turn, turns, figures);
    for (unsigned quadrant = 0; quadrant < CIRCLE_QUADRANTS; quadrant++)
        figures->reversal[quadrant] = reversal_at(turn[0], figures, quadrant);
}

cJSON *circle_figures_json(const struct circle_figures *f)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *centre = cJSON_AddArrayToObject(root, "centre_mm");
    cJSON *reversals = NULL;

    for (unsigned i = 0; i < 2; i++)
        cJSON_AddItemToArray(centre, cJSON_CreateNumber(f->centre_mm[i]));
    cJSON_AddNumberToObject(root, "radius_out_mm", f->radius_out_mm);
    cJSON_AddNumberToObject(root, "deviation_mm", f->deviation_mm);
    cJSON_AddNumberToObject(root, "radial_max_mm", f->most_mm);
    cJSON_AddNumberToObject(root, "radial_min_mm", f->least_mm);
    reversals = cJSON_AddArrayToObject(root, "reversals");
    for (unsigned i = 0; i < CIRCLE_QUADRANTS; i++) {
        cJSON *one = cJSON_CreateObject();

        cJSON_AddNumberToObject(one, "step_mm", f->reversal[i].step_mm);
        cJSON_AddNumberToObject(one, "spike_mm", f->reversal[i].spike_mm);
        cJSON_AddItemToArray(reversals, one);
    }
    return root;
}

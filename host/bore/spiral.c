/*
 * With the parameter phi, base circle r and direction psi at the centre (eq. 6, 11):
 *
 *     x = r [cos(phi + psi) + phi sin(phi + psi) - cos psi]
 *     y = r [sin(phi + psi) - phi cos(phi + psi) - sin psi]
 *
 * At phi = 2 pi n this touches the circle of radius R = 2 pi n r about the origin. The distance
 * from the origin grows with phi:
 *
 *     rho^2 = r^2 [2 + phi^2 - 2 (cos phi + phi sin phi)],     d rho / d phi = r^2 phi (1 - cos phi) / rho
 *
 * and stands still at every whole turn. So plain Newton steps fly off there: each step is kept
 * within the bracket that the signs so far leave, and halves it when it would not shrink the error.
 */
#include "bore/spiral.h"

#include "base/maths.h"

/* Bisection alone would need some 55; Newton's steps are usually 5 to 10. */
#define STEPS_MAX 100

/* Differences of this share of R are rounding. */
#define DISTANCE_SLACK 4e-16

void bore_spiral_set(struct bore_spiral *s, double radius_mm, unsigned turns)
{
    *s = (struct bore_spiral){.radius_mm = radius_mm, .turns = turns};
    s->base_mm = radius_mm / (MATHS_TWO_PI * s->turns);
}

/*
 * For psi = 0, in units of r: x = phi sin phi - 2 sin^2(phi / 2), y = sin phi - phi cos phi.
 * Written so that at small phi, where x = phi^2 / 2 and y = phi^3 / 3, nothing that matters
 * cancels.
 */
static void unit_point(double phi, double point[2])
{
    const double half = takt_maths_sin(0.5 * phi);

    point[0] = phi * takt_maths_sin(phi) - 2.0 * half * half;
    point[1] = takt_maths_sin(phi) - phi * takt_maths_cos(phi);
}

double bore_spiral_distance(double base_mm, double unrolled_rad)
{
    double p[2];

    unit_point(unrolled_rad, p);
    return base_mm * maths_sqrt(p[0] * p[0] + p[1] * p[1]);
}

/* Newton's next phi: the slope is r^2 phi 2 sin^2(phi / 2) / rho. */
static double newton(double base_mm, double phi, double distance_mm, double error_mm)
{
    const double half = takt_maths_sin(0.5 * phi);
    const double slope = base_mm * base_mm * phi * 2.0 * half * half / distance_mm;

    return slope > 0.0 ? phi - error_mm / slope : -1.0;
}

double bore_unrolled(double base_mm, double turns, double distance_mm)
{
    double low = 0.0;
    double high = MATHS_TWO_PI * turns;
    double phi = 0.5 * high;
    double last = MATHS_INFINITY;

    if (distance_mm <= 0.0) {
        return 0.0;
    }
    for (int i = 0; i < STEPS_MAX; i++) {
        const double at_mm = bore_spiral_distance(base_mm, phi);
        const double error_mm = at_mm - distance_mm;

        if (maths_abs(error_mm) <= DISTANCE_SLACK * distance_mm || low == high) {
            break;
        }
        if (error_mm > 0.0) {
            high = phi;
        } else {
            low = phi;
        }
        const double next = newton(base_mm, phi, at_mm, error_mm);
        const bool good = next > low && next < high && maths_abs(error_mm) <= 0.5 * last;

        last = maths_abs(error_mm);
        phi = good ? next : 0.5 * (low + high);
    }
    return phi;
}

/*
 * psi turns the curve's point at phi0 onto the start: the difference of both directions. The
 * source's arccos (10) would lose its sign.
 */
void bore_spiral_begin_at(struct bore_spiral *s, const double start_mm[2])
{
    const double distance_mm = maths_sqrt(start_mm[0] * start_mm[0] + start_mm[1] * start_mm[1]);
    double p[2];

    s->start_rad = bore_unrolled(s->base_mm, s->turns, distance_mm);
    if (distance_mm > 0.0) {
        unit_point(s->start_rad, p);
        s->turned_rad = takt_maths_atan2(start_mm[1], start_mm[0]) - takt_maths_atan2(p[1], p[0]);
    }
}

/* Radius of curvature r phi. */
void bore_spiral_begin_radius(struct bore_spiral *s, double radius_start_mm)
{
    s->start_rad = radius_start_mm / s->base_mm;
}

/* phi0 = sqrt((2 pi n)^2 - 2 L / r) */
void bore_spiral_begin_length(struct bore_spiral *s, double length_mm)
{
    const double end = MATHS_TWO_PI * s->turns;

    s->start_rad = maths_sqrt(maths_max(0.0, end * end - 2.0 * length_mm / s->base_mm));
}

void bore_spiral_point(const struct bore_spiral *s, double unrolled_rad, double point_mm[2])
{
    double p[2];
    double sine;
    double cosine;

    unit_point(unrolled_rad, p);
    takt_maths_sincos(s->turned_rad, &sine, &cosine);
    point_mm[0] = s->base_mm * (p[0] * cosine - p[1] * sine);
    point_mm[1] = s->base_mm * (p[0] * sine + p[1] * cosine);
}

/* L = (r / 2) ((2 pi n)^2 - phi0^2) */
double bore_spiral_length(const struct bore_spiral *s)
{
    const double end = MATHS_TWO_PI * s->turns;

    return 0.5 * s->base_mm * (end - s->start_rad) * (end + s->start_rad);
}

void bore_spiral_base_centre(const struct bore_spiral *s, double centre_mm[2])
{
    double sine;
    double cosine;

    takt_maths_sincos(s->turned_rad, &sine, &cosine);
    centre_mm[0] = -s->base_mm * cosine;
    centre_mm[1] = -s->base_mm * sine;
}

void bore_spiral_form(const struct bore_spiral *s, struct bore_form *form)
{
    form->length_mm = bore_spiral_length(s);
    bore_spiral_point(s, s->start_rad, form->start_mm);
    form->heading_rad = s->start_rad + s->turned_rad;
    form->radius_start_mm = s->base_mm * s->start_rad;
    form->radius_end_mm = s->radius_mm;
}

/* r = (R_end^2 - R_start^2) / (2 L) */
double bore_form_base(const struct bore_form *form)
{
    return (form->radius_end_mm - form->radius_start_mm) *
           (form->radius_end_mm + form->radius_start_mm) / (2.0 * form->length_mm);
}

double bore_form_unrolled(const struct bore_form *form)
{
    return form->radius_start_mm / bore_form_base(form);
}

#include "program/involute.h"

#include "base/assert.h"
#include "base/maths.h"
#include "program/circular.h"
#include "program/coordinates.h"
#include "program/emit.h"
#include "program/report.h"
#include "program/words.h"

/* An end may be inside the base circle by this share of its radius at most: never at the centre. */
#define INSIDE_MAX_RATIO 0.5

/* Fewer than the room geometry can do, so that what compensation makes of it can be run too. */
#define TURNS_MAX (0.5 * CURVE_UNROLLED_MAX_RAD / MATHS_TWO_PI)

/*
 * Ends whose distances from the centre differ by less, or by less than this share, are equally far.
 */
#define CLOSED_MM    1e-6
#define CLOSED_RATIO 1e-9

/* Relative to the centre. */
struct polar {
    double radius_mm, angle_rad;
};

static struct polar polar_of(const struct point *point, enum axis first, enum axis second,
                             const double centre_mm[2])
{
    const double x = point->at[first] - centre_mm[0];
    const double y = point->at[second] - centre_mm[1];

    return (struct polar){maths_sqrt(x * x + y * y), takt_maths_atan2(y, x)};
}

/* inv = phi - atan phi, phi = sqrt((d/r)^2 - 1); 0 inside the base circle. */
static double unrolled_rad(double distance_mm, double radius_mm)
{
    const double ratio = distance_mm / radius_mm;

    TAKT_ASSERT(distance_mm >= 0.0 && radius_mm > 0.0);
    if (ratio <= 1.0) {
        return 0.0;
    }
    const double phi = maths_sqrt((ratio - 1.0) * (ratio + 1.0));

    return phi - takt_maths_atan2(phi, 1.0);
}

/* Distance of the end from the involute through the start, between neighbouring turns at most. */
static double deviation_mm(const struct polar *start, const struct polar *end, double radius_mm,
                           bool clockwise)
{
    const double needed = maths_abs(unrolled_rad(end->radius_mm, radius_mm) -
                                    unrolled_rad(start->radius_mm, radius_mm));
    const double turned = (end->angle_rad - start->angle_rad) * (clockwise ? -1.0 : 1.0);
    const double off = turned - needed;

    return radius_mm * maths_abs(off - MATHS_TWO_PI * takt_maths_round(off / MATHS_TWO_PI));
}

static bool check_ends(struct program *p, const struct move *m, const struct polar *start,
                       const struct polar *end)
{
    const double slack_mm = takt_circular_slack_mm(p);
    const double radius_mm = m->base_radius_mm;
    const double inside_mm = radius_mm - maths_min(slack_mm, INSIDE_MAX_RATIO * radius_mm);

    if (start->radius_mm < inside_mm) {
        return takt_report_error_code(p, TAKT_ERROR_INVOLUTE_START, STEP_MOTION,
                                      radius_mm - start->radius_mm);
    }
    if (end->radius_mm < inside_mm) {
        return takt_report_error_code(p, TAKT_ERROR_INVOLUTE_END, STEP_MOTION,
                                      radius_mm - end->radius_mm);
    }
    const double far_mm = maths_max(start->radius_mm, end->radius_mm);

    if (maths_abs(end->radius_mm - start->radius_mm) <=
        maths_max(CLOSED_MM, CLOSED_RATIO * far_mm)) {
        return takt_report_error_code(p, TAKT_ERROR_INVOLUTE_CLOSED, STEP_MOTION, 0.0);
    }
    if (far_mm <= radius_mm) {
        return takt_report_error_code(p, TAKT_ERROR_INVOLUTE_START, STEP_MOTION,
                                      radius_mm - start->radius_mm);
    }
    const double turns = far_mm / radius_mm / MATHS_TWO_PI;

    if (turns > TURNS_MAX) {
        return takt_report_error_letter(p, TAKT_ERROR_INVOLUTE_TURNS, 'r', takt_maths_floor(turns));
    }
    const double off_mm = deviation_mm(start, end, radius_mm, m->kind == MOVE_INVOLUTE_CW);

    return off_mm <= slack_mm ||
           takt_report_error_code(p, TAKT_ERROR_INVOLUTE_END, STEP_MOTION, off_mm);
}

static bool check_words(struct program *p, const struct program_code *code, enum axis first,
                        enum axis second)
{
    if (!takt_circular_check_plane(p, first, second)) {
        return false;
    }
    if ((p->words.given & LETTERS_CENTRE) == 0) {
        return takt_report_missing(p, code->step, (char)('i' + (int)first));
    }
    if (!words_has(p, 'r')) {
        return takt_report_missing(p, code->step, 'r');
    }
    return words_value(p, 'r') > 0.0 ||
           takt_report_error_letter(p, TAKT_ERROR_WORD_NOT_POSITIVE, 'r', words_value(p, 'r'));
}

bool takt_involute_move(struct program *p, const struct program_code *code)
{
    enum axis first;
    enum axis second;
    struct point end;
    struct move m;

    takt_plane_axes(p->modes.plane, &first, &second);
    if (!check_words(p, code, first, second)) {
        return false;
    }
    takt_coordinates_end(p, &end);
    takt_emit_prepare(p, (enum move_kind)code->argument, &end, &m);
    m.plane = p->modes.plane;
    m.base_radius_mm = words_value(p, 'r') * p->modes.unit_mm;
    if (!takt_circular_centre(p, first, second, m.centre_mm)) {
        return false;
    }
    const struct polar from = polar_of(&p->modes.at, first, second, m.centre_mm);
    const struct polar to = polar_of(&end, first, second, m.centre_mm);

    if (!check_ends(p, &m, &from, &to)) {
        return false;
    }
    p->modes.motion = code;
    return takt_emit_motion(p, &m);
}

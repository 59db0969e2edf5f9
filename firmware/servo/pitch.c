#include "servo/pitch.h"

#include "base/assert.h"
#include "base/maths.h"
#include "correction/edge.h"
#include "correction/spline.h"

/* A point of a double's last bit nearer with every one, at PITCH_STEEPEST_RATIO. */
#define INVERSE_STEPS 16

/*
 * In a piece of unit length the slope differs from that of its chord by |M| / 2 at most, M the
 * greater second derivative at its ends; a table that is read 0.2 steps beyond its end (edge.h) by
 * another 0.2 1.2 |M|.
 */
static bool is_flat(const struct pitch *pitch)
{
    const double most_mm = PITCH_STEEPEST_RATIO / maths_abs(pitch->steps_per_mm);
    for (unsigned i = 0; i + 1 < pitch->points; i++) {
        const double chord_mm = maths_abs(pitch->value_mm[i + 1] - pitch->value_mm[i]);
        const double second_mm =
            maths_max(maths_abs(pitch->second_mm[i]), maths_abs(pitch->second_mm[i + 1]));
        if (!(chord_mm + 0.74 * second_mm <= most_mm))
            return false;
    }
    return true;
}

bool takt_pitch_make(struct pitch *pitch)
{
    double knot[DRIVE_PITCH_POINTS];
    TAKT_ASSERT(pitch->points <= DRIVE_PITCH_POINTS);
    for (unsigned i = 0; i < pitch->points; i++)
        knot[i] = i;
    if (pitch->points >= 2) {
        takt_spline_second_derivatives(pitch->points, knot, pitch->value_mm, pitch->second_mm);
        if (is_flat(pitch))
            return true;
    }
    pitch->points = 0;
    return false;
}

/* K = r v0 + s v1 - r s ((1 + r) M0 + (1 + s) M1) / 6,   r = 1 - s */
double takt_pitch_at(const struct pitch *pitch, double motor_mm)
{
    unsigned outside = 0;
    if (pitch->points == 0)
        return 0;
    const double at = takt_edge_hold((motor_mm - pitch->first_mm) * pitch->steps_per_mm,
                                     pitch->points - 1, &outside);
    const unsigned last = pitch->points - 2;
    const unsigned i = at < 1 ? 0 : at >= last ? last : (unsigned)at;
    const double s = at - i, r = 1 - s;
    const double *value = pitch->value_mm + i, *second = pitch->second_mm + i;
    return r * value[0] + s * value[1] - r * s * ((1 + r) * second[0] + (1 + s) * second[1]) / 6;
}

/* y = x - K(y), again and again: each time PITCH_STEEPEST_RATIO as far off. */
double takt_pitch_get_motor_mm(const struct pitch *pitch, double axis_mm)
{
    double motor_mm = axis_mm;
    for (unsigned i = 0; i < INVERSE_STEPS; i++)
        motor_mm = axis_mm - takt_pitch_at(pitch, motor_mm);
    return motor_mm;
}

/*
 * Set-up: the part, or its pallet, stands displaced and turned. A rigid transform about a pivot P:
 *
 *     K = (R - I) (U - P) + offset,   R = R_z R_y R_x,   K_psi = turn
 *
 * A displacement may be millimetres, so this layer alone is summed in double precision.
 */
#include "base/maths.h"
#include "correction/layer.h"

#define SIDE AXIS_LINEAR_COUNT

/* m = a m, a the rotation by an angle about an axis. */
static void turn(double m[SIDE][SIDE], unsigned about, double angle_rad)
{
    const unsigned first = (about + 1) % SIDE;
    const unsigned second = (about + 2) % SIDE;
    double sine, cosine;

    maths_sincos(angle_rad, &sine, &cosine);
    for (unsigned j = 0; j < SIDE; j++) {
        const double u = m[first][j];
        const double v = m[second][j];

        m[first][j] = cosine * u - sine * v;
        m[second][j] = sine * u + cosine * v;
    }
}

static bool setup_begin(const struct correction *c, struct layer_notes *notes)
{
    const struct correction_settings *s = &c->settings;
    double rotation[SIDE][SIDE] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    bool any = s->setup_turn_rad != 0.0;

    for (unsigned i = 0; i < SIDE; i++) {
        turn(rotation, i, s->setup_rotation_rad[i]);
    }
    for (unsigned i = 0; i < SIDE; i++) {
        for (unsigned j = 0; j < SIDE; j++) {
            notes->number[SIDE * i + j] = rotation[i][j] - (i == j ? 1.0 : 0.0);
        }
        any = any || s->setup_rotation_rad[i] != 0.0 || s->setup_offset_mm[i] != 0.0;
    }
    return any;
}

static void setup_add(struct correction *c, struct layer_notes *notes, double weight,
                      struct correction_sum *sum)
{
    const struct correction_settings *s = &c->settings;
    const unsigned end = c->axes_end < SIDE ? c->axes_end : SIDE;

    for (unsigned i = 0; i < end; i++) {
        double k = s->setup_offset_mm[i];

        for (unsigned j = 0; j < SIDE; j++) {
            k += notes->number[SIDE * i + j] * (c->at->at[j] - s->setup_pivot_mm[j]);
        }
        sum->coarse[i] += weight * k;
    }
    if (s->turn_axis < AXIS_COUNT) {
        sum->coarse[s->turn_axis] += weight * s->setup_turn_rad;
    }
}

static void setup_need(const struct correction *c, const struct layer_notes *notes,
                       const struct motion_bound *most, struct need *need)
{
    const struct correction_settings *s = &c->settings;

    for (unsigned i = 0; i < SIDE; i++) {
        for (unsigned j = 0; j < SIDE; j++) {
            const double slope = maths_abs(notes->number[SIDE * i + j]);

            need_add_slope(need, i, j, slope, most);
            need->size_mm[i] += slope * 2.0 * most->farthest_mm[j];
        }
        need->size_mm[i] += maths_abs(s->setup_offset_mm[i]);
    }
    if (s->turn_axis < AXIS_COUNT) {
        need->size_mm[s->turn_axis] += maths_abs(s->setup_turn_rad);
    }
}

const struct correction_layer layer_setup = {
    .name = "setup",
    .begin = setup_begin,
    .add = setup_add,
    .need = setup_need,
};

/*
 * Matrix: what is proportional to position.
 *
 *     K = machine U + workpiece (U - W) + overhang T = (machine + workpiece) U + (overhang T - workpiece W)
 *
 * over U = (X, Y, Z, psi). The second part is constant while part zero W and tool offset T are, and
 * fades when a program changes them. A diagonal machine matrix corrects the pitch of screws alone.
 */
#include "base/maths.h"
#include "correction/layer.h"

#define SIDE CORRECTION_COORDINATES

static bool matrix_begin(const struct correction *c, struct layer_notes *notes)
{
    const struct correction_settings *s = &c->settings;
    bool any = false;

    for (unsigned i = 0; i < SIDE; i++) {
        for (unsigned j = 0; j < SIDE; j++) {
            const bool exists = takt_correction_axis_of(c, i) < AXIS_COUNT &&
                                takt_correction_axis_of(c, j) < AXIS_COUNT;
            const double a = exists ? s->machine[i][j] + s->workpiece[i][j] : 0.0;

            notes->coefficient[SIDE * i + j] = (float)a;
            any = any || a != 0.0 || s->workpiece[i][j] != 0.0;
        }
        for (unsigned j = 0; j < AXIS_LINEAR_COUNT; j++) {
            any = any || s->overhang[i][j] != 0.0;
        }
    }
    return any;
}

/* Row i of overhang T - workpiece W. */
static double constant_of(const struct correction *c, unsigned i)
{
    double sum = 0.0;

    for (unsigned j = 0; j < AXIS_LINEAR_COUNT; j++) {
        sum += c->settings.overhang[i][j] * (double)c->move->overhang_mm[j] -
               c->settings.workpiece[i][j] * (double)c->move->work_mm[j];
    }
    return sum;
}

/* Remembers W and T, so that the constants are only worked out anew when these change. */
static bool has_moved(const struct correction *c, struct layer_notes *notes)
{
    bool moved = !notes->started;

    if (notes->started && !move_is_motion(c->move)) {
        return false;
    }
    for (unsigned j = 0; j < AXIS_LINEAR_COUNT; j++) {
        const double work = (double)c->move->work_mm[j];
        const double overhang = (double)c->move->overhang_mm[j];

        moved = moved || notes->number[SIDE + j] != work ||
                notes->number[SIDE + AXIS_LINEAR_COUNT + j] != overhang;
        notes->number[SIDE + j] = work;
        notes->number[SIDE + AXIS_LINEAR_COUNT + j] = overhang;
    }
    return moved;
}

static void matrix_follow(struct correction *c, struct layer_notes *notes)
{
    const bool moved = has_moved(c, notes);

    for (unsigned i = 0; i < SIDE; i++) {
        if (moved) {
            notes->number[i] = constant_of(c, i);
        }
        if (!notes->started) {
            notes->fade[i].value = notes->number[i];
        } else if (!fade_is_at(&notes->fade[i], notes->number[i])) {
            (void)fade_cycle(&notes->fade[i], notes->number[i], &c->layer_pace);
        }
    }
}

static void matrix_add(struct correction *c, struct layer_notes *notes, double weight,
                       struct correction_sum *sum)
{
    const float *row = notes->coefficient;

    for (unsigned i = 0; i < SIDE; i++) {
        const unsigned corrected = takt_correction_axis_of(c, i);
        float k = (float)notes->fade[i].value;

        for (unsigned j = 0; j < SIDE && corrected < AXIS_COUNT; j++) {
            const unsigned input = takt_correction_axis_of(c, j);

            k += input < AXIS_COUNT ? row[SIDE * i + j] * (float)c->at->at[input] : 0.0F;
        }
        if (corrected < AXIS_COUNT) {
            sum->fine[corrected] += (float)weight * k;
        }
    }
}

static void matrix_need(const struct correction *c, const struct layer_notes *notes,
                        const struct motion_bound *most, struct need *need)
{
    for (unsigned i = 0; i < SIDE; i++) {
        const unsigned corrected = takt_correction_axis_of(c, i);

        for (unsigned j = 0; j < SIDE && corrected < AXIS_COUNT; j++) {
            const unsigned input = takt_correction_axis_of(c, j);
            const double slope = maths_abs((double)notes->coefficient[SIDE * i + j]);

            if (input < AXIS_COUNT) {
                takt_need_add_slope(need, corrected, input, slope, most);
                need->size_mm[corrected] += slope * most->farthest_mm[input];
                need->noise_mm[corrected] += slope * most->farthest_mm[input] * NEED_ROUNDING;
            }
        }
    }
}

const struct correction_layer takt_layer_matrix = {
    .name = "matrix",
    .begin = matrix_begin,
    .follow = matrix_follow,
    .add = matrix_add,
    .need = matrix_need,
};

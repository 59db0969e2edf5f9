/*
 * Set-up: the part, or its pallet, stands displaced and turned. A rigid transform about a pivot P,
 * which turns with the table T(psi) that bears the part; P is then a point of the table's axis:
 *
 *     K = T ((R - I) T^-1 (U - P) + offset),   R = R_z R_y R_x,   K_psi = turn
 *
 * The set-up is told with the table at psi = 0, and is what remains after the table has turned by
 * K_psi. A displacement may be millimetres, so this layer alone is summed in double precision.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "correction/correction.h"
#include "correction/layer.h"
#include "correction/setup.h"

#include <string.h>

#define SIDE AXIS_LINEAR_COUNT

/* Places among the numbers of a set-up: offset, turns about X, Y, Z, and this. */
enum { TURN = 2 * SIDE };

/* m = a m, a the rotation by an angle about an axis. */
static void turn(double m[SIDE][SIDE], unsigned about, double angle_rad)
{
    const unsigned first = (about + 1) % SIDE;
    const unsigned second = (about + 2) % SIDE;
    double sine, cosine;

    TAKT_ASSERT(about < SIDE);
    takt_maths_sincos(angle_rad, &sine, &cosine);
    for (unsigned j = 0; j < SIDE; j++) {
        const double u = m[first][j];
        const double v = m[second][j];

        m[first][j] = cosine * u - sine * v;
        m[second][j] = sine * u + cosine * v;
    }
}

void takt_setup_prepare(struct setup *s)
{
    double rotation[SIDE][SIDE] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};

    for (unsigned i = 0; i < SIDE; i++) {
        turn(rotation, i, s->number[SIDE + i]);
    }
    for (unsigned i = 0; i < SIDE; i++) {
        for (unsigned j = 0; j < SIDE; j++) {
            s->less_one[i][j] = rotation[i][j] - (i == j ? 1.0 : 0.0);
        }
    }
}

void takt_setup_get_numbers(const struct correction *c, double number[CORRECTION_SETUP_VALUES])
{
    const struct correction_settings *s = &c->settings;

    memcpy(number, s->setup_offset_mm, sizeof(s->setup_offset_mm));
    memcpy(&number[SIDE], s->setup_rotation_rad, sizeof(s->setup_rotation_rad));
    number[TURN] = s->setup_turn_rad;
}

static void set_numbers(struct correction_settings *s, const double number[CORRECTION_SETUP_VALUES])
{
    memcpy(s->setup_offset_mm, number, sizeof(s->setup_offset_mm));
    memcpy(s->setup_rotation_rad, &number[SIDE], sizeof(s->setup_rotation_rad));
    s->setup_turn_rad = number[TURN];
}

/* Does it displace the part? The notes' numbers are R - I then. */
static bool set_notes(struct layer_notes *notes, const struct setup *s)
{
    bool any = false;

    memcpy(notes->number, s->less_one, sizeof(s->less_one));
    for (unsigned i = 0; i < CORRECTION_SETUP_VALUES; i++) {
        any = any || s->number[i] != 0.0;
    }
    return any;
}

bool takt_setup_exchange(struct correction *c, struct layer_notes *notes)
{
    set_numbers(&c->settings, c->setup_next.number);
    return set_notes(notes, &c->setup_next);
}

static bool setup_begin(const struct correction *c, struct layer_notes *notes)
{
    struct setup s;

    takt_setup_get_numbers(c, s.number);
    takt_setup_prepare(&s);
    return set_notes(notes, &s);
}

static bool has_table(const struct correction *c)
{
    return c->settings.turn_axis < AXIS_COUNT;
}

/* The linear axis that the table turns about; those after it, in order, are its plane. */
static unsigned about_of(const struct correction *c)
{
    TAKT_ASSERT(c->settings.turn_axis >= AXIS_A && c->settings.turn_axis < AXIS_COUNT);
    return c->settings.turn_axis - AXIS_A;
}

/* v turns with the table, or back. */
static void turn_vector(const struct correction *c, double sine, double cosine, double v[SIDE])
{
    const unsigned first = (about_of(c) + 1) % SIDE;
    const unsigned second = (about_of(c) + 2) % SIDE;
    const double x = v[first];
    const double y = v[second];

    v[first] = cosine * x - sine * y;
    v[second] = sine * x + cosine * y;
}

static void setup_add(struct correction *c, struct layer_notes *notes, double weight,
                      struct correction_sum *sum)
{
    const struct correction_settings *s = &c->settings;
    const unsigned end = c->axes_end < SIDE ? c->axes_end : SIDE;
    double way[SIDE], k[SIDE], sine = 0.0, cosine = 1.0;

    for (unsigned i = 0; i < SIDE; i++) {
        way[i] = c->at->at[i] - s->setup_pivot_mm[i];
    }
    if (has_table(c)) {
        takt_maths_sincos(c->at->at[s->turn_axis], &sine, &cosine);
        turn_vector(c, -sine, cosine, way);
    }
    for (unsigned i = 0; i < SIDE; i++) {
        k[i] = s->setup_offset_mm[i];
        for (unsigned j = 0; j < SIDE; j++) {
            k[i] += notes->number[SIDE * i + j] * way[j];
        }
    }
    if (has_table(c)) {
        turn_vector(c, sine, cosine, k);
        sum->coarse[s->turn_axis] += weight * s->setup_turn_rad;
    }
    for (unsigned i = 0; i < end; i++) {
        sum->coarse[i] += weight * k[i];
    }
}

/* ---- what it takes of the axes ---- */

static double length_of(double x, double y)
{
    return maths_sqrt(x * x + y * y);
}

/* K_i = slope (x_j - P_j), whatever its sign. */
static void add_constant(const struct correction *c, unsigned i, unsigned j, double slope,
                         const struct motion_bound *most, struct need *need)
{
    const double size = maths_abs(slope);

    takt_need_add_slope(need, i, j, size, most);
    need->size_mm[i] += size * (most->farthest_mm[j] + maths_abs(c->settings.setup_pivot_mm[j]));
}

/* x_j - P_j */
static struct need_jet way_of(const struct correction *c, unsigned j,
                              const struct motion_bound *most)
{
    struct need_jet way = {{maths_abs(c->settings.setup_pivot_mm[j]), 0.0, 0.0, 0.0}};

    takt_need_jet_add_travel(&way, most, j);
    return way;
}

/*
 * What goes round with the table: once per turn the offset in its plane and what R - I does between
 * plane and axis, twice what of R - I is symmetric in the plane.
 */
static void add_waves(const struct correction *c, const struct setup *s,
                      const struct motion_bound *most, struct need *need)
{
    const unsigned t = about_of(c);
    const unsigned u = (t + 1) % SIDE;
    const unsigned v = (t + 2) % SIDE;
    const double *offset = s->number;
    const double(*m)[SIDE] = s->less_one;
    const double round_twice = 0.5 * length_of(m[u][u] - m[v][v], m[u][v] + m[v][u]);
    const struct need_jet one = {{1.0, 0.0, 0.0, 0.0}};
    const struct need_jet along = way_of(c, t, most);
    const unsigned psi = c->settings.turn_axis;
    const struct need_jet shift =
        takt_need_jet_wave(length_of(offset[u], offset[v]), 1.0, most, psi);
    const struct need_jet out = takt_need_jet_wave(length_of(m[u][t], m[v][t]), 1.0, most, psi);
    const struct need_jet into = takt_need_jet_wave(length_of(m[t][u], m[t][v]), 1.0, most, psi);
    const struct need_jet twice = takt_need_jet_wave(round_twice, 2.0, most, psi);

    for (unsigned i = 0; i < 2; i++) {
        const unsigned axis = i == 0 ? u : v;
        const struct need_jet way = way_of(c, axis, most);

        takt_need_add_product(need, axis, &shift, &one);
        takt_need_add_product(need, axis, &out, &along);
        takt_need_add_product(need, t, &into, &way);
        takt_need_add_product(need, u, &twice, &way);
        takt_need_add_product(need, v, &twice, &way);
    }
}

/* What is the same at every angle of the table: turns about its axis are of this kind. */
static void add_unturned(const struct correction *c, const struct setup *s,
                         const struct motion_bound *most, struct need *need)
{
    const unsigned t = about_of(c);
    const unsigned u = (t + 1) % SIDE;
    const unsigned v = (t + 2) % SIDE;
    const double(*m)[SIDE] = s->less_one;
    const double stretch = 0.5 * (m[u][u] + m[v][v]);
    const double swing = 0.5 * (m[v][u] - m[u][v]);

    add_constant(c, t, t, m[t][t], most, need);
    add_constant(c, u, u, stretch, most, need);
    add_constant(c, v, v, stretch, most, need);
    add_constant(c, u, v, swing, most, need);
    add_constant(c, v, u, swing, most, need);
    need->size_mm[t] += maths_abs(s->number[t]);
    need->size_mm[c->settings.turn_axis] += maths_abs(s->number[TURN]);
}

void takt_setup_need(const struct correction *c, const struct setup *s,
                     const struct motion_bound *most, struct need *need)
{
    if (has_table(c)) {
        add_unturned(c, s, most, need);
        add_waves(c, s, most, need);
        return;
    }
    for (unsigned i = 0; i < SIDE; i++) {
        for (unsigned j = 0; j < SIDE; j++) {
            add_constant(c, i, j, s->less_one[i][j], most, need);
        }
        need->size_mm[i] += maths_abs(s->number[i]);
    }
}

static void need_in_force(const struct correction *c, const struct layer_notes *notes,
                          const struct motion_bound *most, struct need *need)
{
    struct setup s;

    takt_setup_get_numbers(c, s.number);
    memcpy(s.less_one, notes->number, sizeof(s.less_one));
    takt_setup_need(c, &s, most, need);
}

const struct correction_layer takt_layer_setup = {
    .name = "setup",
    .begin = setup_begin,
    .add = setup_add,
    .need = need_in_force,
};

/* ---- what the program tells ---- */

void takt_correction_get_setup(const struct correction *c, double number[CORRECTION_SETUP_VALUES])
{
    if (c->setup_waits) {
        memcpy(number, c->setup_next.number, sizeof(c->setup_next.number));
    } else {
        takt_setup_get_numbers(c, number);
    }
}

void takt_correction_forget_setup(struct correction *c)
{
    takt_correction_get_setup(c, c->setup_told);
}

void takt_correction_tell_setup(struct correction *c, unsigned which, double value)
{
    TAKT_ASSERT(which < CORRECTION_SETUP_VALUES);
    c->setup_told[which] = value;
}

bool takt_correction_is_set_up(const struct correction *c)
{
    double number[CORRECTION_SETUP_VALUES];

    takt_correction_get_setup(c, number);
    for (unsigned i = 0; i < CORRECTION_SETUP_VALUES; i++) {
        if (number[i] != c->setup_told[i]) {
            return false;
        }
    }
    return true;
}

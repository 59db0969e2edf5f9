/*
 * Tool wear. A tool that has cut a length L in a time T has lost
 *
 *     along = per_length L + per_time T     of its length: K = - along d
 *     across, likewise                      of its radius: K = across n
 *
 * d is the unit vector from the tool's point into its spindle: that of the settings, turned by the
 * head. n is the unit vector normal to the tool and to the way t, towards the contour, which is to
 * the right of the path when the tool goes left of it (G41), to the left with G42:
 *
 *     n = +- (t x d) / |t x d|
 *
 * Without compensation nobody knows the side, and nothing is done across.
 *
 * Length and time are counted per tool, on cutting moves. Corrections follow smoothly; d goes with
 * the head at once.
 */
#include "base/assert.h"
#include "base/maths.h"
#include "correction/layer.h"

#include <string.h>

/*
 * Among the notes' numbers: 0 to 2 n; the tool; where the cycle before was; d with the head at 0.
 * The coefficients are d; the fades are those of K across, and of what is lost along.
 */
#define TOOL   3
#define BEFORE 4
#define AT_0   (BEFORE + AXIS_LINEAR_COUNT)
#define ALONG  AXIS_LINEAR_COUNT

static double length_of(const double v[AXIS_LINEAR_COUNT])
{
    return maths_sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* d = R d_0, R the head's turn about the linear axis that its letter belongs to. */
static void set_direction(const struct correction *c, struct layer_notes *notes)
{
    const uint32_t head = c->settings.head_axis;
    double d[AXIS_LINEAR_COUNT];

    memcpy(d, &notes->number[AT_0], sizeof(d));
    if (head < AXIS_COUNT) {
        const unsigned first = (head - AXIS_A + 1) % AXIS_LINEAR_COUNT;
        const unsigned second = (head - AXIS_A + 2) % AXIS_LINEAR_COUNT;
        const double u = d[first];
        const double v = d[second];
        double sine, cosine;

        takt_maths_sincos(c->at->at[head], &sine, &cosine);
        d[first] = cosine * u - sine * v;
        d[second] = sine * u + cosine * v;
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        notes->coefficient[i] = (float)d[i];
    }
}

static bool has_across(const struct correction_settings *s)
{
    return s->wear_across_per_mm != 0.0 || s->wear_across_mm_s != 0.0;
}

static bool has_along(const struct correction_settings *s)
{
    return s->wear_along_per_mm != 0.0 || s->wear_along_mm_s != 0.0;
}

static bool wear_begin(const struct correction *c, struct layer_notes *notes)
{
    const double *direction = c->settings.tool_direction;
    const double length = length_of(direction);

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        notes->number[AT_0 + i] = length > 0.0 ? direction[i] / length : 0.0;
    }
    set_direction(c, notes);
    return has_along(&c->settings) || has_across(&c->settings);
}

/* The book of a tool; a new one takes a free place, or that of the tool unused for longest. */
static struct correction_wear *book_of(struct correction *c, uint32_t tool)
{
    struct correction_wear *oldest = &c->wear[0];

    for (unsigned i = 0; i < CORRECTION_TOOLS_MAX; i++) {
        if (c->wear[i].used != 0 && c->wear[i].tool == tool) {
            return &c->wear[i];
        }
        if (c->wear[i].used < oldest->used) {
            oldest = &c->wear[i];
        }
    }
    *oldest = (struct correction_wear){.tool = tool, .used = ++c->tools_used};
    return oldest;
}

void takt_correction_set_wear(struct correction *c, uint32_t tool, double length_mm, double time_s)
{
    struct correction_wear *book = book_of(c, tool);

    book->length_mm = length_mm;
    book->time_s = time_s;
}

void takt_correction_get_wear(const struct correction *c, uint32_t tool, double *length_mm,
                              double *time_s)
{
    *length_mm = *time_s = 0.0;
    for (unsigned i = 0; i < CORRECTION_TOOLS_MAX; i++) {
        if (c->wear[i].used != 0 && c->wear[i].tool == tool) {
            *length_mm = c->wear[i].length_mm;
            *time_s = c->wear[i].time_s;
        }
    }
}

static bool is_cutting(const struct move *move)
{
    return move_is_motion(move) && move->kind != MOVE_RAPID && move->kind != MOVE_PROBE;
}

/* Way of this cycle, X Y Z. */
static double way_of(const struct correction *c, struct layer_notes *notes,
                     double step_mm[AXIS_LINEAR_COUNT])
{
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        step_mm[i] = notes->started ? c->at->at[i] - notes->number[BEFORE + i] : 0.0;
        notes->number[BEFORE + i] = c->at->at[i];
    }
    return length_of(step_mm);
}

/*
 * n = t x d, not yet of unit length; with the sign that leads it towards the contour. Not 0: which
 * side that is is known.
 */
static double cross_path(const struct correction *c, const double t[AXIS_LINEAR_COUNT],
                         const float d[AXIS_LINEAR_COUNT], double n[AXIS_LINEAR_COUNT])
{
    const bool left = (enum cutter_side)c->move->contour_side == CUTTER_LEFT;
    enum axis first, second;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const unsigned j = (i + 1) % AXIS_LINEAR_COUNT;
        const unsigned k = (i + 2) % AXIS_LINEAR_COUNT;

        n[i] = t[j] * (double)d[k] - t[k] * (double)d[j];
    }
    takt_plane_axes(c->move->plane, &first, &second);
    const double right = n[first] * t[second] - n[second] * t[first];

    return left ? right : -right;
}

/*
 * n; 0 without compensation. It stays as it was where the way or the tool does not tell it. In
 * notes->number.
 */
static void set_side(const struct correction *c, const double step_mm[AXIS_LINEAR_COUNT],
                     struct layer_notes *notes)
{
    double n[AXIS_LINEAR_COUNT];

    if ((enum cutter_side)c->move->contour_side == CUTTER_OFF) {
        memset(notes->number, 0, sizeof(n));
        return;
    }
    const double towards = cross_path(c, step_mm, notes->coefficient, n);
    const double length = length_of(n);

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT && towards != 0.0; i++) {
        notes->number[i] = (towards > 0.0 ? n[i] : -n[i]) / length;
    }
}

static void wear_follow(struct correction *c, struct layer_notes *notes)
{
    const struct correction_settings *s = &c->settings;
    double step_mm[AXIS_LINEAR_COUNT];
    const double way_mm = way_of(c, notes, step_mm);

    if (move_is_motion(c->move)) {
        notes->number[TOOL] = c->move->tool;
    }
    struct correction_wear *book = book_of(c, (uint32_t)notes->number[TOOL]);

    set_direction(c, notes);
    if (is_cutting(c->move)) {
        book->length_mm += way_mm;
        book->time_s += way_mm > 0.0 ? c->cycle_s : 0.0;
        set_side(c, step_mm, notes);
    }
    const double along = s->wear_along_per_mm * book->length_mm + s->wear_along_mm_s * book->time_s;
    const double across =
        s->wear_across_per_mm * book->length_mm + s->wear_across_mm_s * book->time_s;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        (void)fade_cycle(&notes->fade[i], across * notes->number[i], &c->layer_pace);
    }
    (void)fade_cycle(&notes->fade[ALONG], along, &c->layer_pace);
}

static void wear_add(struct correction *c, struct layer_notes *notes, double weight,
                     struct correction_sum *sum)
{
    (void)c;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double along = notes->fade[ALONG].value * (double)notes->coefficient[i];

        sum->fine[i] += (float)(weight * (notes->fade[i].value - along));
    }
}

/*
 * A tool is changed before it has lost more than this; at a corner, wear across turns from one side
 * to another.
 */
#define WEAR_MAX_MM 0.1

/* A coordinate of d: a number, or a wave over the head's angle. */
static struct need_jet direction_jet(const struct correction *c, const struct layer_notes *notes,
                                     const struct motion_bound *most, unsigned i)
{
    const double *d = &notes->number[AT_0];
    const uint32_t head = c->settings.head_axis;

    TAKT_ASSERT(i < AXIS_LINEAR_COUNT);
    if (head == AXIS_COUNT || head == AXIS_A + i) {
        return (struct need_jet){{maths_abs(d[i]), 0.0, 0.0, 0.0}};
    }
    const unsigned first = (head - AXIS_A + 1) % AXIS_LINEAR_COUNT;
    const unsigned second = (head - AXIS_A + 2) % AXIS_LINEAR_COUNT;

    return takt_need_jet_wave(maths_sqrt(d[first] * d[first] + d[second] * d[second]), 1.0, most,
                              head);
}

/* What fades between 0 and a size. */
static struct need_jet fade_jet(const struct correction *c, double size_mm)
{
    return (struct need_jet){{size_mm, size_mm * takt_fade_velocity_per_s(&c->layer_pace),
                              size_mm * takt_fade_acceleration_per_s2(&c->layer_pace),
                              size_mm * takt_fade_jerk_per_s3(&c->layer_pace)}};
}

static void wear_need(const struct correction *c, const struct layer_notes *notes,
                      const struct motion_bound *most, struct need *need)
{
    static const struct need_jet one = {{1.0, 0.0, 0.0, 0.0}};
    const struct need_jet along = fade_jet(c, has_along(&c->settings) ? WEAR_MAX_MM : 0.0);
    const struct need_jet across = fade_jet(c, has_across(&c->settings) ? 2.0 * WEAR_MAX_MM : 0.0);

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const struct need_jet d = direction_jet(c, notes, most, i);

        takt_need_add_product(need, i, &d, &along);
        takt_need_add_product(need, i, &one, &across);
    }
}

const struct correction_layer takt_layer_wear = {
    .name = "wear",
    .begin = wear_begin,
    .follow = wear_follow,
    .add = wear_add,
    .need = wear_need,
};

/*
 * Tool wear. A tool that has cut a length L in a time T has lost
 *
 *     along = per_length L + per_time T     of its length (tool axis Z): K_z = - along
 *     across, likewise                      of its radius: K is towards the contour, which is to the right of the path
 *                                           when the tool goes left of it (G41), to the left with G42; without
 *                                           compensation nobody knows the side, and nothing is done across
 *
 * Length and time are counted per tool, on cutting moves. Corrections follow smoothly.
 */
#include "base/maths.h"
#include "correction/layer.h"

/* Among the notes' numbers: 0 to 2 the unit vector across the path; the tool; where the cycle before was. */
#define TOOL   3
#define BEFORE 4

static bool wear_begin(const struct correction *c, struct layer_notes *notes)
{
    const struct correction_settings *s = &c->settings;

    (void)notes;
    return s->wear_along_per_mm != 0.0 || s->wear_along_mm_s != 0.0 ||
           s->wear_across_per_mm != 0.0 || s->wear_across_mm_s != 0.0;
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

void correction_set_wear(struct correction *c, uint32_t tool, double length_mm, double time_s)
{
    struct correction_wear *book = book_of(c, tool);

    book->length_mm = length_mm;
    book->time_s = time_s;
}

void correction_get_wear(const struct correction *c, uint32_t tool, double *length_mm,
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
    double square = 0.0;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        step_mm[i] = notes->started ? c->at->at[i] - notes->number[BEFORE + i] : 0.0;
        notes->number[BEFORE + i] = c->at->at[i];
        square += step_mm[i] * step_mm[i];
    }
    return maths_sqrt(square);
}

/* Unit vector across the path, towards the contour; 0 when the side is not known. In notes->number. */
static void set_side(const struct correction *c, const double step_mm[AXIS_LINEAR_COUNT],
                     struct layer_notes *notes)
{
    const enum cutter_side side = (enum cutter_side)c->move->contour_side;
    enum axis first, second;

    plane_axes(c->move->plane, &first, &second);
    const double u = step_mm[first];
    const double v = step_mm[second];
    const double length = maths_sqrt(u * u + v * v);

    if (side != CUTTER_OFF && !(length > 0.0)) {
        return;
    }
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        notes->number[i] = 0.0;
    }
    if (side != CUTTER_OFF) {
        const double sign = side == CUTTER_LEFT ? 1.0 : -1.0;

        notes->number[first] = sign * v / length;
        notes->number[second] = -sign * u / length;
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

    if (is_cutting(c->move)) {
        book->length_mm += way_mm;
        book->time_s += way_mm > 0.0 ? c->cycle_s : 0.0;
        set_side(c, step_mm, notes);
    }
    const double along = s->wear_along_per_mm * book->length_mm + s->wear_along_mm_s * book->time_s;
    const double across =
        s->wear_across_per_mm * book->length_mm + s->wear_across_mm_s * book->time_s;

    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const double target = across * notes->number[i] - (i == AXIS_Z ? along : 0.0);

        (void)fade_cycle(&notes->fade[i], target, &c->layer_pace);
    }
}

static void wear_add(struct correction *c, struct layer_notes *notes, double weight,
                     struct correction_sum *sum)
{
    (void)c;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        sum->fine[i] += (float)(weight * notes->fade[i].value);
    }
}

/* A tool is changed before it has lost more than this; at a corner, wear across turns from one side to another. */
#define WEAR_MAX_MM 0.1

static void wear_need(const struct correction *c, const struct layer_notes *notes,
                      const struct motion_bound *most, struct need *need)
{
    (void)notes;
    (void)most;
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++) {
        const struct correction_settings *s = &c->settings;
        const bool across = s->wear_across_per_mm != 0.0 || s->wear_across_mm_s != 0.0;
        const double step_mm = across ? 2.0 * WEAR_MAX_MM : i == AXIS_Z ? WEAR_MAX_MM : 0.0;

        need->size_mm[i] += step_mm;
        need->velocity_mm_s[i] += step_mm * fade_velocity_per_s(&c->layer_pace);
        need->acceleration_mm_s2[i] += step_mm * fade_acceleration_per_s2(&c->layer_pace);
        need->jerk_mm_s3[i] += step_mm * fade_jerk_per_s3(&c->layer_pace);
    }
}

const struct correction_layer layer_wear = {
    .name = "wear",
    .begin = wear_begin,
    .follow = wear_follow,
    .add = wear_add,
    .need = wear_need,
};

#include "bore/job.h"

#include "base/maths.h"
#include "bore/approximate.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A whole number of steps or turns may be missed by this share: rounding of a division. */
#define WHOLE_SLACK 1e-12

__attribute__((format(printf, 1, 2))) static const char *wrong(const char *format, ...)
{
    static _Thread_local char text[200];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

/* R = (D - d) / 2 - allowance */
static double circle_mm(const struct bore_job *job, enum bore_pass pass)
{
    double left_mm = pass == BORE_FINISHING && job->pass == BORE_BOTH ? 0 : job->allowance_mm;

    return 0.5 * (job->hole_mm - job->cutter_mm) - left_mm;
}

static bool does(const struct bore_job *job, enum bore_pass pass)
{
    return job->pass == pass || job->pass == BORE_BOTH;
}

static const char *check_hole(const struct bore_job *job)
{
    enum bore_pass widest = job->pass == BORE_FINISHING ? BORE_FINISHING : BORE_ROUGHING;

    if (!(job->hole_mm > 0))
        return wrong("the hole's diameter is %g mm: it must be greater than 0", job->hole_mm);
    if (!(job->cutter_mm > 0))
        return wrong("the cutter's diameter is %g mm: it must be greater than 0", job->cutter_mm);
    if (job->cutter_mm >= job->hole_mm)
        return wrong("the cutter of %g mm is not smaller than the hole of %g mm", job->cutter_mm,
                     job->hole_mm);
    if (!(job->allowance_mm >= 0))
        return wrong("the allowance is %g mm: it must be 0 or more", job->allowance_mm);
    if (!(circle_mm(job, widest) > 0))
        return wrong("the allowance of %g mm leaves nothing to mill: it must be less than %g mm, "
                     "half of hole minus cutter",
                     job->allowance_mm, 0.5 * (job->hole_mm - job->cutter_mm));
    return NULL;
}

/* The pass that begins where the job says. */
static enum bore_pass begun(const struct bore_job *job)
{
    return job->pass == BORE_ROUGHING ? BORE_ROUGHING : BORE_FINISHING;
}

/* n = ceil(R / step): no turn is farther out than asked for. */
static double turns_of(const struct bore_job *job, enum bore_pass pass)
{
    if (pass == BORE_FINISHING)
        return job->turns;
    return takt_maths_ceil(circle_mm(job, BORE_ROUGHING) / job->step_mm * (1 - WHOLE_SLACK));
}

/* The cutter goes round the centre, and what it leaves there stands as a core. */
static const char *check_helix(const struct bore_job *job)
{
    double radius_mm = circle_mm(job, BORE_ROUGHING);

    if (!(job->depth_mm > 0))
        return wrong("a helix goes down: it needs a depth");
    if (radius_mm > 0.5 * job->cutter_mm)
        return wrong("a helix of radius %g mm leaves a core: the cutter of %g mm must be at least "
                     "%g mm",
                     radius_mm, job->cutter_mm, 0.5 * job->hole_mm - job->allowance_mm);
    return NULL;
}

static const char *check_roughing(const struct bore_job *job)
{
    if (!does(job, BORE_ROUGHING))
        return NULL;
    if (job->as == BORE_AS_HELIX)
        return check_helix(job);
    if (!(job->step_mm > 0))
        return wrong("the radial step is %g mm: it must be greater than 0", job->step_mm);
    if (turns_of(job, BORE_ROUGHING) > BORE_TURNS_MAX)
        return wrong("the radial step of %g mm makes %.0f turns: more than %d", job->step_mm,
                     turns_of(job, BORE_ROUGHING), BORE_TURNS_MAX);
    return NULL;
}

static const char *check_start(const struct bore_job *job)
{
    double radius_mm = circle_mm(job, begun(job));
    double distance_mm =
        maths_sqrt(job->start_mm[0] * job->start_mm[0] + job->start_mm[1] * job->start_mm[1]);
    double length_mm =
        MATHS_PI * radius_mm * turns_of(job, begun(job)); /* from the centre: R n pi */

    if (job->begin == BORE_AT_POINT && !(distance_mm < radius_mm))
        return wrong("the start %g,%g is %g mm from the hole's centre: it must be inside the "
                     "circle of %g mm that the cutter's centre goes on",
                     job->start_mm[0], job->start_mm[1], distance_mm, radius_mm);
    if (job->begin == BORE_AT_RADIUS && !(job->start_radius_mm < radius_mm))
        return wrong("the spiral begins with a radius of %g mm: it must be less than the %g mm "
                     "of the circle",
                     job->start_radius_mm, radius_mm);
    if (job->begin == BORE_AT_LENGTH &&
        !(job->start_length_mm > 0 && job->start_length_mm <= length_mm))
        return wrong("the spiral is %g mm long: from the hole's centre it would be %g mm, and "
                     "it cannot be longer",
                     job->start_length_mm, length_mm);
    return NULL;
}

static const char *check_finishing(const struct bore_job *job)
{
    if (!does(job, BORE_FINISHING))
        return NULL;
    if (job->turns < 1 || job->turns > BORE_TURNS_MAX)
        return wrong("the approach makes %u turns: 1 to %d are possible", job->turns,
                     BORE_TURNS_MAX);
    return NULL;
}

static const char *check_arcs_of(const struct bore_path *p)
{
    for (size_t i = 0; i < p->count; i++) {
        const struct bore_piece *piece = &p->piece[i];
        const double x_mm = piece->to_mm[0] - piece->centre_mm[0];
        const double y_mm = piece->to_mm[1] - piece->centre_mm[1];
        const double radius_mm = maths_sqrt(x_mm * x_mm + y_mm * y_mm);

        if (piece->kind == BORE_ARC && radius_mm < BORE_RADIUS_MIN_MM)
            return wrong("an arc of %.2g mm comes of it, and controllers take %g mm at least: a "
                         "larger hole or a smaller cutter, fewer turns, or lines",
                         radius_mm, BORE_RADIUS_MIN_MM);
    }
    return NULL;
}

/* Of all passes. The path is made for it: only then is its smallest arc known. */
static const char *check_arcs(const struct bore_job *job)
{
    const char *problem = NULL;

    for (int pass = BORE_ROUGHING; pass <= BORE_FINISHING && problem == NULL; pass++) {
        struct bore_path path = {0};

        if (!does(job, (enum bore_pass)pass))
            continue;
        bore_make_path(job, (enum bore_pass)pass, &path);
        problem = check_arcs_of(&path);
        bore_path_free(&path);
    }
    return problem;
}

static const char *check_depth(const struct bore_job *job)
{
    if (!(job->depth_mm >= 0))
        return wrong("the depth is %g mm: it must be 0 or more", job->depth_mm);
    if (!(job->depth_step_mm >= 0))
        return wrong("the depth step is %g mm: it must be greater than 0", job->depth_step_mm);
    if (job->depth_step_mm > 0 && job->depth_mm > BORE_DEPTH_STEPS_MAX * job->depth_step_mm)
        return wrong("the depth step of %g mm makes more than %d steps", job->depth_step_mm,
                     BORE_DEPTH_STEPS_MAX);
    if (!(job->height_mm > 0))
        return wrong("the height above the work is %g mm: it must be greater than 0",
                     job->height_mm);
    return NULL;
}

static const char *check_technology(const struct bore_job *job)
{
    if (!(job->feed_mm_min > 0))
        return wrong("the feed is %g mm/min: it must be greater than 0", job->feed_mm_min);
    if (!(job->plunge_mm_min > 0))
        return wrong("the feed down is %g mm/min: it must be greater than 0", job->plunge_mm_min);
    if (!(job->spindle_rpm >= 0))
        return wrong("the spindle's speed is %g rpm: it must be 0 or more", job->spindle_rpm);
    if ((job->as == BORE_AS_ARCS || job->as == BORE_AS_LINES) &&
        !(job->tolerance_mm >= BORE_TOLERANCE_MIN))
        return wrong("the tolerance is %g mm: it must be %g or more", job->tolerance_mm,
                     BORE_TOLERANCE_MIN);
    return NULL;
}

const char *bore_check(const struct bore_job *job)
{
    static const char *(*const checks[])(const struct bore_job *job) = {
        check_hole,  check_roughing,   check_finishing, check_start,
        check_depth, check_technology, check_arcs};
    const char *problem = NULL;

    for (size_t i = 0; i < sizeof checks / sizeof checks[0] && problem == NULL; i++)
        problem = checks[i](job);
    return problem;
}

void bore_set_spiral(const struct bore_job *job, enum bore_pass pass, struct bore_spiral *s)
{
    bore_spiral_set(s, circle_mm(job, pass), (unsigned)turns_of(job, pass));
    s->turned_rad = job->direction_rad;
    if (pass != begun(job))
        return;
    if (job->begin == BORE_AT_POINT)
        bore_spiral_begin_at(s, job->start_mm);
    else if (job->begin == BORE_AT_RADIUS)
        bore_spiral_begin_radius(s, job->start_radius_mm);
    else
        bore_spiral_begin_length(s, job->start_length_mm);
}

unsigned bore_depth_steps(const struct bore_job *job)
{
    if (job->depth_mm == 0 || job->depth_step_mm == 0)
        return 1;
    return (unsigned)maths_max(
        1, takt_maths_ceil(job->depth_mm / job->depth_step_mm * (1 - WHOLE_SLACK)));
}

static void spiral_at(const void *context, double parameter, double point_mm[2],
                      double direction[2])
{
    const struct bore_spiral *s = context;

    bore_spiral_point(s, parameter, point_mm);
    takt_maths_sincos(parameter + s->turned_rad, &direction[1], &direction[0]);
}

/* About the origin; the parameter is the heading. */
static void circle_at(const void *context, double parameter, double point_mm[2],
                      double direction[2])
{
    const struct bore_spiral *s = context;

    takt_maths_sincos(parameter, &direction[1], &direction[0]);
    point_mm[0] = s->radius_mm * direction[1];
    point_mm[1] = -s->radius_mm * direction[0];
}

static void add_spiral(const struct bore_job *job, const struct bore_spiral *s, struct bore_path *p)
{
    struct bore_curve curve = {s, spiral_at};
    struct bore_piece piece = {.kind = BORE_INVOLUTE, .base_mm = s->base_mm};
    double end = MATHS_TWO_PI * s->turns;

    switch (job->as) {
    case BORE_AS_HELIX: /* of roughing; this is a finishing pass */
    case BORE_AS_INVOLUTE:
        bore_spiral_point(s, end, piece.to_mm);
        bore_spiral_base_centre(s, piece.centre_mm);
        bore_path_add(p, &piece);
        break;
    case BORE_AS_ARCS:
        bore_approximate_arcs(p, &curve, s->start_rad, end, job->tolerance_mm);
        break;
    case BORE_AS_LINES:
        bore_approximate_lines(p, &curve, s->start_rad, end, job->tolerance_mm);
        break;
    }
}

/* The whole circle, from where the spiral ended. */
static void add_circle(const struct bore_job *job, const struct bore_spiral *s, struct bore_path *p)
{
    struct bore_curve curve = {s, circle_at};
    double centre[2] = {0, 0};

    if (job->as == BORE_AS_LINES)
        bore_approximate_lines(p, &curve, s->turned_rad, s->turned_rad + MATHS_TWO_PI,
                               job->tolerance_mm);
    else
        bore_path_arc(p, bore_path_start(p, p->count), centre);
}

/* A turn for each depth, and the circle. */
static void make_helix(const struct bore_job *job, struct bore_path *p)
{
    double from[2] = {0, -circle_mm(job, BORE_ROUGHING)};
    unsigned turns = bore_depth_steps(job);

    bore_path_begin(p, from);
    for (unsigned i = 0; i < turns; i++)
        bore_path_helix(p, job->depth_mm / turns);
    bore_path_helix(p, 0);
}

void bore_make_path(const struct bore_job *job, enum bore_pass pass, struct bore_path *p)
{
    struct bore_spiral s;
    double from[2];
    size_t approach;

    if (pass == BORE_ROUGHING && job->as == BORE_AS_HELIX) {
        make_helix(job, p);
        return;
    }
    bore_set_spiral(job, pass, &s);
    bore_spiral_point(&s, s.start_rad, from);
    bore_path_begin(p, from);
    add_spiral(job, &s, p);
    approach = p->count;
    add_circle(job, &s, p);
    if (pass == BORE_FINISHING)
        bore_path_add_mirrored(p, 0, approach);
}

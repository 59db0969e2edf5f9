#include "verifier/tube_verifier.h"

#include "base/maths.h"
#include "verifier/tube_segment.h"
#include "verifier/verifier_curve.h"

#include <string.h>

/* How far ahead of what has been left the path is looked for: steps, and tolerances. */
#define REACH_STEPS      4
#define REACH_TOLERANCES 20

/*
 * Where the setpoint is within the tolerance of the path up to this many elements (tube_path.h)
 * beyond the motion that is executed, no more are gone to; as many behind it are not left yet. What
 * the planner on board rounds at once has fewer (smooth/route.h).
 */
#define CROWD 128
/*
 * And no more than this many pieces: for circles of many turns within the tolerance work would grow
 * with their square.
 */
#define CROWD_PIECES 4096

/* The motion told may be so many off: curves over several have the number of one. */
#define NUMBER_ROOM 16

/* Steps to the nearest place of a curved curve. */
#define REFINE_STEPS 5

/* In the present step, this piece is not come to from the one before. */
#define NOT_ENTERED (-1.0)

/* The nearest of the places that a setpoint may be at. */
struct nearest {
    size_t piece;
    double part;         /* of the piece */
    double distance_mm;  /* from the piece, not from a curve that it is cut of */
    double of_tolerance; /* the same, as a part of the tolerance */
};

/* From the setpoint before to this one. */
struct stride {
    struct tube_segment segment;
    struct point to;
    uint32_t motion; /* that is said to be executed */
    double sag_mm;   /* by which a curve is off the segment, at most */
};

void tube_verifier_init(struct tube_verifier *t, const struct program_config *program,
                        const struct source *source, double exact_mm)
{
    memset(t, 0, sizeof *t);
    tube_path_init(&t->path, program, source, exact_mm);
    t->active = 1;
    t->last = program->start;
    t->before = program->start;
}

void tube_verifier_widen(struct tube_verifier *t, double tolerances)
{
    t->path.tolerances = tolerances;
}

void tube_verifier_free(struct tube_verifier *t)
{
    tube_path_free(&t->path);
}

static void raise_to(double *largest, double value)
{
    if (value > *largest)
        *largest = value;
}

static double within_of(const struct tube_piece *piece)
{
    return piece->motion->tolerance_mm + piece->motion->cut_mm;
}

/* How near a step must come to the end of a piece: an exact motion may lead into the next. */
static double within_end(const struct tube_piece *piece, const struct stride *step)
{
    const double within_mm = maths_max(within_of(piece), piece->motion->turning_mm);

    if (piece->motion->rounded && !piece->ends)
        return within_mm + step->sag_mm;
    return piece->motion->rounded ? within_mm : maths_max(within_mm, step->segment.length_mm / 2);
}

/*
 * Goes past the end of a piece, from this part of the step on. Returns the first part at which it
 * can, or NOT_ENTERED.
 */
static double pass_end(struct tube_piece *piece, const struct stride *step, double from)
{
    const struct point end = tube_segment_end(&piece->segment);
    const struct tube_beside b =
        tube_segment_beside(&step->segment, 0, &end, within_end(piece, step));

    piece->corner_mm = maths_min(piece->corner_mm, b.distance_mm);
    return b.first <= 1 && b.last >= from ? maths_max(b.first, from) : NOT_ENTERED;
}

/*
 * A piece come to in this step (from the part entered on), or before. Returns the same of the next
 * piece. Far from the end of a piece, where most setpoints are, only their own distance from it is
 * noted.
 */
static double follow_piece(struct tube_verifier *t, size_t k, const struct stride *step,
                           double entered, struct nearest *n)
{
    struct tube_piece *piece = tube_path_at(&t->path, k);
    const double from = entered >= 0 ? 0 : piece->from;
    const struct tube_beside b =
        tube_segment_beside(&piece->segment, from, &step->to, within_of(piece));
    const double of_tolerance = b.distance_mm / piece->motion->tolerance_mm;
    const double ahead_mm = (1 - b.part) * piece->segment.length_mm;
    double leaves = NOT_ENTERED;

    if (ahead_mm <= within_end(piece, step) + step->segment.length_mm)
        leaves = pass_end(piece, step, piece->reached ? 0 : entered);
    else
        piece->corner_mm = maths_min(
            piece->corner_mm, maths_sqrt(ahead_mm * ahead_mm + b.distance_mm * b.distance_mm));
    piece->reached = b.first <= 1;
    piece->from = piece->reached ? b.first : from;
    t->looks++;
    if (of_tolerance < n->of_tolerance)
        *n = (struct nearest){
            .piece = k, .part = b.part, .distance_mm = b.distance_mm, .of_tolerance = of_tolerance};
    return leaves;
}

static bool has_piece(struct tube_verifier *t, size_t k)
{
    return k < t->path.count || tube_path_extend(&t->path);
}

/* Is piece k far ahead of piece `from`? */
static bool is_far(const struct tube_verifier *t, size_t k, size_t from)
{
    const double ahead = tube_path_at(&t->path, k)->motion->elements -
                         tube_path_at(&t->path, from)->motion->elements;

    return ahead > CROWD || k > from + CROWD_PIECES;
}

/*
 * All places that the setpoint may be at now. False: there is none; *n is then the nearest of those
 * that were left.
 */
static bool follow(struct tube_verifier *t, const struct stride *step, struct nearest *n)
{
    double entered = NOT_ENTERED;
    size_t active = 0, said = 0;

    for (size_t k = 0; (k < t->active || entered >= 0) && has_piece(t, k); k++) {
        if (tube_path_at(&t->path, k)->motion->number <= step->motion)
            said = k;
        if (k >= t->active && is_far(t, k, said) && n->of_tolerance <= 1)
            break;
        if (entered < 0 && !tube_path_at(&t->path, k)->reached)
            continue;
        entered = follow_piece(t, k, step, entered, n);
        if (tube_path_at(&t->path, k)->reached)
            active = k + 1;
    }
    t->active = active;
    return active > 0;
}

/* The path has been left: it goes on at the nearest place within reach. */
static void find_again(struct tube_verifier *t, const struct stride *step)
{
    const double tolerance_mm = tube_path_at(&t->path, 0)->motion->tolerance_mm;
    const double reach_mm = REACH_STEPS * step->segment.length_mm + REACH_TOLERANCES * tolerance_mm;
    double ahead_mm = 0, least_mm = MATHS_INFINITY, part = 0;
    struct tube_piece *found;

    for (size_t k = 0; ahead_mm <= reach_mm && has_piece(t, k); k++) {
        const struct tube_piece *piece = tube_path_at(&t->path, k);
        const struct tube_beside b =
            tube_segment_beside(&piece->segment, piece->from, &step->to, 0);

        ahead_mm += (1 - piece->from) * piece->length_mm;
        if (b.distance_mm < least_mm) {
            least_mm = b.distance_mm;
            part = b.part;
            t->active = k + 1;
        }
    }
    for (size_t k = 0; k < t->active; k++)
        (void)pass_end(tube_path_at(&t->path, k), step, 0);
    found = tube_path_at(&t->path, t->active - 1);
    found->reached = true;
    found->from = part;
}

/* Steps along the tangent, as if the curve were straight: to where the setpoint lies across it. */
static double curve_distance(const struct tube_piece *piece, double part, const struct point *p)
{
    const struct curve *c = &piece->motion->curve;
    double s_mm = piece->from_mm + part * piece->length_mm;
    double fraction = s_mm / c->length_mm;
    double least = verifier_curve_distance(c, p, &fraction);

    for (int k = 0; k < REFINE_STEPS; k++) {
        struct point on, tangent;
        double along = 0, square = 0;

        takt_curve_point(c, s_mm, &on);
        least = maths_min(least, verifier_distance(&on, p));
        takt_curve_tangent(c, s_mm, &tangent);
        for (int i = 0; i < AXIS_COUNT; i++) {
            along += (p->at[i] - on.at[i]) * tangent.at[i];
            square += tangent.at[i] * tangent.at[i];
        }
        s_mm = maths_clamp(s_mm + along / square, 0, c->length_mm);
    }
    return least;
}

static double distance_from(const struct tube_piece *piece, const struct point *p)
{
    const struct tube_beside b = tube_segment_beside(&piece->segment, piece->from, p, 0);

    return piece->motion->cut_mm > 0 ? curve_distance(piece, b.part, p) : b.distance_mm;
}

/* What the path may be left by in all: no less than an exact motion. */
static double allowed_mm(const struct tube_verifier *t, const struct tube_piece *piece)
{
    return maths_max(piece->motion->tolerance_mm, t->path.exact_mm);
}

static void note_beyond(struct tube_verifier *t, double beyond_mm, uint32_t line)
{
    if (beyond_mm <= t->figures.beyond_mm)
        return;
    t->figures.beyond_mm = beyond_mm;
    t->figures.beyond_line = line;
}

/*
 * Could a setpoint so far from the piece raise any figure? A curve is looked at closely only then.
 */
static bool is_news(const struct tube_verifier *t, const struct tube_piece *piece,
                    double distance_mm)
{
    const double most_mm = distance_mm + piece->motion->cut_mm;

    return most_mm - allowed_mm(t, piece) > t->figures.beyond_mm ||
           (piece->motion->rounded &&
            (most_mm > t->figures.deviation_mm ||
             most_mm > t->figures.path_part * piece->motion->tolerance_mm));
}

/* The nearest of the places at which the setpoint may be; off the path the nearest one left. */
static void measure(struct tube_verifier *t, const struct point *p, struct nearest *n, bool left)
{
    const struct tube_piece *piece = tube_path_at(&t->path, n->piece);

    if (!is_news(t, piece, n->distance_mm))
        return;
    n->distance_mm = distance_from(piece, p);
    n->of_tolerance = n->distance_mm / piece->motion->tolerance_mm;
    for (size_t k = 0; k < t->active && !left; k++) {
        const struct tube_piece *other = tube_path_at(&t->path, k);
        const double distance_mm = other->reached ? distance_from(other, p) : MATHS_INFINITY;

        if (distance_mm < n->of_tolerance * other->motion->tolerance_mm) {
            n->distance_mm = distance_mm;
            n->of_tolerance = distance_mm / other->motion->tolerance_mm;
            piece = other;
        }
    }
    note_beyond(t, n->distance_mm - allowed_mm(t, piece), piece->motion->line);
    if (piece->motion->rounded) {
        raise_to(&t->figures.path_part, n->of_tolerance);
        raise_to(&t->figures.deviation_mm, n->distance_mm);
    }
}

/*
 * The corner at the end of the first piece, if it is one. A tap turns before it, which is verified
 * elsewhere.
 */
static void settle_corner(struct tube_verifier *t)
{
    const struct tube_piece *piece = tube_path_at(&t->path, 0);
    double tolerance_mm = allowed_mm(t, piece), corner_mm;
    struct point end;

    if (!piece->ends || piece->motion->turning_mm > 0)
        return;
    end = tube_segment_end(&piece->segment);
    corner_mm =
        maths_min(piece->corner_mm, verifier_distance(&t->last, &end)); /* if nothing came to it */
    if (t->path.count > 1)
        tolerance_mm = maths_min(tolerance_mm, allowed_mm(t, tube_path_at(&t->path, 1)));
    if (piece->motion->rounded) {
        raise_to(&t->figures.corner_part, corner_mm / piece->motion->tolerance_mm);
        raise_to(&t->figures.corner_mm, corner_mm);
    }
    if (piece->motion->rounded || !t->exact_elsewhere)
        note_beyond(t, corner_mm - tolerance_mm, piece->motion->line);
}

/* Pieces that have been left for good. */
static void drop_left(struct tube_verifier *t)
{
    while (!tube_path_at(&t->path, 0)->reached) {
        settle_corner(t);
        tube_path_drop(&t->path);
        t->active--;
    }
}

static double length_before(const struct tube_piece *piece, double part)
{
    const struct tube_motion *m = piece->motion;

    return takt_curve_is_rotary(&m->curve)
               ? m->travel_mm
               : m->travel_mm + piece->from_mm + part * piece->length_mm;
}

/* Is the setpoint on the motion that is executed, as is said? */
static bool is_believed(const struct tube_piece *piece, const struct stride *step)
{
    return piece->reached && piece->motion->number + NUMBER_ROOM >= step->motion &&
           piece->motion->number <= step->motion &&
           tube_segment_beside(&piece->segment, piece->from, &step->to, 0).distance_mm <=
               piece->motion->tolerance_mm;
}

/*
 * The first piece that is believed, of those far ahead of the first one; t->active: there is none.
 */
static size_t find_believed(struct tube_verifier *t, const struct stride *step)
{
    size_t k = t->active;

    if (!is_far(t, k - 1, 0))
        return k;
    for (k = 0; k < t->active; k++) {
        const struct tube_piece *piece = tube_path_at(&t->path, k);

        if (is_far(t, k, 0) && is_believed(piece, step))
            break;
    }
    return k;
}

/* Pieces far behind the executed motion are not gone back to, if their ends were reached. */
static void leave_crowd(struct tube_verifier *t, const struct stride *step)
{
    size_t k = find_believed(t, step);

    for (; k < t->active && k > 0; k--) {
        const struct tube_piece *piece = tube_path_at(&t->path, 0);

        if (!is_far(t, k, 0) || (piece->ends && piece->corner_mm > allowed_mm(t, piece)))
            return;
        settle_corner(t);
        tube_path_drop(&t->path);
        t->active--;
    }
}

/* |a - 2 b + c| */
static double bend_of(const struct point *a, const struct point *b, const struct point *c)
{
    double square = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double bend = a->at[i] - 2 * b->at[i] + c->at[i];

        square += bend * bend;
    }
    return maths_sqrt(square);
}

/* From the last setpoint to the next one, at the ends of which the way bends by so much. */
static struct stride step_to(const struct tube_verifier *t, double bend_mm)
{
    struct stride step = {.segment = {.start = t->last},
                          .to = t->next,
                          .motion = t->next_motion,
                          .sag_mm = bend_mm / 8};

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double way = t->next.at[i] - t->last.at[i];

        step.segment.way.at[i] = way;
        step.segment.square_mm2 += way * way;
    }
    step.segment.length_mm = maths_sqrt(step.segment.square_mm2);
    return step;
}

/* Behind the next setpoint the axes go on to another. */
static void verify_next(struct tube_verifier *t, const struct point *then)
{
    const double bend_mm = bend_of(&t->last, &t->next, then);
    const struct stride step = step_to(t, maths_max(t->bend_mm, bend_mm));
    struct nearest n = {.of_tolerance = MATHS_INFINITY};
    bool left;

    if (t->path.failed)
        return;
    left = !follow(t, &step, &n);
    measure(t, &step.to, &n, left);
    if (left)
        find_again(t, &step);
    t->figures.path_length_mm = length_before(tube_path_at(&t->path, n.piece), n.part);
    leave_crowd(t, &step);
    drop_left(t);
    t->before = t->last;
    t->last = step.to;
    t->bend_mm = bend_mm;
}

bool tube_verifier_add(struct tube_verifier *t, const struct point *setpoint, uint32_t motion)
{
    if (t->has_next)
        verify_next(t, setpoint);
    else
        t->bend_mm = bend_of(&t->before, &t->last, setpoint);
    t->next = *setpoint;
    t->next_motion = motion;
    t->has_next = true;
    return !t->path.failed;
}

void tube_verifier_stop(struct tube_verifier *t)
{
    const struct point rest = t->next;

    if (t->has_next)
        verify_next(t, &rest);
    t->has_next = false;
}

/*
 * The axes stand before this piece, which has not been come to: it must be near them all the same.
 */
static void measure_rest(struct tube_verifier *t, const struct tube_piece *piece)
{
    const double distance_mm = verifier_distance(&t->last, &piece->segment.start);

    if (piece->motion->rounded) {
        raise_to(&t->figures.path_part, distance_mm / piece->motion->tolerance_mm);
        raise_to(&t->figures.deviation_mm, distance_mm);
    }
    if (piece->motion->rounded || !t->exact_elsewhere)
        note_beyond(t, distance_mm - allowed_mm(t, piece), piece->motion->line);
}

/* All that can be read but its last piece has been left by now. */
static void leave_all(struct tube_verifier *t)
{
    while (has_piece(t, 1)) {
        settle_corner(t);
        tube_path_drop(&t->path);
        if (t->active > 1)
            t->active--;
        else
            measure_rest(t, tube_path_at(&t->path, 0));
    }
}

void tube_verifier_answer(struct tube_verifier *t, const struct program_answer *answer)
{
    tube_verifier_stop(t);
    if (t->path.failed)
        return;
    leave_all(t);
    if (!t->path.motion->probing)
        settle_corner(t);
    tube_path_answer(&t->path, answer);
    t->active = 1;
    t->figures.path_length_mm = t->path.travel_mm;
}

void tube_verifier_finish(struct tube_verifier *t)
{
    tube_verifier_stop(t);
    if (t->path.failed)
        return;
    leave_all(t);
    settle_corner(t);
    if (tube_path_at(&t->path, 0)->reached)
        t->figures.path_length_mm = t->path.travel_mm;
}

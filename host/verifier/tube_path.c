#include "verifier/tube_path.h"

#include "base/maths.h"

#include <stdlib.h>
#include <string.h>

/*
 * Pieces of curved curves are off by this part of the tolerance at most: so much more has the order
 * of places on them.
 */
#define CUT_PART 0.002

/* Lines that may be one element (smooth/merge.h). */
#define LINES_OF_ELEMENT 25

/* At first; it grows. */
#define CAPACITY 64

static bool grow(struct tube_path *p)
{
    const size_t capacity = p->capacity != 0 ? 2 * p->capacity : CAPACITY;
    struct tube_piece *grown = calloc(capacity, sizeof *grown);

    p->failed = grown == NULL;
    if (p->failed)
        return false;
    for (size_t k = 0; k < p->count; k++)
        grown[k] = *tube_path_at(p, k);
    free(p->piece);
    p->piece = grown;
    p->first = 0;
    p->capacity = capacity;
    return true;
}

static void leave_motion(struct tube_motion *m)
{
    if (m != NULL && --m->users == 0)
        free(m);
}

/* False: no memory; the last motion read is what it was. */
static bool begin_motion(struct tube_path *p, const struct tube_motion *motion)
{
    struct tube_motion *m = malloc(sizeof *m);

    p->failed = m == NULL;
    if (p->failed)
        return false;
    *m = *motion;
    m->users = 1;
    leave_motion(p->motion);
    p->motion = m;
    p->cut_to_mm = 0;
    return true;
}

/* NULL: no memory. */
static struct tube_piece *append(struct tube_path *p, const struct point *start,
                                 const struct point *end)
{
    struct tube_piece *piece;
    double square = 0;

    if (p->count == p->capacity && !grow(p))
        return NULL;
    p->count++;
    piece = tube_path_at(p, p->count - 1);
    piece->motion = p->motion;
    piece->motion->users++;
    piece->segment.start = *start;
    for (int i = 0; i < AXIS_COUNT; i++) {
        piece->segment.way.at[i] = end->at[i] - start->at[i];
        square += piece->segment.way.at[i] * piece->segment.way.at[i];
    }
    piece->segment.square_mm2 = square;
    piece->segment.length_mm = maths_sqrt(square);
    piece->reached = false;
    piece->from = 0;
    piece->corner_mm = MATHS_INFINITY;
    return piece;
}

/* Where the path begins, or goes on: as if a motion without length had been made there. */
static void append_point(struct tube_path *p)
{
    struct tube_piece *piece;

    const struct tube_motion none = {.number = p->motions,
                                     .tolerance_mm = p->exact_mm,
                                     .travel_mm = p->travel_mm,
                                     .elements = p->elements};

    if (!begin_motion(p, &none))
        return;
    piece = append(p, &p->end, &p->end);
    if (piece == NULL)
        return;
    piece->from_mm = 0;
    piece->length_mm = 0;
    piece->ends = false;
    piece->reached = true;
}

void tube_path_init(struct tube_path *p, const struct program_config *program,
                    const struct source *source, double exact_mm)
{
    memset(p, 0, sizeof *p);
    takt_program_open(&p->program, program, source);
    takt_cutter_compensation_open(&p->offset, program);
    p->exact_mm = exact_mm;
    p->tolerances = 1;
    p->end = program->start;
    append_point(p);
}

void tube_path_drop(struct tube_path *p)
{
    leave_motion(tube_path_at(p, 0)->motion);
    p->first = (p->first + 1) & (p->capacity - 1);
    p->count--;
}

static void drop_all(struct tube_path *p)
{
    while (p->count > 0)
        tube_path_drop(p);
}

void tube_path_free(struct tube_path *p)
{
    drop_all(p);
    leave_motion(p->motion);
    free(p->piece);
    p->motion = NULL;
    p->piece = NULL;
    p->capacity = 0;
}

/* A piece of length l is off a curve of curvature k by k l^2 / 8. */
static double straight_length(const struct tube_motion *m, double at_mm)
{
    struct point k;
    double square = 0;

    takt_curve_curvature(&m->curve, at_mm, &k);
    for (int i = 0; i < AXIS_COUNT; i++)
        square += k.at[i] * k.at[i];
    return maths_sqrt(8 * m->cut_mm / maths_sqrt(square));
}

static bool take_motion(struct tube_path *p, const struct move *move, const struct curve *curve)
{
    const bool rounded = move->path == PATH_BLEND && move->tolerance_mm > 0;
    const double tolerance_mm = rounded ? p->tolerances * move->tolerance_mm : p->exact_mm;

    p->elements += maths_clamp(curve->length_mm / (2 * tolerance_mm), 1.0 / LINES_OF_ELEMENT, 1);

    struct tube_motion motion = {
        .curve = *curve,
        .line = move->line,
        .number = p->motions,
        .rounded = rounded,
        .probing = move->kind == MOVE_PROBE,
        .tolerance_mm = tolerance_mm,
        .turning_mm = move->kind == MOVE_TAP ? TUBE_TURNING_REV * move->feed_rev_mm : 0,
        .travel_mm = p->travel_mm,
        .elements = p->elements,
        .cut_mm = curve->kind == CURVE_LINE ? 0 : CUT_PART * tolerance_mm};

    if (curve->kind == CURVE_ARC) /* its curvature falls or rises all along, by rounded decimals */
        motion.even_mm =
            maths_min(straight_length(&motion, 0), straight_length(&motion, curve->length_mm));
    p->cut_to = curve->start;
    if (!takt_curve_is_rotary(curve))
        p->travel_mm += curve->length_mm;
    return begin_motion(p, &motion);
}

static bool read_motion(struct tube_path *p)
{
    struct move move;
    struct diagnostic error;
    enum program_result result = PROGRAM_MOVE;

    while (!p->ended) {
        struct curve curve;
        const struct point start = p->end;

        result = takt_cutter_compensation_next(&p->offset, &p->program, &move, &error);
        p->ended = result != PROGRAM_MOVE && result != PROGRAM_WAIT;
        if (result != PROGRAM_MOVE)
            break;
        if (!move_is_motion(&move))
            continue;
        p->motions++;
        p->end = move.end;
        if (takt_move_curve(&move, &start, &curve))
            return take_motion(p, &move, &curve);
    }
    return false;
}

/*
 * Where the next piece of the motion ends: no curve is off a piece that is shorter than that by
 * more.
 */
static double next_cut(const struct tube_path *p)
{
    const struct tube_motion *m = p->motion;
    const double length_mm = m->curve.length_mm;
    double step_mm = m->even_mm;

    if (m->curve.kind == CURVE_LINE)
        return length_mm;
    if (step_mm == 0) {
        step_mm = straight_length(m, p->cut_to_mm);
        step_mm =
            maths_min(step_mm, straight_length(m, maths_min(p->cut_to_mm + step_mm, length_mm)));
    }
    step_mm = maths_max(step_mm, m->cut_mm);
    return p->cut_to_mm + step_mm < length_mm ? p->cut_to_mm + step_mm : length_mm;
}

bool tube_path_extend(struct tube_path *p)
{
    const struct curve *c;
    struct tube_piece *piece;
    struct point end;
    double to_mm;

    if (p->motion->curve.length_mm <= p->cut_to_mm && !read_motion(p))
        return false;
    c = &p->motion->curve;
    to_mm = next_cut(p);
    end = c->end;
    if (to_mm < c->length_mm)
        takt_curve_point(c, to_mm, &end);
    piece = append(p, &p->cut_to, &end);
    if (piece == NULL)
        return false;
    piece->from_mm = p->cut_to_mm;
    piece->length_mm = to_mm - p->cut_to_mm;
    piece->ends = to_mm >= c->length_mm;
    p->cut_to_mm = to_mm;
    p->cut_to = end;
    return true;
}

/* How far along a line. */
static double place_on_line(const struct curve *c, const struct point *at)
{
    double along = 0, square = 0;

    for (int i = 0; i < AXIS_COUNT; i++) {
        const double way = c->end.at[i] - c->start.at[i];

        along += (at->at[i] - c->start.at[i]) * way;
        square += way * way;
    }
    return c->length_mm * maths_clamp(along / square, 0, 1);
}

void tube_path_answer(struct tube_path *p, const struct program_answer *answer)
{
    const struct tube_motion *m = p->motion;

    if (m->probing) {
        if (!takt_curve_is_rotary(&m->curve))
            p->travel_mm = m->travel_mm + place_on_line(&m->curve, &answer->rest_at);
        p->end = answer->rest_at;
    }
    drop_all(p);
    append_point(p);
    takt_cutter_compensation_answer(&p->offset, &p->program, answer);
}

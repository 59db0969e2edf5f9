/* How a motion is divided, so that its pieces follow the corrected path. */
#include "base/maths.h"
#include "takt/offline_private.h"

/* Words have six decimals: what is written is this far from what was meant, at most, in each axis. */
#define WRITTEN_STEPS_PER_MM 1e6

/* Arcs of more than a third of a turn are never written. */
#define SWEEP_MAX_RAD (MATHS_TWO_PI / 3.0)

/* A piece is compared with the corrected path at so many inner points. */
#define SAMPLES 4

/* As it will be read: rounded to what is written. Rotary axes are written in degrees, finely enough. */
static double round_to_written(double mm)
{
    return maths_round(mm * WRITTEN_STEPS_PER_MM) / WRITTEN_STEPS_PER_MM;
}

static void corrected(struct offline_rewriter *r, const struct move *move, const struct point *at,
                      struct point *to)
{
    struct point k;
    double size = 0;

    correction_evaluate(&r->correction, at, move, &k);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        to->at[i] = at->at[i] + k.at[i];
        size += i < AXIS_LINEAR_COUNT ? k.at[i] * k.at[i] : 0;
    }
    r->totals.largest_mm = maths_max(r->totals.largest_mm, maths_sqrt(size));
}

static double distance(const struct point *a, const struct point *b)
{
    double square = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        square += (a->at[i] - b->at[i]) * (a->at[i] - b->at[i]);
    return maths_sqrt(square);
}

/* The point of the programmed motion at a part of its length. */
static void point_of(const struct curve *c, double part, struct point *at)
{
    curve_point(c, part * c->length_mm, at);
}

/*
 * The circle through three points a, m, b of a plane, by the perpendicular bisectors; relative to a:
 *
 *     2 (m - a) . c = |m - a|^2,   2 (b - a) . c = |b - a|^2
 */
static void circle_through(const struct point *a, const struct point *m, const struct point *b,
                           enum plane plane, double centre_mm[2])
{
    enum axis first, second;

    plane_axes(plane, &first, &second);
    const double mu = m->at[first] - a->at[first], mv = m->at[second] - a->at[second];
    const double bu = b->at[first] - a->at[first], bv = b->at[second] - a->at[second];
    const double mm = 0.5 * (mu * mu + mv * mv), bb = 0.5 * (bu * bu + bv * bv);
    const double d = mu * bv - mv * bu;

    centre_mm[0] = a->at[first] + (mm * bv - bb * mv) / d;
    centre_mm[1] = a->at[second] + (mu * bb - bu * mm) / d;
}

/* Piece k of n of a motion: from where the one before ended. */
static void set_piece(struct offline_rewriter *r, const struct move *move, const struct curve *c,
                      unsigned k, unsigned n, const struct point *from, struct offline_piece *piece)
{
    struct point at;

    if (k + 1 == n)
        at = move->end;
    else
        point_of(c, (double)(k + 1) / n, &at);
    corrected(r, move, &at, &piece->end);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        piece->end.at[i] = round_to_written(piece->end.at[i]);
    piece->arc = move_is_arc(move);
    if (piece->arc) {
        struct point middle;

        point_of(c, (k + 0.5) / n, &at);
        corrected(r, move, &at, &middle);
        circle_through(from, &middle, &piece->end, move->plane, piece->centre_mm);
    }
}

/* A piece as the machine will run it. */
static bool curve_of(const struct move *move, const struct point *from,
                     const struct offline_piece *piece, struct curve *c)
{
    struct move written = *move;

    written.end = piece->end;
    written.turns = 1;
    written.centre_mm[0] = piece->centre_mm[0];
    written.centre_mm[1] = piece->centre_mm[1];
    return move_curve(&written, from, c);
}

/* Largest distance of a piece from the corrected path, compared at equal parts of their length: no less than the true one. */
static double error_of(struct offline_rewriter *r, const struct move *move, const struct curve *c,
                       unsigned k, unsigned n, const struct point *from,
                       const struct offline_piece *piece)
{
    struct curve written;
    double worst = 0;

    if (!curve_of(move, from, piece, &written))
        return 0;
    for (unsigned i = 1; i < SAMPLES; i++) {
        const double part = (double)i / SAMPLES;
        struct point programmed, wanted, found;

        point_of(c, (k + part) / n, &programmed);
        corrected(r, move, &programmed, &wanted);
        point_of(&written, part, &found);
        worst = maths_max(worst, distance(&wanted, &found));
    }
    return worst;
}

static double divide_by(struct offline_rewriter *r, const struct move *move, const struct curve *c,
                        unsigned n, struct offline_piece *pieces)
{
    struct point from = r->written;
    double worst = 0;

    for (unsigned k = 0; k < n; k++) {
        set_piece(r, move, c, k, n, &from, &pieces[k]);
        worst = maths_max(worst, error_of(r, move, c, k, n, &from, &pieces[k]));
        from = pieces[k].end;
    }
    return worst;
}

unsigned offline_divide(struct offline_rewriter *r, const struct move *move,
                        struct offline_piece pieces[OFFLINE_PIECES_MAX])
{
    struct curve c;
    unsigned n = 1;
    double error;

    r->totals.motions++;
    if (!move_curve(move, &r->at, &c)) {
        set_piece(r, move, &c, 0, 1, &r->written, &pieces[0]);
        return 1;
    }
    if (move_is_arc(move))
        n = (unsigned)maths_ceil(maths_abs(c.arc.sweep_rad) / SWEEP_MAX_RAD);
    error = divide_by(r, move, &c, n, pieces);
    while (move->kind != MOVE_RAPID && error > r->tolerance_mm) {
        n *= 2;
        if (n > OFFLINE_PIECES_MAX) {
            r->wrong = "this motion would have to be divided into too many pieces: raise the "
                       "tolerance";
            r->wrong_line = move->line;
            return 0;
        }
        error = divide_by(r, move, &c, n, pieces);
    }
    if (move->kind != MOVE_RAPID)
        r->totals.error_mm = maths_max(r->totals.error_mm, error);
    return n;
}

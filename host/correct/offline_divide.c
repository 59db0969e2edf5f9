/*
 * How a motion is divided, so that its pieces follow the corrected path.
 *
 * Arcs: each piece is the circle through three corrected points. Involutes: what maps both ends of
 * a piece z to where they are corrected to, w, and keeps shapes, is
 *
 *     z -> a z + b,   a = (w1 - w0) / (z1 - z0),   b = w0 - a z0      (complex numbers of the plane)
 *
 * It makes of an involute another one, of the base circle a C + b, |a| r.
 */
#include "base/maths.h"
#include "correct/offline_private.h"
#include "geometry/involute.h"

/*
 * Words have six decimals: what is written is this far from what was meant, at most, in each axis.
 */
#define WRITTEN_STEPS_PER_MM 1e6

/* Up to this many of them are no change of a length. */
#define WRITTEN_STEPS 4.0

/* Arcs and involutes of more than a third of a turn are never written. */
#define SWEEP_MAX_RAD (MATHS_TWO_PI / 3.0)

/* Centres farther away are those of lines. */
#define CENTRE_MAX_MM 1e6

/* Ends of involutes that are nearly as far from the centre are refused where they are read. */
#define INVOLUTE_CLOSED_MM 4e-6

/*
 * A piece is compared with the corrected path at this many places, less one. Between them it may be
 * a little farther off: of a parabola nothing, of a cubic of the same three points 0.4 % of the
 * largest distance.
 */
#define SAMPLES      8
#define BETWEEN_PART 0.98

static bool is_curved(const struct move *move)
{
    return move_is_arc(move) || move_is_involute(move);
}

/*
 * As it will be read: rounded to what is written. Rotary axes are written in degrees, finely
 * enough.
 */
static double round_to_written(double mm)
{
    return takt_maths_round(mm * WRITTEN_STEPS_PER_MM) / WRITTEN_STEPS_PER_MM;
}

static void corrected(struct offline_rewriter *r, const struct move *move, const struct point *at,
                      struct point *to)
{
    struct point k;
    double size = 0;

    takt_correction_evaluate(&r->correction, at, move, &k);
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

/* Where a part of a curve ends: of its length; of an involute, of the turn of its heading. */
static double place_of(const struct curve *c, double part)
{
    if (c->kind != CURVE_INVOLUTE)
        return part * c->length_mm;
    const double from = takt_involute_unrolled(c, 0.0);
    const double to = takt_involute_unrolled(c, c->length_mm);

    return maths_clamp(takt_involute_place(c, from + part * (to - from)), 0.0, c->length_mm);
}

static void point_of(const struct curve *c, double part, struct point *at)
{
    takt_curve_point(c, place_of(c, part), at);
}

/*
 * The circle through three points a, m, b of a plane, by the perpendicular bisectors; relative to
 * a:
 *
 *     2 (m - a) . c = |m - a|^2,   2 (b - a) . c = |b - a|^2
 */
static void circle_through(const struct point *a, const struct point *m, const struct point *b,
                           enum plane plane, double centre_mm[2])
{
    enum axis first, second;

    takt_plane_axes(plane, &first, &second);
    const double mu = m->at[first] - a->at[first], mv = m->at[second] - a->at[second];
    const double bu = b->at[first] - a->at[first], bv = b->at[second] - a->at[second];
    const double mm = 0.5 * (mu * mu + mv * mv), bb = 0.5 * (bu * bu + bv * bv);
    const double d = mu * bv - mv * bu;

    centre_mm[0] = a->at[first] + (mm * bv - bb * mv) / d;
    centre_mm[1] = a->at[second] + (mu * bb - bu * mm) / d;
}

/* See the top. */
static void map_involute(const struct curve *c, const struct point *z0, const struct point *z1,
                         const struct point *w0, struct offline_piece *piece)
{
    const struct curve_involute *i = &c->involute;
    const unsigned u = i->first, v = i->second;
    const double zu = z1->at[u] - z0->at[u], zv = z1->at[v] - z0->at[v];
    const double wu = piece->end.at[u] - w0->at[u], wv = piece->end.at[v] - w0->at[v];
    const double square = zu * zu + zv * zv;
    const double au = (wu * zu + wv * zv) / square, av = (wv * zu - wu * zv) / square;
    const double cu = i->centre_mm[0] - z0->at[u], cv = i->centre_mm[1] - z0->at[v];

    piece->centre_mm[0] = w0->at[u] + au * cu - av * cv;
    piece->centre_mm[1] = w0->at[v] + av * cu + au * cv;
    piece->base_radius_mm = maths_sqrt(au * au + av * av) * i->radius_mm;
}

/* One of n equal parts of a motion. */
struct part {
    const struct move *move;
    bool straight; /* to be written as a line */
    const struct curve *c;
    unsigned k, n;
    struct point from; /* where the piece before ends, as written */
    struct point
        lead; /* how far that is from the corrected path: after layers have been switched, say */
};

static void point_in(const struct part *p, double part, struct point *at)
{
    point_of(p->c, (p->k + part) / p->n, at);
}

/*
 * Where the written path is to be: from the start of the first piece it is led onto the corrected
 * path.
 */
static void wanted_in(struct offline_rewriter *r, const struct part *p, double part,
                      struct point *wanted)
{
    struct point at;

    point_in(p, part, &at);
    corrected(r, p->move, &at, wanted);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        wanted->at[i] += (1.0 - part) * p->lead.at[i];
}

static void set_lead(struct offline_rewriter *r, struct part *p)
{
    struct point start;

    p->lead = (struct point){{0}};
    if (p->k > 0)
        return;
    corrected(r, p->move, &r->at, &start);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        p->lead.at[i] = p->from.at[i] - start.at[i];
}

static void set_piece(struct offline_rewriter *r, const struct part *p, struct offline_piece *piece)
{
    struct point at, middle;

    if (p->k + 1 == p->n)
        at = p->move->end;
    else
        point_in(p, 1.0, &at);
    corrected(r, p->move, &at, &piece->end);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        piece->end.at[i] = round_to_written(piece->end.at[i]);
    piece->share = (place_of(p->c, (p->k + 1.0) / p->n) - place_of(p->c, (double)p->k / p->n)) /
                   p->c->length_mm;
    piece->straight = p->straight;
    if (p->straight)
        return;
    if (move_is_arc(p->move)) {
        wanted_in(r, p, 0.5, &middle);
        circle_through(&p->from, &middle, &piece->end, p->move->plane, piece->centre_mm);
    } else if (move_is_involute(p->move)) {
        point_in(p, 0.0, &middle);
        map_involute(p->c, &middle, &at, &p->from, piece);
    }
}

/* The circle through three points of a line has no centre to be written. */
static bool has_centre(const struct offline_piece *piece)
{
    return maths_abs(piece->centre_mm[0]) < CENTRE_MAX_MM &&
           maths_abs(piece->centre_mm[1]) < CENTRE_MAX_MM;
}

/* A piece as the machine will run it. */
static bool curve_of(const struct move *move, const struct point *from,
                     const struct offline_piece *piece, struct curve *c)
{
    struct move written = *move;

    if (piece->straight || !is_curved(move))
        return takt_curve_set_line(c, from, &piece->end);
    written.end = piece->end;
    written.turns = 1;
    written.centre_mm[0] = piece->centre_mm[0];
    written.centre_mm[1] = piece->centre_mm[1];
    written.base_radius_mm = piece->base_radius_mm;
    return has_centre(piece) && takt_move_curve(&written, from, c);
}

/*
 * Largest distance of a piece from the corrected path, compared at equal parts of both: no less
 * than the true one.
 */
static double error_of(struct offline_rewriter *r, const struct part *p,
                       const struct offline_piece *piece)
{
    struct curve written;
    double worst = 0;

    if (!curve_of(p->move, &p->from, piece, &written))
        return is_curved(p->move) && !p->straight ? MATHS_INFINITY : 0;
    for (unsigned i = 1; i < SAMPLES; i++) {
        struct point wanted, found;

        wanted_in(r, p, (double)i / SAMPLES, &wanted);
        point_of(&written, (double)i / SAMPLES, &found);
        worst = maths_max(worst, distance(&wanted, &found));
    }
    return worst;
}

static double divide_by(struct offline_rewriter *r, const struct move *move, const struct curve *c,
                        bool straight, unsigned n, struct offline_piece *pieces)
{
    struct part part = {.move = move, .straight = straight, .c = c, .n = n, .from = r->written};
    double worst = 0;

    for (part.k = 0; part.k < n; part.k++) {
        set_lead(r, &part);
        set_piece(r, &part, &pieces[part.k]);
        worst = maths_max(worst, error_of(r, &part, &pieces[part.k]));
        part.from = pieces[part.k].end;
    }
    return worst;
}

/* Nothing to divide: only the end is corrected. */
static unsigned set_end(struct offline_rewriter *r, const struct move *move,
                        struct offline_piece *piece)
{
    *piece = (struct offline_piece){.share = 1.0, .pitch_mm = move->feed_rev_mm};
    corrected(r, move, &move->end, &piece->end);
    for (unsigned i = 0; i < AXIS_LINEAR_COUNT; i++)
        piece->end.at[i] = round_to_written(piece->end.at[i]);
    return 1;
}

static bool is_thread(const struct move *move)
{
    return move->kind == MOVE_THREAD || move->kind == MOVE_TAP;
}

/* A thread that has become longer has as many turns as before. */
static unsigned keep_whole(struct offline_rewriter *r, const struct move *move,
                           const struct curve *c, struct offline_piece *piece)
{
    const double error_mm = divide_by(r, move, c, false, 1, piece);
    struct curve written;

    piece->pitch_mm = move->feed_rev_mm;
    if (curve_of(move, &r->written, piece, &written) &&
        maths_abs(written.length_mm - c->length_mm) > WRITTEN_STEPS / WRITTEN_STEPS_PER_MM)
        piece->pitch_mm *= written.length_mm / c->length_mm;
    if (error_mm > r->totals.thread_error_mm) {
        r->totals.thread_error_mm = error_mm;
        r->totals.thread_line = move->line;
    }
    return 1;
}

static unsigned least_pieces(const struct curve *c)
{
    double sweep_rad = 0;

    if (c->kind == CURVE_ARC)
        sweep_rad = c->arc.sweep_rad;
    else if (c->kind == CURVE_INVOLUTE)
        sweep_rad = takt_involute_unrolled(c, c->length_mm) - takt_involute_unrolled(c, 0.0);
    return (unsigned)maths_max(1.0, takt_maths_ceil(maths_abs(sweep_rad) / SWEEP_MAX_RAD));
}

static double radius_at(const struct point *at, const struct move *move,
                        const struct offline_piece *piece)
{
    enum axis first, second;

    takt_plane_axes(move->plane, &first, &second);
    const double u = at->at[first] - piece->centre_mm[0];
    const double v = at->at[second] - piece->centre_mm[1];

    return maths_sqrt(u * u + v * v);
}

/* Will all pieces of an involute be read as involutes? */
static bool can_be_read(const struct offline_rewriter *r, const struct move *move,
                        const struct offline_piece *pieces, unsigned n)
{
    const struct point *from = &r->written;

    for (unsigned k = 0; k < n && move_is_involute(move) && !pieces[k].straight; k++) {
        const double change_mm =
            radius_at(&pieces[k].end, move, &pieces[k]) - radius_at(from, move, &pieces[k]);

        if (!(maths_abs(change_mm) > INVOLUTE_CLOSED_MM))
            return false;
        from = &pieces[k].end;
    }
    return true;
}

/*
 * As curves of their kind, or as lines. Returns how many pieces; 0: they do not keep the tolerance.
 */
static unsigned divide_as(struct offline_rewriter *r, const struct move *move,
                          const struct curve *c, bool straight, struct offline_piece *pieces)
{
    const double least_mm =
        move->kind == MOVE_RAPID ? MATHS_INFINITY : BETWEEN_PART * r->tolerance_mm;

    for (unsigned n = least_pieces(c); n <= OFFLINE_PIECES_MAX; n *= 2) {
        const double error_mm = divide_by(r, move, c, straight, n, pieces);

        if (error_mm > least_mm)
            continue;
        if (move->kind != MOVE_RAPID)
            r->totals.error_mm = maths_max(r->totals.error_mm, error_mm);
        return can_be_read(r, move, pieces, n) ? n : 0;
    }
    return 0;
}

unsigned offline_divide(struct offline_rewriter *r, const struct move *move,
                        struct offline_piece pieces[OFFLINE_PIECES_MAX])
{
    struct curve c;
    unsigned n;

    r->totals.motions++;
    if (!takt_move_curve(move, &r->at, &c))
        return set_end(r, move, &pieces[0]);
    if (is_thread(move))
        return keep_whole(r, move, &c, &pieces[0]);
    n = divide_as(r, move, &c, false, pieces);
    if (n == 0 && is_curved(move))
        n = divide_as(r, move, &c, true, pieces);
    if (n == 0) {
        r->wrong = "this motion would have to be divided into too many pieces: raise the tolerance";
        r->wrong_line = move->line;
    }
    return n;
}

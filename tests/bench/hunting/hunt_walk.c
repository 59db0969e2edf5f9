#include "hunt_walk.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

/* Feed is compared over each of these numbers of cycles. */
static const size_t windows[] = {1, 16, 256};
#define WINDOWS (sizeof windows / sizeof windows[0])

/* Setpoints that are the same so often are a stop. */
#define STANDING_CYCLES 3

/*
 * A stop is not asked for where the path bends by less than this, cosine of the angle: 20 degrees,
 * and a kink.
 */
#define SMOOTH_COSINE 0.94
#define EXACT_COSINE  (1 - 1e-8)

static const struct span nowhere = {2, -1};

/*
 * The parts f of a segment with |p - start - f way| <= within:
 * |f - g| <= sqrt((within^2 - d^2) / way^2).
 */
static struct span near(unsigned axes, const double *start, const double *way, double square_mm2,
                        const double *p, double within_mm)
{
    double closest = 0, square = 0, half;

    for (unsigned i = 0; i < axes; i++)
        closest += (p[i] - start[i]) * way[i];
    closest = square_mm2 > 0 ? closest / square_mm2 : 0;
    for (unsigned i = 0; i < axes; i++) {
        const double off = p[i] - start[i] - closest * way[i];

        square += off * off;
    }
    if (square > within_mm * within_mm)
        return nowhere;
    if (square_mm2 <= 0)
        return (struct span){0, 1};
    half = sqrt((within_mm * within_mm - square) / square_mm2);
    return (struct span){fmax(closest - half, 0), fmin(closest + half, 1)};
}

static bool is_there(struct span s)
{
    return s.first <= s.last;
}

static struct span from_on(struct span s, double first)
{
    return (struct span){fmax(s.first, first), s.last};
}

/* The longer one of the steps before and after that to row k. */
static double beside_step(const struct verifier *j, size_t k)
{
    double before[AXES_MAX], after[AXES_MAX];

    step_of(j, k > 0 ? k - 1 : 0, before);
    step_of(j, k + 1, after);
    return fmax(length_of(before, 0, j->axes), length_of(after, 0, j->axes));
}

/*
 * How far the end of a piece may be from step k (from row k - 1 to row k). On an exact path it is
 * gone through on the way from one setpoint to the next: half of that way from the nearer one at
 * most. As long as that are the steps beside it; or there, where one junction alone is passed,
 * differ so much.
 */
static double end_within(const struct verifier *j, size_t piece, size_t k, double factor)
{
    const struct piece *p = &j->piece[piece];
    const struct motion *m = &j->motion[p->motion];
    const double bend_mm = fmax(j->bend[k > 0 ? k - 1 : 0], j->bend[k]);
    double within_mm = p->tolerance_mm;

    if (p->ends && m->stops)
        return 4 * ROUNDING * factor;
    if (piece + 1 < j->pieces)
        within_mm = fmin(within_mm, j->piece[piece + 1].tolerance_mm);
    if (m->tolerance_mm > 0)
        return within_mm * factor + bend_mm / 8;
    return within_mm * factor + fmax(bend_mm, beside_step(j, k)) / 2;
}

/* Most that the step goes along any of the pieces it may be on. */
static void go_along(const struct verifier *j, struct walk *w, size_t piece, const double *step)
{
    const struct piece *p = &j->piece[piece];
    double along = 0;

    for (unsigned i = 0; i < j->axes; i++)
        along += step[i] * p->way[i];
    w->along_mm = fmax(w->along_mm, p->length_mm > 0 ? along / p->length_mm : 0);
    w->tolerance_mm = fmax(w->tolerance_mm, j->motion[p->motion].tolerance_mm);
    w->last = piece;
    if (w->first > piece)
        w->first = piece;
}

static const double *end_of(const struct verifier *j, size_t piece)
{
    return piece + 1 < j->pieces ? j->piece[piece + 1].start : j->motion[j->motions - 1].end;
}

/* One step, from row k - 1 to row k: the places that its end may be at. False: there is none. */
static bool advance(struct verifier *j, struct walk *w, size_t k, double factor, size_t *low,
                    size_t *high)
{
    const double *from = row_of(j, k > 0 ? k - 1 : 0), *to = row_of(j, k);
    struct span entered = k == 0 ? (struct span){0, 1} : nowhere;
    double step[AXES_MAX], square;
    size_t first = j->pieces, last = 0, n = *low;

    step_of(j, k, step);
    square = pow(length_of(step, 0, j->axes), 2);
    w->first = j->pieces;
    w->along_mm = -(double)INFINITY;
    w->tolerance_mm = 0;
    for (; n < j->pieces && (n <= *high || is_there(entered)); n++) {
        const struct piece *p = &j->piece[n];
        const struct span old = j->reach[n];
        const bool was = k > 0 && n <= *high && is_there(old);
        struct span now, end;

        j->work++;
        j->reach[n] = nowhere;
        if (!was && !is_there(entered))
            continue;
        now = near(j->axes, p->start, p->way, p->square_mm2, to, p->tolerance_mm * factor);
        j->reach[n] = is_there(entered) ? now : from_on(now, old.first);
        go_along(j, w, n, step);
        end = near(j->axes, from, step, square, end_of(j, n), end_within(j, n, k, factor));
        entered = was ? end : from_on(end, entered.first);
        if (is_there(j->reach[n])) {
            last = n;
            first = first < n ? first : n;
        }
    }
    *low = first;
    *high = last;
    return first < j->pieces;
}

/* The part of the motion at which the setpoint lies across it; steps along the tangent. */
static double curve_distance(const struct verifier *j, const struct piece *p, struct span reach,
                             const double *x)
{
    const struct motion *m = &j->motion[p->motion];
    double part = p->from + (reach.first + reach.last) / 2 * (p->to - p->from),
           least = (double)INFINITY;

    for (int i = 0; i < 6; i++) {
        double on[AXES_MAX], ahead[AXES_MAX], along = 0, square = 0, off[AXES_MAX];
        const double h = 1e-4 * (p->to - p->from);

        place(j, m, part, on);
        place(j, m, part + h, ahead);
        for (unsigned a = 0; a < j->axes; a++) {
            const double t = (ahead[a] - on[a]) / h;

            off[a] = x[a] - on[a];
            along += off[a] * t;
            square += t * t;
        }
        least = fmin(least, length_of(off, 0, j->axes));
        part += square > 0 ? along / square : 0;
        part = fmin(fmax(part, 0), 1);
    }
    return least;
}

static double time_at(const struct verifier *j, size_t piece, double part, const double *before)
{
    const struct piece *p = &j->piece[piece];

    return before[p->motion] + j->motion[p->motion].time_s * (p->from + part * (p->to - p->from));
}

/*
 * Faster than programmed? In exact path by the time that the way would have taken: what a tolerance
 * cuts off is no haste.
 */
static void verify_exact_feed(const struct verifier *j, struct walk *w, size_t k, unsigned line)
{
    for (size_t i = 0; i < WINDOWS; i++) {
        const size_t n = windows[i];
        const double allowed = (double)n * j->cycle_s * j->feed_factor;

        if (w->exact_rows > n)
            note(&w->feed_ratio, &w->feed_line, (w->time_s[0][k] - w->time_s[1][k - n]) / allowed,
                 line);
    }
}

/*
 * Within a tolerance by the step's length, where all motions it may belong to are of one kind: over
 * the axes that a feed of that kind counts, X Y Z, or A B C of motions of those alone, as time_s
 * does. What rounding moves the others by, on the way to a motion of theirs, is bounded by the
 * tolerance, and is no part of F.
 */
static void verify_feed(const struct verifier *j, struct walk *w, size_t k)
{
    double step[AXES_MAX], most = 0;
    bool linear = true, turning = true;

    for (size_t n = w->first; n <= w->last; n++) {
        const struct motion *m = &j->motion[j->piece[n].motion];

        if (m->is_rapid)
            return;
        linear = linear && m->turning_rad <= 0;
        turning = turning && m->linear_mm <= 0;
        most = fmax(most, (m->linear_mm > 0 ? m->linear_mm : m->turning_rad) / m->time_s);
    }
    if (linear == turning)
        return;
    step_of(j, k, step);
    const double counted =
        linear ? length_of(step, 0, j->linear_axes) : length_of(step, j->linear_axes, j->axes);

    note(&w->feed_ratio, &w->feed_line,
         (counted - 4 * ROUNDING) / j->cycle_s / most / j->feed_factor,
         j->motion[j->piece[w->first].motion].line);
}

static bool has_rounded(const struct verifier *j, const struct walk *w)
{
    for (size_t n = w->first; n <= w->last; n++) {
        if (j->motion[j->piece[n].motion].tolerance_mm > 0)
            return true;
    }
    return false;
}

/* Sum of |t_k - t_k-1|, t the tangents of pieces, from one to another. */
static double turn_between(const struct verifier *j, size_t from, size_t to)
{
    double turn = 0;

    for (size_t n = from + 1; n <= to; n++) {
        const struct piece *a = &j->piece[n - 1], *b = &j->piece[n];
        double d[AXES_MAX];

        for (unsigned i = 0; i < j->axes; i++)
            d[i] =
                b->way[i] / fmax(b->length_mm, DBL_MIN) - a->way[i] / fmax(a->length_mm, DBL_MIN);
        turn += length_of(d, 0, j->axes);
    }
    return turn;
}

/*
 * Backwards against every piece that it may be on. A curve in order may do so by 2 P: from P before
 * a place of the path to P behind it. In all, with setpoints x_k = p_k + e_k, |e_k| <= P, beside
 * places p_k that only go on, and the tangents t_k there,
 *
 *     sum (x_k+1 - x_k) t_k >= sum (e_k+1 - e_k) t_k = e_n t_n-1 - e_0 t_0 - sum e_k (t_k - t_k-1) >= -P (2 + sum |t_k - t_k-1|)
 *
 * So what a curve may go back by is what the path turns by meanwhile, and 2.
 */
static void verify_back(const struct verifier *j, struct walk *w, size_t k)
{
    double step[AXES_MAX];

    step_of(j, k, step);
    if (w->back_mm <= 0)
        w->back_first = w->first;
    if (w->along_mm < 0)
        w->back_mm -= w->along_mm;
    else
        w->back_mm = fmax(0, w->back_mm - length_of(step, 0, j->axes));
    if (w->tolerance_mm > 0 && w->back_mm > w->back_part * w->tolerance_mm)
        note(&w->back_part, &w->back_line,
             w->back_mm / w->tolerance_mm - turn_between(j, w->back_first, w->last),
             j->motion[j->piece[w->first].motion].line);
}

/* The part of a piece; nothing of one that is touched, but left. */
static double part_of(double part)
{
    return part >= 0 && part <= 1 ? part : 0;
}

/* Does the path go on smoothly some way before and after the pieces touched, with no stop there? */
static bool is_smooth(const struct verifier *j, const struct walk *w)
{
    const bool rounded = has_rounded(j, w);
    const double cosine = rounded ? SMOOTH_COSINE : EXACT_COSINE;
    const double reach_mm = 4 * j->piece[w->first].tolerance_mm;
    const struct piece *middle = &j->piece[w->first];
    size_t first = w->first, last = w->last;
    double before_mm = part_of(j->reach[first].first) * middle->length_mm;
    double after_mm = part_of(1 - j->reach[last].last) * j->piece[last].length_mm;

    while (before_mm < reach_mm) {
        if (first-- == 0)
            return false;
        before_mm += j->piece[first].length_mm;
    }
    while (after_mm < reach_mm) {
        if (++last == j->pieces)
            return false;
        after_mm += j->piece[last].length_mm;
    }
    for (size_t n = first; n <= last; n++) {
        const struct piece *p = &j->piece[n];
        const struct motion *m = &j->motion[p->motion];
        double dot = 0;

        for (unsigned i = 0; i < j->axes; i++)
            dot += p->way[i] * middle->way[i];
        if (dot < cosine * p->length_mm * middle->length_mm || (p->ends && m->stops) ||
            (m->tolerance_mm > 0) != rounded)
            return false;
    }
    return true;
}

static void verify_standing(const struct verifier *j, struct walk *w, size_t k)
{
    double step[AXES_MAX];

    step_of(j, k, step);
    w->standing = length_of(step, 0, j->axes) <= 2 * ROUNDING ? w->standing + 1 : 0;
    if (w->standing != STANDING_CYCLES || !is_smooth(j, w))
        return;
    w->stops++;
    if (w->stops == 1)
        w->stop_line = j->motion[j->piece[w->first].motion].line;
}

static void verify_exact(const struct verifier *j, struct walk *w, size_t k, size_t low,
                         size_t high, const double *before)
{
    double least = (double)INFINITY;
    const unsigned line = j->motion[j->piece[low].motion].line;

    for (size_t n = low; n <= high; n++) {
        if (is_there(j->reach[n]))
            least = fmin(least, curve_distance(j, &j->piece[n], j->reach[n], row_of(j, k)));
    }
    note(&w->off_mm, &w->off_line, least, line);
    w->exact_rows++;
    w->time_s[0][k] = time_at(j, low, j->reach[low].first, before);
    w->time_s[1][k] = time_at(j, high, j->reach[high].last, before);
    verify_exact_feed(j, w, k, line);
}

/* Does the last row lead on to where the path must end? */
static bool is_done(const struct verifier *j, size_t high)
{
    return !j->completed || (high + 1 == j->pieces && j->reach[high].last >= 1);
}

struct walk walk_along(struct verifier *j, double factor, bool closely, const double *before)
{
    struct walk w = {0};
    size_t low = 0, high = 0;

    if (closely) {
        w.time_s[0] = make(j->rows, sizeof(double));
        w.time_s[1] = make(j->rows, sizeof(double));
    }
    for (size_t k = 0; k < j->rows; k++) {
        if (!advance(j, &w, k, factor, &low, &high)) {
            w.lost_row = k;
            break;
        }
        if (j->work > j->work_most) {
            w.tired_row = k + 1;
            break;
        }
        if (!closely)
            continue;
        if (!has_rounded(j, &w))
            verify_exact(j, &w, k, low, high, before);
        else
            w.exact_rows = 0;
        if (w.exact_rows == 0 && k > 0)
            verify_feed(j, &w, k);
        if (k > 0) {
            verify_back(j, &w, k);
            verify_standing(j, &w, k);
        }
        w.arrived = k + 1 == j->rows && is_done(j, high);
    }
    if (!closely)
        w.arrived = w.lost_row == 0 && w.tired_row == 0 && is_done(j, high);
    free(w.time_s[0]);
    free(w.time_s[1]);
    return w;
}

double least_factor(struct verifier *j)
{
    double low = 1, high = 1.1;

    while (!walk_along(j, high, false, NULL).arrived) {
        low = high;
        high *= 1.5;
        if (high > 1e6 || j->work > j->work_most)
            return 1.001 * low;
    }
    while (high > 1.001 * low && j->work <= j->work_most) {
        const double middle = sqrt(low * high);

        if (walk_along(j, middle, false, NULL).arrived)
            high = middle;
        else
            low = middle;
    }
    return high;
}

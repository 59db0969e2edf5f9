#include "replay/halt.h"

#include "base/assert.h"
#include "base/maths.h"

/* Parts of what a cycle may use that the way to rest is reckoned with. */
#define WAY_CHANGE 0.95
#define WAY_SECOND 0.85

/* Halvings of what a cycle may change the change by. */
#define HALVINGS 10

/* Cycles of a landing at most: it goes on whatever is ordered meanwhile. */
#define LANDING_MAX 200.0
#define HOP_MAX     64.0

/* Part of what the change may change by that a landing uses at most. */
#define LANDING_SECOND 0.95

static double change_max(const struct rate *r)
{
    TAKT_ASSERT(r->limits.change > 0.0 && r->limits.kept > 0.0 && r->limits.kept < 1.0);
    return r->limits.change * (1.0 - r->limits.kept * HALT_RATE * HALT_RATE);
}

static double second_max(const struct rate *r)
{
    return r->limits.room * (1.0 - r->limits.kept * HALT_RATE * HALT_RATE * HALT_RATE);
}

bool takt_halt_is_possible(const struct rate *r)
{
    return r->now <= HALT_RATE && maths_abs(r->change) <= change_max(r) &&
           (r->change >= 0.0 ||
            r->now >= 0.5 * r->change * r->change / (WAY_SECOND * second_max(r)));
}

double takt_halt_way(const struct rate *r)
{
    const double m = WAY_SECOND * second_max(r);
    const double t = r->change / m;
    const double high = r->now + 0.5 * r->change * t;
    const double c = maths_min(WAY_CHANGE * change_max(r), maths_sqrt(m * high));
    const double begun =
        t >= 0.0 ? (r->now + r->change * t / 3.0) * t : (high - m * t * t / 6.0) * t;

    TAKT_ASSERT(!(high > 0.0) || c > 0.0);
    return high > 0.0 ? begun + 0.5 * high * (high / c + c / m) : 0.0;
}

static double second_towards(const struct rate *r, double to)
{
    return takt_rate_second(r, to, second_max(r), second_max(r), change_max(r));
}

static bool fits(const struct rate *r, double second, double way)
{
    struct rate next = *r;
    const double here = takt_rate_change_by(&next, second);

    return here + takt_halt_way(&next) <= way;
}

/*
 * The largest second difference up to most from which the rest of the way is enough; no less than
 * braking to the rate 0 needs.
 */
static double find_second(const struct rate *r, double most, double way)
{
    double low = second_towards(r, 0.0);
    double high = most;

    if (high <= low || fits(r, high, way)) {
        return high;
    }
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);

        if (fits(r, middle, way)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* One cycle leads to the rate that it is to be, from where the way is enough. */
static bool settles(struct rate *r, double to, double way, double *here)
{
    struct rate next = *r;

    takt_rate_set(&next, to);
    *here = 0.5 * (r->now + to);
    if (!rate_settles(r, to, second_max(r)) || *here + takt_halt_way(&next) > way) {
        return false;
    }
    *r = next;
    return true;
}

/*
 * A landing: u(t) = r t + c t^2 / 2 + a3 t^3 + a4 t^4 + a5 t^5 is at the end of the way w, at rest,
 * after n cycles:
 *
 *     a3 = (20 w - 12 r n - 3 c n^2) / 2 n^3,  a4 = (-30 w + 16 r n + 3 c n^2) / 2 n^4,  a5 = (12 w - 6 r n - c n^2) / 2 n^5
 */
struct halt_curve {
    double a3, a4, a5;
};

static struct halt_curve curve_of(const struct rate *r, double way, double n)
{
    const double rn = r->now * n;
    const double cn = r->change * n * n;
    const double half = 0.5 / (n * n * n);

    TAKT_ASSERT(n >= 1.0);
    return (struct halt_curve){(20.0 * way - 12.0 * rn - 3.0 * cn) * half,
                               (-30.0 * way + 16.0 * rn + 3.0 * cn) * half / n,
                               (12.0 * way - 6.0 * rn - cn) * half / (n * n)};
}

/* The state after t cycles of it; returns how far it has led. */
static double curve_at(const struct halt_curve *l, struct rate *r, double t)
{
    const double now = r->now;
    const double change = r->change;

    r->now = now + (change + (3.0 * l->a3 + (4.0 * l->a4 + 5.0 * l->a5 * t) * t) * t) * t;
    r->change = change + (6.0 * l->a3 + (12.0 * l->a4 + 20.0 * l->a5 * t) * t) * t;
    return (now + (0.5 * change + (l->a3 + (l->a4 + l->a5 * t) * t) * t) * t) * t;
}

/*
 * u"' = 6 a3 + 24 a4 t + 60 a5 t^2 is within the bounds of rate.h and never negative, so that the
 * rate and its change only fall, in size, to 0. Where it is least or most: at the ends, and at
 * t = -a4 / 5 a5, by -12 a4^2 / 5 a5.
 */
static bool is_good(const struct halt_curve *l, const struct rate *r, double n)
{
    const double most =
        LANDING_SECOND * r->limits.room * (1.0 - r->limits.kept * r->now * r->now * r->now);
    const double begin = 6.0 * l->a3;
    const double end = begin + (24.0 * l->a4 + 60.0 * l->a5 * n) * n;
    double middle = begin;

    if (-l->a4 * l->a5 > 0.0 && maths_abs(l->a4) < maths_abs(5.0 * l->a5) * n) {
        middle -= 2.4 * l->a4 * l->a4 / l->a5;
    }
    return maths_min(maths_min(begin, end), middle) >= 0.0 &&
           maths_max(maths_max(begin, end), middle) <= most;
}

/*
 * Cycles of a landing that begins at rest, whose rate is 15 w / 8 n at most, its change 10
 * w / (sqrt 3 n^2) and that one's change 60 w / n^3. 0: so many that it had better be driven as
 * ordered.
 */
static double hop_cycles(const struct rate *r, double to, double way)
{
    const double by_change = maths_sqrt(5.7735027 * way / change_max(r));
    const double n = takt_maths_ceil(maths_max(
        maths_max(takt_maths_cbrt(60.0 * way / second_max(r)), by_change), 1.875 * way / to));

    TAKT_ASSERT(to > 0.0 && way >= 0.0);
    return n <= HOP_MAX ? maths_max(n, 1.0) : 0.0;
}

/*
 * For one that ends braking, where the way is M t^3 / 6 and the rate M t^2 / 2 of the time left. 0:
 * not yet.
 */
static double brake_cycles(const struct rate *r, double way)
{
    const double n =
        r->change < 0.0 && r->now > 0.0 ? takt_maths_ceil(3.0 * way / r->now) : LANDING_MAX + 1.0;

    if (n > LANDING_MAX) {
        return 0.0;
    }
    const struct halt_curve l = curve_of(r, way, n);

    return is_good(&l, r, n) ? n : 0.0;
}

/*
 * May the rest of the way be led in one cycle? The ways of the cycles before were r - c / 2 and c
 * less, but for the last change of the change, and those behind it are 0: third differences within
 * the room, which is 0.4 of what there is.
 */
static bool is_at_end(const struct rate *r, double way)
{
    const double room = r->limits.room;
    const double before = r->now - 0.5 * r->change;

    return way <= room && maths_abs(way - before - r->change) <= room &&
           maths_abs(before - 2.0 * way) <= room;
}

static bool begins_landing(struct halt *h, const struct rate *r, double to, double way)
{
    if (is_at_end(r, way)) {
        h->cycles = 1.0;
    } else if (to > 0.0) {
        h->cycles = rate_rests(r) ? hop_cycles(r, to, way) : brake_cycles(r, way);
    }
    return h->cycles > 0.0;
}

/* A cycle of the landing. */
static double land(struct halt *h, struct rate *r, double way)
{
    const struct halt_curve l = curve_of(r, way, h->cycles);

    TAKT_ASSERT(h->cycles >= 1.0);
    h->cycles -= 1.0;
    if (h->cycles < 1.0) {
        takt_rate_set(r, 0.0);
        return way;
    }
    return maths_min(curve_at(&l, r, 1.0), way);
}

double takt_halt_step(struct halt *h, struct rate *r, double to, double way)
{
    double here;

    if (h->cycles > 0.0 || begins_landing(h, r, to, way)) {
        return land(h, r, way);
    }
    if (settles(r, to, way, &here)) {
        return here;
    }
    return takt_rate_change_by(r, find_second(r, second_towards(r, to), way));
}

#include "smooth/stall.h"

#include "base/maths.h"

/*
 * A curve goes on by this part of so many tolerances, or of the way at nominal feed, in so many windows, or it never will: or
 * creeps, standing still at the end of each window that it was to leave a place in.
 */
#define STALL_PART       0.1
#define STALL_TOLERANCES 8.0
#define STALL_WINDOWS    2

/* From rest it goes to the route, and then on along it: where it comes to rest more often without having gone on, it never will. */
#define STALL_RESTS 2

/* Where it does not, so much of the tolerance is used, but no less than that part of all of it, for so many tolerances. */
#define NARROWER   0.25
#define NARROWEST  (1.0 / 64.0)
#define NARROW_FOR 16.0

void stall_start(struct stall *s, double tolerance_mm)
{
    *s = (struct stall){.all_mm = tolerance_mm};
}

/* How far the curve should go on in so many pieces: a part of a tolerance, or at nominal feed, or to the end of what is known. */
static double way_expected(const struct stall *s, const struct window *w, const struct route *r,
                           unsigned ready, unsigned pieces)
{
    const double feed_mm_s = (double)route_element(r, w->element[ready])->feed_mm_s;
    const double way_mm =
        maths_min(STALL_TOLERANCES * r->tolerance_mm, pieces * w->interval_s * feed_mm_s);

    return STALL_PART * maths_min(way_mm, route_end(r) - s->mark_mm);
}

/* Does it come to rest again and again where it is? */
static bool rests_again(struct stall *s, const struct route *r, double at_mm)
{
    if (at_mm > s->rest_mm + STALL_PART * r->tolerance_mm) {
        s->rest_mm = at_mm;
        s->rests = 0;
    }
    s->rests++;
    return s->rests > STALL_RESTS;
}

bool stall_stands(struct stall *s, const struct window *w, const struct route *r,
                  const struct stall_window *now)
{
    const unsigned pieces = STALL_WINDOWS * now->most;
    const double at_mm = w->at_mm[now->ready];

    if (now->good >= now->most &&
        w->at_mm[now->whole] <= s->mark_mm + way_expected(s, w, r, now->ready, now->most)) {
        return true;
    }
    if (now->rests && rests_again(s, r, at_mm)) {
        return true;
    }
    s->idle += now->ready;
    if (at_mm > s->mark_mm + way_expected(s, w, r, now->ready, pieces)) {
        s->mark_mm = at_mm;
        s->idle = 0;
    }
    return s->idle > pieces;
}

double stall_tolerance(struct stall *s, const struct window *w, const struct route *r,
                       unsigned ready, bool stands)
{
    const double at_mm = w->at_mm[ready];
    const double narrower_mm = NARROWER * r->tolerance_mm;

    if (stands) {
        s->idle = 0;
        s->rests = 0;
        s->narrow_mm = at_mm + NARROW_FOR * s->all_mm;
        return narrower_mm >= NARROWEST * s->all_mm ? narrower_mm : 0.0;
    }
    return stall_is_near(s, r->tolerance_mm) && at_mm > s->narrow_mm ? s->all_mm : 0.0;
}

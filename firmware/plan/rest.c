/*
 * Goal: a short slow block beside a rest must not hold up the lead point where the setpoint could not reach its ceiling
 * anyway.
 *
 * The lead point is bound by w^2 <= 2 a y, y its way from the rest, since it speeds up from there, or slows down to there,
 * by a at most. Of all ways that keep this, the one that always changes its feed by a has the fastest setpoint, averaged
 * over N cycles, at a way x from the rest:
 *
 *     t <= N cycles:  x = a t^3 / 6N,  v = a t^2 / 2N           v^3 = (9/2) (a/N) x^2
 *     farther away:                                             v^2 = 2 a x - a^2 N^2 / 12
 *
 * For take a way to the same oldest position: in between it lies nowhere nearer to the rest, so its mean is not nearer, and
 * it covers no more within the window. Further averaging boxes change nothing: v is a concave function of x, and a mean of
 * points below it lies below it. A hold only lowers w.
 *
 * Rejected: to lift a block before or behind others of another acceleration. What the lead point may do later then changed
 * when more blocks became known, and a promise was broken.
 */
#include "plan/rest.h"

#include "base/maths.h"
#include "plan/path.h"
#include "plan/path_unit.h"
#include "plan/span.h"

/* Blocks beside a rest that are looked at, at most. */
#define BLOCKS_MAX 8

bool rest_may_exceed(double feed, double x_mm, double a, uint32_t cycles)
{
    const double n = (double)cycles;

    return 6.0 * x_mm <= a * n * n ? 4.5 * a * x_mm * x_mm > n * feed * feed * feed
                                   : 2.0 * a * x_mm - a * a * n * n / 12.0 > feed * feed;
}

static double acceleration(const struct rest_span *r, uint32_t index)
{
    return ceiling_block_acceleration(r->path, index, r->cycles);
}

/* Of a block by itself. */
static struct rest_feeds own_feeds(const struct rest_span *r, uint32_t index)
{
    return (struct rest_feeds){ceiling_block_feed(r->path, index, r->request),
                               path_block_top(path_at(r->path, index))};
}

static bool ends_span(const struct rest_span *r, uint32_t index)
{
    return span_lands(r->path, index) || span_stops(r->path, index);
}

static void find_end(struct rest_span *r, uint32_t index)
{
    for (; index != r->path->closed && path_at(r->path, index)->motion; index++) {
        if (ends_span(r, index)) {
            r->rests = span_stops(r->path, index);
            r->end = index + 1;
            return;
        }
    }
}

void rest_begin(struct rest_span *r, const struct path *path, const struct ceiling_request *request,
                uint32_t index, uint32_t cycles)
{
    const uint64_t start = path_at(path, index)->start;
    const bool first = index == request->first;
    const bool inside = first && ((int64_t)(request->lead - start) > 0 || request->span == start);
    const bool rests = first || span_stops(path, index - 1);

    *r = (struct rest_span){.path = path, .request = request, .cycles = cycles};
    r->start = inside ? request->span : start;
    r->start_a = inside ? request->rest_a : rests ? 0.0 : MATHS_INFINITY;
    find_end(r, index);
}

/* Does the setpoint, never farther from a rest than x_mm, stay below a ceiling? With the margin of ceilings. */
static bool is_below(const struct rest_span *r, double x_mm, double a, double feed_mm_s)
{
    const double feed = feed_mm_s * r->path->limits.cycle_s;

    return !rest_may_exceed(feed, x_mm + CEILING_MARGIN_CYCLES * feed, a, r->cycles);
}

/*
 * Blocks that the setpoint passes on its way up to speed take the feed of the one behind them, if the lead point may speed
 * up alike in all.
 */
static void rise(struct rest_span *r, uint32_t index, double a, struct rest_feeds *feeds)
{
    struct rest_feeds own = *feeds;
    bool low = true;

    r->start_a = r->start_a == 0.0 || r->start_a == a ? a : MATHS_INFINITY;
    for (uint32_t i = index; r->start_a == a && i - index < BLOCKS_MAX && !ends_span(r, i); i++) {
        const double x_mm = path_mm(r->start, path_end(r->path, i));

        low = low && is_below(r, x_mm, a, own.now);
        if (i + 1 == r->path->closed || acceleration(r, i + 1) != a ||
            !is_below(r, x_mm, a, own.highest)) {
            return;
        }
        own = own_feeds(r, i + 1);
        feeds->now = low ? maths_max(feeds->now, own.now) : feeds->now;
        feeds->highest = maths_max(feeds->highest, own.highest);
    }
}

/* May the lead point slow down alike in all blocks from this one to the end? */
static bool is_even(const struct rest_span *r, uint32_t index, double a)
{
    for (; index != r->end; index++) {
        if (acceleration(r, index) != a) {
            return false;
        }
    }
    return true;
}

/* Blocks that it passes on its way to rest take the feed of the one before them, likewise. */
static void fall(const struct rest_span *r, uint32_t index, double a, const struct rest_feeds *own,
                 struct rest_feeds *feeds)
{
    if (!r->rests || r->end - index > BLOCKS_MAX || a != r->before_a || !is_even(r, index, a)) {
        return;
    }
    const double x_mm = path_mm(path_at(r->path, index)->start, path_end(r->path, r->end - 1));

    if (is_below(r, x_mm, a, own->now)) {
        feeds->now = maths_max(feeds->now, r->before.now);
    }
    if (is_below(r, x_mm, a, own->highest)) {
        feeds->highest = maths_max(feeds->highest, r->before.highest);
    }
}

struct rest_feeds rest_block_feeds(struct rest_span *r, uint32_t index)
{
    const double a = acceleration(r, index);
    const struct rest_feeds own = own_feeds(r, index);
    struct rest_feeds feeds = own;

    rise(r, index, a, &feeds);
    fall(r, index, a, &own, &feeds);
    r->before = feeds;
    r->before_a = a;
    return feeds;
}

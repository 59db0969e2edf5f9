#include "page/page_peaks.h"

#include "base/maths.h"

#include <string.h>

/* Differences up to the third need as many cycles before. */
#define ORDERS 3

void page_peaks_init(struct page_peaks *p, uint32_t cycle_us, uint32_t point_us)
{
    memset(p, 0, sizeof *p);
    p->cycle_s = 1e-6 * (double)cycle_us;
    p->every = point_us > cycle_us ? point_us / cycle_us : 1;
}

static void keep_larger(double *peak, double value)
{
    if (maths_abs(value) > maths_abs(*peak))
        *peak = value;
}

/* v = dx / T, a = dv / T, j = da / T */
static void add_axis(struct page_peaks *p, const struct page_cycle *cycle, unsigned i)
{
    const double v = (cycle->set.at[i] - p->set.at[i]) / p->cycle_s;
    const double a = (v - p->velocity.at[i]) / p->cycle_s;
    const double j = (a - p->acceleration.at[i]) / p->cycle_s;

    keep_larger(&p->peak[PAGE_FOLLOWING].at[i], cycle->following.at[i]);
    if (p->known > 0)
        keep_larger(&p->peak[PAGE_VELOCITY].at[i], v);
    if (p->known > 1)
        keep_larger(&p->peak[PAGE_ACCELERATION].at[i], a);
    if (p->known > 2)
        keep_larger(&p->peak[PAGE_JERK].at[i], j);
    p->velocity.at[i] = v;
    p->acceleration.at[i] = a;
}

static void add_point(struct page_peaks *p, const struct point *at)
{
    if (++p->skipped < p->every || p->points == PAGE_POINTS_MAX)
        return;
    p->skipped = 0;
    p->point[p->points++] = *at;
}

void page_peaks_add(struct page_peaks *p, const struct page_cycle *cycle)
{
    if (cycle->number != p->number + 1)
        p->known = 0;
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        add_axis(p, cycle, i);
    add_point(p, &cycle->set);
    p->known += p->known < ORDERS;
    p->number = cycle->number;
    p->set = cycle->set;
}

void page_peaks_clear(struct page_peaks *p)
{
    memset(p->peak, 0, sizeof p->peak);
    p->points = 0;
}

#include "report/thin.h"

#include <math.h>
#include <stdlib.h>

bool thin_open(struct thin *t, unsigned series)
{
    *t = (struct thin){.series = series, .width_cycles = 1};
    t->extreme = calloc((size_t)series * (THIN_BUCKETS_MAX + 1), sizeof *t->extreme);
    return t->extreme != NULL;
}

void thin_close(struct thin *t)
{
    free(t->extreme);
    t->extreme = NULL;
}

static struct thin_extremes *thin_bucket(const struct thin *t, uint32_t bucket)
{
    return t->extreme + (size_t)bucket * t->series;
}

static void bucket_start(struct thin_extremes *e, unsigned series)
{
    for (unsigned i = 0; i < series; i++)
        e[i] = (struct thin_extremes){.min = INFINITY, .max = -INFINITY};
}

/* A NaN compares false and leaves no trace. */
static void bucket_add(struct thin_extremes *e, unsigned series, uint32_t cycle, const float *value)
{
    for (unsigned i = 0; i < series; i++) {
        if (value[i] < e[i].min) {
            e[i].min = value[i];
            e[i].min_cycle = cycle;
        }
        if (value[i] > e[i].max) {
            e[i].max = value[i];
            e[i].max_cycle = cycle;
        }
    }
}

/* Among equal extremes the earlier one is kept. */
static struct thin_extremes extremes_merge(const struct thin_extremes *a,
                                           const struct thin_extremes *b)
{
    struct thin_extremes merged = *a;
    if (b->min < a->min) {
        merged.min = b->min;
        merged.min_cycle = b->min_cycle;
    }
    if (b->max > a->max) {
        merged.max = b->max;
        merged.max_cycle = b->max_cycle;
    }
    return merged;
}

static void thin_merge_pairs(struct thin *t)
{
    for (uint32_t k = 0; k < t->buckets / 2; k++) {
        const struct thin_extremes *even = thin_bucket(t, 2 * k);
        const struct thin_extremes *odd = thin_bucket(t, 2 * k + 1);
        struct thin_extremes *merged = thin_bucket(t, k);
        for (unsigned i = 0; i < t->series; i++)
            merged[i] = extremes_merge(&even[i], &odd[i]);
    }
    t->buckets /= 2;
    t->width_cycles *= 2;
}

void thin_add(struct thin *t, uint32_t cycle, const float *value)
{
    struct thin_extremes *filling = thin_bucket(t, t->buckets);
    if (t->filled_cycles == 0)
        bucket_start(filling, t->series);
    bucket_add(filling, t->series, cycle, value);
    if (++t->filled_cycles < t->width_cycles)
        return;
    t->filled_cycles = 0;
    if (++t->buckets == THIN_BUCKETS_MAX)
        thin_merge_pairs(t);
}

/* One point when both extremes are the same cycle's, else two in order of time. */
static unsigned extremes_get_points(const struct thin_extremes *e, struct thin_point *point)
{
    const struct thin_point low = {e->min_cycle, e->min};
    const struct thin_point high = {e->max_cycle, e->max};
    if (e->min > e->max)
        return 0;
    point[0] = low.cycle < high.cycle ? low : high;
    if (low.cycle == high.cycle)
        return 1;
    point[1] = low.cycle < high.cycle ? high : low;
    return 2;
}

unsigned thin_get_points(const struct thin *t, unsigned series, struct thin_point *point)
{
    const uint32_t buckets = t->buckets + (t->filled_cycles > 0);
    unsigned count = 0;
    for (uint32_t k = 0; k < buckets; k++)
        count += extremes_get_points(&thin_bucket(t, k)[series], point + count);
    return count;
}

/*
 * Many series over the same cycles, thinned so that every peak survives.
 *
 * The cycles are cut into buckets of equal width; a bucket keeps the smallest and the largest value
 * of each series and the cycles they stood at. A bucket starts one cycle wide; whenever
 * THIN_BUCKETS_MAX are full they are merged in pairs and the width doubles. So memory is bounded
 * however long a run is, the result depends on the values alone, and a run of up to
 * THIN_BUCKETS_MAX cycles is kept whole.
 */
#ifndef TAKT_REPORT_THIN_H
#define TAKT_REPORT_THIN_H

#include <stdbool.h>
#include <stdint.h>

#define THIN_BUCKETS_MAX 8192
/* Points one series can come to: two a bucket, and the bucket being filled. */
#define THIN_POINTS_MAX (2 * THIN_BUCKETS_MAX + 2)

struct thin_extremes {
    float min, max; /* min > max: nothing seen yet */
    uint32_t min_cycle, max_cycle;
};

struct thin_point {
    uint32_t cycle;
    float value;
};

struct thin {
    unsigned series;
    uint32_t width_cycles;  /* of a full bucket */
    uint32_t filled_cycles; /* of the bucket being filled */
    uint32_t buckets;       /* full ones */
    struct thin_extremes
        *extreme; /* [THIN_BUCKETS_MAX + 1][series]: full ones, then the one being filled */
};

/* False: out of memory. thin_close frees it. */
bool thin_open(struct thin *t, unsigned series);
void thin_close(struct thin *t);

/*
 * The values of all series at the next cycle; NaN: the series has none there. Cycles come in order.
 */
void thin_add(struct thin *t, uint32_t cycle, const float *value);

/* What is left of one series, in order of time, into point[THIN_POINTS_MAX]; returns how many. */
unsigned thin_get_points(const struct thin *t, unsigned series, struct thin_point *point);

#endif

#include "bore/track.h"

#include "base/maths.h"

#include <stdlib.h>

void bore_track_begin(struct bore_track *t, const char *name, double cycle_s)
{
    *t = (struct bore_track){.name = name, .cycle_s = cycle_s};
}

void bore_track_free(struct bore_track *t)
{
    free(t->at_mm);
    *t = (struct bore_track){0};
}

bool bore_track_add(struct bore_track *t, double x_mm, double y_mm, double z_mm)
{
    if (t->count == t->capacity) {
        size_t capacity = t->capacity == 0 ? 4096 : 2 * t->capacity;
        double(*at_mm)[3] = realloc(t->at_mm, capacity * sizeof *at_mm);

        if (at_mm == NULL)
            return false;
        t->at_mm = at_mm;
        t->capacity = capacity;
    }
    t->at_mm[t->count][0] = x_mm;
    t->at_mm[t->count][1] = y_mm;
    t->at_mm[t->count++][2] = z_mm;
    return true;
}

static double place(const struct bore_track *t, size_t cycle, size_t before, unsigned axis)
{
    return before > cycle ? 0 : t->at_mm[cycle - before][axis];
}

struct bore_motion bore_track_motion(const struct bore_track *t, size_t cycle)
{
    struct bore_motion m = {0};
    double square = 0;

    for (unsigned axis = 0; axis < 2; axis++) {
        double x[4];

        for (size_t i = 0; i < 4; i++)
            x[i] = place(t, cycle, i, axis);
        double v = (x[0] - x[1]) / t->cycle_s;
        double a = (x[0] - 2 * x[1] + x[2]) / (t->cycle_s * t->cycle_s);
        double j = (x[0] - 3 * x[1] + 3 * x[2] - x[3]) / (t->cycle_s * t->cycle_s * t->cycle_s);

        square += v * v;
        m.acceleration_mm_s2 = maths_max(m.acceleration_mm_s2, maths_abs(a));
        m.jerk_mm_s3 = maths_max(m.jerk_mm_s3, maths_abs(j));
    }
    m.feed_mm_s = maths_sqrt(square);
    return m;
}

struct bore_motion bore_track_peaks(const struct bore_track *t, size_t first, size_t last)
{
    struct bore_motion most = {0};

    for (size_t cycle = first; cycle < last && cycle < t->count; cycle++) {
        struct bore_motion m = bore_track_motion(t, cycle);

        most.feed_mm_s = maths_max(most.feed_mm_s, m.feed_mm_s);
        most.acceleration_mm_s2 = maths_max(most.acceleration_mm_s2, m.acceleration_mm_s2);
        most.jerk_mm_s3 = maths_max(most.jerk_mm_s3, m.jerk_mm_s3);
    }
    return most;
}

double bore_track_time(const struct bore_track *t)
{
    return (double)t->count * t->cycle_s;
}

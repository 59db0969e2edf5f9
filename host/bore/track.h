/*
 * The setpoints of a run, one a cycle, and what they ask of the axes of the plane.
 */
#ifndef TAKT_BORE_TRACK_H
#define TAKT_BORE_TRACK_H

#include <stdbool.h>
#include <stddef.h>

struct bore_track {
    const char *name;
    double cycle_s;
    double (*at_mm)[3];
    size_t count, capacity;
};

/*
 * By differences of the setpoints over the cycle, the axes at rest at the origin before the first.
 */
struct bore_motion {
    double feed_mm_s;          /* along the path */
    double acceleration_mm_s2; /* of the axis that has more */
    double jerk_mm_s3;
};

void bore_track_begin(struct bore_track *t, const char *name, double cycle_s);
void bore_track_free(struct bore_track *t);
/* False: memory is short. */
bool bore_track_add(struct bore_track *t, double x_mm, double y_mm, double z_mm);

struct bore_motion bore_track_motion(const struct bore_track *t, size_t cycle);

/* The largest of each over cycles from first to before last. */
struct bore_motion bore_track_peaks(const struct bore_track *t, size_t first, size_t last);

double bore_track_time(const struct bore_track *t);

#endif

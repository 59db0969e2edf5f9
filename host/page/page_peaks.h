/*
 * What the setpoints of many cycles come to, for a screen that is drawn far more rarely: of each
 * axis the largest velocity, acceleration, jerk and following error since the last look, by
 * differences, and points of the way.
 */
#ifndef TAKT_PAGE_PAGE_PEAKS_H
#define TAKT_PAGE_PAGE_PEAKS_H

#include "page/page_link.h"

/* Points of the way, between two looks. */
#define PAGE_POINTS_MAX 64

enum page_peak { PAGE_VELOCITY, PAGE_ACCELERATION, PAGE_JERK, PAGE_FOLLOWING, PAGE_PEAKS };

struct page_peaks {
    double cycle_s;
    /* cycles without a gap before this one, up to 3: of what order differences are known */
    unsigned known;
    unsigned skipped; /* cycles since the last point */
    unsigned every;   /* cycles between two points */
    uint32_t number;
    struct point set, velocity, acceleration; /* of the last cycle */
    struct point peak[PAGE_PEAKS]; /* with the sign of the largest magnitude; mm, rad, s */
    struct point point[PAGE_POINTS_MAX];
    unsigned points;
};

/* point_us: between two points of the way, about. */
void page_peaks_init(struct page_peaks *peaks, uint32_t cycle_us, uint32_t point_us);
void page_peaks_add(struct page_peaks *peaks, const struct page_cycle *cycle);
/* They have been looked at. */
void page_peaks_clear(struct page_peaks *peaks);

#endif

/*
 * Slowing down along a path under an acceleration and a jerk: what the nominal feed is verified by.
 *
 *     feed |‾‾\                 acceleration |  \        /
 *          |   \                             |   \______/      -p, at most A
 *          |    \__                          |
 *          +---------- time                  +------------ time
 */
#ifndef TAKT_SMOOTH_BRAKING_H
#define TAKT_SMOOTH_BRAKING_H

struct braking_limits {
    float acceleration; /* mm/s2 */
    float jerk;         /* mm/s3 */
};

/*
 * The way from a feed and an acceleration until the feed is another one, at most as high, with no
 * acceleration: the one there is ends first, then braking begins. 0 where braking need only end.
 */
float takt_braking_way(const struct braking_limits *l, float feed, float acceleration, float to);

#endif

/*
 * The source's feed diagram of one block, and the factor that makes it land (seed 003, section 1).
 *
 *    feed |       _________________            F_cruise
 *         |      /                 \
 *         |     /                   \________  F_end
 *         |____/ F_start
 *         +----|---|-------------|--|-------> time
 *            up_s     even_s     down_s        each a whole number of cycles
 *
 * Ramps follow an S-curve of limited jerk, stretched to whole cycles. The way of the diagram is
 * then a little longer than the block; every feed is multiplied by kl = length / way <= 1 (3), (4),
 * so that the block ends with a cycle. Its end feeds are multiplied too: between two blocks feed
 * steps by |kl - kl'| F.
 */
#ifndef TAKT_CLASSIC_DIAGRAM_H
#define TAKT_CLASSIC_DIAGRAM_H

#include <stdbool.h>

/* Units: mm, or rad where only rotary axes move. */
struct diagram_limits {
    double length_mm; /* > 0 */
    double feed_mm_s; /* highest, > 0 */
    double a_mm_s2;   /* > 0 */
    double j_mm_s3;   /* > 0 */
};

struct diagram {
    double start_mm_s, cruise_mm_s, end_mm_s; /* before kl */
    double up_s, even_s, down_s;
    double up_round, down_round; /* part of a ramp in which its acceleration rises: 0 to 1/2 */
    double kl;
};

/* Shortest time in which feed changes by so much, >= 0. */
double takt_diagram_ramp_s(const struct diagram_limits *limits, double change_mm_s);

/*
 * The highest feed from which, or to which, one can come from another, at most the highest, within
 * the length.
 */
double takt_diagram_reach(const struct diagram_limits *limits, double feed_mm_s);

/* The diagram between two feeds, each to be reached from the other within the length. */
void takt_diagram_set(struct diagram *d, const struct diagram_limits *limits, double start_mm_s,
                      double end_mm_s, double cycle_s);

/* How long it lasts. */
double takt_diagram_time(const struct diagram *d);

/* Way and feed after a time of it, kl included. */
double takt_diagram_way(const struct diagram *d, double time_s);
double takt_diagram_feed(const struct diagram *d, double time_s);

/* Does feed fall to its end feed then? */
bool takt_diagram_brakes(const struct diagram *d, double time_s);

#endif

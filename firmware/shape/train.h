/*
 * A train of impulses: a weighted mean of what came in c_i cycles ago. Weights add up to 1.
 *
 *     y(n) = w_0 x(n - c_0) + w_1 x(n - c_1) + ...
 *
 * One after the other is again one: the train of the two is each impulse of the one followed by
 * each of the other.
 */
#ifndef TAKT_SHAPE_TRAIN_H
#define TAKT_SHAPE_TRAIN_H

#include <stdint.h>

/*
 * Impulses for two modes: 3 x 3 (or 5 x 5 of those that stand between cycles), times 3 that keep
 * the way, times 2 of a delay.
 */
#define TRAIN_IMPULSES_MAX 64

struct impulse {
    uint32_t cycles; /* late */
    double weight;
};

struct train {
    uint32_t count; /* >= 1 */
    struct impulse impulse[TRAIN_IMPULSES_MAX];
};

/* Leaves everything as it is. */
void takt_train_set_one(struct train *t);

/*
 * Adds an impulse at any time >= 0, that of half of a cycle and so on by the two cycles beside it.
 */
void takt_train_add(struct train *t, double cycles, double weight);

/* The first of a train, which all are added to. */
void takt_train_set_none(struct train *t);

/* Divides the weights by their sum. */
void takt_train_normalise(struct train *t);

/* second is gone through after t. Together they need at most TRAIN_IMPULSES_MAX impulses. */
void takt_train_append(struct train *t, const struct train *second);

/* Cycles by which the train delays slow motion: w_0 c_0 + w_1 c_1 + ... */
double takt_train_mean(const struct train *t);

/*
 * How far it spreads an impulse, cycles squared: w_0 (c_0 - mean)^2 + ... Where x accelerates by a,
 * y is ahead by a/2 of it.
 */
double takt_train_spread(const struct train *t);

/*
 * Weights below 0, added up, without their sign: what a mean has beyond its highest value of what
 * comes in.
 */
double takt_train_below_zero(const struct train *t);

/* The latest impulse. */
uint32_t takt_train_length(const struct train *t);

#endif

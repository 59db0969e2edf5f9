#include "shape/train.h"

#include "base/assert.h"
#include "base/maths.h"

void takt_train_set_none(struct train *t)
{
    t->count = 0;
}

void takt_train_set_one(struct train *t)
{
    t->count = 1;
    t->impulse[0] = (struct impulse){0, 1.0};
}

static void add_whole(struct train *t, uint32_t cycles, double weight)
{
    for (uint32_t i = 0; i < t->count; i++) {
        if (t->impulse[i].cycles == cycles) {
            t->impulse[i].weight += weight;
            return;
        }
    }
    TAKT_ASSERT(t->count < TRAIN_IMPULSES_MAX);
    t->impulse[t->count++] = (struct impulse){cycles, weight};
}

void takt_train_add(struct train *t, double cycles, double weight)
{
    const double whole = takt_maths_floor(cycles);
    const double part = cycles - whole;

    TAKT_ASSERT(cycles >= 0.0);
    add_whole(t, (uint32_t)whole, (1.0 - part) * weight);
    if (part > 0.0) {
        add_whole(t, (uint32_t)whole + 1, part * weight);
    }
}

void takt_train_normalise(struct train *t)
{
    double sum = 0.0;

    for (uint32_t i = 0; i < t->count; i++) {
        sum += t->impulse[i].weight;
    }
    for (uint32_t i = 0; i < t->count; i++) {
        t->impulse[i].weight /= sum;
    }
}

void takt_train_append(struct train *t, const struct train *second)
{
    const struct train first = *t;

    TAKT_ASSERT(first.count > 0 && second->count > 0);
    takt_train_set_none(t);
    for (uint32_t i = 0; i < first.count; i++) {
        for (uint32_t k = 0; k < second->count; k++) {
            add_whole(t, first.impulse[i].cycles + second->impulse[k].cycles,
                      first.impulse[i].weight * second->impulse[k].weight);
        }
    }
}

double takt_train_mean(const struct train *t)
{
    double mean = 0.0;

    TAKT_ASSERT(t->count <= TRAIN_IMPULSES_MAX);
    for (uint32_t i = 0; i < t->count; i++) {
        mean += t->impulse[i].weight * (double)t->impulse[i].cycles;
    }
    return mean;
}

double takt_train_spread(const struct train *t)
{
    const double mean = takt_train_mean(t);
    double spread = 0.0;

    for (uint32_t i = 0; i < t->count; i++) {
        const double away = (double)t->impulse[i].cycles - mean;

        spread += t->impulse[i].weight * away * away;
    }
    return spread;
}

double takt_train_below_zero(const struct train *t)
{
    double sum = 0.0;

    for (uint32_t i = 0; i < t->count; i++) {
        sum += maths_max(0.0, -t->impulse[i].weight);
    }
    return sum;
}

uint32_t takt_train_length(const struct train *t)
{
    uint32_t length = 0;

    for (uint32_t i = 0; i < t->count; i++) {
        length = t->impulse[i].cycles > length ? t->impulse[i].cycles : length;
    }
    return length;
}

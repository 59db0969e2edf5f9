#include "motion/average.h"

#include "base/assert.h"

/*
 * The sum over n inputs at, at - step, ... is n at - step n (n - 1) / 2, and moves by n step a
 * cycle. The inputs are not written, which would take as long as the window is: until a box has had
 * n new ones it counts the old ones up by step.
 */
void takt_average_start(struct average *a, enum ramp_profile profile, uint32_t cycles, uint64_t at,
                        uint64_t step)
{
    uint32_t first = 0;

    TAKT_ASSERT(cycles >= 1 && cycles <= takt_ramp_profile_cycles_max(profile));
    a->boxes = takt_ramp_profile_boxes(profile);
    a->at = at;
    a->scale = 1;
    for (unsigned b = 0; b < a->boxes; b++) {
        struct average_box *box = &a->box[b];
        const uint64_t n = takt_ramp_profile_box_cycles(b, cycles);

        box->first = box->next = first;
        first += (uint32_t)n;
        box->end = first;
        box->old = (uint32_t)n;
        box->oldest = at - (n - 1) * step;
        box->step = step;
        box->sum = n * at - n * (n - 1) / 2 * step;
        at = box->sum;
        step *= n;
        a->scale *= n;
    }
    TAKT_ASSERT(a->box[a->boxes - 1].end <= AVERAGE_INPUTS_MAX);
    a->product = (double)a->scale;
}

static inline uint64_t take_oldest(struct average_box *box, const uint64_t *place)
{
    const uint64_t oldest = box->oldest;

    if (box->old == 0) {
        return *place;
    }
    box->old--;
    box->oldest += box->step;
    return oldest;
}

void takt_average_push(struct average *a, uint64_t at)
{
    a->at = at;
    for (unsigned b = 0; b < a->boxes; b++) {
        struct average_box *box = &a->box[b];
        uint64_t *place = &a->input[box->next];

        box->sum += at - take_oldest(box, place);
        *place = at;
        box->next = box->next + 1 == box->end ? box->first : box->next + 1;
        at = box->sum;
    }
}

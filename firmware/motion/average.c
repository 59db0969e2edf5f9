#include "motion/average.h"

/* The sum over n inputs at, at - step, ... is n at - step n (n - 1) / 2, and moves by n step a cycle. */
void average_start(struct average *a, enum law law, uint32_t cycles, uint64_t at, uint64_t step)
{
    uint32_t first = 0;

    a->law = law;
    a->at = at;
    a->product = 1.0;
    for (unsigned b = 0; b < law_boxes(law); b++) {
        struct average_box *box = &a->box[b];
        const uint64_t n = law_box_cycles(b, cycles);

        box->cycles = (uint32_t)n;
        box->first = first;
        box->next = 0;
        uint64_t input = at;

        for (uint32_t i = first + box->cycles; i-- > first;) {
            a->input[i] = input;
            input -= step;
        }
        first += box->cycles;
        box->sum = n * at - n * (n - 1) / 2 * step;
        at = box->sum;
        step *= n;
        a->product *= (double)n;
    }
}

void average_push(struct average *a, uint64_t at)
{
    a->at = at;
    for (unsigned b = 0; b < law_boxes(a->law); b++) {
        struct average_box *box = &a->box[b];

        uint64_t *oldest = &a->input[box->first + box->next];

        box->sum += at - *oldest;
        *oldest = at;
        box->next = box->next + 1 == box->cycles ? 0 : box->next + 1;
        at = box->sum;
    }
}

/* The last sum is product times the average, modulo 2^64; product times the newest input minus it is small. */
double average_lag(const struct average *a)
{
    const struct average_box *last = &a->box[law_boxes(a->law) - 1];
    uint64_t scaled = a->at;

    for (unsigned b = 0; b < law_boxes(a->law); b++) {
        scaled *= a->box[b].cycles;
    }
    return (double)(int64_t)(scaled - last->sum) / a->product;
}

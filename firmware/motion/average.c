#include "motion/average.h"

/* The sum over n inputs at, at - step, ... is n at - step n (n - 1) / 2, and moves by n step a cycle. */
void average_start(struct average *a, enum law law, uint32_t cycles, uint64_t at, uint64_t step)
{
    a->law = law;
    a->next = 0;
    a->at = at;
    a->product = 1.0;
    for (unsigned b = 0; b < law_boxes(law); b++) {
        struct average_box *box = &a->box[b];
        const uint64_t n = law_box_cycles(b, cycles);

        box->cycles = (uint32_t)n;
        for (uint64_t i = 0; i < n; i++) {
            box->input[LAW_CYCLES_MAX - 1 - i] = at - i * step;
        }
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

        box->sum += at - box->input[(a->next - box->cycles) % LAW_CYCLES_MAX];
        box->input[a->next] = at;
        at = box->sum;
    }
    a->next = (a->next + 1) % LAW_CYCLES_MAX;
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

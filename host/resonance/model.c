#include "resonance/model.h"

#include "vibration/vibration.h"

/* x[k + 1] - 2 x[k] + x[k - 1], in place. */
static void differ_twice(double *x, size_t count, double cycle_s)
{
    double last = count > 0 ? x[0] : 0;

    for (size_t k = 0; k + 1 < count; k++) {
        const double here = x[k];

        x[k] = k > 0 ? ((x[k + 1] - here) - (here - last)) / (cycle_s * cycle_s) : 0;
        last = here;
    }
    if (count > 0)
        x[count - 1] = 0;
}

void resonance_answer(const struct resonance_record *record, double hz, double damping,
                      double *answer_mm_s2)
{
    const struct vibration_config config = {.mode = {{hz, damping, 1}}};
    struct vibration v;

    vibration_init(&v, &config, record->cycle_s);
    for (size_t k = 0; k < record->count; k++) {
        struct point at = {{record->foot_mm[k]}};

        vibration_follow(&v, &at);
        answer_mm_s2[k] = at.at[AXIS_X] - record->foot_mm[k];
    }
    differ_twice(answer_mm_s2, record->count, record->cycle_s);
}

void resonance_beside(const struct resonance_record *record, double *beside_mm_s2)
{
    for (size_t k = 0; k < record->count; k++)
        beside_mm_s2[k] = record->foot_mm[k];
    differ_twice(beside_mm_s2, record->count, record->cycle_s);
    for (size_t k = 0; k < record->count; k++) {
        const bool is_end = k == 0 || k + 1 == record->count;

        beside_mm_s2[k] = is_end ? 0 : record->tool_mm_s2[k] - beside_mm_s2[k];
    }
}

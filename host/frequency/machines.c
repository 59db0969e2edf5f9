#include "frequency/machines.h"

#include <ctype.h>
#include <stdbool.h>

const struct known_machine known_machines[] = {
    {"6R13GN1", 1000, 0.006, 0.01, 5},
    {"FP7M", 1500, 0.006, 0.012, 5},
    {"FP7SMN", 4500, 0.012, 0.02, 5},
    {"MA655SM30A", 6000, 0.02, 0.1, 5},
    /* its axis X alone: jerk meets feed at a radius of 40 mm, and acceleration at 55 mm */
    {"MA655 X", 6000, 0.0283, 0.0283, 0.625},
    {"16K20F3", 7500, 0.02, 0.08, 5},
    {"UCP710", 0, 0, 0, 0},
    {"MIKRON UCP 710", 0, 0, 0, 0},
};

const size_t known_machines_count = sizeof known_machines / sizeof known_machines[0];

static bool is_same(const char *a, const char *b)
{
    while (*a != '\0' && toupper((unsigned char)*a) == toupper((unsigned char)*b)) {
        a++;
        b++;
    }
    return *a == *b;
}

const struct known_machine *known_machine_find(const char *name)
{
    for (size_t i = 0; i < known_machines_count; i++) {
        if (is_same(known_machines[i].name, name))
            return &known_machines[i];
    }
    return NULL;
}

bool known_machine_has_limits(const struct known_machine *machine)
{
    return machine->feed_max_mm_min > 0;
}

struct cycle_limits known_machine_limits(const struct known_machine *machine)
{
    return (struct cycle_limits){
        .feed_mm_s = machine->feed_max_mm_min / 60,
        .acceleration_mm_s2 = machine->gravities * STANDARD_GRAVITY_MM_S2,
        .jerk_mm_s3 = machine->jerk_m_s3 * 1000,
    };
}

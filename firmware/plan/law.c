#include "plan/law.h"

/* With three boxes: 64 x 32 x 32 = 2^16 times 2^38 units a mm leaves 512 mm between lead point and setpoint. */
uint32_t takt_law_cycles_max(enum law law)
{
    return law == LAW_GENTLE ? LAW_CYCLES_MAX / 4 : LAW_CYCLES_MAX;
}

unsigned takt_law_boxes(enum law law)
{
    switch (law) {
    case LAW_JERK:
        return 1;
    case LAW_SMOOTH:
        return 2;
    case LAW_GENTLE:
        break;
    }
    return 3;
}

uint32_t takt_law_box_cycles(unsigned i, uint32_t cycles)
{
    return i == 0 ? cycles : (cycles + 1) / 2;
}

uint32_t takt_law_window_cycles(enum law law, uint32_t cycles)
{
    uint32_t window = 1;

    for (unsigned i = 0; i < takt_law_boxes(law); i++) {
        window += takt_law_box_cycles(i, cycles) - 1;
    }
    return window;
}

/*
 * The pulses of step drives as levels of the pins of a GPIO port, one word every slot of 2.5 us,
 * which direct memory access sends in time (step_output.c).
 *
 *     slot       k - 1          k            k + 1
 *     changes    direction      step high    step low
 *
 * A pulse goes into the first slot from its time on in which its axis is not still busy with the
 * one before: that makes at most 200,000 steps a second and a direction that stands 2.5 us before
 * its step. What does not end in a cycle goes on in the next one. Everything is two slots late, so
 * that a direction has its slot.
 */
#ifndef TAKT_STM32_STEP_SLOTS_H
#define TAKT_STM32_STEP_SLOTS_H

#include "hal/step.h"

#define STEP_SLOT_NS        2500U
#define STEP_SLOTS_MAX      800U /* a cycle of 2 ms */
#define STEP_SLOTS_DELAY    2U
#define STEP_SLOTS_OVERHANG 4U /* words of a cycle that fall into the next */

struct step_slots {
    unsigned slots; /* in a cycle */
    /*
     * Levels in the cycle to come, right at any time: a cycle that is sent too early has steps too
     * few, none the wrong way
     */
    uint16_t *word; /* NULL: not begun */
    /* of the next one: step pins that are high, direction pins that change */
    uint16_t overhang[STEP_SLOTS_OVERHANG];
    uint16_t level;           /* of the direction pins at its end */
    uint8_t direction;        /* as the pins stand after it, by axis */
    int32_t free[AXIS_COUNT]; /* the first slot in which an axis may step */
};

/* False: such a cycle is not possible: at least 10 us, at most 2 ms, whole slots. */
bool takt_step_slots_init(struct step_slots *s, uint32_t cycle_us);

/*
 * Begins the cycle to come, in memory for as many words as it has slots, which nobody else uses
 * until it is taken.
 */
void takt_step_slots_begin(struct step_slots *s, uint16_t *word);

/*
 * For a cycle that has begun. False: no room in it. Pins 0 to 5 are steps, 8 to 13 directions of X
 * Y Z A B C.
 */
bool takt_step_slots_add(struct step_slots *s, const struct step_pulse *pulse);

/* Ends the cycle: its memory has the levels. All other pins of the port are low. */
void takt_step_slots_take(struct step_slots *s);

#endif

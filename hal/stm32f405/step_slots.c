#include "stm32f405/step_slots.h"

#include <string.h>

#define NS_PER_US 1000U

#define DIRECTION_PINS 8U
#define STEPS_MASK     0xFFU

bool step_slots_init(struct step_slots *s, uint32_t cycle_us)
{
    memset(s, 0, sizeof *s);
    s->slots = cycle_us * NS_PER_US / STEP_SLOT_NS;
    return s->slots >= STEP_SLOTS_OVERHANG && s->slots <= STEP_SLOTS_MAX &&
           cycle_us * NS_PER_US % STEP_SLOT_NS == 0;
}

void step_slots_begin(struct step_slots *s, uint16_t *word)
{
    memset(word, 0, s->slots * sizeof *word);
    memcpy(word, s->overhang, sizeof s->overhang);
    memset(s->overhang, 0, sizeof s->overhang);
    s->word = word;
}

static void set_pin(struct step_slots *s, unsigned slot, unsigned pin)
{
    uint16_t *word = slot < s->slots ? &s->word[slot] : &s->overhang[slot - s->slots];

    *word |= (uint16_t)(1U << pin);
}

static void turn(struct step_slots *s, unsigned axis, bool backwards, unsigned slot)
{
    set_pin(s, slot, DIRECTION_PINS + axis);
    s->direction = (uint8_t)((s->direction & ~(1U << axis)) | (unsigned)backwards << axis);
}

static bool add_axis(struct step_slots *s, unsigned axis, bool backwards, unsigned slot)
{
    if ((int32_t)slot < s->free[axis])
        slot = (unsigned)s->free[axis];
    if (slot + 1 >= s->slots + STEP_SLOTS_OVERHANG)
        return false;
    if (backwards != ((s->direction & 1U << axis) != 0))
        turn(s, axis, backwards, slot - 1);
    set_pin(s, slot, axis);
    s->free[axis] = (int32_t)slot + 2;
    return true;
}

bool step_slots_add(struct step_slots *s, const struct step_pulse *pulse)
{
    const unsigned slot = pulse->time_ns / STEP_SLOT_NS + STEP_SLOTS_DELAY;
    bool good = true;

    for (unsigned axis = 0; axis < AXIS_COUNT && good; axis++) {
        if ((pulse->axes >> axis & 1U) != 0)
            good = add_axis(s, axis, (pulse->direction >> axis & 1U) != 0, slot);
    }
    return good;
}

void step_slots_take(struct step_slots *s)
{
    unsigned level = s->level;

    for (unsigned i = 0; i < s->slots; i++) {
        level ^= s->word[i] & ~STEPS_MASK;
        s->word[i] = (uint16_t)(level | (s->word[i] & STEPS_MASK));
    }
    s->level = (uint16_t)level;
    s->word = NULL;
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++)
        s->free[axis] -= (int32_t)s->slots;
}

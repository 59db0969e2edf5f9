#include "stm32/step_slots.h"

#include <string.h>

#define NS_PER_US 1000U

#define DIRECTION_PINS 8U
#define STEPS_MASK     0xFFU

bool takt_step_slots_init(struct step_slots *s, uint32_t cycle_us)
{
    memset(s, 0, sizeof *s);
    s->slots = cycle_us * NS_PER_US / STEP_SLOT_NS;
    return s->slots >= STEP_SLOTS_OVERHANG && s->slots <= STEP_SLOTS_MAX &&
           cycle_us * NS_PER_US % STEP_SLOT_NS == 0;
}

/*
 * The levels of a slot of this cycle, or of one that falls into the next: there as changes of what
 * comes before.
 */
static void raise_pin(struct step_slots *s, unsigned slot, unsigned pin)
{
    uint16_t *word = slot < s->slots ? &s->word[slot] : &s->overhang[slot - s->slots];

    *word |= (uint16_t)(1U << pin);
}

/* A direction changes, from this slot on. */
static void change_level(struct step_slots *s, unsigned slot, unsigned pins)
{
    for (unsigned i = slot; i < s->slots; i++)
        s->word[i] ^= (uint16_t)pins;
    s->level ^= (uint16_t)pins;
}

void takt_step_slots_begin(struct step_slots *s, uint16_t *word)
{
    uint16_t overhang[STEP_SLOTS_OVERHANG];

    memcpy(overhang, s->overhang, sizeof overhang);
    memset(s->overhang, 0, sizeof s->overhang);
    s->word = word;
    for (unsigned i = 0; i < s->slots; i++)
        word[i] = s->level;
    for (unsigned i = 0; i < STEP_SLOTS_OVERHANG; i++) {
        if ((overhang[i] & ~STEPS_MASK) != 0)
            change_level(s, i, overhang[i] & ~STEPS_MASK);
        word[i] |= (uint16_t)(overhang[i] & STEPS_MASK);
    }
}

static void turn(struct step_slots *s, unsigned axis, bool backwards, unsigned slot)
{
    if (slot < s->slots)
        change_level(s, slot, 1U << (DIRECTION_PINS + axis));
    else
        raise_pin(s, slot, DIRECTION_PINS + axis);
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
    raise_pin(s, slot, axis);
    s->free[axis] = (int32_t)slot + 2;
    return true;
}

bool takt_step_slots_add(struct step_slots *s, const struct step_pulse *pulse)
{
    const unsigned slot = pulse->time_ns / STEP_SLOT_NS + STEP_SLOTS_DELAY;
    bool good = true;

    for (unsigned axis = 0; axis < AXIS_COUNT && good; axis++) {
        if ((pulse->axes >> axis & 1U) != 0)
            good = add_axis(s, axis, (pulse->direction >> axis & 1U) != 0, slot);
    }
    return good;
}

void takt_step_slots_take(struct step_slots *s)
{
    s->word = NULL;
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++)
        s->free[axis] -= (int32_t)s->slots;
}

#include "program/parameters.h"

#include "base/assert.h"

#include <string.h>

void takt_parameters_clear(struct parameters *p)
{
    memset(p, 0, sizeof(*p));
}

/* Index of the first number not below number, by bisection. */
static unsigned position_of(const struct parameters *p, unsigned number)
{
    unsigned low = 0;
    unsigned high = p->count;

    TAKT_ASSERT(p->count <= PARAMETERS_MAX);
    while (low < high) {
        const unsigned middle = (low + high) / 2;

        if (p->number[middle] < number) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

static bool holds(const struct parameters *p, unsigned position, unsigned number)
{
    return position < p->count && p->number[position] == number;
}

double takt_parameters_get(const struct parameters *p, unsigned number)
{
    TAKT_ASSERT(number >= 1);
    if (number <= PARAMETERS_LOCAL) {
        return p->local[number - 1];
    }
    const unsigned position = position_of(p, number);

    return holds(p, position, number) ? p->value[position] : 0.0;
}

static void insert(struct parameters *p, unsigned position, unsigned number)
{
    TAKT_ASSERT(p->count < PARAMETERS_MAX && position <= p->count);
    for (unsigned i = p->count; i > position; i--) {
        p->number[i] = p->number[i - 1];
        p->value[i] = p->value[i - 1];
    }
    p->number[position] = (uint16_t)number;
    p->count++;
}

/* Those that are 0 need no place. */
static void drop_zeros(struct parameters *p)
{
    unsigned count = 0;

    for (unsigned i = 0; i < p->count; i++) {
        if (p->value[i] != 0.0) {
            p->number[count] = p->number[i];
            p->value[count++] = p->value[i];
        }
    }
    p->count = (uint16_t)count;
}

static bool make_room(struct parameters *p)
{
    if (p->count == PARAMETERS_MAX) {
        drop_zeros(p);
    }
    return p->count < PARAMETERS_MAX;
}

bool takt_parameters_set(struct parameters *p, unsigned number, double value)
{
    TAKT_ASSERT(number >= 1);
    if (number <= PARAMETERS_LOCAL) {
        p->local[number - 1] = value;
        return true;
    }
    unsigned position = position_of(p, number);

    if (!holds(p, position, number)) {
        if (value == 0.0) {
            return true;
        }
        if (!make_room(p)) {
            return false;
        }
        position = position_of(p, number);
        insert(p, position, number);
    }
    p->value[position] = value;
    return true;
}

bool takt_parameters_next(const struct parameters *p, unsigned *number, double *value)
{
    for (unsigned n = *number + 1; n <= PARAMETERS_LOCAL; n++) {
        if (p->local[n - 1] != 0.0) {
            *number = n;
            *value = p->local[n - 1];
            return true;
        }
    }
    for (unsigned i = position_of(p, *number + 1); i < p->count; i++) {
        if (p->value[i] != 0.0) {
            *number = p->number[i];
            *value = p->value[i];
            return true;
        }
    }
    return false;
}

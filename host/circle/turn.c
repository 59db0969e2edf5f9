#include "circle/turn.h"

#include "base/maths.h"

#include <stdlib.h>

/* At first; it doubles. */
#define CAPACITY 4096

static bool make_room(struct circle_turn *turn)
{
    const size_t capacity = turn->capacity != 0 ? 2 * turn->capacity : CAPACITY;
    struct circle_place *place;

    if (turn->count < turn->capacity)
        return true;
    place = realloc(turn->place, capacity * sizeof *place);
    turn->failed = turn->failed || place == NULL;
    if (place == NULL)
        return false;
    turn->place = place;
    turn->capacity = capacity;
    return true;
}

void circle_turn_add(struct circle_turn *turn, const double from_centre_mm[2])
{
    const double x = from_centre_mm[0], y = from_centre_mm[1];
    const double angle = takt_maths_atan2(y, x);

    if (!make_room(turn))
        return;
    turn->place[turn->count++] = (struct circle_place){angle < 0 ? angle + MATHS_TWO_PI : angle,
                                                       maths_sqrt(x * x + y * y) - turn->radius_mm};
}

void circle_turn_free(struct circle_turn *turn)
{
    free(turn->place);
    turn->place = NULL;
    turn->count = turn->capacity = 0;
}

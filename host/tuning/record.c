#include "tuning/record.h"

#include <stdlib.h>

#define ROOM_FIRST 4096

static bool grow(double **numbers, size_t room)
{
    double *more = realloc(*numbers, room * sizeof **numbers);

    if (more != NULL)
        *numbers = more;
    return more != NULL;
}

void tuning_record_add(struct tuning_record *record, double input, double position)
{
    const size_t room = record->room > 0 ? 2 * record->room : ROOM_FIRST;

    if (record->failed)
        return;
    if (record->count == record->room) {
        if (!grow(&record->input, room) || !grow(&record->position, room)) {
            record->failed = true;
            return;
        }
        record->room = room;
    }
    record->input[record->count] = input;
    record->position[record->count++] = position;
}

void tuning_record_free(struct tuning_record *record)
{
    free(record->input);
    free(record->position);
    *record = (struct tuning_record){.cycle_s = record->cycle_s, .step = record->step};
}

#include "resonance/record.h"

#include <stdlib.h>

/* At first; it doubles. */
#define CAPACITY 16384

static bool make_room(struct resonance_record *r)
{
    const size_t capacity = r->capacity != 0 ? 2 * r->capacity : CAPACITY;
    double *foot_mm, *tool_mm_s2;

    if (r->count < r->capacity)
        return true;
    foot_mm = realloc(r->foot_mm, capacity * sizeof *foot_mm);
    r->foot_mm = foot_mm != NULL ? foot_mm : r->foot_mm;
    tool_mm_s2 = realloc(r->tool_mm_s2, capacity * sizeof *tool_mm_s2);
    r->tool_mm_s2 = tool_mm_s2 != NULL ? tool_mm_s2 : r->tool_mm_s2;
    r->failed = r->failed || foot_mm == NULL || tool_mm_s2 == NULL;
    r->capacity = r->failed ? r->capacity : capacity;
    return !r->failed;
}

void resonance_record_add(struct resonance_record *record, double foot_mm, double tool_mm_s2)
{
    if (!make_room(record))
        return;
    record->foot_mm[record->count] = foot_mm;
    record->tool_mm_s2[record->count] = tool_mm_s2;
    record->count++;
}

void resonance_record_free(struct resonance_record *record)
{
    free(record->foot_mm);
    free(record->tool_mm_s2);
    *record = (struct resonance_record){.cycle_s = record->cycle_s};
}
